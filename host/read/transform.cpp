#include "read/transform.h"

#include "base/table.h"

#include <algorithm>
#include <cmath>

namespace opal {

namespace {

bool is_finite(const Transform &t) {
    return std::ranges::all_of(
        t.rows, [](const auto &row) { return std::ranges::all_of(row, [](double x) { return std::isfinite(x); }); });
}

// |det| over the product of the columns' lengths, 0 to 1 (Hadamard's inequality): 0 if the map is singular, whatever
// its scale.
bool is_invertible(const Transform &t) {
    double box = 1;
    for (int i = 0; i < 3; ++i)
        box *= std::hypot(t.rows[i][0], t.rows[i][1], t.rows[i][2]);
    return std::abs(t.determinant()) > 1e-14 * box;
}

} // namespace

Transform parse_transform(const XmlNode &node, const ParseContext &context,
                          std::span<const TransformOperation> operations) {
    Transform result;
    bool is_good = true;
    for (const XmlNode &child : node.children(context.handler())) {
        const auto row = std::ranges::find(operations, child.tag(), &TransformOperation::name);
        if (row == operations.end()) {
            context.unknown(child, unknown_name("operation", child.tag(), names_of(operations)));
            is_good = is_good && context.lenient;
            continue;
        }
        bool is_read = false;
        context.attempt(child, [&] {
            result = row->parse(child, context) * result;
            child.require_empty();
            is_read = true;
        });
        is_good = is_good && is_read;
    }
    if (!is_good)
        throw NoObject{};
    if (!is_finite(result))
        node.fail("the numbers of the transform overflow");
    if (!is_invertible(result))
        node.fail("the transform is singular: it flattens space and has no inverse");
    return result;
}

Transform look_at(const XmlNode &node, Vec3 origin, Vec3 target, Vec3 up) {
    const Vec3 direction = target - origin;
    if (length(direction) == 0)
        node.fail("origin and target of a lookat must differ");
    if (!(length(cross(up, direction)) > 1e-12 * length(up) * length(direction)))
        node.fail("up of a lookat must not be 0 0 0 or parallel to the direction from origin to target");
    return Transform::look_at(origin, target, up);
}

} // namespace opal
