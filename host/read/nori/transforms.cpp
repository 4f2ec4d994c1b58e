#include "read/nori/transforms.h"

#include "base/values.h"
#include "read/transform.h"

namespace opal {

namespace {

Vec3 triple_of(const XmlNode &node, const char *attribute) {
    return at_place(node, [&] { return parse_triple(node.attribute(attribute)); });
}

void require(const XmlNode &node, const ParseContext &context, std::initializer_list<const char *> names) {
    if (!context.require_attributes(node, names))
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
    return look_at(node, origin, target, up);
}

const std::vector<TransformOperation> operations = {{"translate", parse_translate},
                                                    {"scale", parse_scale},
                                                    {"rotate", parse_rotate},
                                                    {"matrix", parse_matrix},
                                                    {"lookat", parse_lookat}};

} // namespace

Transform parse_transform(const XmlNode &node, const ParseContext &context) {
    return parse_transform(node, context, operations);
}

} // namespace opal
