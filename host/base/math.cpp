#include "base/math.h"

#include <numbers>

namespace opal {

namespace {

Vec3 row(const Transform &t, int i) { return {t.rows[i][0], t.rows[i][1], t.rows[i][2]}; }

Transform from_columns(Vec3 x, Vec3 y, Vec3 z, Vec3 origin) {
    Transform t;
    for (int i = 0; i < 3; ++i)
        t.rows[i] = {x[i], y[i], z[i], origin[i]};
    return t;
}

} // namespace

Vec3 Transform::point(Vec3 p) const {
    auto along = [&](int i) { return dot(row(*this, i), p) + rows[i][3]; };
    double w = along(3);
    return {along(0) / w, along(1) / w, along(2) / w};
}

Vec3 Transform::vector(Vec3 v) const { return {dot(row(*this, 0), v), dot(row(*this, 1), v), dot(row(*this, 2), v)}; }

// The rows of the inverse transpose are the cross products of the rows, divided by the determinant. Its sign matters:
// without it, a mirroring transform would turn the normals round.
Vec3 Transform::normal(Vec3 n) const {
    Vec3 a = row(*this, 0), b = row(*this, 1), c = row(*this, 2);
    return Vec3{dot(cross(b, c), n), dot(cross(c, a), n), dot(cross(a, b), n)} * (1 / determinant());
}

double Transform::determinant() const { return dot(row(*this, 0), cross(row(*this, 1), row(*this, 2))); }

Transform Transform::translate(Vec3 t) { return from_columns({1, 0, 0}, {0, 1, 0}, {0, 0, 1}, t); }

Transform Transform::scale(Vec3 s) { return from_columns({s.x, 0, 0}, {0, s.y, 0}, {0, 0, s.z}, {}); }

// Rodrigues' formula: R = cos I + sin [a]x + (1 - cos) a a^T.
Transform Transform::rotate(Vec3 axis, double degrees) {
    Vec3 a = normalize(axis);
    double radians = degrees * std::numbers::pi / 180, s = std::sin(radians), c = std::cos(radians);
    auto column = [&](Vec3 e) { return e * c + cross(a, e) * s + a * (dot(a, e) * (1 - c)); };
    return from_columns(column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1}), {});
}

// Columns left, up', direction, origin. In Nori the camera's +x axis points to the left of the image.
Transform Transform::look_at(Vec3 origin, Vec3 target, Vec3 up) {
    Vec3 direction = normalize(target - origin);
    Vec3 left = normalize(cross(normalize(up), direction));
    return from_columns(left, normalize(cross(direction, left)), direction, origin);
}

Transform operator*(const Transform &a, const Transform &b) {
    Transform product;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) {
            product.rows[i][j] = 0;
            for (int k = 0; k < 4; ++k)
                product.rows[i][j] += a.rows[i][k] * b.rows[k][j];
        }
    return product;
}

} // namespace opal
