#include "densities/sampled.h"
#include "base/error.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace opal {

namespace {

using stats::DomainKind;

struct WarpRow {
    const char *name;
    DomainKind domain;
};

#define OPAL_WARP_ROW(name, domain) {#name, DomainKind::domain},
#define OPAL_LOBE_ROW(name, domain, parameter, otherwise) {#name, DomainKind::domain},
constexpr WarpRow warps[] = {OPAL_WARPS(OPAL_WARP_ROW, OPAL_WARP_ROW, OPAL_LOBE_ROW)};

constexpr double turn = 2 * std::numbers::pi, far_away = 1e30;
constexpr Vec3 no_point = {NAN, NAN, NAN}; // outside of every domain

double angle_of(Vec3 w) { // azimuth in [0, 2 pi)
    const double phi = std::atan2(w.y, w.x);
    return phi < 0 ? phi + turn : phi;
}

// A lobe of this width, in radians, around direction w.
void add_peak(Sampled &sampled, Vec3 w, double width) {
    const double sine = std::hypot(w.x, w.y), low = sampled.domain->bounds.x0;
    const std::vector<double> us = stats::splits_about(w.z, width * std::max(sine, width / 2), low, 1);
    sampled.splits_u.insert(sampled.splits_u.end(), us.begin(), us.end());
    if (sine > width)
        for (double center : {angle_of(w) - turn, angle_of(w), angle_of(w) + turn}) {
            const std::vector<double> vs = stats::splits_about(center, width / sine, 0, turn);
            sampled.splits_v.insert(sampled.splits_v.end(), vs.begin(), vs.end());
        }
}

bool is_black(Vec3 weight) { return weight.x == 0 && weight.y == 0 && weight.z == 0; }

// The angle to the mirrored wi, in radians, that a fiftieth of a BSDF's samples stay within: no more than the width of
// a lobe around it, if there is one.
double lobe_width(KernelProbe &probe, unsigned id, Vec3 wi) {
    const Planes drawn = probe.bsdf_sample(id, wi, probe.numbers(4096, {}));
    std::vector<double> angles;
    for (size_t i = 0; i < drawn.count; i++)
        if (!is_black(drawn.vec3(BSDF_WEIGHT_R, i)) && drawn.at(BSDF_DISCRETE, i) == 0)
            angles.push_back(2 *
                             std::asin(std::min(1.0, length(drawn.vec3(BSDF_WO_X, i) - Vec3{-wi.x, -wi.y, wi.z}) / 2)));
    if (angles.empty())
        return 1;
    const auto fiftieth = angles.begin() + std::ptrdiff_t(angles.size() / 50);
    std::nth_element(angles.begin(), fiftieth, angles.end());
    return *fiftieth;
}

// Adds the lobe of what passes to the other side, if there is one: about the mean direction, as wide as the fiftieth of
// the samples that lies closest to it.
void add_passing_peak(Sampled &sampled, KernelProbe &probe, unsigned id, Vec3 wi) {
    const Planes drawn = probe.bsdf_sample(id, wi, probe.numbers(4096, {}));
    std::vector<Vec3> passing;
    Vec3 sum{};
    for (size_t i = 0; i < drawn.count; i++)
        if (const Vec3 wo = drawn.vec3(BSDF_WO_X, i);
            wo.z * wi.z < 0 && !is_black(drawn.vec3(BSDF_WEIGHT_R, i)) && drawn.at(BSDF_DISCRETE, i) == 0) {
            passing.push_back(wo);
            sum = sum + wo;
        }
    if (passing.size() < 100)
        return;
    const Vec3 middle = normalize(sum);
    std::vector<double> angles;
    for (Vec3 wo : passing)
        angles.push_back(2 * std::asin(std::min(1.0, length(wo - middle) / 2)));
    const auto fiftieth = angles.begin() + std::ptrdiff_t(angles.size() / 50);
    std::nth_element(angles.begin(), fiftieth, angles.end());
    add_peak(sampled, middle, *fiftieth);
}

} // namespace

const char *warp_name(int warp) { return warps[warp].name; }

bool is_discrete(const Bsdf &bsdf) { return !(bsdf.traits() & OPAL_SMOOTH); }

Sampled sampled_warp(KernelProbe &probe, int warp, float parameter) {
    Sampled sampled;
    sampled.name = warps[warp].name;
    sampled.domain = &stats::domain(warps[warp].domain);
    sampled.draw = [&probe, warp, parameter](const Planes &numbers, stats::Histogram &histogram) {
        const Planes drawn = probe.warp_sample(warp, parameter, numbers);
        for (size_t i = 0; i < drawn.count; i++)
            histogram.add(drawn.vec3(WARP_X, i));
    };
    sampled.density = [&probe, warp, parameter](std::span<const Vec3> points, std::span<double> values) {
        const Planes pdf = probe.warp_pdf(warp, parameter, points);
        std::copy_n(pdf.values.begin(), points.size(), values.begin());
    };
    if (warp == WARP_beckmann)
        add_peak(sampled, {0, 0, 1}, parameter);
    if (warp == WARP_phong_lobe)
        add_peak(sampled, {0, 0, 1}, 1 / std::sqrt(parameter + 1));
    if (warp == WARP_tent)
        sampled.splits_u = sampled.splits_v = {0};
    return sampled;
}

Sampled sampled_bsdf(KernelProbe &probe, unsigned id, Vec3 wi) {
    const FlatScene &scene = probe.scene();
    unsigned traits = 0;
    visit_bsdfs(scene, scene.meshes.at(id).bsdf, [&](uint at) { traits |= bsdf_traits(scene.bsdfs[at]); });
    Sampled sampled;
    sampled.name = bsdf_name(scene.bsdfs[scene.meshes[id].bsdf]);
    if (!(traits & OPAL_SMOOTH))
        throw Error(fmt::format("a {} is discrete: its directions have no density to compare with", sampled.name));
    sampled.domain = &stats::domain(DomainKind::sphere);
    sampled.may_fail = true;
    sampled.draw = [&probe, id, wi](const Planes &numbers, stats::Histogram &histogram) {
        const Planes drawn = probe.bsdf_sample(id, wi, numbers);
        for (size_t i = 0; i < drawn.count; i++)
            if (drawn.at(BSDF_DISCRETE, i) != 0 ||
                (is_black(drawn.vec3(BSDF_WEIGHT_R, i)) && drawn.at(BSDF_PDF, i) == 0))
                histogram.add_failed();
            else
                histogram.add(drawn.vec3(BSDF_WO_X, i));
    };
    sampled.density = [&probe, id, wi](std::span<const Vec3> points, std::span<double> values) {
        const Planes f = probe.bsdf_eval(id, wi, points);
        std::copy_n(f.values.begin() + std::ptrdiff_t(EVAL_PDF * f.stride), points.size(), values.begin());
    };
    sampled.splits_u = {0};
    sampled.relative_error = 1e-4; // directions in single precision leave a narrow lobe no more
    if (traits & OPAL_PERTURBS)
        sampled.relative_error = 2e-3; // it jumps where a direction gets to the other side of one normal
    add_peak(sampled, {-wi.x, -wi.y, wi.z}, lobe_width(probe, id, wi));
    if (traits & OPAL_TRANSMITS)
        add_passing_peak(sampled, probe, id, wi);
    if (wi.z < 0.2) { // where densities over half vectors, 1 / h.wo, are steep
        const std::vector<double> grazing = stats::splits_about(wi.z, wi.z / 2, -1, 1);
        sampled.splits_u.insert(sampled.splits_u.end(), grazing.begin(), grazing.end());
    }
    return sampled;
}

Planes rays_from(Vec3 from, std::span<const Vec3> directions) {
    Planes rays(RAY_PLANES, directions.size());
    for (size_t i = 0; i < directions.size(); i++) {
        const Vec3 d = directions[i];
        const double ray[RAY_PLANES] = {from.x, from.y, from.z, d.x, d.y, d.z, 0, far_away};
        for (size_t plane = 0; plane < RAY_PLANES; plane++)
            rays.at(plane, i) = float(ray[plane]);
    }
    return rays;
}

namespace {

// Directions to lights around the scene.
Sampled sampled_environment(KernelProbe &probe, Vec3 flat_from) {
    Sampled sampled;
    sampled.name = "light";
    sampled.domain = &stats::domain(DomainKind::sphere);
    sampled.draw = [&probe, flat_from](const Planes &numbers, stats::Histogram &histogram) {
        const Planes drawn = probe.light_sample(flat_from, numbers);
        for (size_t i = 0; i < drawn.count; i++)
            histogram.add(drawn.at(LIGHT_ACTIVE, i) ? drawn.vec3(LIGHT_D_X, i) : no_point);
    };
    sampled.density = [&probe, flat_from](std::span<const Vec3> directions, std::span<double> values) {
        const Planes hits = probe.trace(rays_from(flat_from, directions));
        for (size_t i = 0; i < directions.size(); i++)
            values[i] = hits.at(HIT_LIGHT_DENSITY, i);
    };
    return sampled;
}

// Directions to a sphere that is alone, as points of the unit square: x is the share of the solid angle that is closer
// to its middle, y the azimuth in turns. A uniform density over the directions is uniform there.
class SphereDirections {
public:
    SphereDirections(const emitter_sphere_record &sphere, bool two_sided, Vec3 from) {
        const Vec3 f = Vec3{sphere.center[0], sphere.center[1], sphere.center[2]} - from;
        const double distance = length(f), sine = sphere.radius / distance;
        const bool inside = (sphere.inward || two_sided) && distance < sphere.radius;
        n_ = distance > 0 ? f * (1 / distance) : Vec3{0, 0, 1};
        s_ = normalize(cross(n_, std::abs(n_.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
        t_ = cross(n_, s_);
        lowered_ = inside ? 2 : sine * sine / (1 + std::sqrt((1 - sine) * (1 + sine)));
    }
    double solid_angle() const { return turn * lowered_; }
    Vec3 point_of(Vec3 d) const {         // 1 - cosine as |d - n|^2 / 2
        constexpr double rounding = 1e-2; // that of d may lead past the edge of a small sphere
        const Vec3 away = d - n_;
        const double x = dot(away, away) / 2 / lowered_;
        return {x < 1 + rounding ? std::min(x, 1.0) : x, angle_of({dot(d, s_), dot(d, t_), 0}) / turn, 0};
    }
    Vec3 direction_at(Vec3 point) const {
        const double lowered = point.x * lowered_, sine = std::sqrt(lowered * (2 - lowered)), phi = turn * point.y;
        return n_ * (1 - lowered) + s_ * (sine * std::cos(phi)) + t_ * (sine * std::sin(phi));
    }

private:
    Vec3 n_, s_, t_;
    double lowered_; // 1 - cosine of the directions, at most
};

Sampled sampled_sphere(KernelProbe &probe, Vec3 flat_from) {
    const EmitterRecord &emitter = probe.scene().emitters.at(0);
    // The device's point: its floats.
    const Vec3 from{float(flat_from.x), float(flat_from.y), float(flat_from.z)};
    const SphereDirections directions(emitter.u.of_sphere, emitter.two_sided != 0, from);
    Sampled sampled;
    sampled.name = "light";
    sampled.domain = &stats::domain(DomainKind::square);
    sampled.draw = [&probe, from, directions](const Planes &numbers, stats::Histogram &histogram) {
        const Planes drawn = probe.light_sample(from, numbers);
        for (size_t i = 0; i < drawn.count; i++)
            histogram.add(drawn.at(LIGHT_ACTIVE, i) ? directions.point_of(drawn.vec3(LIGHT_D_X, i)) : no_point);
    };
    sampled.density = [&probe, from, directions](std::span<const Vec3> points, std::span<double> values) {
        std::vector<Vec3> rays;
        for (Vec3 point : points)
            rays.push_back(directions.direction_at(point));
        const Planes hits = probe.trace(rays_from(from, rays));
        for (size_t i = 0; i < points.size(); i++)
            values[i] = hits.at(HIT_LIGHT_DENSITY, i) * directions.solid_angle();
    };
    return sampled;
}

// Points on lights in the unit square.
Sampled sampled_square(KernelProbe &probe, Vec3 from, Vec3 flat_from) {
    Sampled sampled;
    sampled.name = "light";
    sampled.domain = &stats::domain(DomainKind::square);
    sampled.draw = [&probe, from, flat_from](const Planes &numbers, stats::Histogram &histogram) {
        const Planes drawn = probe.light_sample(flat_from, numbers);
        for (size_t i = 0; i < drawn.count; i++) {
            const double distance = drawn.at(LIGHT_DISTANCE, i) / probe.scene().scale;
            histogram.add(drawn.at(LIGHT_ACTIVE, i) ? from + drawn.vec3(LIGHT_D_X, i) * distance : no_point);
        }
    };
    sampled.density = [&probe, from, flat_from](std::span<const Vec3> points, std::span<double> values) {
        std::vector<Vec3> directions;
        for (Vec3 point : points)
            directions.push_back(normalize(point - from));
        const Planes hits = probe.trace(rays_from(flat_from, directions));
        for (size_t i = 0; i < points.size(); i++) { // from solid angle to area
            const Vec3 to_point = points[i] - from;
            values[i] = hits.at(HIT_LIGHT_DENSITY, i) * std::abs(directions[i].z) / dot(to_point, to_point);
        }
    };
    sampled.relative_error = 2e-3; // it jumps from triangle to triangle
    return sampled;
}

} // namespace

Sampled sampled_lights(KernelProbe &probe, Vec3 from) {
    const FlatScene &scene = probe.scene();
    const Vec3 flat_from = (from - scene.center) * scene.scale;
    if (scene.settings.environment != OPAL_NONE)
        return sampled_environment(probe, flat_from);
    const bool is_sphere = scene.emitters.size() == 1 && scene.emitters[0].kind == EMITTER_sphere;
    return is_sphere ? sampled_sphere(probe, flat_from) : sampled_square(probe, from, flat_from);
}

void draw_in_batches(KernelProbe &probe, size_t count, unsigned seed, const std::function<void(const Planes &)> &use) {
    constexpr size_t batch = 1 << 19;
    NumberOptions options;
    for (size_t done = 0; done < count; done += batch) {
        options.seed = seed + unsigned(done / batch) * 0x9e3779b9u;
        use(probe.numbers(std::min(batch, count - done), options));
    }
}

DensityCheck check_density(KernelProbe &probe, const Sampled &sampled, int nu, int nv, size_t count, unsigned seed,
                           const stats::ChiSquareOptions &options) {
    DensityCheck check{stats::Histogram({sampled.domain, nu, nv}), {}};
    draw_in_batches(probe, count, seed, [&](const Planes &numbers) { sampled.draw(numbers, check.histogram); });
    check.test = density_test(check.histogram, sampled.density, sampled.may_fail, sampled.splits_u, sampled.splits_v,
                              options, sampled.relative_error);
    return check;
}

} // namespace opal
