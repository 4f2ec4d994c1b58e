// The tables of lights.
#include "flatten/emitter_kinds.h"
#include "flatten/texture_mean.h"
#include "support/error_of.h"
#include "support/plain_scenes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>

using namespace opal;

namespace {

constexpr double pi = std::numbers::pi;

} // namespace

TEST_CASE("a light of slivers down to the smallest triangle", "[emitters]") {
    // Widths over many decades: what is kept has an area, and the table of areas adds up.
    TriangleMesh mesh;
    std::mt19937 random(5);
    for (unsigned i = 0; i < 2000; i++) {
        const double width = std::pow(10.0, -12.0 * i / 2000), y = double(random()) / 4294967296.0;
        mesh.positions.insert(mesh.positions.end(), {{0, y, 0}, {1, y, 0}, {0, y + width, 0}});
        mesh.triangles.push_back({{{3 * i, OPAL_NONE}, {3 * i + 1, OPAL_NONE}, {3 * i + 2, OPAL_NONE}}});
    }
    const FlatScene scene = flatten(scene_of({light(mesh, {1, 1, 1})}), 8);
    CHECK(scene.triangles.size() > 1000);
    CHECK(scene.triangles.size() < 2000);
    REQUIRE(scene.light_triangles.size() == scene.triangles.size());
    double all = 0, sum = 0;
    for (const LightTriangle &row : scene.light_triangles)
        all += area_of(scene, row.slot);
    for (const LightTriangle &row : scene.light_triangles) {
        const double own = area_of(scene, row.slot), probability = own / row.inverse_pdf;
        CHECK(own > 0);
        // As the area says, but for a random number's 2^-24 in the table's rows, of which there are so many.
        CHECK(probability == Approx(own / all).epsilon(1e-3).margin(0x1p-24));
        CHECK((row.accept >= 0 && row.accept <= 1 && row.other < scene.emitters[0].count));
        sum += probability;
    }
    CHECK(sum == Approx(1).epsilon(1e-6));
}

TEST_CASE("emitters of each kind, in the flattened units", "[emitters]") {
    const Color bright{1, 2, 3}, power{100, 50, 20};
    SceneDescription description = scene_of({
        diffuse(Parallelogram{{-8, -8, 0}, {16, 0, 0}, {0, 16, 0}}),                                  // scale 1/8
        light(mesh_of({{0, 0, 1}, {4, 0, 1}, {0, 4, 1}, {4, 1, 1}}, {{0, 1, 2}, {0, 1, 3}}), bright), // areas 8 and 2
        light(Parallelogram{{0, 0, 2}, {2, 0, 0}, {0, 3, 0}}, bright),                                // area 6
        light(one_triangle, {0, 0, 0}),
    });
    description.lights = {{emitter_point{{4, 0, 0}, power}, {}}, {emitter_point{{0, 0, 0}, {0, 0, 0}}, {}}};

    SECTION("by power and by area") {
        description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
        description.strategy[AXIS_triangle_choice] = CHOICE_triangle_choice_area;
        const FlatScene scene = flatten(description, 1);
        REQUIRE(scene.scale == 0.125);
        const double center_z = scene.center.z;
        REQUIRE(scene.emitters.size() == 3);
        CHECK(scene.settings.emitter_count == 3);
        CHECK((scene.meshes[0].emitter == OPAL_NONE && scene.meshes[1].emitter == 0 && scene.meshes[2].emitter == 1 &&
               scene.meshes[3].emitter == OPAL_NONE));
        const EmitterRecord &mesh = scene.emitters[0], &quad = scene.emitters[1], &point = scene.emitters[2];

        CHECK((mesh.kind == EMITTER_mesh && mesh.first == 0 && mesh.count == 2));
        CHECK((mesh.u.of_mesh.color[0] == 1 && mesh.u.of_mesh.color[2] == 3));
        const uint first = mesh.u.of_mesh.first_triangle;
        CHECK((scene.triangles[first].mesh == 1 && scene.triangles[first + 1].mesh == 1));
        CHECK(area_of(scene, scene.light_triangles[0].slot) == Approx(8. / 64)); // each row leads to its own triangle
        CHECK(area_of(scene, scene.light_triangles[1].slot) == Approx(2. / 64));
        for (const LightTriangle &row : scene.light_triangles)
            CHECK(row.inverse_pdf == Approx(10. / 64));

        const emitter_parallelogram_record &own = quad.u.of_parallelogram;
        CHECK((quad.kind == EMITTER_parallelogram && own.u[0] == 0.25f && own.v[1] == 0.375f &&
               own.origin[2] == float((2 - center_z) / 8)));
        CHECK(own.area == Approx(6. / 64));

        CHECK(point.kind == EMITTER_point);
        CHECK(point.u.of_point.position[0] == 0.5f);
        // Intensity over squared distance is the same in both units.
        CHECK(point.u.of_point.color[0] / (0.5 * 0.5) == Approx(100 / (4 * pi) / (4. * 4.)));

        const double powers[] = {pi * luminance(bright) * 10, pi * luminance(bright) * 6, luminance(power)};
        const double all = powers[0] + powers[1] + powers[2];
        double kept[3] = {};
        for (int i = 0; i < 3; i++) {
            CHECK(scene.emitters[i].probability == Approx(powers[i] / all));
            kept[i] += scene.emitters[i].accept / 3;
            kept[scene.emitters[i].other] += (1 - scene.emitters[i].accept) / 3;
        }
        for (int i = 0; i < 3; i++)
            CHECK(kept[i] == Approx(powers[i] / all));
    }
    SECTION("all alike") {
        description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_uniform;
        description.strategy[AXIS_triangle_choice] = CHOICE_triangle_choice_uniform;
        const FlatScene scene = flatten(description, 8);
        for (const EmitterRecord &emitter : scene.emitters)
            CHECK(emitter.probability == Approx(1. / 3).epsilon(1e-6));
        for (const LightTriangle &row : scene.light_triangles)
            CHECK(area_of(scene, row.slot) / row.inverse_pdf == Approx(0.5));
    }
}

TEST_CASE("emitters are chosen by power unless a strategy says otherwise, and alike where powers are equal",
          "[emitters]") {
    CHECK(Strategy{}[AXIS_emitter_choice] == CHOICE_emitter_choice_power);
    const auto lamp = [](double place, double side, double radiance) {
        return light(Parallelogram{{place, 0, 0}, {side, 0, 0}, {0, side, 0}}, {radiance, radiance, radiance});
    };
    const auto probabilities = [](const FlatScene &scene) {
        std::vector<float> all;
        for (const EmitterRecord &emitter : scene.emitters)
            all.push_back(emitter.probability);
        return all;
    };
    // Their areas differ by the rounding of corners. Black lamps are no emitters.
    SceneDescription description =
        scene_of({lamp(-3.3, 0.007, 4), lamp(0.123, 0.007, 4), lamp(2.1, 0.014, 1), lamp(2.5, 0.014, 0)});
    description.lights = {{emitter_point{{0, 0, 1}, {0, 0, 0}}, {}}};
    FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 3);
    CHECK((scene.emitters[0].u.of_parallelogram.area != scene.emitters[1].u.of_parallelogram.area));
    CHECK(scene.features.axes[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform);
    CHECK(scene.features.axis_reasons[AXIS_emitter_choice] == "all emitters have the same power");
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_uniform;
    CHECK(probabilities(scene) == probabilities(flatten(description, 8)));

    description.strategy = {};
    description.meshes[2].emits_on_both_sides = true; // of twice the power
    scene = flatten(description, 8);
    CHECK(scene.features.axes[AXIS_emitter_choice] == CHOICE_emitter_choice_power);
    CHECK(scene.emitters[2].probability == Approx(0.5));

    description.meshes.resize(1);
    scene = flatten(description, 8);
    CHECK(scene.features.axes[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform);
    CHECK(scene.features.axis_reasons[AXIS_emitter_choice] == "there is nothing to choose from");
}

TEST_CASE("emitters whose powers are all 0 as numbers are chosen alike", "[emitters]") {
    SceneDescription description;
    description.lights = {{emitter_constant{{1, 1, 1}}, {}}}; // the scene's bounding sphere is empty
    CHECK(flatten(description, 8).emitters.at(0).probability == 1);
    const Color least{0, 0, std::numeric_limits<double>::denorm_min()}; // its luminance is 0
    description = scene_of({light(one_triangle, least), light(one_triangle, least)});
    const FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 2);
    CHECK((scene.emitters[0].probability == 0.5f && scene.emitters[1].probability == 0.5f));
}

TEST_CASE("an environment sheds its power on the scene's bounding sphere, and there is one", "[emitters]") {
    const Color bright{1, 2, 3}, power{100, 50, 20};
    SceneDescription description = scene_of({diffuse(Parallelogram{{-8, -8, 0}, {16, 0, 0}, {0, 16, 0}})});
    CHECK(flatten(description, 8).settings.environment == OPAL_NONE);
    description.lights = {
        {emitter_constant{{0, 0, 0}}, {}}, {emitter_point{{4, 0, 0}, power}, {}}, {emitter_constant{bright}, {}}};
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    const FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 2);
    CHECK(scene.settings.environment == 1);
    CHECK((scene.emitters[1].kind == EMITTER_constant && scene.emitters[1].u.of_constant.color[2] == 3));
    const double sky = pi * luminance(bright) * 4 * pi * 128; // radius 8 sqrt(2)
    CHECK(scene.emitters[1].probability == Approx(sky / (sky + luminance(power))));

    description.lights.push_back({emitter_constant{bright}, {"a.xml", 7, 1}});
    description.lights[2].place = {"a.xml", 5, 2};
    CHECK(test::error_of([&] { flatten(description, 8); }) ==
          "a.xml:7:1: a second environment: rays that leave the scene meet one only; the first is at a.xml:5:2");
}

TEST_CASE("a spot's power is the integral of its falloff", "[emitters]") {
    // cos a = c; the falloff that cl/emitters/spot.cl has, in its plain form, by the midpoint rule
    const auto integral = [](double cutoff, double beam, bool smooth) {
        const double to = cutoff * pi / 180, from = std::min(beam, cutoff) * pi / 180;
        const auto falloff = [&](double angle) {
            const double share = smooth ? (std::cos(angle) - std::cos(to)) / (std::cos(from) - std::cos(to))
                                        : (to - angle) / (to - from);
            return angle <= from ? 1 : smooth ? std::pow(share, 4) : share;
        };
        constexpr int steps = 100000;
        double sum = 0;
        for (int i = 0; i < steps; i++) {
            const double angle = to * (i + 0.5) / steps;
            sum += 2 * pi * std::sin(angle) * falloff(angle) * to / steps;
        }
        return sum;
    };
    const Color bright{1, 2, 3};
    for (const auto &[cutoff, beam] : {std::pair{20.0, 15.0},
                                       {180.0, 0.0},
                                       {180.0, 180.0},
                                       {90.0, 89.9},
                                       {40.0, 60.0},
                                       {0.01, 0.002},
                                       {30.0, 30.0},
                                       {175.0, 170.0}})
        for (bool smooth : {false, true}) {
            INFO(cutoff << " " << beam << " " << smooth);
            const Light light{emitter_spot{{1, 2, 3}, {0, 0, -2}, bright, cutoff, beam, smooth}, {}};
            CHECK(power_of(light, 7) == Approx(luminance(bright) * integral(cutoff, beam, smooth)).epsilon(1e-6));
        }
    CHECK(power_of(Light{emitter_spot{{}, {0, 0, 1}, bright, 1e-7, 0, false}, {}}, 1) ==
          Approx(luminance(bright) * pi * std::pow(1e-7 * pi / 180, 2) / 3)); // of a cone this thin a third
    CHECK(is_black(Light{emitter_spot{{}, {0, 0, 1}, bright, 0, 0, false}, {}}));
}

TEST_CASE("a projector sheds what its image gets at distance 1", "[emitters]") {
    const double width = 2 * std::tan(pi / 6);
    const Light light{emitter_projector{{}, {0, 0, 2}, {}, {1, 1, 1}, 60, 2}, {}};
    CHECK(power_of(light, 7) == Approx(pi * width * width / 2));
}

TEST_CASE("textured lights are chosen by the mean of the texture over their surface", "[emitters]") {
    const auto picture = std::make_shared<Picture>(); // black but for the right half of the top row
    picture->width = picture->height = 2;
    picture->channels = 1;
    picture->floats = {0, 1, 0, 0};
    const BitmapTexture corner{.picture = picture, .nearest = true};
    BitmapTexture away = corner;
    away.to_uv = {{{0.25, 0, 0}, {0, 0.25, 0.5}}}; // no point of the surface sees the white texel
    TriangleMesh half = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
    half.uvs = {{0.5f, 0}, {1, 0}, {1, 0.5f}}; // in the white texel
    half.uv_corners = {{0, 1, 2}};
    std::vector<Mesh> meshes = {light(Parallelogram{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1}),
                                light(half, {1, 1, 1}), light(Sphere{{3, 0, 0}, 0.5}, {1, 1, 1}),
                                light(Parallelogram{{0, 0, 1}, {1, 0, 0}, {0, 1, 0}}, {1, 1, 1})};
    for (Mesh &mesh : meshes)
        mesh.texture = corner;
    meshes[3].texture = away;
    SceneDescription description = scene_of(meshes);
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    const FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 4);
    const std::vector<double> powers = {0.25, 0.5, pi / 4, 0.25}; // of the last the mean over the unit square
    double all = 0;
    for (const double power : powers)
        all += power;
    for (size_t i = 0; i < powers.size(); i++)
        CHECK(scene.emitters[i].probability == Approx(powers[i] / all).epsilon(1e-3));
}

TEST_CASE("the host looks textures up as the device does", "[emitters]") {
    // Mitsuba 3.9.1, as in tests/device/textures.cpp: red of an image of 4 x 2 pixels.
    const auto picture = std::make_shared<Picture>();
    picture->width = 4;
    picture->height = 2;
    picture->channels = 1;
    picture->floats = {0.125f, 0.25f, 0.375f, 0.5f, 0.125f, 0.25f, 0.375f, 0.5f};
    const auto red = [&](uint wrap, bool nearest, double u, double v) {
        return color_at(BitmapTexture{.picture = picture, .nearest = nearest, .wrap = wrap}, u, v)[0];
    };
    CHECK(red(WRAP_repeat, false, 0.25, 0.5) == Approx(0.1875));
    CHECK(red(WRAP_repeat, false, -1.1, 0.3) == Approx(0.4625));
    CHECK(red(WRAP_repeat, true, -1.1, 0.3) == Approx(0.5));
    CHECK(red(WRAP_mirror, false, 2.3, 1.4) == Approx(0.2125));
    CHECK(red(WRAP_mirror, true, 1.1, 0.25) == Approx(0.5));
    CHECK(red(WRAP_clamp, false, 0.77, 0.62) == Approx(0.4475));
    CHECK(red(WRAP_clamp, true, 2.3, 1.4) == Approx(0.5));
    CHECK(std::isfinite(red(WRAP_mirror, false, NAN, 1e300)));
    const CheckerboardTexture squares;
    CHECK(color_at(squares, 0.5, 0.1)[0] == 0.4);
    CHECK(color_at(squares, -0.1, 0.1)[0] == 0.2);
}

TEST_CASE("spots and directional lights in the flattened units", "[emitters]") {
    const Color bright{1, 2, 3};
    SceneDescription description = scene_of({diffuse(Parallelogram{{-8, -8, 0}, {16, 0, 0}, {0, 16, 0}})}); // scale 1/8
    description.lights = {{emitter_spot{{4, 0, 0}, {0, 0, -3}, bright, 60, 30, false}, {}},
                          {emitter_spot{{4, 0, 0}, {0, 0, -3}, bright, 60, 60, true}, {}},
                          {emitter_directional{{0, 3, -4}, bright}, {}}};
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    const FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 3);
    const emitter_spot_record spot = scene.emitters[0].u.of_spot, sharp = scene.emitters[1].u.of_spot;
    CHECK((spot.color[1] == 2.f / 64 && spot.position[0] == 0.5f && spot.direction[2] == -1));
    CHECK(spot.cutoff_angle == Approx(pi / 3));
    CHECK(spot.inverse_transition == Approx(6 / pi));
    CHECK((sharp.smooth == 1 && std::isfinite(sharp.inverse_transition) && sharp.inverse_transition > 1e20f));
    const emitter_directional_record sun = scene.emitters[2].u.of_directional;
    CHECK((sun.color[2] == 3 && sun.direction[1] == 0.6f && sun.direction[2] == -0.8f));
    CHECK(scene.settings.environment == OPAL_NONE); // no ray meets it
    // The circle of half the box's diagonal: radius 8 sqrt(2).
    CHECK(power_of(description.lights[2], 8 * std::sqrt(2)) == Approx(luminance(bright) * pi * 128));
    const double spots = power_of(description.lights[0], 0) + power_of(description.lights[1], 0),
                 all = spots + luminance(bright) * pi * 128;
    CHECK(scene.emitters[2].probability == Approx(1 - spots / all));
}
