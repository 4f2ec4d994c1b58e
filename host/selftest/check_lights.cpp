// Lights as light sampling sees them: directions against the density that hitting the light is weighed with, delta
// lights against what they must be, and the power by which lights are chosen.
#include "densities/targets.h"
#include "flatten/emitter_kinds.h"
#include "selftest/checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

constexpr double pi = std::numbers::pi;
constexpr size_t directions = 1 << 14;

// The directions around an axis (unit) that make less than some angle with it.
struct Cap {
    Vec3 axis{0, 0, 1};
    double angle = pi;
    double solid_angle() const { return 4 * pi * std::pow(std::sin(angle / 2), 2); }
};

// Directions that are even over a cap (Gonzalez 2010, "Measurement of Areas on a Sphere Using Fibonacci and
// Latitude-Longitude Lattices").
std::vector<Vec3> even_directions(const Cap &cap = {}) {
    const Vec3 turn = Vec3{0, 0, 1} - cap.axis; // a mirror that takes z to the axis
    const double size = dot(turn, turn), height = cap.solid_angle() / (2 * pi);
    std::vector<Vec3> all;
    for (size_t i = 0; i < directions; i++) {
        const Vec3 d = stats::spherical_direction(1 - height * (double(i) + 0.5) / directions,
                                                  2 * pi * std::fmod(double(i) * std::numbers::phi, 1));
        all.push_back(size > 0 ? d - turn * (2 * dot(turn, d) / size) : d);
    }
    return all;
}

double radiance_at(const Planes &drawn, size_t i) {
    const double value =
        luminance({drawn.at(LIGHT_RADIANCE_R, i), drawn.at(LIGHT_RADIANCE_G, i), drawn.at(LIGHT_RADIANCE_B, i)});
    return drawn.at(LIGHT_ACTIVE, i) ? value : 0;
}

// Whether sample i could be one of a delta light: a unit direction, light that is finite and not negative, density 1.
bool is_delta_sample(const Planes &drawn, size_t i, double density_error) {
    bool good = std::abs(length(drawn.vec3(LIGHT_D_X, i)) - 1) < 1e-5 &&
                std::abs(double(drawn.at(LIGHT_DENSITY, i)) - 1) <= density_error;
    for (size_t channel = 0; channel < 3; channel++) {
        const double value = drawn.at(LIGHT_RADIANCE_R + channel, i);
        good = good && value >= 0 && std::isfinite(value);
    }
    return good;
}

bool is_near(double a, double b) { return std::abs(a - b) <= 1e-4 * std::abs(b); }

// A light that is infinitely far: one direction and irradiance everywhere. Power over pi (the bounding circle of radius
// 1).
Findings distant_findings(KernelProbe &probe, const Light &light, const Planes &numbers, const std::string &subject,
                          double density_error) {
    const Planes drawn = probe.light_sample(even_directions(), numbers);
    double wrong = 0;
    for (size_t i = 0; i < drawn.count; i++)
        wrong += !is_delta_sample(drawn, i, density_error) || !is_near(radiance_at(drawn, i), radiance_at(drawn, 0)) ||
                 length(drawn.vec3(LIGHT_D_X, i) - drawn.vec3(LIGHT_D_X, 0)) > 1e-5;
    return {
        none_wrong("lights: samples of delta lights, wrong", wrong, subject),
        at_most("lights: power, off by", std::abs(pi * radiance_at(drawn, 0) / power_of(light, 1) - 1), 1e-2, subject)};
}

// The cap that holds the directions of a cap into which a light shines.
Cap lit_part(const Cap &cap, const std::vector<Vec3> &from, const Planes &drawn) {
    Vec3 sum{};
    for (size_t i = 0; i < directions; i++)
        sum = sum + from[i] * radiance_at(drawn, i);
    if (!(length(sum) > 0))
        return cap;
    Cap part{normalize(sum), 0};
    for (size_t i = 0; i < directions; i++)
        if (radiance_at(drawn, i) > 0)
            part.angle = std::max(part.angle, std::acos(std::clamp(dot(part.axis, from[i]), -1.0, 1.0)));
    part.angle += 3 * std::sqrt(cap.solid_angle() / directions); // up to the next direction
    return part.angle < cap.angle ? part : cap;
}

// A light at a point: all directions lead there, the irradiance falls by the distance's square, and the intensity over
// all directions is the power.
Findings point_like_findings(KernelProbe &probe, const Light &light, const Planes &numbers, const std::string &subject,
                             double density_error) {
    // Alone in its scene it lies at the origin. Seen from there, d / 2 and d are one direction bit for bit, so that
    // light which falls steeply with the angle is the same, too.
    const Vec3 position{};
    std::vector<Vec3> near, far;
    for (Vec3 d : even_directions()) {
        near.push_back(d * 0.5);
        far.push_back(d);
    }
    const Planes from_near = probe.light_sample(near, numbers), from_far = probe.light_sample(far, numbers);
    double wrong = 0;
    for (size_t i = 0; i < directions; i++) {
        const Vec3 met = near[i] + from_near.vec3(LIGHT_D_X, i) * from_near.at(LIGHT_DISTANCE, i);
        wrong += !is_delta_sample(from_near, i, density_error) || !is_delta_sample(from_far, i, density_error) ||
                 length(met - position) > 1e-5 || !is_near(radiance_at(from_near, i) / 4, radiance_at(from_far, i));
    }
    Cap cap;
    double power = 0;
    for (int finer = 0; finer < 3; finer++) { // a light that shines into a few directions alone needs more of these
        const std::vector<Vec3> from = even_directions(cap);
        const Planes drawn = probe.light_sample(from, numbers);
        power = 0;
        for (size_t i = 0; i < directions; i++)
            power += radiance_at(drawn, i) * cap.solid_angle() / directions;
        cap = lit_part(cap, from, drawn);
    }
    const double scale = probe.scene().scale;
    return {
        none_wrong("lights: samples of delta lights, wrong", wrong, subject),
        at_most("lights: power, off by", std::abs(power / (power_of(light, 1) * scale * scale) - 1), 1e-2, subject)};
}

// The radiance over all directions, times the bounding circle of radius 1.
Finding environment_power(KernelProbe &probe, const Light &light, const Planes &numbers, const std::string &subject) {
    const Planes drawn = probe.light_sample(Vec3{}, numbers);
    double sum = 0;
    for (size_t i = 0; i < drawn.count; i++)
        sum += radiance_at(drawn, i) / drawn.at(LIGHT_DENSITY, i);
    return at_most("lights: power, off by", std::abs(sum / double(drawn.count) * pi / power_of(light, 1) - 1), 1e-2,
                   subject);
}

} // namespace

Findings light_findings(KernelProbe &probe, const Sampled &lights, const std::string &subject, const Effort &effort) {
    Sampled sampled = lights;
    sampled.relative_error = effort.quadrature_error;
    const DensityCheck check = check_density(probe, sampled, effort.nu, effort.nv, effort.samples, effort.seed);
    return {p_value("lights: directions against density, smallest p", check.test.result.p_value, subject),
            at_most("lights: integral of the pdf, off by", std::abs(check.test.mass.value - 1), 1e-3, subject)};
}

Findings scene_emitter_findings(KernelProbe &probe, const Light &light, const std::string &subject,
                                const Effort &effort) {
    NumberOptions which;
    which.seed = effort.seed;
    const Planes numbers = probe.numbers(directions, which);
    if (!can_be_met(light.kind()))
        return is_infinite(light.kind()) ? distant_findings(probe, light, numbers, subject, effort.density_error)
                                         : point_like_findings(probe, light, numbers, subject, effort.density_error);
    Findings findings = light_findings(probe, sampled_lights(probe), subject, effort);
    findings.push_back(environment_power(probe, light, numbers, subject));
    return findings;
}

FlatScene scene_of_light(const Light &light, int lanes) {
    SceneDescription scene;
    scene.lights = {light};
    scene.strategy[AXIS_integrator] = CHOICE_integrator_path; // else its kernel may lack the light
    scene.strategy[AXIS_lighting] = CHOICE_lighting_emitter;
    scene.strategy.specialise = Specialise::off;
    return flatten(scene, lanes);
}

Findings run_lights(const Device &device, const SelftestOptions &options) {
    Findings findings;
    Effort effort = effort_of(options);
    effort.seed += 500;
    for (const char *name : {"light:parallelogram", "light:mesh", "light:many", "light:sphere", "light:sphere_inside"})
        for (const char *choice : {"uniform", "power"}) {
            const std::map<std::string, std::string> axes = {{"emitter-choice", choice},
                                                             {"triangle-choice", choice[0] == 'u' ? "uniform" : "area"},
                                                             {"specialise", "off"}};
            const Target target = open_target(name, {}, axes, device, options.build, *options.sources);
            effort.seed++;
            append(findings, light_findings(*target.probe, target.sampled, target.description, effort));
        }
    for (uint kind = 0; kind < EMITTER_COUNT; kind++)
        if (!(emitter_traits(kind) & OPAL_SURFACE)) {
            const Light light = light_of_parameters(kind, {});
            KernelProbe probe(device, scene_of_light(light, options.build.lanes), options.build, *options.sources);
            effort.seed++;
            append(findings, scene_emitter_findings(probe, light, emitter_name(kind), effort));
        }
    return summary_of(findings);
}

} // namespace opal
