// Textures on the parameters of BSDFs. Some tests add a kind of texture to the sources.
#include "scene/examples.h"
#include "support/pictures.h"
#include "support/probe.h"
#include "textures/list.h"

#include <catch2/catch.hpp>

#include <array>
#include <bit>
#include <memory>
#include <numbers>
#include <random>

using namespace opal;
using namespace opal::test;

namespace {

// The sources with a texture of one colour, which its record holds after its kind.
Sources with_constant_texture() {
    Sources sources = Sources::embedded();
    std::string &list = sources.files.at("textures/list.h");
    const std::string none = "#define OPAL_TEXTURES(TEXTURE)";
    REQUIRE(list.find(none) != std::string::npos);
    list.replace(list.find(none), none.size(), none + " TEXTURE(constant)");
    sources.files["textures/constant.cl"] =
        "static v3 texture_constant_color(const Scene *scene, uints at, TexturePoint point, mask active) {\n"
        "    global const float *color = (global const float *)scene->textures + 1;\n"
        "    return v3_of(GATHER_WORD(real, color, at), GATHER_WORD(real, (color + 1), at),\n"
        "                 GATHER_WORD(real, (color + 2), at));\n"
        "}\n";
    return sources;
}

uint word(float x) { return std::bit_cast<uint>(x); }

// Three meshes: diffuse with a texture, diffuse without, Phong with a texture on its exponent.
FlatScene textured_scene() {
    bsdf_diffuse_record red{.albedo = {0.8, 0.4, 0.2}};
    bsdf_phong_record glossy{.n = 40};
    red.albedo.texture = 0;
    glossy.n.texture = 4;
    FlatScene scene = scene_of_bsdfs({red, bsdf_diffuse_record{.albedo = 0.6}, glossy, bsdf_phong_record{.n = 10}});
    scene.textures = {0, word(0.5f), word(0.25f), word(1), 0, word(0.25f), word(0.25f), word(0.25f)};
    scene.features.texture_kinds = 1;             // that of with_constant_texture
    scene.features.textured[BSDF_diffuse] = 1;    // albedo
    scene.features.textured[BSDF_phong] = 1 << 3; // n
    return scene;
}

// The image of 4 x 2 pixels, rows from the top, that Mitsuba 3.9.1 was asked of, and where.
std::shared_ptr<const Picture> measured_picture() {
    const auto picture = std::make_shared<Picture>();
    picture->width = 4;
    picture->height = 2;
    picture->channels = 3;
    for (float v : {0.f, 1.f})
        for (float u : {0.f, 1.f, 2.f, 3.f})
            for (float value : {0.125f + 0.125f * u, 0.25f + 0.25f * v, 0.0625f * u + 0.25f * v})
                picture->floats.push_back(value);
    return picture;
}
const std::vector<std::array<double, 2>> measured_at = {
    {0.125, 0.25}, {0.125, 0.75}, {0.375, 0.25}, {0.25, 0.25}, {0.25, 0.5}, {0, 0},     {0.01, 0.25}, {0.99, 0.25},
    {0.125, 0.01}, {0.125, 0.99}, {1.1, 0.25},   {-0.1, 0.25}, {-1.1, 0.3}, {2.3, 1.4}, {0.5, 0.5},   {0.77, 0.62}};

// A white diffuse material with a texture.
Bsdf textured(const BitmapTexture &texture) {
    Bsdf material = bsdf_diffuse_record{.albedo = 1};
    material.textures[bsdf_parameters(BSDF_diffuse)[0].texture_word] = texture;
    return material;
}

} // namespace

TEST_CASE("A texture multiplies its parameter, in the lanes that have one", "[textures]") {
    const Vec3 wi = {0.6, 0, 0.8}, mirrored = {-0.6, 0, 0.8};
    const double inverse_pi = 1 / std::numbers::pi;
    for (int lanes : tested_lanes()) {
        INFO(lanes << " lanes");
        KernelProbe probe = probe_of(textured_scene(), lanes, with_constant_texture());
        const auto f = [&](unsigned mesh, Vec3 wo) { return probe.bsdf_eval(mesh, wi, std::vector{wo}); };
        CHECK(f(0, mirrored).at(EVAL_R, 0) == Approx(0.8 * 0.5 * inverse_pi));
        CHECK(f(0, mirrored).at(EVAL_G, 0) == Approx(0.4 * 0.25 * inverse_pi));
        CHECK(f(0, mirrored).at(EVAL_B, 0) == Approx(0.2 * inverse_pi));
        CHECK(f(1, mirrored).at(EVAL_R, 0) == Approx(0.6 * inverse_pi));
        const Vec3 beside = {-0.8, 0, 0.6}; // 40 * 0.25 is the exponent of the untextured one
        CHECK(f(2, beside).at(EVAL_R, 0) == Approx(f(3, beside).at(EVAL_R, 0)));
        CHECK(f(2, beside).at(EVAL_PDF, 0) == Approx(f(3, beside).at(EVAL_PDF, 0)));
    }
}

TEST_CASE("A kernel without textures reads none", "[textures]") {
    FlatScene scene = textured_scene();
    scene.features.textured.fill(0);
    KernelProbe probe = probe_of(scene, 8, with_constant_texture());
    const Planes f = probe.bsdf_eval(0, {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
    CHECK(f.at(EVAL_R, 0) == Approx(0.8 / std::numbers::pi));
}

TEST_CASE("The program says which parameters have a texture", "[textures]") {
    const FlatScene scene = textured_scene();
    const std::string text = program_text(scene.features, {}, Sources::embedded());
    CHECK_THAT(text, Catch::Contains("#define OPAL_TEXTURED_bsdf_diffuse 1\n") &&
                         Catch::Contains("#define OPAL_TEXTURED_bsdf_phong 8\n") &&
                         Catch::Contains("#define OPAL_TEXTURED_bsdf_microfacet 0\n"));
}

TEST_CASE("A checkerboard has two by two squares, as Mitsuba has it", "[textures]") {
    struct Lookup {
        double u, v, value;
    };
    // Mitsuba 3.9.1; the end of the first half belongs to it.
    const std::vector<Lookup> lookups = {{0.1, 0.1, 0.4},  {0.6, 0.1, 0.2}, {0.1, 0.6, 0.2}, {0.6, 0.6, 0.4},
                                         {-0.1, 0.1, 0.2}, {1.1, 0.1, 0.4}, {0.5, 0.1, 0.4}, {0.5, 0.6, 0.2}};
    std::vector<Bsdf> materials(lookups.size(), Bsdf(bsdf_diffuse_record{.albedo = 1}));
    const size_t albedo = bsdf_parameters(BSDF_diffuse)[0].texture_word;
    for (size_t i = 0; i < lookups.size(); i++) // the probe asks at (0, 0)
        materials[i].textures[albedo] = CheckerboardTexture{.to_uv = {{{5, 0, lookups[i].u}, {0, 5, lookups[i].v}}}};
    const FlatScene scene = scene_of_bsdfs(materials);
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene, lanes, Sources::embedded());
        for (size_t i = 0; i < lookups.size(); i++) {
            INFO(lanes << " lanes, uv " << lookups[i].u << " " << lookups[i].v);
            const Planes f = probe.bsdf_eval(unsigned(i), {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
            CHECK(f.at(EVAL_R, 0) == Approx(lookups[i].value / std::numbers::pi));
        }
    }
}

TEST_CASE("A bitmap is looked up as Mitsuba does it", "[textures]") {
    const std::shared_ptr<const Picture> picture = measured_picture();
    struct Lookups {
        uint wrap;
        bool nearest;
        std::vector<double> red, green, blue;
    };
    const std::vector<Lookups> table = {
        {WRAP_repeat,
         false,
         {0.125, 0.125, 0.25, 0.1875, 0.1875, 0.3125, 0.2975, 0.3275, 0.125, 0.125, 0.1625, 0.4625, 0.4625, 0.2125,
          0.3125, 0.4475},
         {0.25, 0.5, 0.25, 0.25, 0.375, 0.375, 0.25, 0.25, 0.37, 0.38, 0.25, 0.25, 0.275, 0.325, 0.375, 0.435},
         {0, 0.25, 0.0625, 0.03125, 0.15625, 0.21875, 0.08625001, 0.10125, 0.12, 0.13, 0.01874998, 0.16875, 0.19375,
          0.11875, 0.21875, 0.34625}},
        {WRAP_repeat,
         true,
         {0.125, 0.125, 0.25, 0.25, 0.25, 0.125, 0.125, 0.5, 0.125, 0.125, 0.125, 0.5, 0.5, 0.25, 0.375, 0.5},
         {0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.25, 0.5, 0.5},
         {0, 0.25, 0.0625, 0.0625, 0.3125, 0, 0, 0.1875, 0, 0.25, 0, 0.1875, 0.1875, 0.0625, 0.375, 0.4375}},
        {WRAP_mirror,
         false,
         {0.125, 0.125, 0.25, 0.1875, 0.1875, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.125, 0.5, 0.2125, 0.3125, 0.4475},
         {0.25, 0.5, 0.25, 0.25, 0.375, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.275, 0.425, 0.375, 0.435},
         {0, 0.25, 0.0625, 0.03125, 0.15625, 0, 0, 0.1875, 0, 0.25, 0.1875, 0, 0.2125, 0.21875, 0.21875, 0.34625}},
        {WRAP_mirror,
         true,
         {0.125, 0.125, 0.25, 0.25, 0.25, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.125, 0.5, 0.25, 0.375, 0.5},
         {0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.5, 0.5, 0.5},
         {0, 0.25, 0.0625, 0.0625, 0.3125, 0, 0, 0.1875, 0, 0.25, 0.1875, 0, 0.1875, 0.3125, 0.375, 0.4375}},
        {WRAP_clamp,
         false,
         {0.125, 0.125, 0.25, 0.1875, 0.1875, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.3125, 0.4475},
         {0.25, 0.5, 0.25, 0.25, 0.375, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.275, 0.5, 0.375, 0.435},
         {0, 0.25, 0.0625, 0.03125, 0.15625, 0, 0, 0.1875, 0, 0.25, 0.1875, 0, 0.02500001, 0.4375, 0.21875, 0.34625}},
        {WRAP_clamp,
         true,
         {0.125, 0.125, 0.25, 0.25, 0.25, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.125, 0.125, 0.5, 0.375, 0.5},
         {0.25, 0.5, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.25, 0.5, 0.25, 0.25, 0.25, 0.5, 0.5, 0.5},
         {0, 0.25, 0.0625, 0.0625, 0.3125, 0, 0, 0.1875, 0, 0.25, 0.1875, 0, 0, 0.4375, 0.375, 0.4375}},
    };
    std::vector<Bsdf> materials;
    const size_t albedo = bsdf_parameters(BSDF_diffuse)[0].texture_word;
    for (const Lookups &lookups : table)
        for (const auto &[u, v] : measured_at) { // the probe asks at (0, 0)
            Bsdf &material = materials.emplace_back(bsdf_diffuse_record{.albedo = 1});
            material.textures[albedo] = BitmapTexture{.picture = picture,
                                                      .nearest = lookups.nearest,
                                                      .wrap = lookups.wrap,
                                                      .to_uv = {{{1, 0, u}, {0, 1, v}}}};
        }
    const FlatScene scene = scene_of_bsdfs(materials);
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene, lanes, Sources::embedded());
        for (size_t i = 0; i < materials.size(); i++) {
            const Lookups &lookups = table[i / measured_at.size()];
            const size_t k = i % measured_at.size();
            INFO(lanes << " lanes, wrap " << lookups.wrap << (lookups.nearest ? " nearest" : "") << ", uv "
                       << measured_at[k][0] << " " << measured_at[k][1]);
            const Planes f = probe.bsdf_eval(unsigned(i), {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
            CHECK(f.at(EVAL_R, 0) * std::numbers::pi == Approx(lookups.red[k]).margin(1e-6));
            CHECK(f.at(EVAL_G, 0) * std::numbers::pi == Approx(lookups.green[k]).margin(1e-6));
            CHECK(f.at(EVAL_B, 0) * std::numbers::pi == Approx(lookups.blue[k]).margin(1e-6));
        }
    }
}

TEST_CASE("Bytes of a bitmap are decoded from sRGB unless it is raw", "[textures]") {
    const auto picture = std::make_shared<Picture>();
    picture->width = 3; // of one channel: the bytes do not fill words
    picture->height = 1;
    picture->channels = 1;
    picture->bytes = {60, 128, 255};
    picture->encoded = true;
    const std::vector<double> decoded = {0.04518617, 0.2158604, 1}, raw = {0.2352941, 0.5019608, 1}; // Mitsuba 3.9.1
    std::vector<Bsdf> materials;
    for (const bool is_raw : {false, true})
        for (int i = 0; i < 3; i++) {
            Bsdf &material = materials.emplace_back(bsdf_diffuse_record{.albedo = 1});
            material.textures[bsdf_parameters(BSDF_diffuse)[0].texture_word] = BitmapTexture{
                .picture = picture, .raw = is_raw, .nearest = true, .to_uv = {{{1, 0, (i + 0.5) / 3}, {0, 1, 0.5}}}};
        }
    KernelProbe probe = probe_of(scene_of_bsdfs(materials), device().info.native_lanes, Sources::embedded());
    for (unsigned i = 0; i < materials.size(); i++) {
        const Planes f = probe.bsdf_eval(i, {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
        CHECK(f.at(EVAL_B, 0) * std::numbers::pi == Approx(i < 3 ? decoded[i] : raw[i - 3]).margin(1e-6));
    }
}

TEST_CASE("to_uv maps texture coordinates as Mitsuba does it", "[textures]") {
    struct Row {
        UvTransform to_uv;
        const char *texels; // at measured_at, by their indices in rows from the top
    };
    // Mitsuba 3.9.1, nearest, repeat. The looks at the ends of texels that a turn by 90 degrees moves are left out.
    const std::vector<Row> table = {
        {{{{10, 0, 0}, {0, 10, 0}}}, "5576204715440002"},
        {{{{2, 0, 0}, {0, 3, 0}}}, "5176604715477246"},
        {{{{1, 0, 0.25}, {0, 1, 0.1}}}, "1522611011100674"},
        {{{{0, -1, 0}, {1, 0, 0}}}, "--------30--62-5"},
        {{{{0.8660254, -0.5, 0}, {0.5, 0.8660254, 0}}}, "36007-3606737145"},
        {{{{2, 0, 0.25}, {0, 2, 0}}}, "6647315426544713"},
        {{{{2, 0, 0.5}, {0, 2, 0}}}, "7754026537655420"},
    };
    for (const Row &row : table) {
        const Bsdf material = textured({.picture = measured_picture(), .nearest = true, .to_uv = row.to_uv});
        for (size_t k = 0; k < measured_at.size(); k++) {
            if (row.texels[k] == '-')
                continue;
            INFO(row.to_uv[0][0] << " " << row.to_uv[0][1] << ", uv " << measured_at[k][0] << " " << measured_at[k][1]);
            TriangleMesh mesh = examples::quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}); // all of one place in the texture
            mesh.uvs = {{float(measured_at[k][0]), float(measured_at[k][1])}};
            mesh.uv_corners.assign(mesh.triangles.size(), {0, 0, 0});
            SceneDescription scene;
            scene.camera = examples::camera({0, 0, 5}, {0, 0, 0}, 20);
            scene.camera.width = scene.camera.height = 2;
            scene.lights = {{emitter_constant{.radiance = {1, 1, 1}}, {}}};
            scene.meshes = {examples::made_of(std::move(mesh), material)};
            const Film film =
                render(with_strategy(
                           scene, {{"integrator", "direct_lighting"}, {"lighting", "bsdf"}, {"hemisphere", "cosine"}}),
                       1, 1);
            const int texel = row.texels[k] - '0';
            CHECK(sample_of(film, 0).mean == Approx(0.125 + 0.125 * (texel % 4)).margin(1e-6));
            CHECK(sample_of(film, 1).mean == Approx(0.25 + 0.25 * (texel / 4)).margin(1e-6));
        }
    }
}

TEST_CASE("Values of 16 bits are half floats, as Mitsuba holds them, but for its format variant", "[textures]") {
    const std::vector<int> bytes = {0, 1, 5, 10, 11, 20, 60, 128, 200, 254, 255}; // times 257
    // Mitsuba 3.9.1
    const std::vector<double> decoded = {0,
                                         0.0003035069,
                                         0.001517296,
                                         0.003034592,
                                         0.003347397,
                                         0.006996155,
                                         0.04519653,
                                         0.2158203,
                                         0.5776367,
                                         0.9912109,
                                         1};
    const std::vector<double> raw = {0,         0.003921509, 0.01960754, 0.03921509, 0.04315186, 0.07843018,
                                     0.2353516, 0.5019531,   0.7841797,  0.9960938,  1};
    const std::vector<double> exact = {
        0,         0.000303527, 0.001517635, 0.00303527, 0.003346541, 0.006995399, 0.04518617,
        0.2158604, 0.5775807,   0.9911022,   1};
    const auto picture = std::make_shared<Picture>();
    picture->width = int(bytes.size());
    picture->height = 1;
    picture->channels = 1;
    picture->encoded = true;
    for (int byte : bytes)
        picture->floats.push_back(float(byte) / 255);
    std::vector<Bsdf> materials;
    for (const auto &[is_raw, full] : {std::pair(false, false), {true, false}, {false, true}})
        for (size_t i = 0; i < bytes.size(); i++)
            materials.push_back(textured({.picture = picture,
                                          .raw = is_raw,
                                          .nearest = true,
                                          .to_uv = {{{1, 0, (double(i) + 0.5) / double(bytes.size())}, {0, 1, 0.5}}},
                                          .full_precision = full}));
    KernelProbe probe = probe_of(scene_of_bsdfs(materials), device().info.native_lanes, Sources::embedded());
    for (unsigned i = 0; i < materials.size(); i++) {
        const std::vector<double> &values = i < bytes.size() ? decoded : i < 2 * bytes.size() ? raw : exact;
        const Planes f = probe.bsdf_eval(i, {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
        CHECK(f.at(EVAL_R, 0) * std::numbers::pi == Approx(values[i % bytes.size()]).margin(1e-7));
    }
}

TEST_CASE("Where one number is wanted, a colour is its luminance", "[textures]") {
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = 1; // one row and one column: the same everywhere
    picture->channels = 3;
    picture->bytes = {200, 100, 50};
    picture->encoded = true;
    const std::vector<double> numbers = {0.216275, 0.4614065}; // Mitsuba 3.9.1: decoded, raw
    std::vector<Bsdf> materials;
    for (const bool is_raw : {false, true}) {
        Bsdf &mask = materials.emplace_back(bsdf_mask_record{.opacity = 1});
        mask.children = {bsdf_diffuse_record{.albedo = 1}};
        mask.textures[bsdf_parameters(BSDF_mask)[0].texture_word] =
            BitmapTexture{.picture = picture, .raw = is_raw, .to_uv = {{{1, 0, 0.3}, {0, 1, -7.9}}}};
    }
    KernelProbe probe = probe_of(scene_of_bsdfs(materials), device().info.native_lanes, Sources::embedded());
    for (unsigned i = 0; i < materials.size(); i++) {
        const Planes f = probe.bsdf_eval(i, {0, 0, 1}, std::vector{Vec3{0, 0, 1}});
        CHECK(f.at(EVAL_R, 0) * std::numbers::pi == Approx(numbers[i]).margin(1e-6));
    }
}

TEST_CASE("Lanes beside each other may have textures of other kinds", "[textures]") {
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = 3;
    picture->channels = 3;
    picture->bytes.assign(27, 51); // a fifth
    const auto textured = [](Texture texture) {
        Bsdf material = bsdf_diffuse_record{.albedo = 1};
        material.textures[bsdf_parameters(BSDF_diffuse)[0].texture_word] = std::move(texture);
        return material;
    };
    SceneDescription scene;
    scene.camera = examples::camera({0, 0, 5}, {0, 0, 0}, 20);
    scene.camera.width = scene.camera.height = 16;
    const Bsdf squares = textured(CheckerboardTexture{{0.6, 0.6, 0.6}, {0.6, 0.6, 0.6}});
    const Bsdf bitmap = textured(BitmapTexture{.picture = picture});
    constexpr int count = 64; // stripes narrower than a pixel, one kind beside the other
    constexpr double width = 4.0 / count;
    scene.lights = {{emitter_constant{.radiance = {1, 1, 1}}, {}}};
    const Overrides exact = {{"integrator", "direct_lighting"}, {"lighting", "bsdf"}, {"hemisphere", "cosine"}};
    for (const bool bitmap_is_last : {true, false}) { // in the table, at whose end records of one kind are shorter
        scene.meshes.clear();
        for (int i = 0; i < count; i++)
            scene.meshes.push_back(examples::made_of(Parallelogram{{i * width - 2, -2, 0}, {width, 0, 0}, {0, 4, 0}},
                                                     (i % 2 == 0) == bitmap_is_last ? squares : bitmap));
        for (int lanes : tested_lanes()) {
            INFO(lanes << " lanes");
            const Film film = render(with_strategy(scene, exact), 64, 1, {.lanes = lanes});
            CHECK(sample_of(film, 0).mean == Approx((0.6 + 0.2) / 2).margin(0.01)); // 6 standard deviations
        }
    }
}

TEST_CASE("A textured spot among other lights is the only one whose texture is read", "[textures]") {
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = 3;
    picture->channels = 3;
    picture->bytes.assign(27, 51);
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(-1, 1);
    SceneDescription scene;
    scene.camera = examples::camera({0, 2, -5}, {0, 0, 0}, 60);
    scene.camera.width = scene.camera.height = 16;
    scene.lights = {{emitter_spot{{0, 2, -3}, {0, -2, 3}, {9, 9, 9}, 60, 45, false},
                     {},
                     LightTexture{BitmapTexture{.picture = picture}, {1, 0, 0}, normalize({0, 3, 2})}}};
    scene.meshes = {examples::made_of(Parallelogram{{-4, -1, -4}, {0, 0, 8}, {8, 0, 0}}, examples::diffuse(0.5))};
    const auto any = [&] { return Vec3{uniform(random), uniform(random), uniform(random)}; };
    for (int i = 0; i < 40; i++)
        scene.meshes.push_back(examples::light(Parallelogram{any() * 3 + Vec3{0, 3, 0}, any(), any()}, 1));
    scene = with_strategy(scene, {{"integrator", "path_mis"}, {"emitter-choice", "uniform"}});
    const double one = sample_of(render(scene, 16, 1, {.lanes = 1})).mean;
    for (int lanes : tested_lanes())
        CHECK(sample_of(render(scene, 16, 1, {.lanes = lanes})).mean == Approx(one).epsilon(1e-3));
}
