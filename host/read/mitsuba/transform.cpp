#include "read/mitsuba/transform.h"

#include "base/log.h"
#include "base/printable.h"
#include "base/values.h"
#include "read/transform.h"

#include <fmt/format.h>

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <vector>

namespace opal::mitsuba {

namespace {

constexpr std::initializer_list<const char *> xyz = {"value", "x", "y", "z"};

double number_of(const XmlNode &node, const char *attribute) {
    return at_place(node, [&] { return parse_number(node.attribute(attribute)); });
}

Vec3 triple_of(const XmlNode &node, const char *attribute) {
    return at_place(node, [&] { return parse_triple(node.attribute(attribute)); });
}

void require(const XmlNode &node, const ParseContext &context, std::initializer_list<const char *> names,
             std::initializer_list<const char *> optional = {}) {
    if (!context.require_attributes(node, names, optional))
        throw NoObject{}; // that is told
}

Transform parse_translate(const XmlNode &node, const ParseContext &context) {
    require(node, context, {}, xyz);
    return Transform::translate(parse_xyz(node, 0));
}

Transform parse_scale(const XmlNode &node, const ParseContext &context) {
    require(node, context, {}, xyz);
    return Transform::scale(parse_xyz(node, 1));
}

// Rodrigues' formula c I + s [a]x + (1 - c) a a^T, but with the axis a as written: that is what Mitsuba computes.
Transform rotation(Vec3 a, double degrees) {
    const double radians = degrees * std::numbers::pi / 180, s = std::sin(radians), c = std::cos(radians);
    Transform result;
    for (int j = 0; j < 3; j++) {
        const Vec3 e{double(j == 0), double(j == 1), double(j == 2)};
        const Vec3 column = e * c + cross(a, e) * s + a * (a[j] * (1 - c));
        for (int i = 0; i < 3; i++)
            result.rows[size_t(i)][size_t(j)] = column[i];
    }
    return result;
}

Transform parse_rotate(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"angle"}, xyz);
    const Vec3 axis = parse_xyz(node, 0);
    const double norm = length(axis);
    if (norm == 0)
        node.fail("the axis of a rotation must not be 0 0 0");
    constexpr double rounded = 1e-3; // of an axis with three decimals
    if (std::abs(norm - 1) > rounded)
        warn(fmt::format(
            "{}: the axis of this <rotate> has length {:.4g}, not 1: the scene is stretched, as Mitsuba does",
            node.place().text(), norm));
    return rotation(axis, number_of(node, "angle"));
}

Transform parse_matrix(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"value"});
    const std::string text = node.attribute("value");
    const size_t count = split(text).size(), side = count == 9 ? 3 : 4;
    if (count != 9 && count != 16)
        node.fail(fmt::format("{} holds {} numbers, not 16 or 9", opal::quoted(text), count));
    const std::vector<double> numbers = at_place(node, [&] { return parse_numbers(text, count); });
    Transform matrix;
    for (size_t i = 0; i < side; i++)
        for (size_t j = 0; j < side; j++)
            matrix.rows[i][j] = numbers[i * side + j];
    if (matrix.rows[3] != std::array<double, 4>{0, 0, 0, 1})
        node.fail("the last row of a <matrix> must be 0 0 0 1");
    return matrix;
}

// The first vector of an orthonormal basis around the direction (Duff et al. 2017): the up that Mitsuba chooses.
Vec3 chosen_up(Vec3 direction) {
    const Vec3 n = normalize(direction);
    const double sign = std::copysign(1, n.z), a = -1 / (sign + n.z), b = n.x * n.y * a;
    return {1 + sign * n.x * n.x * a, sign * b, -sign * n.x};
}

Transform parse_lookat(const XmlNode &node, const ParseContext &context) {
    require(node, context, {"origin", "target"}, {"up"});
    const Vec3 origin = triple_of(node, "origin"), target = triple_of(node, "target");
    const Vec3 up = node.attribute("up").empty() ? Vec3{} : triple_of(node, "up");
    const bool chooses = length(up) == 0 && length(target - origin) > 0;
    return look_at(node, origin, target, chooses ? chosen_up(target - origin) : up);
}

// lookAt: as files of Mitsuba 0.x spell it; Mitsuba 3 refuses it there.
const std::vector<TransformOperation> operations = {{"translate", parse_translate}, {"scale", parse_scale},
                                                    {"rotate", parse_rotate},       {"matrix", parse_matrix},
                                                    {"lookat", parse_lookat},       {"lookAt", parse_lookat}};

} // namespace

Vec3 parse_xyz(const XmlNode &node, double fallback) {
    const bool has_parts = node.has_attribute("x") || node.has_attribute("y") || node.has_attribute("z");
    if (node.has_attribute("value")) {
        if (has_parts)
            node.fail(fmt::format("<{}> has both value and x, y or z", node.tag()));
        const std::string text = node.attribute("value");
        return at_place(node, [&] {
            if (split(text).size() != 1)
                return parse_triple(text);
            const double x = parse_numbers(text, 1)[0];
            return Vec3{x, x, x};
        });
    }
    const auto part = [&](const char *name) { return node.has_attribute(name) ? number_of(node, name) : fallback; };
    return {part("x"), part("y"), part("z")};
}

Transform parse_transform(const XmlNode &node, const ParseContext &context) {
    return opal::parse_transform(node, context, operations);
}

} // namespace opal::mitsuba
