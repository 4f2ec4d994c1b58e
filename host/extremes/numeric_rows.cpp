#include "extremes/numeric_rows.h"

#include "extremes/scenes.h"
#include "selftest/watertight.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal::extremes {

namespace {

KernelProbe probe_of(FlatScene flat, const Device &device, const StressSettings &settings, MathMode math) {
    BuildOptions build;
    build.math = math;
    build.lanes = lanes_for(device.info, 0, math);
    return KernelProbe(device, std::move(flat), build, *settings.sources);
}

// Compares the values of both precisions one by one, and averages the row's figure.
class Comparison {
public:
    void add(double single, double oracle, bool valid_single, bool valid_oracle) {
        invalid_single_ += !valid_single;
        invalid_oracle_ += !valid_oracle;
        if (valid_single && valid_oracle)
            error_ = std::max(error_, std::abs(single - oracle));
    }
    void add(double single, double oracle) { add(single, oracle, std::isfinite(single), std::isfinite(oracle)); }
    // Adds vectors whose components are three planes from `plane` on. The figure is their third component.
    void add_vectors(const Planes &single, const Planes &oracle, size_t plane) {
        for (size_t i = 0; i < single.count; i++) {
            for (size_t p = plane; p < plane + 3; p++)
                add(single.at(p, i), oracle.at(p, i));
            count_figure(single.at(plane + 2, i), oracle.at(plane + 2, i));
        }
    }
    void count_figure(double single, double oracle) {
        sum_single_ += single;
        sum_oracle_ += oracle;
        figures_++;
    }
    NumericResult result() const {
        return {sum_single_ / figures_, sum_oracle_ / figures_, error_, invalid_single_, invalid_oracle_};
    }

private:
    double error_ = 0, sum_single_ = 0, sum_oracle_ = 0, figures_ = 0;
    unsigned long long invalid_single_ = 0, invalid_oracle_ = 0;
};

// Pairs of random numbers (u, other) and (other, u). The third plane, which chooses the lobe, runs through all numbers.
Planes number_pairs(double u) {
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

struct WarpCase {
    int warp;
    float parameter;
};
const WarpCase warp_cases[] = {{WARP_tent, 0},
                               {WARP_uniform_disk, 0},
                               {WARP_concentric_disk, 0},
                               {WARP_uniform_sphere, 0},
                               {WARP_uniform_hemisphere, 0},
                               {WARP_cosine_hemisphere, 0},
                               {WARP_beckmann, 1},
                               {WARP_beckmann, 1e-2f},
                               {WARP_beckmann, 1e-6f},
                               {WARP_phong_lobe, 0},
                               {WARP_phong_lobe, 100},
                               {WARP_phong_lobe, 1e8f}};

// A scene with every BSDF, a mesh light and a parallelogram light.
FlatScene scene_of_everything() {
    SceneDescription scene = room();
    scene.meshes.push_back(light(cube({0.6, 0.6, 0.6}, 0.1, false), 1));
    scene.strategy.specialise = Specialise::off;
    return flatten(scene, 1);
}

} // namespace

NumericResult measure_numbers(double u, const Device &device, const StressSettings &settings) {
    KernelProbe single = probe_of(scene_of_everything(), device, settings, MathMode::precise);
    KernelProbe oracle = probe_of(scene_of_everything(), device, settings, MathMode::double_precision);
    const Planes numbers = number_pairs(u);
    Comparison comparison;
    for (const WarpCase &warp_case : warp_cases) {
        const Planes a = single.warp_sample(warp_case.warp, warp_case.parameter, numbers),
                     b = oracle.warp_sample(warp_case.warp, warp_case.parameter, numbers);
        comparison.add_vectors(a, b, WARP_X);
        std::vector<Vec3> points;
        for (size_t i = 0; i < a.count; i++)
            points.push_back(a.vec3(WARP_X, i));
        const Planes density = single.warp_pdf(warp_case.warp, warp_case.parameter, points);
        for (size_t i = 0; i < density.count; i++) // up to 1 / alpha^2: not compared, but it must be a density
            comparison.add(0, 0, std::isfinite(density.at(0, i)) && density.at(0, i) >= 0, true);
    }
    for (unsigned mesh = 0; mesh < single.scene().meshes.size(); mesh++)
        for (const double degrees : {0.0, 45.0, 89.999}) {
            const double angle = degrees * (std::numbers::pi / 180);
            const Vec3 wi = {std::sin(angle), 0, std::cos(angle)};
            const Planes a = of_radiance(single.bsdf_sample(mesh, wi, numbers)),
                         b = of_radiance(oracle.bsdf_sample(mesh, wi, numbers));
            comparison.add_vectors(a, b, BSDF_WO_X);
            comparison.add_vectors(a, b, BSDF_WEIGHT_R);
        }
    const Vec3 from = {0.1, -0.2, 0.05};
    comparison.add_vectors(single.light_sample(from, numbers), oracle.light_sample(from, numbers), LIGHT_D_X);
    return comparison.result();
}

NumericResult measure_samplers(double spp, const Device &device, const StressSettings &settings) {
    KernelProbe single = probe_of(scene_of_everything(), device, settings, MathMode::precise);
    KernelProbe oracle = probe_of(scene_of_everything(), device, settings, MathMode::double_precision);
    Comparison comparison;
    for (const int sampler : {CHOICE_sampler_independent, CHOICE_sampler_stratified, CHOICE_sampler_sobol}) {
        NumberOptions options;
        options.seed = settings.seed;
        options.sampler = sampler;
        options.spp = unsigned(spp);
        // At most max_tried samples, evenly from the first to the last: index i is sample i * sample_step.
        constexpr double max_tried = 4096;
        const size_t count = size_t(std::min(max_tried, spp));
        options.sample_step = count > 1 ? unsigned((spp - 1) / double(count - 1)) : 1;
        const Planes a = single.numbers(count, options), b = oracle.numbers(count, options);
        for (size_t i = 0; i < count; i++)
            for (size_t plane = 0; plane < 2 * OPAL_PROBE_PAIRS; plane++) {
                const double x = a.at(plane, i), y = b.at(plane, i);
                comparison.add(x, y, x >= 0 && x < 1, y >= 0 && y < 1);
                comparison.count_figure(x, y);
            }
    }
    return comparison.result();
}

NumericResult measure_critical_angle(double ulps, const Device &device, const StressSettings &settings) {
    // The ray comes from inside, from below the surface. At the critical angle the sine is ext_ior / int_ior.
    constexpr float int_ior = 1.5f;
    float sine = 1 / int_ior;
    for (int i = 0; i < std::abs(ulps); i++)
        sine = std::nextafter(sine, ulps > 0 ? 1.f : 0.f);
    const Vec3 wi = {sine, 0, -std::sqrt(1 - double(sine) * sine)};
    const FlatScene flat = scene_of_bsdfs({dielectric(int_ior)});
    KernelProbe single = probe_of(flat, device, settings, MathMode::precise),
                oracle = probe_of(flat, device, settings, MathMode::double_precision);
    constexpr unsigned long long max_samples = 1 << 20;
    const size_t count = size_t(std::min(settings.paths(), max_samples));
    Planes numbers(3, count);
    for (size_t i = 0; i < count; i++)
        numbers.at(2, i) = (float(i) + 0.5f) / float(count);
    const Planes a = single.bsdf_sample(0, wi, numbers), b = oracle.bsdf_sample(0, wi, numbers);
    Comparison comparison;
    const auto valid = [](const Planes &p, size_t i) {
        const Vec3 wo = p.vec3(BSDF_WO_X, i);
        return std::isfinite(p.at(BSDF_WEIGHT_R, i)) && std::abs(length(wo) - 1) < 1e-5;
    };
    for (size_t i = 0; i < count; i++) {
        comparison.add(0, 0, valid(a, i), valid(b, i));
        comparison.count_figure(a.at(BSDF_WO_Z, i) < 0, b.at(BSDF_WO_Z, i) < 0);
    }
    NumericResult result = comparison.result();
    result.error = std::abs(result.single - result.oracle);
    return result;
}

namespace {

struct ClosedMesh {
    SceneDescription scene;
    bool listed; // whether its triangles may be in the face list instead of the tree
};

// Convex meshes around the origin, with a half side of about 1.
const std::vector<ClosedMesh> &closed_meshes() {
    static const std::vector<ClosedMesh> meshes = {{scene_of_mesh(cube({}, 1)), true},
                                                   {scene_of_mesh(edges::closed_sphere(3)), true},
                                                   {scene_of_mesh(edges::closed_sphere(12)), false},
                                                   {scene_of_mesh(edges::closed_sphere(64)), false},
                                                   {scene_of_mesh(slivered_cube(1e5)), false}};
    return meshes;
}

} // namespace

unsigned long long lost_at_edges(double scale, unsigned long long rays, const Device &device,
                                 const StressSettings &settings, MathMode math) {
    std::mt19937 random(settings.seed);
    const auto unit = [&random] { return double(random()) * 0x1p-32; };
    constexpr unsigned long long max_batch = 1 << 19; // rays
    const size_t meshes = closed_meshes().size();
    const size_t batch =
        size_t(std::min((rays + meshes - 1) / meshes, max_batch)); // rounded up: one round then suffices
    unsigned long long lost = 0, done = 0;
    while (done < rays)
        for (const ClosedMesh &mesh : closed_meshes()) {
            const double size = scale * (0.5 + unit()); // flattening scales by powers of two only: the mantissa matters
            const Transform rotation = Transform::rotate({unit() - 0.5, unit() - 0.5, unit() - 0.5}, 360 * unit());
            SceneDescription scene =
                moved(mesh.scene, Transform::translate(Vec3{unit() - 0.5, unit() - 0.5, unit() - 0.5} * (1e4 * size)) *
                                      Transform::scale({size, size, size}) * rotation);
            scene.strategy.specialise = mesh.listed ? Specialise::on : Specialise::off;
            KernelProbe probe =
                probe_of(flatten(scene, lanes_for(device.info, 0, math), mesh.listed), device, settings, math);
            lost += edges::lost_rays(probe, batch, random);
            done += batch;
        }
    return lost;
}

NumericResult measure_edges(double scale, const Device &device, const StressSettings &settings) {
    const double rays = double(settings.paths());
    const double single = double(lost_at_edges(scale, settings.paths(), device, settings, MathMode::precise)) / rays;
    const double oracle =
        double(lost_at_edges(scale, settings.paths(), device, settings, MathMode::double_precision)) / rays;
    return {single, oracle, std::abs(single - oracle), 0, 0, single};
}

} // namespace opal::extremes
