// Domains of sampling functions, each with an area-preserving map to a rectangle: equal cells of the rectangle are
// equal areas (or solid angles) of the domain.
#pragma once

#include "base/math.h"
#include "stats/quadrature.h"

#include <optional>
#include <string>
#include <vector>

namespace opal::stats {

// name, rectangle [u0, u1] x [v0, v1], du dv / d(measure)   (measure: area, or solid angle in sr)
//   square       [0, 1]^2                    u = x, v = y
//   biunit       [-1, 1]^2, where tents lie  u = x, v = y
//   disk         radius 1                    u = r^2, v = phi
//   triangle     x, y >= 0, x + y <= 1       u = (1 - y)^2, v = x / (1 - y)
//   hemisphere   z >= 0                      u = cos theta, v = phi
//   sphere                                   u = cos theta, v = phi
// phi = atan2(y, x) lies in [0, 2 pi). Points of two dimensions have z = 0; directions are unit vectors.
enum class DomainKind { square, biunit, disk, triangle, hemisphere, sphere };

struct Domain {
    DomainKind kind;
    const char *name;
    Rectangle bounds;                                             // of (u, v)
    double area_ratio;                                            // du dv for one unit of the domain's own measure
    double measure() const { return bounds.area() / area_ratio; } // whole area or solid angle
};

const Domain &domain(DomainKind kind);
const Domain &domain(const std::string &name); // Error that lists the names

// (u, v) of a point, and back. Nothing for NaN and for points outside the domain, beyond a tolerance of 1e-5 of its
// size for single precision; a direction whose length is not 1 is outside.
std::optional<Point2> to_rectangle(const Domain &domain, Vec3 point);
Vec3 from_rectangle(const Domain &domain, Point2 uv);

// A direction from spherical coordinates: (sin theta cos phi, sin theta sin phi, cos theta).
Vec3 spherical_direction(double cos_theta, double phi);

} // namespace opal::stats
