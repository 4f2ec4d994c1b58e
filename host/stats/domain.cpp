#include "stats/domain.h"

#include "base/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace opal::stats {
namespace {

constexpr double pi = std::numbers::pi;
constexpr double slack = 1e-5; // about 100 roundings of single precision at 1

constexpr std::array<Domain, 6> domains = {{{DomainKind::square, "square", {0, 1, 0, 1}, 1},
                                            {DomainKind::biunit, "biunit", {-1, 1, -1, 1}, 1},
                                            {DomainKind::disk, "disk", {0, 1, 0, 2 * pi}, 2},
                                            {DomainKind::triangle, "triangle", {0, 1, 0, 1}, 2},
                                            {DomainKind::hemisphere, "hemisphere", {0, 1, 0, 2 * pi}, 1},
                                            {DomainKind::sphere, "sphere", {-1, 1, 0, 2 * pi}, 1}}};

double azimuth(Vec3 p) {
    double phi = std::atan2(p.y, p.x);
    return phi < 0 ? phi + 2 * pi : phi;
}

bool is_unit(Vec3 d) { return std::abs(length(d) - 1) <= slack; }

Point2 unclamped(const Domain &domain, Vec3 p) {
    switch (domain.kind) {
    case DomainKind::disk:
        return {p.x * p.x + p.y * p.y, azimuth(p)};
    case DomainKind::triangle: // near the tip rounding carries x / (1 - y) far beyond 1, so x and y
                               // are tested instead
        if (!(p.x >= -slack && p.y >= -slack && p.x + p.y <= 1 + slack))
            return {NAN, NAN};
        return {(1 - p.y) * std::abs(1 - p.y), p.y < 1 ? std::clamp(p.x / (1 - p.y), 0.0, 1.0) : 0};
    case DomainKind::hemisphere:
    case DomainKind::sphere:
        return is_unit(p) ? Point2{p.z, azimuth(p)} : Point2{NAN, NAN};
    default:
        return {p.x, p.y};
    }
}

} // namespace

const Domain &domain(DomainKind kind) { return domains[size_t(kind)]; }

const Domain &domain(const std::string &name) {
    std::string names;
    for (const Domain &d : domains) {
        if (name == d.name)
            return d;
        names += (names.empty() ? "" : ", ") + std::string(d.name);
    }
    throw Error("unknown domain '" + name + "'; available: " + names);
}

std::optional<Point2> to_rectangle(const Domain &domain, Vec3 point) {
    Point2 uv = unclamped(domain, point);
    const Rectangle &b = domain.bounds;
    bool inside = uv.x >= b.x0 - slack && uv.x <= b.x1 + slack && uv.y >= b.y0 - slack && uv.y <= b.y1 + slack;
    if (!inside) // or NaN
        return std::nullopt;
    return Point2{std::clamp(uv.x, b.x0, b.x1), std::clamp(uv.y, b.y0, b.y1)};
}

Vec3 spherical_direction(double cos_theta, double phi) {
    double sin_theta = std::sqrt(std::max(0.0, (1 - cos_theta) * (1 + cos_theta)));
    return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

Vec3 from_rectangle(const Domain &domain, Point2 uv) {
    switch (domain.kind) {
    case DomainKind::disk:
        return {std::sqrt(uv.x) * std::cos(uv.y), std::sqrt(uv.x) * std::sin(uv.y), 0};
    case DomainKind::triangle:
        return {uv.y * std::sqrt(uv.x), 1 - std::sqrt(uv.x), 0};
    case DomainKind::hemisphere:
    case DomainKind::sphere:
        return spherical_direction(uv.x, uv.y);
    default:
        return {uv.x, uv.y, 0};
    }
}

} // namespace opal::stats
