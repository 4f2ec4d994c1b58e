// What is drawn against its density; BSDFs, emitters and the functions below them against formulas in double.
#include "densities/sampled.h"
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <cmath>
#include <numbers>
#include <random>

namespace opal::test {

namespace {

constexpr double pi = std::numbers::pi;
constexpr size_t draws = 150000;

KernelProbe probe_of(const FlatScene &scene, int lanes, const Sources &sources) {
    BuildOptions build;
    build.lanes = lanes;
    return KernelProbe(device(), scene, build, sources);
}

cl::Program program_from(const Sources &sources, const std::string &text, int lanes) {
    Sources with_text = sources;
    with_text.files["tests/inline.cl"] =
        "#include \"core/lanes.cl\"\n#include \"core/math.cl\"\n#include \"bsdfs/fresnel.cl\"\n" + text;
    BuildOptions build;
    build.lanes = lanes;
    build.kernels = "tests/inline.cl";
    return build_program(device(), program_text(all_features(), build, with_text), build);
}

std::string at_width(int lanes) { return " at " + std::to_string(lanes) + " lanes"; }

Vec3 direction(double degrees) { return {std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)}; }

struct Material {
    std::string name;
    BsdfRecord record;
};

std::vector<Material> materials() {
    const auto microfacet = [](float alpha) {
        BsdfRecord record = bsdf_record(BSDF_microfacet);
        record.u.microfacet = {alpha, 1.5f, 1.000277f, 0.8f, {0.1f, 0.2f, 0.15f}};
        return record;
    };
    const auto phong = [](float n) {
        BsdfRecord record = bsdf_record(BSDF_phong, 0.8f);
        record.u.phong.n = n;
        record.u.phong.pd = 0.3f;
        return record;
    };
    BsdfRecord uniform = bsdf_record(BSDF_diffuse, 0.6f);
    uniform.u.diffuse.use_cosine = 0;
    return {{"diffuse", bsdf_record(BSDF_diffuse, 0.6f)},
            {"diffuse, uniform", uniform},
            {"microfacet 0.1", microfacet(0.1f)},
            {"microfacet 0.4", microfacet(0.4f)},
            {"phong 10", phong(10)},
            {"phong 200", phong(200)}};
}

FlatScene scene_of(const std::vector<Material> &list) {
    std::vector<BsdfRecord> records;
    for (const Material &material : list)
        records.push_back(material.record);
    return scene_of_bsdfs(records);
}

Planes random_numbers(KernelProbe &probe, size_t count, unsigned seed) {
    NumberOptions options;
    options.seed = seed;
    return probe.numbers(count, options);
}

// Each sample's weight is f cos / pdf of eval at its direction, and its density is eval's. A direction is rounded: the
// half vector recomputed from it is off by some 2^-24 / (wi.h), which Beckmann's density magnifies by 2 tan / alpha^2,
// single samples of 89.9 degrees by 1e-2; so the mean is held to 1e-4.
Finding weights_fit(const std::string &what, KernelProbe &probe, unsigned id, Vec3 wi, unsigned seed) {
    const Planes drawn = probe.bsdf_sample(id, wi, random_numbers(probe, 4096, seed));
    std::vector<Vec3> directions;
    for (size_t i = 0; i < drawn.count; i++)
        directions.push_back(drawn.vec3(BSDF_WO_X, i));
    const Planes f = probe.bsdf_eval(id, wi, directions);
    size_t wrong = 0;
    stats::Moments off;
    for (size_t i = 0; i < drawn.count; i++) {
        const double pdf = f.at(EVAL_PDF, i), weight = drawn.at(BSDF_WEIGHT_G, i);
        const double ratio = pdf > 0 && directions[i].z > 0 ? f.at(EVAL_G, i) * directions[i].z / pdf : 0;
        const double density_off = pdf > 0 ? std::abs(drawn.at(BSDF_PDF, i) / pdf - 1) : drawn.at(BSDF_PDF, i);
        wrong += std::abs(ratio - weight) > 2e-2 * weight || density_off > 2e-2;
        off.add(density_off);
    }
    return exact(what + ": " + std::to_string(wrong) + " of 4096 weights are not f cos / pdf, densities are off by " +
                     std::to_string(off.mean()),
                 wrong <= 8 && off.mean() <= 1e-4);
}

Finding reciprocal(const std::string &what, KernelProbe &probe, unsigned id) {
    const Vec3 a = normalize({0.3, 0.2, 0.7}), b = normalize({-0.4, -0.1, 0.5});
    const float there = probe.bsdf_eval(id, a, std::vector<Vec3>{b}).at(EVAL_G, 0),
                back = probe.bsdf_eval(id, b, std::vector<Vec3>{a}).at(EVAL_G, 0);
    return exact(what + " is reciprocal", there > 0 && std::abs(there - back) <= 1e-4 * there);
}

stats::Sample albedo_of(KernelProbe &probe, unsigned id, Vec3 wi, unsigned seed) {
    stats::Moments moments;
    const Planes drawn = probe.bsdf_sample(id, wi, random_numbers(probe, 1 << 18, seed));
    for (size_t i = 0; i < drawn.count; i++)
        moments.add(0.212671 * drawn.at(BSDF_WEIGHT_R, i) + 0.715160 * drawn.at(BSDF_WEIGHT_G, i) +
                    0.072169 * drawn.at(BSDF_WEIGHT_B, i));
    return moments.sample();
}

double fresnel(double cosine, double near, double far) { // Born and Wolf, "Principles of Optics", section 1.5.2
    const double sine = near / far * std::sqrt(1 - cosine * cosine);
    if (sine >= 1)
        return 1;
    const double other = std::sqrt(1 - sine * sine);
    const double s = (near * cosine - far * other) / (near * cosine + far * other),
                 p = (far * cosine - near * other) / (far * cosine + near * other);
    return (s * s + p * p) / 2;
}

// Lights in the unit square of z = 0: a mesh of unequal triangles, two of them slivers, and a parallelogram.
// No edge lies on a line between the histogram's cells, where the last bit would decide which cell a sample falls in.
SceneDescription flat_lights() {
    return opal::scene_of(
        {light(
             mesh_of(
                 {{0.03, 0.04, 0}, {0.47, 0.04, 0}, {0.47, 0.97, 0}, {0.13, 0.97, 0}, {0.11, 0.93, 0}, {0.03, 0.87, 0}},
                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}}),
             {1, 2, 3}),
         light(Parallelogram{{0.58, 0.22, 0}, {0.39, 0, 0}, {0, 0.51, 0}}, {9, 8, 2})});
}

// The density that sampling reports, against the one of a ray that finds the same point.
Finding densities_agree(const std::string &what, KernelProbe &probe, unsigned seed) {
    const Planes drawn = probe.light_sample(random_numbers(probe, 20000, seed));
    Planes rays(RAY_PLANES, drawn.count);
    const double scale = probe.scene().scale;
    for (size_t i = 0; i < drawn.count; i++) {
        const double ray[RAY_PLANES] = {
            drawn.at(LIGHT_X, i), drawn.at(LIGHT_Y, i), drawn.at(LIGHT_Z, i) + scale, 0, 0, -1, 0, 4 * scale};
        for (size_t plane = 0; plane < RAY_PLANES; plane++)
            rays.at(plane, i) = float(ray[plane]);
    }
    const Planes hits = probe.trace(rays);
    size_t wrong = 0;
    for (size_t i = 0; i < drawn.count; i++)
        wrong += hits.bits(HIT_EMITTER, i) != drawn.bits(LIGHT_ID, i) ||
                 !(std::abs(hits.at(HIT_LIGHT_DENSITY, i) / drawn.at(LIGHT_DENSITY, i) - 1) < 1e-4) ||
                 !(drawn.at(LIGHT_NORMAL_Z, i) > 0.999);
    // Points on an edge, to which the ray may see the neighbour.
    return exact(what + ": " + std::to_string(wrong) + " of 20000 densities differ", wrong <= 20);
}

} // namespace

Findings check_warps(const Sources &sources, unsigned seed) {
    struct Row {
        int warp;
        float parameter;
    };
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_bsdfs({}), lanes, sources);
        for (const Row &row : {Row{WARP_tent, 0},
                               {WARP_uniform_disk, 0},
                               {WARP_uniform_sphere, 0},
                               {WARP_uniform_hemisphere, 0},
                               {WARP_cosine_hemisphere, 0},
                               {WARP_beckmann, 0.05f},
                               {WARP_beckmann, 0.5f},
                               {WARP_phong_lobe, 1},
                               {WARP_phong_lobe, 20},
                               {WARP_phong_lobe, 1000}}) {
            const Sampled sampled = sampled_warp(probe, row.warp, row.parameter);
            const DensityCheck check = check_density(probe, sampled, 16, 20, draws, seed + unsigned(findings.size()));
            findings.push_back(
                {sampled.name + " " + std::to_string(row.parameter) + at_width(lanes) + check.test.result.reason,
                 check.test.result.p_value});
        }
    }
    return findings;
}

Findings check_bsdfs(const Sources &sources, unsigned seed) {
    Findings findings;
    const std::vector<Material> list = materials();
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of(list), lanes, sources);
        for (unsigned id = 0; id < list.size(); id++) {
            findings.push_back(reciprocal(list[id].name, probe, id));
            for (double degrees : {0.0, 40.0, 75.0, 89.9}) {
                const std::string what = list[id].name + ", " + std::to_string(degrees) + " degrees" + at_width(lanes);
                findings.push_back(weights_fit(what, probe, id, direction(degrees), seed + id));
                if (lanes == 1 && degrees != 40) // the same functions at both widths: most of the chi-square at one
                    continue;
                const DensityCheck check = check_density(probe, sampled_bsdf(probe, id, direction(degrees)), 20, 20,
                                                         draws, seed + unsigned(findings.size()));
                findings.push_back({what + ": " + check.test.result.reason, check.test.result.p_value});
            }
        }
    }
    return findings;
}

Findings check_albedos(const Sources &sources, unsigned seed) {
    Findings findings;
    const std::vector<Material> list = materials();
    KernelProbe probe = probe_of(scene_of(list), device().info.native_lanes, sources);
    // The luminance's directional albedo of alpha 0.1 by quadrature (SCENE_FORMAT, section 6).
    for (const auto &[degrees, albedo] :
         {std::pair{0.0, 0.207084}, {45.0, 0.215892}, {60.0, 0.247775}, {80.0, 0.430824}, {85.0, 0.519005}})
        findings.push_back(
            {"albedo of the microfacets at " + std::to_string(degrees),
             stats::z_test(albedo_of(probe, 2, direction(degrees), seed + unsigned(degrees)), albedo).p_value});
    for (unsigned id = 0; id < 2; id++)
        findings.push_back({"albedo of " + list[id].name,
                            stats::z_test(albedo_of(probe, id, direction(50), seed + id), 0.6f).p_value});
    for (unsigned id = 0; id < list.size(); id++)
        for (double degrees : {0.0, 60.0, 89.0}) {
            const stats::Sample sample = albedo_of(probe, id, direction(degrees), seed + 7);
            findings.push_back(exact("albedo of " + list[id].name + " at most 1",
                                     sample.mean <= 1 + 6 * std::sqrt(sample.variance / sample.n)));
        }
    return findings;
}

Findings check_refraction(const Sources &sources, unsigned) {
    Findings findings;
    constexpr size_t angles = 512;
    std::vector<float> cosines, sines2;
    for (size_t i = 0; i < angles; i++) {
        const double theta = pi / 2 * (double(i) + 0.5) / angles;
        cosines.push_back(float(std::cos(theta)));
        sines2.push_back(float(std::sin(theta) * std::sin(theta)));
    }
    for (int lanes : tested_lanes()) {
        const cl::Program program = program_from(sources,
                                                 "kernel void reflectance(global const float *c, global const float "
                                                 "*s2, float near, float far, global float *out) {\n"
                                                 "    size_t i = get_global_id(0) * LANES;\n"
                                                 "    real r = fresnel_dielectric(LOAD(real, (c + i)), LOAD(real, (s2 "
                                                 "+ i)), boundary_of((real)(near), (real)(far)));\n"
                                                 "    STORE(r, (out + i));\n}\n",
                                                 lanes);
        for (const auto &[near, far] :
             {std::pair{1.f, 1.5f}, {1.5f, 1.f}, {1.000277f, 1.5046f}, {1.33f, 1.34f}, {2.4f, 1.f}}) {
            const Output<float> out(angles);
            run(program, "reflectance", angles / size_t(lanes), cosines, sines2, near, far, out);
            const std::vector<float> found = out.read();
            size_t wrong = 0;
            for (size_t i = 0; i < angles; i++) {
                const double truth = fresnel(cosines[i], near, far);
                wrong += !(std::abs(found[i] - truth) <=
                           2e-4 * truth + 2e-7); // near the critical angle an ulp of the sine weighs most
            }
            findings.push_back(exact("Fresnel's formulas, indices " + std::to_string(near) + " " + std::to_string(far) +
                                         at_width(lanes) + ": " + std::to_string(wrong) + " wrong",
                                     wrong <= 2));
        }

        BsdfRecord glass = bsdf_record(BSDF_dielectric);
        KernelProbe probe = probe_of(scene_of_bsdfs({glass}), lanes, sources);
        size_t bent_wrong = 0, straight_wrong = 0, refracted = 0;
        Planes numbers(3, 2);
        numbers.at(2, 0) = 0;              // reflects
        numbers.at(2, 1) = 0x1.fffffep-1f; // refracts unless all is reflected
        for (double degrees = 1; degrees < 180; degrees += 4) {
            if (degrees > 88 && degrees < 92)
                continue;
            const Vec3 wi = normalize(
                {std::sin(degrees * pi / 180) * 0.6, std::sin(degrees * pi / 180) * 0.8, std::cos(degrees * pi / 180)});
            const Planes drawn = probe.bsdf_sample(0, wi, numbers);
            const Vec3 back = drawn.vec3(BSDF_WO_X, 0), through = drawn.vec3(BSDF_WO_X, 1);
            // What is reflected weighs its reflectance over the probability that it is drawn with: 1 but for a random
            // number's 2^-24.
            const double reflectance = fresnel(std::abs(wi.z), wi.z > 0 ? 1 : 1.5, wi.z > 0 ? 1.5 : 1);
            const double weight = drawn.at(BSDF_WEIGHT_R, 0);
            straight_wrong += length(back - Vec3{-wi.x, -wi.y, wi.z}) > 1e-6 || weight > 1 ||
                              weight < 1 - 0x1p-24 / reflectance - 1e-7;
            const double eta = wi.z > 0 ? 1.5 : 1 / 1.5, sine2 = (wi.x * wi.x + wi.y * wi.y) / (eta * eta);
            if (sine2 >= 1)
                continue;
            const Vec3 truth{-wi.x / eta, -wi.y / eta, wi.z > 0 ? -std::sqrt(1 - sine2) : std::sqrt(1 - sine2)};
            bent_wrong += length(through - truth) > 1e-5 ||
                          std::abs(drawn.at(BSDF_WEIGHT_R, 1) * eta * eta - 1) > 1e-5 ||
                          std::abs(drawn.at(BSDF_ETA, 1) - eta) > 1e-5;
            refracted++;
        }
        findings.push_back(
            exact("reflected directions" + at_width(lanes) + ": " + std::to_string(straight_wrong) + " wrong",
                  straight_wrong == 0));
        findings.push_back(exact("Snell's law" + at_width(lanes) + ": " + std::to_string(bent_wrong) + " wrong",
                                 bent_wrong == 0 && refracted > 25));
    }
    return findings;
}

Findings check_emitters(const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : tested_lanes())
        for (const char *emitter_choice : {"uniform", "power"})
            for (const char *triangle_choice : {"area", "uniform"}) {
                const SceneDescription lights = with(
                    flat_lights(),
                    {{"emitter-choice", emitter_choice}, {"triangle-choice", triangle_choice}, {"specialise", "off"}});
                const FlatScene flat = flatten(lights, lanes);
                const std::string what = std::string("emitters by ") + emitter_choice + ", triangles by " +
                                         triangle_choice + at_width(lanes);
                double sum = 0, triangles = 0;
                for (const EmitterRecord &emitter : flat.emitters)
                    sum += emitter.probability;
                for (const LightTriangle &triangle : flat.light_triangles)
                    triangles += area_of(flat, triangle.slot) / triangle.inverse_pdf;
                findings.push_back(exact(what + ": probabilities sum to 1",
                                         std::abs(sum - 1) < 1e-6 && std::abs(triangles - 1) < 1e-6));
                KernelProbe probe = probe_of(flat, lanes, sources);
                findings.push_back(densities_agree(what, probe, seed + unsigned(findings.size())));
                if (lanes != tested_lanes().back())
                    continue;
                const DensityCheck check =
                    check_density(probe, sampled_lights(probe), 10, 10, draws, seed + unsigned(findings.size()));
                findings.push_back({what + ": " + check.test.result.reason, check.test.result.p_value});
            }
    return findings;
}

Findings check_trigonometry(const Sources &sources, unsigned seed) {
    Findings findings;
    std::mt19937 random(seed);
    std::vector<float> u;
    for (size_t i = 0; i < 1 << 16; i++)
        u.push_back(i < 64 ? float(i) / 32 - 1 : float(random() >> 8) * 0x1p-24f * (i % 8 ? 1.f : 100.f));
    for (int lanes : tested_lanes()) {
        const cl::Program program =
            program_from(sources,
                         "kernel void turn(global const float *u, global float *c, global float *s) {\n"
                         "    size_t i = get_global_id(0) * LANES;\n    v2 r = cos_sin_2pi(LOAD(real, (u + i)));\n"
                         "    STORE(r.x, (c + i)); STORE(r.y, (s + i));\n}\n",
                         lanes);
        const Output<float> cosines(u.size()), sines(u.size());
        run(program, "turn", u.size() / size_t(lanes), u, cosines, sines);
        const std::vector<float> c = cosines.read(), s = sines.read();
        double worst = 0;
        for (size_t i = 0; i < u.size(); i++) {
            const double turns = u[i] - std::floor(double(u[i]));
            worst =
                std::max({worst, std::abs(c[i] - std::cos(2 * pi * turns)), std::abs(s[i] - std::sin(2 * pi * turns))});
        }
        findings.push_back(exact("cosine and sine within 2 ulp of 1" + at_width(lanes) + ", off by " +
                                     std::to_string(worst * 1e9) + "e-9",
                                 worst <= 1.2e-7));
    }
    return findings;
}

} // namespace opal::test
