#include "read/nori/transforms.h"

#include "read/nori/properties.h"

#include <fmt/format.h>

namespace opal {

namespace {

Vec3 triple_of(const XmlNode &node, const char *attribute) {
    return at_place(node, [&] { return parse_triple(node.attribute(attribute)); });
}

Transform parse_translate(const XmlNode &node) {
    node.require_attributes({"value"});
    return Transform::translate(triple_of(node, "value"));
}

Transform parse_scale(const XmlNode &node) {
    node.require_attributes({"value"});
    return Transform::scale(triple_of(node, "value"));
}

Transform parse_rotate(const XmlNode &node) {
    node.require_attributes({"axis", "angle"});
    Vec3 axis = triple_of(node, "axis");
    if (length(axis) == 0)
        node.fail("the axis of a rotation must not be 0 0 0");
    return Transform::rotate(axis, at_place(node, [&] { return parse_number(node.attribute("angle")); }));
}

Transform parse_matrix(const XmlNode &node) {
    node.require_attributes({"value"});
    std::vector<double> n = at_place(node, [&] { return parse_numbers(node.attribute("value"), 16); });
    Transform matrix;
    for (int i = 0; i < 16; ++i)
        matrix.rows[i / 4][i % 4] = n[i];
    return matrix;
}

Transform parse_lookat(const XmlNode &node) {
    node.require_attributes({"origin", "target", "up"});
    Vec3 origin = triple_of(node, "origin"), target = triple_of(node, "target"), up = triple_of(node, "up");
    Vec3 direction = target - origin;
    if (length(direction) == 0)
        node.fail("origin and target of a lookat must differ");
    if (!(length(cross(up, direction)) > 1e-12 * length(up) * length(direction)))
        node.fail("up of a lookat must not be 0 0 0 or parallel to the direction from origin to target");
    return Transform::look_at(origin, target, up);
}

// |det| over the product of the columns' lengths, 0 to 1 (Hadamard's inequality): 0 if the map is singular, whatever
// its scale.
bool invertible(const Transform &t) {
    double box = 1;
    for (int i = 0; i < 3; ++i)
        box *= std::hypot(t.rows[i][0], t.rows[i][1], t.rows[i][2]);
    return std::abs(t.determinant()) > 1e-14 * box;
}

struct Operation {
    std::string name;
    Transform (*parse)(const XmlNode &);
};

const std::vector<Operation> operations = {{"translate", parse_translate},
                                           {"scale", parse_scale},
                                           {"rotate", parse_rotate},
                                           {"matrix", parse_matrix},
                                           {"lookat", parse_lookat}};

} // namespace

Transform parse_transform(const XmlNode &node) {
    Transform result;
    for (const XmlNode &child : node.children()) {
        const Operation &operation =
            at_place(child, [&]() -> const Operation & { return find_row(operations, "operation", child.tag()); });
        result = operation.parse(child) * result;
        if (!child.children().empty())
            child.children().front().fail(fmt::format("<{}> holds nothing", child.tag()));
    }
    if (!invertible(result))
        node.fail("the transform is singular: it flattens space and has no inverse");
    return result;
}

} // namespace opal
