// Vectors and transforms in double, for reading and flattening scenes.
#pragma once

#include <array>
#include <cmath>

namespace opal {

struct Vec3 {
    double x = 0, y = 0, z = 0;
    double operator[](int axis) const { return axis == 0 ? x : axis == 1 ? y : z; }
};

inline Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator*(Vec3 a, double s) { return {a.x * s, a.y * s, a.z * s}; }
inline double dot(Vec3 a, Vec3 b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec3 cross(Vec3 a, Vec3 b) { return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x}; }
inline double length(Vec3 a) { return std::hypot(a.x, a.y, a.z); }
inline Vec3 normalize(Vec3 a) { return a * (1 / length(a)); }

// A 4 x 4 matrix, row-major: point p goes to rows[i][0..2] . p + rows[i][3], divided by w.
struct Transform {
    std::array<std::array<double, 4>, 4> rows = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};

    Vec3 point(Vec3 p) const;
    Vec3 vector(Vec3 v) const;
    Vec3 normal(Vec3 n) const;  // inverse transpose, not normalised
    double determinant() const; // of the upper 3x3
    static Transform translate(Vec3 t);
    static Transform scale(Vec3 s);
    static Transform rotate(Vec3 axis, double degrees);
    static Transform look_at(Vec3 origin, Vec3 target, Vec3 up);
};
Transform operator*(const Transform &a, const Transform &b); // applies b first

} // namespace opal
