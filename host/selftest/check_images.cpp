// Whole renders of scenes whose radiance is known: a furnace, and a floor below a light.
#include "render/renderer.h"
#include "scene/examples.h"
#include "scene/options.h"
#include "selftest/selftest.h"
#include "stats/hypothesis.h"

#include <cmath>
#include <numbers>

namespace opal {

namespace {

// Reflects `albedo` into directions that are drawn uniformly, and emits `radiance`.
Mesh parallelogram(Vec3 origin, Vec3 u, Vec3 v, double albedo, double radiance) {
    Mesh mesh = examples::made_of(Parallelogram{origin, u, v}, examples::diffuse(albedo, false));
    if (radiance > 0)
        mesh.radiance = Color{radiance, radiance, radiance};
    return mesh;
}

SceneDescription camera_at(Vec3 origin, Vec3 target) {
    SceneDescription scene;
    scene.camera.to_world = Transform::look_at(origin, target, {0, 0, 1});
    scene.camera.width = scene.camera.height = 1;
    scene.camera.perspective.fov = 1e-3;
    return scene;
}

// A closed cube that emits 1 and reflects 1/2: radiance 2 in every direction.
SceneDescription furnace() {
    SceneDescription scene = camera_at({0.5, 0.4, 0.3}, {0.8, 0.1, 0});
    const Vec3 x = {1, 0, 0}, y = {0, 1, 0}, z = {0, 0, 1};
    const std::array<Vec3, 3> faces[] = {{Vec3{}, x, y}, {z, y, x},      {Vec3{}, y, z},
                                         {x, z, y},      {Vec3{}, z, x}, {y, x, z}};
    for (const auto &[origin, u, v] : faces)
        scene.meshes.push_back(parallelogram(origin, u, v, 0.5, 1));
    return scene;
}

// A floor of albedo 0.6 below a black square light of side 2 and radiance 3, at height 1 above the point that is seen:
// E = pi L F, F = 4/pi s atan(s), s = 1 / sqrt(2) (Siegel and Howell, configuration 9).
SceneDescription floor_and_light() {
    SceneDescription scene = camera_at({3, 0.1, 0.5}, {0, 0, 0});
    scene.meshes = {
        parallelogram({-5, -5, 0}, {10, 0, 0}, {0, 10, 0}, 0.6, 0),
        parallelogram({-1, 1, 1}, {1, 0, 0}, {0, -2, 0}, 0, 3),
        parallelogram({0, 1, 1}, {1, 0, 0}, {0, -2, 0}, 0, 3)}; // in two halves, to share the furnace's kernel
    return scene;
}
double floor_radiance() {
    const double s = std::sqrt(0.5);
    return 0.6 * 3 * 4 / std::numbers::pi * s * std::atan(s);
}

// A patch of albedo 1e-6 among black walls that emit 1. Roulette lets one path in a million through, and each Sobol
// number comes once: the mean of 2^24 samples is the albedo, but for roundings, where choices are drawn with the
// probability that weighs them.
double error_of_counted_choice(const Device &device, const SelftestOptions &options) {
    constexpr float albedo = 1e-6f;
    SceneDescription scene = furnace();
    for (Mesh &wall : scene.meshes)
        wall.bsdf = examples::diffuse(0, false);
    scene.meshes.push_back(parallelogram({0.7, 0, 0.05}, {0.2, 0, 0}, {0, 0.2, 0}, albedo, 0));
    scene.meshes.back().bsdf = examples::diffuse(albedo, true); // all its paths weigh alike
    apply_integrator(scene.strategy, find_integrator("path_mats"));
    scene.strategy[AXIS_rr] = CHOICE_rr_throughput;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_sobol;
    scene.strategy.rr_depth = 1;
    RenderOptions render;
    render.build = options.build;
    render.sources = options.sources;
    Renderer renderer(device, flatten(scene, options.build.lanes), render);
    renderer.restart(options.seed);
    renderer.render(1u << 24);
    return std::abs(statistics_of(renderer.film()).mean_luminance / double(albedo) - 1);
}

stats::TestResult judge(const Device &device, SceneDescription scene, const char *integrator, double reference,
                        const SelftestOptions &options) {
    apply_integrator(scene.strategy, find_integrator(integrator));
    RenderOptions render;
    render.build = options.build;
    render.sources = options.sources;
    Renderer renderer(device, flatten(scene, options.build.lanes), render);
    renderer.restart(options.seed + 1);
    renderer.render(options.full ? 2'000'000 : 100'000);
    const FilmStatistics film = statistics_of(renderer.film());
    const double n = double(film.samples);
    if (film.invalid)
        return {NAN, 0, 0, "not finite"};
    return stats::t_test({n, film.mean_luminance, film.stderr_luminance * film.stderr_luminance * n}, reference);
}

} // namespace

// Each strategy against the same known radiance, and so against every other. Quick: MIS, which uses both ways to find
// light.
Findings run_images(const Device &device, const SelftestOptions &options) {
    Findings findings;
    for (const char *integrator : {"path_mis", "path_mats", "path_ems"}) {
        findings.push_back(p_value("furnace, p", judge(device, furnace(), integrator, 2, options).p_value, integrator));
        const double p = judge(device, floor_and_light(), integrator, floor_radiance(), options).p_value;
        findings.push_back(p_value("floor and light, p", p, integrator));
        if (!options.full)
            break;
    }
    findings.push_back(at_most("a choice of probability 1e-6, counted: relative error",
                               error_of_counted_choice(device, options), 1e-6));
    return summary_of(findings);
}

} // namespace opal
