#include "read/nori/transforms.h"

#include "base/table.h"
#include "base/values.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

Vec3 triple_of(const XmlNode &node, const char *attribute) {
    return at_place(node, [&] { return parse_triple(node.attribute(attribute)); });
}

void require(const XmlNode &node, const ParseContext &context, std::initializer_list<const char *> names) {
    context.require_attributes(node, names);
    for (const char *name : names)
        if (!node.has_attribute(name))
            throw NoObject{}; // that is told
}

Transform parse_translate(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"value"});
    return Transform::translate(triple_of(node, "value"));
}

Transform parse_scale(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"value"});
    return Transform::scale(triple_of(node, "value"));
}

Transform parse_rotate(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"axis", "angle"});
    Vec3 axis = triple_of(node, "axis");
    if (length(axis) == 0)
        node.fail("the axis of a rotation must not be 0 0 0");
    return Transform::rotate(axis, at_place(node, [&] { return parse_number(node.attribute("angle")); }));
}

Transform parse_matrix(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"value"});
    std::vector<double> n = at_place(node, [&] { return parse_numbers(node.attribute("value"), 16); });
    Transform matrix;
    for (int i = 0; i < 16; ++i)
        matrix.rows[i / 4][i % 4] = n[i];
    return matrix;
}

Transform parse_lookat(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"origin", "target", "up"});
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
    Transform (*parse)(const XmlNode &, const ParseContext &);
};

const std::vector<Operation> operations = {{"translate", parse_translate},
                                           {"scale", parse_scale},
                                           {"rotate", parse_rotate},
                                           {"matrix", parse_matrix},
                                           {"lookat", parse_lookat}};

} // namespace

Transform parse_transform(const XmlNode &node, const ParseContext &context) {
    Transform result;
    bool is_good = true;
    for (const XmlNode &child : node.children(context.handler())) {
        const auto row = std::find_if(operations.begin(), operations.end(),
                                      [&](const Operation &operation) { return operation.name == child.tag(); });
        if (row == operations.end()) {
            context.unknown(child, unknown_name("operation", child.tag(), names_of(operations)));
            is_good = is_good && context.lenient;
            continue;
        }
        bool is_read = false;
        context.attempt(child, [&] {
            result = row->parse(child, context) * result;
            if (!child.children().empty())
                child.children().front().fail(fmt::format("<{}> holds nothing", child.tag()));
            is_read = true;
        });
        is_good = is_good && is_read;
    }
    if (!is_good)
        throw NoObject{};
    if (!invertible(result))
        node.fail("the transform is singular: it flattens space and has no inverse");
    return result;
}

} // namespace opal
