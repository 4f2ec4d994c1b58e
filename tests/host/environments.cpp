// Environments that are images: what files become, the tables for light sampling, and bad input.
#include "base/log.h"
#include "flatten/emitter_kinds.h"
#include "image/image.h"
#include "read/load.h"
#include "support/error_of.h"
#include "support/plain_scenes.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace opal;
using test::error_of;

namespace {

constexpr double pi = std::numbers::pi;

Picture picture_of(int width, int height, std::vector<float> grey) {
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 1;
    picture.floats.assign(grey.begin(), grey.end());
    return picture;
}

std::shared_ptr<const EnvironmentMap> map_of(int width, int height, std::vector<float> grey) {
    return environment_of(picture_of(width, height, std::move(grey)), "a.exr");
}

emitter_envmap light_of(std::shared_ptr<const EnvironmentMap> map) {
    emitter_envmap light;
    light.map = std::move(map);
    return light;
}

// A scene's text around an emitter, which is on line 2.
std::string nori(const std::string &emitter) { return "<scene><camera type='perspective'/>\n" + emitter + "</scene>"; }
std::string mitsuba(const std::string &emitter) { return "<scene version='3.0.0'>\n" + emitter + "</scene>"; }

struct EnvironmentFixture {
    test::ScratchFolder scratch;
    EnvironmentFixture() {
        Image image;
        image.width = 2;
        image.height = 3;
        for (const char *name : {"R", "G", "B"})
            image.layers.push_back({name, {1, 2, 3, 4, 5, 6}});
        write_exr(image, scratch / "a.exr");
        for (Layer &layer : image.layers)
            layer.values[1] = -2;
        write_exr(image, scratch / "negative.exr");
    }
    SceneDescription load(const std::string &text) const { return load_scene(scratch.write("a.xml", text)); }
    emitter_envmap light(const std::string &text) const {
        return std::get<emitter_envmap>(load(text).lights.at(0).parameters);
    }
    std::vector<std::string> warnings_of(const std::string &text) const {
        const size_t before = warnings().size();
        load(text);
        return {warnings().begin() + std::ptrdiff_t(before), warnings().end()};
    }
    std::string error_in(const std::string &text) const {
        const std::string error = error_of([&] { load(text); }), file = (scratch / "a.xml").string();
        return error.starts_with(file) ? error.substr(file.size()) : error;
    }
};

std::string file(const std::string &name = "a.exr", const std::string &property = "filename") {
    return fmt::format("<string name='{}' value='{}'/>", property, name);
}

std::string envmap(const std::string &body, const std::string &type = "envmap") {
    return fmt::format("<emitter type='{}'>{}</emitter><shape type='sphere'/>", type, body);
}

bool near(Vec3 a, Vec3 b) { return length(a - b) < 1e-12; }

} // namespace

TEST_CASE("the mean of a map over all directions is that of its interpolation", "[environments]") {
    CHECK(map_of(4, 1, {3, 3, 3, 3})->mean_luminance == Approx(3));
    CHECK(map_of(1, 2, {1, 5})->mean_luminance == Approx(3)); // linear in the angle: symmetric
    // By the midpoint rule.
    const std::vector<float> rows = {7, 1, 0, 9, 2};
    constexpr int steps = 20000;
    double sum = 0;
    for (int i = 0; i < steps; i++) {
        const double v = (i + 0.5) / steps, row = 4 * v, below = std::floor(row);
        const auto first = size_t(below);
        sum += (rows[first] + (row - below) * (rows[first + 1] - rows[first])) * std::sin(pi * v) * pi / (2 * steps);
    }
    CHECK(map_of(1, 5, rows)->mean_luminance == Approx(sum).epsilon(1e-7));
    const emitter_envmap light = light_of(map_of(1, 5, rows));
    CHECK(power_of(light, 3) == Approx(4 * pi * pi * 9 * sum).epsilon(1e-6));
}

TEST_CASE("maps of one and two rows get rows between", "[environments]") {
    const auto one = map_of(2, 1, {1, 4}), two = map_of(2, 2, {1, 4, 3, 8});
    CHECK((one->height == 3 && two->height == 3));
    for (size_t texel = 0; texel < 6; texel++) {
        CHECK(one->texels[3 * texel + 1] == (texel % 2 ? 4 : 1));
        CHECK(two->texels[3 * texel + 2] == std::vector<float>{1, 4, 2, 6, 3, 8}[texel]);
    }
}

TEST_CASE("bytes of a map are decoded; values that are no radiance are 0, and counted", "[environments]") {
    Picture bytes;
    bytes.width = 1;
    bytes.height = 3;
    bytes.channels = 1;
    for (int value : {0, 128, 255})
        bytes.bytes.push_back(std::uint8_t(value));
    bytes.encoded = true;
    const auto map = environment_of(std::move(bytes), "a.png");
    CHECK(map->texels[4] == Approx(0.21586).epsilon(1e-4));
    CHECK(map->texels[8] == 1);

    const size_t before = warnings().size();
    const auto odd = map_of(2, 3, {1, -1, NAN, INFINITY, 2, 3});
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() ==
          "a.exr: 9 values are negative or no finite numbers: they are taken as 0"); // of 3 channels
    CHECK((odd->texels[3] == 0 && odd->texels[6] == 0 && odd->texels[9] == 0 && odd->texels[12] == 2));
}

TEST_CASE("a map's alias table has the shares of its cells, however dim they are", "[environments]") {
    std::mt19937 random(3);
    for (const auto &[width, height, sun] :
         {std::tuple{1, 3, 0.f}, {8, 4, 0.f}, {64, 33, 0.f}, {64, 33, 1e6f}, {7, 5, 1e30f}}) {
        std::vector<float> grey;
        for (int i = 0; i < width * height; i++)
            grey.push_back(1e-6f * float(random() % 1000));
        if (sun > 0)
            grey[size_t(width * (height / 2))] = sun;
        const emitter_envmap light = light_of(map_of(width, height, grey));
        SceneDescription description = scene_of({});
        description.lights = {{light, {}}};
        const FlatScene scene = flatten(description, 8);
        const emitter_envmap_record record = scene.emitters.at(0).u.of_envmap;
        const size_t columns = record.width, cells = columns * (record.height - 1);
        REQUIRE(scene.environment_texels.size() == cells + columns);

        std::vector<double> drawn(cells), wanted(cells);
        const auto importance = [&](size_t x, size_t y) {
            const double luminance = light.map->luminance_at(y * columns + x % columns);
            return std::max(luminance, double(record.least)) * std::sin(pi * double(y) / (record.height - 1));
        };
        double sum = 0;
        for (size_t i = 0; i < cells; i++) {
            const EnvironmentTexel &texel = scene.environment_texels[i];
            REQUIRE(texel.other < cells);
            REQUIRE((texel.accept >= 0 && texel.accept <= 1));
            drawn[i] += texel.accept / double(cells);
            drawn[texel.other] += (1 - texel.accept) / double(cells);
            const size_t x = i % columns, y = i / columns;
            wanted[i] = (importance(x, y) + importance(x + 1, y) + importance(x, y + 1) + importance(x + 1, y + 1)) / 4;
            sum += wanted[i];
        }
        double worst = 0;
        for (size_t i = 0; i < cells; i++)
            worst = std::max(worst, std::abs(drawn[i] / (wanted[i] / sum) - 1));
        INFO(width << " x " << height << ", " << sun);
        CHECK(worst < 1e-5);
        CHECK(record.density_scale == Approx(double(cells) / (2 * pi * pi * sum)));
    }
}

TEST_CASE("a black map is left out, one that is lit at the poles alone is not", "[environments]") {
    SceneDescription description = scene_of({});
    description.lights = {{light_of(map_of(2, 3, {0, 0, 0, 0, 0, 0})), {}}};
    CHECK(flatten(description, 8).emitters.empty());
    emitter_envmap poles = light_of(map_of(1, 4, {5, 0, 0, 5}));
    for (const bool compensated : {false, true}) {
        poles.mis_compensation = compensated;
        description.lights = {{poles, {}}};
        const FlatScene scene = flatten(description, 8);
        REQUIRE(scene.settings.environment == 0);
        CHECK((std::isfinite(scene.emitters[0].u.of_envmap.density_scale) && scene.emitters[0].u.of_envmap.least > 0));
    }
    emitter_envmap dark = light_of(map_of(1, 1, {1}));
    dark.scale = 0;
    CHECK(is_black(Light{dark, {}}));
}

TEST_CASE("what light sampling leaves out of a map of much contrast", "[environments]") {
    emitter_envmap light = light_of(map_of(2, 3, {1, 1, 9, 1, 1, 1}));
    light.mis_compensation = true;
    SceneDescription description = scene_of({});
    description.lights = {{light, {}}};
    const auto subtracted = [&] { return flatten(description, 8).emitters.at(0).u.of_envmap.subtracted; };
    CHECK(subtracted() == Approx(14 / 6.));
    description.strategy[AXIS_lighting] = CHOICE_lighting_emitter; // no BSDF sample would find the rest
    CHECK(subtracted() == 0);
    description.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    light.map = map_of(2, 3, {1, 1, 1.05f, 1, 1, 1});
    description.lights = {{light, {}}};
    CHECK(subtracted() == 0);
}

TEST_CASE("directions of a transform without its lengths", "[environments]") {
    const Transform turned = Transform::rotate({1, 2, 3}, 40);
    for (const Transform &scale : {Transform::scale({1, 1, 1}), Transform::scale({3, 3, 3}),
                                   Transform::scale({2, 5, 7}), Transform::scale({-2, 1, 1})}) {
        const Transform found = orthonormal(Transform::translate({1, 2, 3}) * turned * scale);
        CHECK(near(found.vector({0, 1, 0}), turned.vector({0, 1, 0})));
        CHECK(near(found.vector({0, 0, 1}), turned.vector({0, 0, 1})));
        CHECK(near(found.vector({1, 0, 0}), turned.vector({scale.rows[0][0] < 0 ? -1. : 1., 0, 0})));
        CHECK(near(found.point({}), {}));
    }
}

TEST_CASE_METHOD(EnvironmentFixture, "an envmap of Mitsuba", "[environments]") {
    const emitter_envmap plain = light(mitsuba(envmap(file())));
    CHECK((plain.map->width == 2 && plain.map->height == 3 && plain.scale == 1 && !plain.mis_compensation));
    CHECK(plain.map->texels[3 * 5] == 6);
    const emitter_envmap full =
        light(mitsuba(envmap(file() + "<float name='scale' value='3'/><boolean name='mis_compensation' value='true'/>"
                                      "<transform name='to_world'><rotate y='1' angle='90'/></transform>")));
    CHECK((full.scale == 3 && full.mis_compensation));
    CHECK(near(full.to_world.vector({0, 0, 1}), {1, 0, 0}));

    CHECK(error_in(mitsuba(envmap(file() + "<float name='gamma' value='2'/>")))
              .starts_with(":2:63: unknown property 'gamma' of emitter 'envmap'"));
    CHECK_THAT(error_in(mitsuba(envmap("<texture name='bitmap' type='bitmap'>" + file() + "</texture>"))),
               Catch::Contains("the emitter lacks its filename"));
    CHECK(error_in(mitsuba(envmap(file() + "<float name='scale' value='-1'/>"))) ==
          ":2:63: property 'scale': must not be negative");
    CHECK_THAT(error_in(mitsuba(envmap(file("b.exr")))), Catch::StartsWith(":2:24: "));
    scratch.write("b.exr", "no picture");
    CHECK_THAT(error_in(mitsuba(envmap(file("b.exr")))),
               Catch::StartsWith(":2:24: property 'filename': ") &&
                   Catch::Contains("b.exr: is a file of unknown kind, not an image"));
}

TEST_CASE_METHOD(EnvironmentFixture, "environments of Nori's forks have Nori's spherical coordinates",
                 "[environments]") {
    const std::vector<std::pair<std::string, std::string>> forms = {{"envmap", file()},
                                                                    {"env", file("a.exr", "OpenEXR")},
                                                                    {"environment", file("a.exr", "envMapPath")},
                                                                    {"env_map", file("a.exr", "mapname")}};
    for (const auto &[type, name] : forms) {
        const emitter_envmap found =
            light(nori(fmt::format("<emitter type='{}'>{}<float name='strength' value='3'/></emitter>", type, name)));
        CHECK((found.map->width == 2 && found.scale == 3));
        CHECK(near(found.to_world.vector({0, 1, 0}), {0, 0, 1}));  // the first row
        CHECK(near(found.to_world.vector({0, 0, -1}), {1, 0, 0})); // u = 0
        CHECK(near(found.to_world.vector({1, 0, 0}), {0, 1, 0}));  // u = 1/4
    }
    const emitter_envmap upright = light(nori("<emitter type='IBL'>" + file("a.exr", "exr_path") + "</emitter>"));
    CHECK(near(upright.to_world.vector({0, 1, 0}), {0, 1, 0}));
    CHECK(near(upright.to_world.vector({0, 0, -1}), {0, 0, -1}));
    const std::string turned = "<transform name='toWorld'><rotate axis='1 0 0' angle='-90'/></transform>";
    CHECK(near(light(nori("<emitter type='IBL'>" + file() + turned + "</emitter>")).to_world.vector({0, 1, 0}),
               {0, 1, 0}));
    CHECK(error_in(nori("<emitter type='envmap'/>")) == ":2:1: <emitter> lacks its property 'filename'");
    CHECK_THAT(error_in(nori("<emitter type='envmap'>" + file("b.exr") + "</emitter>")),
               Catch::StartsWith(":2:24: ") && Catch::Contains("no such file: "));
    CHECK_THAT(error_in(nori("<emitter type='envmap'>" + file() + "<float name='scale' value='-1'/></emitter>")),
               Catch::Contains("property 'scale': must be 0 or more"));
}

TEST_CASE_METHOD(EnvironmentFixture, "maps that are scaled, and texels that are negative, are told", "[environments]") {
    const auto scaled = [](const std::string &name, const std::string &scale) {
        return file() + fmt::format("<transform name='{}'><scale value='{}'/></transform>", name, scale);
    };
    for (const std::string &text : {mitsuba(envmap(scaled("to_world", "2"))),
                                    nori("<emitter type='env'>" + scaled("toWorld", "1 2 1") + "</emitter>")}) {
        const std::vector<std::string> told = warnings_of(text);
        REQUIRE_FALSE(told.empty());
        CHECK_THAT(told[0], Catch::Contains("a.xml:2:") && Catch::Contains("this transform scales an environment"));
    }
    CHECK(warnings_of(mitsuba(envmap(scaled("to_world", "-1, 1, 1")))).empty());
    const std::vector<std::string> told = warnings_of(mitsuba(envmap(file("negative.exr"))));
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0],
               Catch::EndsWith("negative.exr: 3 values are negative or no finite numbers: they are taken as 0"));
}

TEST_CASE_METHOD(EnvironmentFixture, "the hash of a scene covers its environment", "[environments]") {
    const std::string first = load(mitsuba(envmap(file()))).hash;
    std::filesystem::copy_file(scratch / "negative.exr", scratch / "a.exr",
                               std::filesystem::copy_options::overwrite_existing);
    CHECK(load(mitsuba(envmap(file()))).hash != first);
}
