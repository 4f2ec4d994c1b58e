// What is drawn against its density; BSDFs, emitters and the functions below them against formulas in double.
#include "base/table.h"
#include "extremes/scenes.h"
#include "selftest/checks.h"
#include "support/cases.h"
#include "support/kernel_checks.h"
#include "support/kernels.h"
#include "support/pictures.h"
#include "support/probe.h"
#include "support/rooms.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <random>

namespace opal::test {

namespace {

constexpr double pi = std::numbers::pi;

// More samples than selftest takes, and other seeds at each width.
Effort effort_at(int lanes, unsigned seed) {
    Effort effort;
    effort.samples = 150'000;
    effort.nu = effort.nv = 20;
    effort.angles = {0, 40, 60, 75, 89.9};
    effort.draws = lanes == tested_lanes().back() ? 1 << 18 : 1 << 14;
    effort.quadrature_error = 2e-3;
    effort.seed = seed + 1000u * unsigned(lanes);
    effort.each_sample = true;
    return effort;
}

cl::Program program_with_fresnel(const Sources &sources, const std::string &text, int lanes) {
    return program_from(sources,
                        "#include \"core/lanes.cl\"\n#include \"core/math.cl\"\n#include \"bsdfs/fresnel.cl\"\n" + text,
                        lanes);
}

Vec3 direction(double degrees) { return {std::sin(degrees * pi / 180), 0, std::cos(degrees * pi / 180)}; }

Planes random_numbers(KernelProbe &probe, size_t count, unsigned seed) {
    NumberOptions options;
    options.seed = seed;
    return probe.numbers(count, options);
}

stats::Sample albedo_of(KernelProbe &probe, unsigned id, Vec3 wi, unsigned seed) {
    stats::Moments moments;
    const Planes drawn = probe.bsdf_sample(id, wi, random_numbers(probe, 1 << 18, seed));
    for (size_t i = 0; i < drawn.count; i++)
        moments.add(luminance({drawn.at(BSDF_WEIGHT_R, i), drawn.at(BSDF_WEIGHT_G, i), drawn.at(BSDF_WEIGHT_B, i)}));
    return moments.sample();
}

// Those of the cases with these names.
template <class Case> std::vector<Case> named(const std::vector<Case> &cases, const std::vector<std::string> &names) {
    std::vector<Case> found;
    for (const std::string &name : names)
        found.push_back(find_row(cases, "case of tests/cases", name));
    return found;
}

// The meshes in one scene, each in a column of the unit square.
SceneDescription side_by_side(const std::vector<Mesh> &meshes) {
    SceneDescription scene = scene_of({});
    const double width = 1 / double(meshes.size());
    for (size_t i = 0; i < meshes.size(); i++) {
        const Transform to_column = Transform::translate({double(i) * width, 0, 0}) * Transform::scale({width, 1, 1});
        const SceneDescription moved = extremes::moved(scene_of({meshes[i]}), to_column);
        scene.meshes.push_back(moved.meshes.front());
    }
    return scene;
}

// Probabilities of emitters, and of triangles within the mesh lights.
Finding probabilities_sum(const std::string &what, const FlatScene &flat) {
    double emitters = 0, triangles = 0, meshes = 0;
    for (const EmitterRecord &emitter : flat.emitters) {
        emitters += emitter.probability;
        meshes += emitter.kind == EMITTER_mesh;
    }
    for (const LightTriangle &triangle : flat.light_triangles)
        triangles += area_of(flat, triangle.slot) / triangle.inverse_pdf;
    return exact(what + ": probabilities sum to 1",
                 std::abs(emitters - 1) < 1e-6 && std::abs(triangles - meshes) < 1e-6 * (1 + meshes));
}

// Whether a sphere's normals point to the side of a point.
bool is_before(const emitter_sphere_record &sphere, Vec3 from) {
    const Vec3 center{sphere.center[0], sphere.center[1], sphere.center[2]};
    return (length(from - center) < sphere.radius) == (sphere.inward != 0);
}

// What sampling reports of a direction, against a ray of that direction: emitter, distance, radiance and density. From
// below, the backs of lights in the unit square are seen.
Finding samples_agree(const std::string &what, KernelProbe &probe, unsigned seed) {
    const bool around = probe.scene().settings.environment != OPAL_NONE;
    const double scale = probe.scene().scale;
    const Planes numbers = random_numbers(probe, 20000, seed);
    const auto close = [](double a, double b) { return std::abs(a / b - 1) < 1e-4; };
    size_t wrong = 0;
    for (const double height : {0.4, -0.4}) {
        const Vec3 from = (Vec3{0.7, 0.3, height} - probe.scene().center) * scale;
        const Planes drawn = probe.light_sample(from, numbers);
        std::vector<Vec3> directions;
        for (size_t i = 0; i < drawn.count; i++)
            directions.push_back(drawn.vec3(LIGHT_D_X, i));
        const Planes hits = probe.trace(rays_from(from, directions));
        for (size_t i = 0; i < drawn.count; i++) {
            const EmitterRecord &emitter = probe.scene().emitters[drawn.bits(LIGHT_ID, i)];
            const bool front = emitter.kind == EMITTER_sphere ? is_before(emitter.u.of_sphere, from) : height > 0;
            const bool lit = front || around || emitter.two_sided != 0;
            wrong += drawn.at(LIGHT_ACTIVE, i) != (lit ? 1 : 0);
            if (lit)
                wrong += hits.bits(HIT_EMITTER, i) != drawn.bits(LIGHT_ID, i) ||
                         !close(hits.at(HIT_LIGHT_DENSITY, i), drawn.at(LIGHT_DENSITY, i)) ||
                         !close(hits.at(HIT_T, i), drawn.at(LIGHT_DISTANCE, i)) ||
                         !close(hits.at(HIT_RADIANCE_R, i), drawn.at(LIGHT_RADIANCE_R, i));
        }
    }
    // Of points on an edge the ray may hit the neighbour.
    return exact(what + ": " + std::to_string(wrong) + " of 40000 samples differ", wrong <= 20);
}

} // namespace

Findings check_warps(const Sources &sources, unsigned seed) {
    std::vector<WarpCase> cases = selftest_warps();
    cases.insert(cases.end(), {{WARP_beckmann, 0.5f}, {WARP_phong_lobe, 1}});
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_bsdfs({}), lanes, sources);
        append(findings, warp_findings(probe, cases, effort_at(lanes, seed)));
    }
    return findings;
}

Findings check_materials(const std::vector<Material> &materials, const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_materials(materials), lanes, sources);
        append(findings, material_findings(probe, materials, effort_at(lanes, seed)));
    }
    return findings;
}

Findings check_bsdfs(const Sources &sources, unsigned seed) { return check_materials(bsdf_cases(), sources, seed); }
Check check_of_bsdfs(std::vector<std::string> names) {
    return [names = std::move(names)](const Sources &sources, unsigned seed) {
        return check_materials(named(bsdf_cases(), names), sources, seed);
    };
}

Findings check_albedos(const Sources &sources, unsigned seed) {
    Findings findings;
    const std::vector<Material> materials = named(bsdf_cases(), {"microfacet_0.1", "microfacet_0", "microfacet_ggx_0.4",
                                                                 "diffuse", "diffuse_uniform", "mask_nested"});
    KernelProbe probe = probe_of(scene_of_materials(materials), device().info.native_lanes, sources);
    const auto judge = [&](const std::string &name, double degrees, double albedo) {
        const auto found = std::find_if(materials.begin(), materials.end(), [&](auto &m) { return m.name == name; });
        REQUIRE(found != materials.end());
        const stats::Sample sample = albedo_of(probe, unsigned(found - materials.begin()), direction(degrees), ++seed);
        findings.push_back(p_value("albedo of " + name + " at " + std::to_string(degrees) + " degrees",
                                   stats::z_test(sample, albedo).p_value));
    };
    // Luminance of kd / pi + ks D F G / (4 cos_i cos_o cos_h) times cos_o, by adaptive quadrature over wo.
    for (const auto &[degrees, albedo] :
         {std::pair{0.0, 0.207084}, {45.0, 0.215892}, {60.0, 0.247775}, {80.0, 0.430824}, {85.0, 0.519005}})
        judge("microfacet_0.1", degrees, albedo);
    for (const auto &[degrees, albedo] : {std::pair{0.0, 0.200756}, {60.0, 0.215542}, {80.0, 0.247710}})
        judge("microfacet_ggx_0.4", degrees, albedo);
    for (double degrees : {0.0, 60.0, 85.0}) // luminance of kd + ks F
        judge("microfacet_0", degrees,
              luminance(Color{0.1, 0.2, 0.15}) + 0.8 * fresnel_reflectance(direction(degrees).z, 1.000277, 1.5));
    judge("diffuse", 50, 0.6f);
    judge("diffuse_uniform", 50, 0.6f);
    for (double degrees : {0.0, 60.0, 130.0}) // what is reflected, and what passes
        judge("mask_nested", degrees, 0.7 * 0.6 * (degrees < 90 ? 0.5 : 0) + (1 - 0.7 * 0.6));
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
        const cl::Program program =
            program_with_fresnel(sources,
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
                const double truth = fresnel_reflectance(cosines[i], near, far);
                wrong += !(std::abs(found[i] - truth) <=
                           2e-4 * truth + 2e-7); // an ulp of the sine matters most near the critical angle
            }
            findings.push_back(exact("Fresnel's formulas, indices " + std::to_string(near) + " " + std::to_string(far) +
                                         at_width(lanes) + ": " + std::to_string(wrong) + " wrong",
                                     wrong <= 2));
        }

        KernelProbe probe = probe_of(scene_of_bsdfs({examples::dielectric(1.5)}), lanes, sources);
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
            // The weight of a reflection is the reflectance over the probability that it is drawn with, a multiple of
            // 2^-24: nearly 1.
            const double reflectance = fresnel_reflectance(std::abs(wi.z), wi.z > 0 ? 1 : 1.5, wi.z > 0 ? 1.5 : 1);
            const double weight = drawn.at(BSDF_WEIGHT_R, 0);
            straight_wrong += length(back - Vec3{-wi.x, -wi.y, wi.z}) > 1e-6 || weight > 1 ||
                              weight < 1 - 0x1p-24 / reflectance - 1e-7;
            const double eta = wi.z > 0 ? 1.5 : 1 / 1.5, sine2 = (wi.x * wi.x + wi.y * wi.y) / (eta * eta);
            if (sine2 >= 1)
                continue;
            const Vec3 truth{-wi.x / eta, -wi.y / eta, wi.z > 0 ? -std::sqrt(1 - sine2) : std::sqrt(1 - sine2)};
            bent_wrong += length(through - truth) > 1e-5 || std::abs(drawn.at(BSDF_WEIGHT_R, 1) - 1) > 1e-5 ||
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

// An emitter of scenes by itself.
Findings check_light(const std::string &name, const Light &light, const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_light(light, lanes), lanes, sources);
        append(findings, scene_emitter_findings(probe, light, name + at_width(lanes), effort_at(lanes, seed)));
        if (can_be_met(light.kind()))
            findings.push_back(samples_agree(name + at_width(lanes), probe, seed));
    }
    return findings;
}

Findings check_lights(const std::vector<LightCase> &cases, const Sources &sources, unsigned seed) {
    std::vector<std::pair<std::string, SceneDescription>> scenes;
    std::vector<Mesh> meshes;
    Findings findings;
    for (const LightCase &light : cases)
        if (const auto *mesh = std::get_if<Mesh>(&light.emitter)) {
            if (!std::holds_alternative<Sphere>(mesh->shape)) // which is none any more in a column
                meshes.push_back(*mesh);
            scenes.emplace_back(light.name, scene_of({*mesh}));
        } else
            append(findings, check_light(light.name, std::get<Light>(light.emitter), sources, seed++));
    if (!meshes.empty())
        scenes.emplace_back("all lights", side_by_side(meshes));
    for (int lanes : tested_lanes())
        for (const auto &[name, scene] : scenes)
            for (const char *emitter_choice : {"uniform", "power"})
                for (const char *triangle_choice : {"area", "uniform"}) {
                    if (scene.meshes.size() == 1 && emitter_choice[0] == 'p')
                        continue; // there is no choice of emitters
                    const FlatScene flat = flatten(with_strategy(scene, {{"emitter-choice", emitter_choice},
                                                                         {"triangle-choice", triangle_choice},
                                                                         {"specialise", "off"}}),
                                                   lanes);
                    const std::string what = name + ", emitters by " + emitter_choice + ", triangles by " +
                                             triangle_choice + at_width(lanes);
                    findings.push_back(probabilities_sum(what, flat));
                    KernelProbe probe = probe_of(flat, lanes, sources);
                    Effort effort = effort_at(lanes, seed + unsigned(findings.size()));
                    effort.nu = effort.nv = 10;
                    findings.push_back(samples_agree(what, probe, effort.seed));
                    if (lanes == tested_lanes().back())
                        append(findings, light_findings(probe, sampled_lights(probe), what, effort));
                }
    return findings;
}

Findings check_emitters(const Sources &sources, unsigned seed) { return check_lights(emitter_cases(), sources, seed); }
Check check_of_emitters(std::vector<std::string> names) {
    return [names = std::move(names)](const Sources &sources, unsigned seed) {
        return check_lights(named(emitter_cases(), names), sources, seed);
    };
}

Findings check_sphere_lights(const Sources &sources, unsigned seed) {
    Findings findings;
    // Distances of the centre, in radii.
    for (const double distance : {0.0, 0.4, 1 - 1e-5, 1 + 1e-5, 1.01, 2.0, 100.0, 1e4})
        for (int lanes : tested_lanes()) {
            Mesh mesh = light(Sphere{{0.1, -0.2, 0.3}, 0.7, distance < 1}, {4, 2, 1});
            const FlatScene flat = flatten(with_strategy(scene_of({mesh}), {{"specialise", "off"}}), lanes);
            KernelProbe probe = probe_of(flat, lanes, sources);
            Effort effort = effort_at(lanes, seed + unsigned(findings.size()));
            const std::string what = "a sphere " + std::to_string(distance) + " radii away" + at_width(lanes);
            const Vec3 from = Vec3{0.1, -0.2, 0.3} + normalize({3, -2, 6}) * (0.7 * distance);
            if (distance > 10) { // where the quadrature would see how directions are rounded
                effort.samples = 50'000;
                Sampled sampled = sampled_lights(probe, from);
                sampled.relative_error = 1e-2;
                const DensityCheck check = check_density(probe, sampled, 10, 10, effort.samples, effort.seed);
                findings.push_back(p_value("directions against density", check.test.result.p_value, what));
            } else {
                append(findings, light_findings(probe, sampled_lights(probe, from), what, effort));
            }
        }
    return findings;
}

namespace {

// A picture of smooth noise, which no symmetry of a surface maps to itself.
Texture noise(unsigned seed) {
    std::mt19937 random(seed);
    const auto picture = std::make_shared<Picture>();
    picture->width = 5;
    picture->height = 4;
    picture->channels = 3;
    for (int i = 0; i < 5 * 4 * 3; i++)
        picture->floats.push_back(float(0.25 + double(random() >> 8) * 0x1p-24));
    return BitmapTexture{.picture = picture, .to_uv = {{{1.5, 0.25, 0.1}, {-0.25, 0.75, 0.3}}}};
}

// Lights in the unit square, and spheres beside it: of each kind one and one that is turned round.
std::vector<Mesh> textured_lights() {
    TriangleMesh two = examples::mesh_of({{0.3, 0, 0}, {0.6, 0, 0}, {0.6, 1, 0}, {0.3, 1, 0}}, {{0, 1, 2}, {0, 2, 3}});
    two.uvs = {{0, 0}, {2, 0.5f}, {1, 3}, {-1, 1}};
    two.uv_corners = {{0, 1, 2}, {0, 2, 3}};
    const TriangleMesh plain = examples::mesh_of({{0.6, 0, 0}, {0.8, 0, 0}, {0.7, 1, 0}}, {{0, 1, 2}});
    std::vector<Mesh> lights = {
        light(Parallelogram{{0, 0, 0}, {0.1, 0, 0}, {0, 1, 0}}, {1, 2, 3}),
        light(Parallelogram{{0.1, 0, 0}, {0.1, 0, 0}, {0, 1, 0}, true}, {3, 2, 1}),
        light(two, {1, 1, 1}),
        light(plain, {4, 4, 4}),
        light(Sphere{{1.2, 0.2, 0}, 0.1}, {2, 1, 1}),
        light(Sphere{{}, 0.1}.moved(Transform::translate({1.2, 0.8, 0}) * Transform::rotate({1, 2, 3}, 40)),
              {5, 5, 2})};
    unsigned seed = 1;
    for (Mesh &mesh : lights)
        mesh.texture = noise(seed++);
    lights[3].texture.reset(); // a lane's neighbours may have none
    return lights;
}

// A map of random colours over four decades, one texel of which is that much brighter.
std::shared_ptr<const EnvironmentMap> random_map(int width, int height, float sun, unsigned seed) {
    std::mt19937 random(seed);
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 3;
    for (int i = 0; i < 3 * width * height; i++)
        picture.floats.push_back(std::exp2(float(random() % 1000) / 75));
    for (size_t channel = 0; channel < 3 && sun > 0; channel++)
        picture.floats[3 * size_t(width * (height / 2) + width / 2) + channel] = sun;
    return environment_of(std::move(picture), "random");
}

} // namespace

Findings check_textured_lights(const Sources &sources, unsigned seed) {
    Findings findings;
    const auto check = [&](const std::string &what, const std::vector<Mesh> &meshes) {
        for (int lanes : tested_lanes()) {
            KernelProbe probe = probe_of(flatten(scene_of(meshes), lanes), lanes, sources);
            findings.push_back(samples_agree(what + at_width(lanes), probe, seed++));
        }
    };
    const std::vector<Mesh> lights = textured_lights();
    for (size_t i = 0; i < lights.size(); i++)
        check("textured light " + std::to_string(i), {lights[i]});
    check("all textured lights", lights);
    return findings;
}

Findings check_skies(const Sources &sources, unsigned seed) {
    struct Sky {
        const char *name;
        int width, height;
        float sun;
        Transform to_world;
    };
    const Transform turned = Transform::rotate({1, 2, -1}, 77);
    const std::vector<Sky> skies = {{"one texel", 1, 1, 0, {}},
                                    {"one row", 5, 1, 0, turned},
                                    {"two rows", 3, 2, 0, {}},
                                    {"one column", 1, 6, 0, turned},
                                    {"7 x 5 texels, mirrored", 7, 5, 0, turned * Transform::scale({-1, 1, 1})},
                                    {"16 x 9 texels with a sun", 16, 9, 1e6f, turned}};
    Findings findings;
    for (const Sky &sky : skies) {
        emitter_envmap light;
        light.map = random_map(sky.width, sky.height, sky.sun, ++seed);
        light.to_world = sky.to_world;
        append(findings, check_light(sky.name, {light, {}}, sources, seed++));
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
        const cl::Program program = program_with_fresnel(
            sources,
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
