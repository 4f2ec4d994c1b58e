// Single against double precision on the same random numbers: both walk the same paths, so that samples differ by
// rounding alone. Doubles at 1, 4, 8 and 16 lanes differ by less than a float can hold.
#include "support/device.h"
#include "support/mutants.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/seeds.h"

#include <cmath>

using namespace opal;
using namespace opal::test;

namespace {

constexpr unsigned spp = 16;

// Every sample of a render: R, G, B of every pixel, one pass after the other.
std::vector<double> samples_of(const SceneDescription &scene, MathMode math, int lanes = 0,
                               const Sources &from = Sources::embedded()) {
    RenderSetup setup;
    setup.math = math;
    setup.lanes = lanes;
    setup.sources = &from;
    Renderer renderer = renderer_of(scene, setup);
    std::vector<double> values;
    for (unsigned sample = 0; sample < spp; sample++) {
        renderer.restart(test_seed(60), sample);
        renderer.render(sample + 1);
        const Film film = renderer.film();
        CHECK(film.invalid == 0);
        for (const auto &rgb : film.sum)
            values.insert(values.end(), rgb.begin(), rgb.end());
    }
    return values;
}

// The share of samples of which a channel differs by more than `limit`, relative.
double share_off(const std::vector<double> &a, const std::vector<double> &b, double limit) {
    size_t off = 0;
    for (size_t i = 0; i < a.size(); i += 3) {
        bool differs = false;
        for (size_t c = i; c < i + 3; c++)
            differs = differs || !(std::abs(a[c] - b[c]) <= limit * std::max(std::abs(a[c]), std::abs(b[c])));
        off += differs;
    }
    return double(off) / (double(a.size()) / 3);
}

double relative_difference_of_means(const std::vector<double> &a, const std::vector<double> &b) {
    double sum_a = 0, sum_b = 0;
    for (size_t i = 0; i < a.size(); i++) {
        sum_a += a[i];
        sum_b += b[i];
    }
    return std::abs(sum_a - sum_b) / sum_b;
}

// The gallery has every BSDF and both kinds of area light; with another cube of glass it is too large to do without a
// tree.
SceneDescription gallery_with_tree() {
    SceneDescription scene = gallery(32, 24);
    scene.meshes.push_back(made_of(cube({-0.1, 0.2, 0.5}, 0.15), examples::dielectric()));
    return scene;
}

bool doubles() {
    if (!device().info.fp64)
        WARN("the device has no double precision: nothing to hold single against");
    return device().info.fp64;
}

} // namespace

TEST_CASE("Single precision walks the paths of double precision", "[double]") {
    if (!doubles())
        return;
    for (const Overrides &how : std::vector<Overrides>{
             {{"lighting", "mis"}},
             {{"lighting", "bsdf"},
              {"sampler", "stratified"},
              {"max-depth", "8"}}, // long paths through glass are chaotic
             {{"lighting", "emitter"}, {"sampler", "sobol"}, {"emitter-choice", "uniform"}, {"rr", "throughput-eta"}},
             {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "one-sample"}},
             {{"integrator", "whitted"}}})
        for (const bool tree : {false, true}) {
            if (tree && how != Overrides{{"lighting", "mis"}})
                continue;
            const SceneDescription room = tree ? gallery_with_tree() : gallery(32, 24),
                                   scene = with_strategy(room, how);
            const auto single = samples_of(scene, MathMode::precise),
                       oracle = samples_of(scene, MathMode::double_precision);
            const double off = share_off(single, oracle, 1e-3), means = relative_difference_of_means(single, oracle);
            INFO(how.begin()->second << ", " << room.meshes.size() << " meshes: " << off
                                     << " of the samples off by 1e-3, means by " << means);
            CHECK(off < 5e-4);   // paths that a last bit sends elsewhere: at an edge, a lobe, a total reflection
            CHECK(means < 2e-4); // a few of those hit a lamp
        }
}

TEST_CASE("Doubles at every width agree to far below a float", "[double]") {
    if (!doubles())
        return;
    for (const SceneDescription &scene : {gallery(32, 24), gallery_with_tree()}) {
        const auto one = samples_of(scene, MathMode::double_precision, 1);
        for (int lanes : {4, 8}) {
            const auto many = samples_of(scene, MathMode::double_precision, lanes);
            INFO(lanes << " lanes, " << scene.meshes.size() << " meshes");
            CHECK(share_off(one, many, 1e-7) < 1e-4); // one of 12288. Samples are floats, so nearly all are equal
        }
        // Singles differ more: these doubles are doubles.
        CHECK(share_off(samples_of(scene, MathMode::precise, 1), samples_of(scene, MathMode::precise, 8), 1e-7) > 0.01);
    }
}

TEST_CASE("What makes single precision walk other paths is seen", "[double]") {
    if (!doubles())
        return;
    const Mutant jump{"frames that jump on upright walls", "core/math.cl", "n.z < jump ? (real)(-1) : (real)(1)",
                      "copysign((real)(1), n.z)"};
    const Sources wrong = mutated(Sources::embedded(), jump);
    // Walls whose normals have z = 0 but for the last bit: turned and slanted, so that it is a difference of products
    SceneDescription scene = gallery(32, 24);
    const Transform turned = Transform::rotate({0, 0, 1}, 34);
    for (Mesh &mesh : scene.meshes)
        if (auto *p = std::get_if<Parallelogram>(&mesh.shape))
            *p = {turned.point(p->origin), turned.vector(p->u), turned.vector(p->v + p->u * 0.37)};
    const double right =
        share_off(samples_of(scene, MathMode::precise), samples_of(scene, MathMode::double_precision), 1e-3);
    const double mutant = share_off(samples_of(scene, MathMode::precise, 0, wrong),
                                    samples_of(scene, MathMode::double_precision, 0, wrong), 1e-3);
    INFO(right << " of the samples off, " << mutant << " with the mutant");
    CHECK(right < 5e-4);
    CHECK(mutant > 1e-2);
}
