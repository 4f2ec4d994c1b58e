// Probabilities of discrete choices, by counting. 2^24 Sobol samples of a pixel take each number k 2^-24 once in every
// dimension, so that a choice of probability p comes up exactly p 2^24 times, and an image without other variance is
// exact. There are no statistics and no seed; limits are roundings.
#include "probe/kernel_probe.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace opal::test {

namespace {

constexpr double pi = std::numbers::pi;
constexpr double counted_limit = 1e-6; // relative

Finding counted(const std::string &what, SceneDescription scene, const Overrides &how, double truth,
                const Sources &sources) {
    scene.camera.width = scene.camera.height = 1;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_sobol;
    RenderSetup setup;
    setup.sources = &sources;
    const double got = sample_of(render(with_strategy(std::move(scene), how), 1u << 24, 0, setup), 0).mean;
    return exact(fmt::format("{}: {:.9g}, not {:.9g}, off by {:.2g}", what, got, truth, got / truth - 1),
                 std::abs(got / truth - 1) <= counted_limit);
}

// A patch of that albedo in a black room that emits 1: a path that survives the patch has the weight albedo / survival.
SceneDescription dark_patch(double albedo) {
    SceneDescription scene = furnace(0, 1);
    scene.meshes.push_back(diffuse(Parallelogram{{-0.1, -0.5, -0.1}, {0, 0, 0.2}, {0.2, 0, 0}}, float(albedo), true));
    scene.camera = camera({0, 0, 0}, {0, -0.5, 0}, 1, 1, 1);
    scene.strategy.rr_depth = 1;
    return scene;
}
const Overrides dark_path = {{"lighting", "bsdf"}, {"rr", "throughput"}};

// The scene point_light with further lamps below the floor, which hides them.
SceneDescription lamps(const std::vector<double> &others) {
    SceneDescription scene = point_light();
    scene.camera.perspective.fov = 1e-5; // all samples see one point, however few choose the lamp
    for (double power : others)
        scene.lights.push_back({emitter_point{{0.1, -1, 0.2}, {power, power, power}}, {}});
    return scene;
}

// A mesh light of `count` equal triangles. The floor sees the first, straight above; all others face up.
constexpr double small = 1.0 / 2048;
SceneDescription one_triangle_of(unsigned count) {
    SceneDescription scene = triangle_light();
    scene.meshes.pop_back();
    TriangleMesh mesh;
    for (unsigned i = 0; i < count; i++) { // multiples of 2^-12: exact in float, and so all areas are one
        const Vec3 o = i == 0 ? Vec3{0.25, 1, 0.25} : Vec3{0.5 + small * (i % 1024), 1, small * double(i / 1024)};
        const Vec3 u{small, 0, 0}, v{0, 0, small};
        const unsigned first = unsigned(mesh.positions.size());
        mesh.positions.insert(mesh.positions.end(), {o, i == 0 ? o + u : o + v, i == 0 ? o + v : o + u});
        mesh.triangles.push_back({{{first, OPAL_NONE}, {first + 1, OPAL_NONE}, {first + 2, OPAL_NONE}}});
    }
    scene.meshes.push_back(light(mesh, {1e6, 1e6, 1e6}));
    scene.camera = camera({1, 0.5, -1}, {0.25 + small / 3, 0, 0.25 + small / 3}, 1, 1, 1e-5);
    return scene;
}
double one_triangle_truth() { return 0.8 / pi * 1e6 * small * small / 2; } // cosines and distance 1, but for small^2

} // namespace

Findings check_counted(const Sources &sources, unsigned) {
    const double lamp = point_light_truth(), third = double(float(0.01));
    Findings findings;
    findings.push_back(counted("roulette, albedo 0.01", dark_patch(0.01), dark_path, third, sources));
    findings.push_back(counted("roulette, albedo 1e-6", dark_patch(1e-6), dark_path, double(1e-6f), sources));
    SceneDescription fixed = dark_patch(0.5);
    fixed.strategy.rr_prob = 1e-5;
    findings.push_back(counted("fixed roulette, 1e-5", fixed, {{"lighting", "bsdf"}, {"rr", "fixed"}}, 0.5, sources));

    const Overrides by_light = {{"lighting", "emitter"}, {"emitter-choice", "uniform"}},
                    by_power = {{"lighting", "emitter"}, {"emitter-choice", "power"}};
    findings.push_back(counted("one lamp of three", lamps({50, 50}), by_light, lamp, sources));
    findings.push_back(counted("one lamp of 1000", lamps(std::vector<double>(999, 50)), by_light, lamp, sources));
    // A draw from an alias table takes two numbers, for row and accept. Their pairs come up exactly as often as they
    // should where both shares are even, as here.
    SceneDescription dim = lamps({1e8});
    std::get<emitter_point>(dim.lights[0].parameters).power = {100, 100, 100};
    findings.push_back(counted("a lamp of 1e-6 of another's power", dim, by_power, lamp, sources));

    for (float index : {1.001f, 1.01f, 1.33f})
        findings.push_back(counted(fmt::format("reflection, index {}", index), reflection(index),
                                   {{"lighting", "bsdf"}, {"rr", "off"}}, fresnel_reflectance(1, 1, double(index)),
                                   sources));

    for (const char *choice : {"area", "uniform"})
        findings.push_back(counted(fmt::format("one triangle of 100 003 by {}", choice), one_triangle_of(100003),
                                   {{"lighting", "emitter"}, {"triangle-choice", choice}}, one_triangle_truth(),
                                   sources));
    // Without any choice every path sums the series 1 + a + a^2 + ...
    for (double albedo : {0.9, 0.99, 0.999}) {
        SceneDescription scene = furnace(albedo, 1);
        scene.meshes[0].bsdf = examples::diffuse(albedo, true);
        RenderSetup setup;
        setup.sources = &sources;
        scene.camera.width = scene.camera.height = 2;
        const double truth = 1 / (1 - double(float(albedo)));
        const double got =
            sample_of(render(with_strategy(scene, {{"lighting", "bsdf"}, {"rr", "off"}}), 4, 0, setup), 0).mean;
        findings.push_back(exact(
            fmt::format("furnace of albedo {}: {:.9g}, not {:.9g}, off by {:.2g}", albedo, got, truth, got / truth - 1),
            std::abs(got / truth - 1) <= counted_limit));
    }
    return findings;
}

Findings check_choices(const Sources &sources, unsigned) {
    Findings findings;
    const Vec3 wi = normalize({0.8, 0, 0.6}), mirrored{-wi.x, -wi.y, wi.z};
    // stated: the probability that the density implies; wished: the one that the material asks for. Of the numbers
    // around `stated` exactly those below it must choose the first part.
    const auto judge = [&](const std::string &what, KernelProbe &probe, double stated, double wished) {
        const double k = std::round(std::ldexp(stated, 24));
        Planes numbers(3, 8);
        for (size_t i = 0; i < 8; i++) {
            numbers.at(0, i) = 0.3f;
            numbers.at(1, i) = 0.1f;
            numbers.at(2, i) = float(std::ldexp(std::clamp(k + double(i) - 3, 0.0, 0x1p24 - 1), -24));
        }
        numbers.at(2, 6) = 0;
        numbers.at(2, 7) = 0x1.fffffep-1f;
        const Planes drawn = probe.bsdf_sample(0, wi, numbers);
        const auto same = [&](size_t a, size_t b) {
            return length(drawn.vec3(BSDF_WO_X, a) - drawn.vec3(BSDF_WO_X, b)) < 1e-6;
        };
        size_t wrong = same(6, 7);
        for (size_t i = 0; i < 6; i++)
            wrong += !same(i, double(numbers.at(2, i)) * 0x1p24 < k ? 6 : 7);
        findings.push_back(exact(
            fmt::format("{}: drawn as {:.9g} says, for {:.9g}: {} of 7 numbers wrong", what, stated, wished, wrong),
            wrong == 0 && std::abs(stated / (k * 0x1p-24) - 1) < 1e-6 && stated >= wished * (1 - 1e-6) &&
                stated <= wished + 0x1p-24));
    };
    for (int lanes : tested_lanes()) {
        BuildOptions build;
        build.lanes = lanes;
        const auto probe_of = [&](const Bsdf &bsdf) {
            return KernelProbe(device(), scene_of_bsdfs({bsdf}), build, sources);
        };
        const auto density = [&](KernelProbe &probe, Vec3 wo) {
            return double(probe.bsdf_eval(0, wi, std::vector{wo}).at(EVAL_PDF, 0));
        };
        const auto coated = [](float kd) { return examples::microfacet(0.001, kd); };
        KernelProbe half = probe_of(coated(0.5f)); // half of each part: its density gives that of the coat alone
        const double base = wi.z / pi, coat = 2 * density(half, mirrored) - base;
        for (float share : {1e-6f, 3e-4f, 0.3f}) {
            auto phong = examples::phong(1e4).as<bsdf_phong_record>(); // so narrow that it is black towards the viewer
            phong.pd = share;
            KernelProbe probe = probe_of(phong);
            judge(fmt::format("Phong's diffuse part at {} lanes", lanes), probe, density(probe, wi) * pi / wi.z,
                  double(share));
            if (share > 0.1f)
                continue; // a float density cannot tell so many numbers apart
            const float kd = 1 - share;
            KernelProbe coated_probe = probe_of(coated(kd));
            judge(fmt::format("the microfacets' coat at {} lanes", lanes), coated_probe,
                  (density(coated_probe, mirrored) - base) / (coat - base), 1 - double(kd));
        }
    }
    return findings;
}

} // namespace opal::test
