#include "extremes/numeric_rows.h"

#include "extremes/scenes.h"
#include "selftest/watertight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal::extremes {

namespace {

KernelProbe probe_of(FlatScene flat, const Device &device, const How &how, MathMode math) {
    BuildOptions build;
    build.math = math;
    build.lanes = lanes_for(device.info, 0, math);
    return KernelProbe(device, std::move(flat), build, *how.sources);
}

// What both precisions returned, value by value.
class Pair {
public:
    void add(double single, double oracle, bool right_single, bool right_oracle) {
        invalid_single += !right_single;
        invalid_oracle += !right_oracle;
        if (right_single && right_oracle)
            error = std::max(error, std::abs(single - oracle));
    }
    void add(double single, double oracle) { add(single, oracle, std::isfinite(single), std::isfinite(oracle)); }
    void add_planes(const Planes &single, const Planes &oracle,
                    size_t plane) { // of directions or points: the figure is their third plane
        for (size_t i = 0; i < single.count; i++) {
            for (size_t p = plane; p < plane + 3; p++)
                add(single.at(p, i), oracle.at(p, i));
            count_figure(single.at(plane + 2, i), oracle.at(plane + 2, i));
        }
    }
    void count_figure(double single, double oracle) {
        sums[0] += single;
        sums[1] += oracle;
        figures++;
    }
    Probed result() const { return {sums[0] / figures, sums[1] / figures, error, invalid_single, invalid_oracle}; }

private:
    double error = 0, sums[2] = {0, 0}, figures = 0;
    unsigned long long invalid_single = 0, invalid_oracle = 0;
};

// The pairs of u with others, both ways around; the third plane has lobes from 0 to the largest number.
Planes pairs_of(double u) {
    const std::vector<double> others = {0, 0x1p-32, 0x1p-24, 0.25, 0.5, 0.75, 1 - 0x1p-24};
    Planes numbers(2 * OPAL_PROBE_PAIRS, 2 * others.size() * others.size());
    for (size_t i = 0; i < numbers.count; i++) {
        const double other = others[i / 2 % others.size()], lobe = others[i / 2 / others.size()];
        for (size_t plane = 0; plane < 2 * OPAL_PROBE_PAIRS; plane++)
            numbers.at(plane, i) = float(plane % 2 == i % 2 ? u : other);
        numbers.at(2, i) = float(lobe);
    }
    return numbers;
}

struct Lobe {
    int warp;
    float parameter;
};
const Lobe warps[] = {{WARP_tent, 0},
                      {WARP_uniform_disk, 0},
                      {WARP_uniform_sphere, 0},
                      {WARP_uniform_hemisphere, 0},
                      {WARP_cosine_hemisphere, 0},
                      {WARP_beckmann, 1},
                      {WARP_beckmann, 1e-2f},
                      {WARP_beckmann, 1e-6f},
                      {WARP_phong_lobe, 0},
                      {WARP_phong_lobe, 100},
                      {WARP_phong_lobe, 1e8f}};

// One of each BSDF, a mesh light and a parallelogram in one scene.
FlatScene scene_of_everything() {
    SceneDescription scene = room();
    scene.meshes.push_back(light(cube({0.6, 0.6, 0.6}, 0.1, false), 1));
    scene.strategy.specialise = false;
    return flatten(scene, 1);
}

} // namespace

Probed probe_numbers(double u, const Device &device, const How &how) {
    KernelProbe single = probe_of(scene_of_everything(), device, how, MathMode::precise);
    KernelProbe oracle = probe_of(scene_of_everything(), device, how, MathMode::double_precision);
    const Planes numbers = pairs_of(u);
    Pair pair;
    for (const Lobe &lobe : warps) {
        const Planes a = single.warp_sample(lobe.warp, lobe.parameter, numbers),
                     b = oracle.warp_sample(lobe.warp, lobe.parameter, numbers);
        pair.add_planes(a, b, WARP_X);
        std::vector<Vec3> points;
        for (size_t i = 0; i < a.count; i++)
            points.push_back(a.vec3(WARP_X, i));
        const Planes density = single.warp_pdf(lobe.warp, lobe.parameter, points);
        for (size_t i = 0; i < density.count; i++) // of the size of 1/alpha^2: not compared, but it must be a density
            pair.add(0, 0, std::isfinite(density.at(0, i)) && density.at(0, i) >= 0, true);
    }
    for (unsigned bsdf = 0; bsdf < single.scene().bsdfs.size(); bsdf++)
        for (const double degrees : {0.0, 45.0, 89.999}) {
            const double angle = degrees * (std::numbers::pi / 180);
            const Vec3 wi = {std::sin(angle), 0, std::cos(angle)};
            const Planes a = single.bsdf_sample(bsdf, wi, numbers), b = oracle.bsdf_sample(bsdf, wi, numbers);
            pair.add_planes(a, b, BSDF_WO_X);
            pair.add_planes(a, b, BSDF_WEIGHT_R);
        }
    pair.add_planes(single.light_sample(numbers), oracle.light_sample(numbers), LIGHT_X);
    return pair.result();
}

Probed probe_samplers(double spp, const Device &device, const How &how) {
    KernelProbe single = probe_of(scene_of_everything(), device, how, MathMode::precise);
    KernelProbe oracle = probe_of(scene_of_everything(), device, how, MathMode::double_precision);
    Pair pair;
    for (const int sampler : {CHOICE_sampler_independent, CHOICE_sampler_stratified, CHOICE_sampler_sobol}) {
        NumberOptions options;
        options.seed = how.seed;
        options.sampler = sampler;
        options.spp = unsigned(spp);
        // Samples from 0 to the last, 4096 of them: index i is sample i * step.
        const size_t count = size_t(std::min(4096.0, spp));
        options.sample_step = count > 1 ? unsigned((spp - 1) / double(count - 1)) : 1;
        const Planes a = single.numbers(count, options), b = oracle.numbers(count, options);
        for (size_t i = 0; i < count; i++)
            for (size_t plane = 0; plane < 2 * OPAL_PROBE_PAIRS; plane++) {
                const double x = a.at(plane, i), y = b.at(plane, i);
                pair.add(x, y, x >= 0 && x < 1, y >= 0 && y < 1);
                pair.count_figure(x, y);
            }
    }
    return pair.result();
}

Probed probe_critical_angle(double ulps, const Device &device, const How &how) {
    // From inside: the side that the normal points away from. sin = n_far / n_near at the critical angle.
    const double critical = 1.0f / 1.5f;
    float sine = float(critical);
    for (int i = 0; i < std::abs(ulps); i++)
        sine = std::nextafter(sine, ulps > 0 ? 1.f : 0.f);
    const Vec3 wi = {sine, 0, -std::sqrt(1 - double(sine) * sine)};
    const FlatScene flat = scene_of_bsdfs({dielectric(1.5)});
    KernelProbe single = probe_of(flat, device, how, MathMode::precise),
                oracle = probe_of(flat, device, how, MathMode::double_precision);
    const size_t count = size_t(std::min<unsigned long long>(how.paths(), 1 << 20));
    Planes numbers(3, count);
    for (size_t i = 0; i < count; i++)
        numbers.at(2, i) = (float(i) + 0.5f) / float(count);
    const Planes a = single.bsdf_sample(0, wi, numbers), b = oracle.bsdf_sample(0, wi, numbers);
    Pair pair;
    const auto finite = [](const Planes &p, size_t i) {
        const Vec3 wo = p.vec3(BSDF_WO_X, i);
        return std::isfinite(p.at(BSDF_WEIGHT_R, i)) && std::abs(length(wo) - 1) < 1e-5;
    };
    for (size_t i = 0; i < count; i++) {
        pair.add(0, 0, finite(a, i), finite(b, i));
        pair.count_figure(a.at(BSDF_WO_Z, i) < 0, b.at(BSDF_WO_Z, i) < 0);
    }
    Probed probed = pair.result();
    probed.error = std::abs(probed.single - probed.oracle);
    return probed;
}

namespace {

struct ClosedMesh {
    SceneDescription scene;
    bool listed; // its triangles may be outside the tree
};

// Convex around the origin, of about half side 1.
const std::vector<ClosedMesh> &closed_meshes() {
    static const std::vector<ClosedMesh> meshes = {{scene_of_mesh(cube({}, 1)), true},
                                                   {scene_of_mesh(edges::closed_sphere(3)), true},
                                                   {scene_of_mesh(edges::closed_sphere(12)), false},
                                                   {scene_of_mesh(edges::closed_sphere(64)), false},
                                                   {scene_of_mesh(slivered_cube(1e5)), false}};
    return meshes;
}

} // namespace

unsigned long long lost_at_edges(double scale, unsigned long long rays, const Device &device, const How &how,
                                 MathMode math) {
    std::mt19937 random(how.seed);
    const auto unit = [&random] { return double(random()) * 0x1p-32; };
    constexpr unsigned long long batch = 1 << 19;
    const size_t meshes = closed_meshes().size(),
                 of_each = size_t(std::min((rays + meshes - 1) / meshes, batch)); // up, or all would be done twice
    unsigned long long lost = 0, done = 0;
    while (done < rays)
        for (const ClosedMesh &mesh : closed_meshes()) {
            const double size =
                scale * (0.5 + unit()); // scenes are scaled by powers of two: the rest of the size counts
            const Transform turn = Transform::rotate({unit() - 0.5, unit() - 0.5, unit() - 0.5}, 360 * unit());
            SceneDescription scene =
                moved(mesh.scene, Transform::translate(Vec3{unit() - 0.5, unit() - 0.5, unit() - 0.5} * (1e4 * size)) *
                                      Transform::scale({size, size, size}) * turn);
            scene.strategy.specialise = mesh.listed;
            KernelProbe probe = probe_of(flatten(scene, lanes_for(device.info, 0, math)), device, how, math);
            lost += edges::lost_rays(probe, of_each, random);
            done += of_each;
        }
    return lost;
}

Probed probe_edges(double scale, const Device &device, const How &how) {
    const double rays = double(how.paths());
    const double single = double(lost_at_edges(scale, how.paths(), device, how, MathMode::precise)) / rays;
    const double oracle = double(lost_at_edges(scale, how.paths(), device, how, MathMode::double_precision)) / rays;
    return {single, oracle, std::abs(single - oracle), 0, 0, single};
}

} // namespace opal::extremes
