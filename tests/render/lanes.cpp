// 1, 4, 8 and 16 lanes render the same picture: the same random numbers, other roundings. Only a path that a rounding
// sends elsewhere may differ, and few do. One lane walks the tree where more test every triangle, so this holds the two
// intersectors together too.
#include "support/device.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

#include <cmath>

using namespace opal;
using namespace opal::test;

namespace {

struct Difference {
    size_t pixels_off = 0; // by more than 1e-4
    double means = 0;      // relative, over the other pixels
};

Difference difference(const Film &a, const Film &b) {
    Difference d;
    double sum_a = 0, sum_b = 0;
    for (size_t p = 0; p < a.sum.size(); p++) {
        bool off = a.count[p] != b.count[p];
        for (int c = 0; c < 3; c++)
            off = off ||
                  std::abs(a.sum[p][c] - b.sum[p][c]) > 1e-4 * std::max(std::abs(a.sum[p][c]), std::abs(b.sum[p][c]));
        d.pixels_off += off;
        for (int c = 0; c < 3 && !off; c++) {
            sum_a += a.sum[p][c];
            sum_b += b.sum[p][c];
        }
    }
    d.means = std::abs(sum_a - sum_b) / std::max(sum_a, sum_b);
    return d;
}

Film at_lanes(const SceneDescription &scene, int lanes, MathMode math = MathMode::precise) {
    RenderSetup setup;
    setup.lanes = lanes;
    setup.math = math;
    return render(scene, 8, test_seed(50), setup);
}

// The gallery with another cube of glass is too large to do without a tree at any width.
SceneDescription large_gallery(int width, int height) {
    SceneDescription scene = gallery(width, height);
    scene.meshes.push_back(made_of(cube({-0.1, 0.2, 0.5}, 0.15), examples::dielectric()));
    return scene;
}

// Without a ceiling, so that ambient occlusion is not 0.
SceneDescription strategy_of(SceneDescription scene, const Overrides &how) {
    if (how.at("integrator") == "ao")
        std::erase_if(scene.meshes, [](const Mesh &mesh) {
            const auto *shape = std::get_if<Parallelogram>(&mesh.shape);
            return shape && shape->origin.y == 1;
        });
    return with_strategy(std::move(scene), how);
}

} // namespace

TEST_CASE("The same picture at every width, in every integrator", "[lanes]") {
    const std::vector<Overrides> strategies = {
        {{"integrator", "normals"}},
        {{"integrator", "ao"}, {"hemisphere", "cosine"}},
        {{"integrator", "av"}},
        {{"integrator", "simple"}},
        {{"integrator", "whitted"}},
        {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "one-sample"}},
        {{"integrator", "path_mats"}, {"sampler", "stratified"}},
        {{"integrator", "path_ems"}, {"sampler", "sobol"}},
        {{"integrator", "path_mis"}, {"mis", "power"}}};
    SceneDescription scene = large_gallery(25, 21); // not a multiple of anything
    scene.simple_light = {{0.1, 0.5, -0.2}, {30, 20, 10}};
    scene.spp = 8;
    for (Overrides how : strategies) {
        how["specialise"] = "off"; // one program a width
        const SceneDescription chosen = strategy_of(scene, how);
        const Film one = at_lanes(chosen, 1);
        CHECK(one.invalid == 0);
        for (int lanes : {4, 8, 16}) {
            const Difference d = difference(one, at_lanes(chosen, lanes));
            INFO(how.at("integrator") << " at " << lanes << " lanes: " << d.pixels_off
                                      << " pixels off, means differ by " << d.means);
            CHECK(d.pixels_off <= 3);
            CHECK(d.means < 1e-6);
        }
    }
}

TEST_CASE("The same picture at every width without a tree, and by the tree", "[lanes]") {
    const SceneDescription scene = with_strategy(gallery(25, 21), {{"mis", "power"}});
    const Film one = at_lanes(scene, 1);
    for (int lanes : {4, 8, 16}) {
        const FlatScene flat = flatten(scene, lanes);
        REQUIRE_FALSE(flat.features[FEATURE_tree]);
        const Difference d = difference(one, at_lanes(scene, lanes));
        INFO(lanes << " lanes: " << d.pixels_off << " pixels off, means differ by " << d.means);
        CHECK(d.pixels_off <= 3);
        CHECK(d.means < 1e-6);
    }
}

TEST_CASE("The general kernel renders what the specialised ones do", "[lanes]") {
    const std::vector<Overrides> strategies = {
        {{"integrator", "ao"}, {"hemisphere", "uniform"}},
        {{"integrator", "whitted"}},
        {{"integrator", "direct_lighting"}, {"lighting", "emitter"}, {"emitter-choice", "power"}},
        {{"integrator", "path"}, {"lighting", "bsdf"}, {"rr", "fixed"}},
        {{"integrator", "path"}, {"lighting", "mis"}, {"triangle-choice", "uniform"}, {"sampler", "sobol"}}};
    // In double, where the device has it: the general kernel lists no faces, and what it rounds otherwise long paths
    // through glass magnify.
    const MathMode math = device().info.fp64 ? MathMode::double_precision : MathMode::precise;
    SceneDescription scene = large_gallery(25, 21); // with a tree, as the general kernel has
    for (Overrides how : strategies) {
        const Film special = at_lanes(strategy_of(scene, how), 0, math);
        how["specialise"] = "off";
        const Difference d = difference(special, at_lanes(strategy_of(scene, how), 0, math));
        INFO(how.at("integrator") << ": " << d.pixels_off << " pixels off, means differ by " << d.means);
        CHECK(d.pixels_off <= 3);
        CHECK(d.means < 1e-6);
    }
}
