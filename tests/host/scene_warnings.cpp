// Warnings about images that are not what was meant, each at its line of the scene, and silence where they would be
// false.
#include "flatten/scene_warnings.h"
#include "base/log.h"
#include "read/nori/load.h"
#include "support/plain_scenes.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

using Lines = std::vector<std::string>;

// A camera at depth 0 that looks along z, on line 2, and `body` from line 3 on. cube.obj spans -1 to 1.
struct WarningFixture {
    ScratchFolder scratch;
    Lines loaded; // warnings that loading gave

    SceneDescription load(const std::string &body, const std::string &camera = "", const std::string &more = "") {
        scratch.write("cube.obj", "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
                                  "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n");
        const std::string text = fmt::format("<scene>{}<integrator type=\"path_mis\"/>\n<camera type=\"perspective\">"
                                             "{}<rfilter type=\"box\"/></camera>\n{}\n</scene>",
                                             more, camera, body);
        const size_t before = warnings().size();
        SceneDescription scene = load_scene(scratch.write("scene.xml", text));
        loaded.assign(warnings().begin() + std::ptrdiff_t(before), warnings().end());
        shorten(loaded);
        return scene;
    }
    void shorten(Lines &lines) const { // file names, without the folder
        const std::string folder = scratch.path().string() + "/";
        for (std::string &line : lines)
            for (size_t at; (at = line.find(folder)) != std::string::npos;)
                line.erase(at, folder.size());
    }
    Lines warned(const std::string &body, const std::string &camera = "") {
        Lines lines = scene_warnings(load(body, camera));
        shorten(lines);
        return lines;
    }
    Lines notes(const SceneDescription &scene, bool samples_given = false) const {
        Lines lines = scene_notes(scene, samples_given);
        shorten(lines);
        return lines;
    }
};

std::string cube_at(const std::string &where, const std::string &more = "") {
    return fmt::format(R"(<mesh type="obj"><string name="filename" value="cube.obj"/>)"
                       R"(<transform name="toWorld"><translate value="{}"/></transform>{}</mesh>)",
                       where, more);
}

const std::string emitter = R"(<emitter type="area"><color name="radiance" value="1 1 1"/></emitter>)";

// A square of side 2 in the plane y = height that faces up, or down.
std::string square_at(double height, bool up, const std::string &more) {
    return fmt::format(R"(<mesh type="parallelogram"><point name="origin" value="-1 {} 4"/>)"
                       R"(<vector name="{}" value="2 0 0"/><vector name="{}" value="0 0 2"/>{}</mesh>)",
                       height, up ? "v" : "u", up ? "u" : "v", more);
}

const std::string lamp_down = square_at(4, false, emitter), lamp_up = square_at(4, true, emitter);

const std::string point_light =
    R"(<emitter type="point"><point name="position" value="0 3 3"/><color name="power" value="1 1 1"/></emitter>)";

void check_one(const Lines &lines, const std::string &start, const std::string &reason) {
    INFO(start);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines[0], Catch::StartsWith("scene.xml:" + start) && Catch::Contains(reason));
}

} // namespace

TEST_CASE_METHOD(WarningFixture, "An ordinary scene brings no warning and no note", "[scene_warnings]") {
    const std::string white = R"(<bsdf type="diffuse"/>)";
    const SceneDescription scene =
        load(cube_at("0 0 5", white) + square_at(4, false, white + emitter), "",
             R"(<sampler type="independent"><integer name="sampleCount" value="1"/></sampler>)");
    CHECK(loaded.empty());
    CHECK(scene_warnings(scene).empty());
    CHECK(notes(scene).empty());
}

TEST_CASE_METHOD(WarningFixture, "Geometry outside the camera's clip distances", "[scene_warnings]") {
    const std::string clip = R"(<float name="nearClip" value="1"/><float name="farClip" value="10"/>)";
    check_one(warned(cube_at("0 0 20") + lamp_down, R"(<float name="farClip" value="2"/>)"),
              "2:", "sees depths from nearClip 0.0001 to farClip 2, and all meshes lie at depths from 4 to 21");
    check_one(warned(cube_at("0 0 0.1") + point_light, R"(<float name="nearClip" value="2"/>)"),
              "2:", "the only mesh lies at depths from -0.9 to 1.1");
    check_one(warned(cube_at("0 0 -5", emitter)), "2:", "depths from -6 to -4, behind it");
    check_one(warned(cube_at("0 0 5") + cube_at("0 0 20") + lamp_down, clip),
              "2:", "does not see 1 mesh beyond farClip 10 (the first: cube.obj at scene.xml:3:");
    // What is partly seen, or behind the camera, or a light far away
    CHECK(warned(cube_at("0 0 1") + lamp_down, clip).empty());
    CHECK(warned(cube_at("0 0 10.5") + lamp_down, clip).empty());
    CHECK(warned(cube_at("0 0 5") + cube_at("0 0 -5") + lamp_down, clip).empty());
    CHECK(warned(cube_at("0 0 5") + cube_at("0 0 20", emitter), clip).empty());
}

TEST_CASE_METHOD(WarningFixture, "Lights that all face away", "[scene_warnings]") {
    check_one(warned(cube_at("0 0 5") + "\n" + lamp_up), "4:", "the only light faces away");
    check_one(warned(cube_at("0 0 5") + "\n" + lamp_up + lamp_up), "4:", "all 2 lights face away");
    check_one(warned(square_at(-1, true, "") + "\n" +
                     R"(<mesh type="obj"><string name="filename" value="cube.obj"/><transform name="toWorld">)"
                     R"(<scale value="1 0.01 1"/><translate value="0 0.005 5"/></transform></mesh>)" +
                     square_at(1, true, emitter)),
              "4:", "the only light faces away");
    // One of two; a light beside a point light; what only the camera sees; what is partly in front
    CHECK(warned(cube_at("0 0 5") + lamp_up + square_at(4.5, false, emitter)).empty());
    CHECK(warned(cube_at("0 0 5") + lamp_up + point_light).empty());
    CHECK(warned(cube_at("0 0 5") + square_at(-2, true, emitter)).empty());
    CHECK(warned(cube_at("0 3.5 5") + lamp_up).empty());
    CHECK(warned(cube_at("0 0 5", emitter)).empty()); // shines on all sides, on the camera too
    std::string both = lamp_up;                       // shines on both sides
    both.replace(both.find("</emitter>"), 0, R"(<boolean name="twosided" value="true"/>)");
    CHECK(warned(cube_at("0 0 5") + both).empty());
    // A bowl that faces away lights itself
    scratch.write("bowl.obj", "v -1 5 4\nv 1 5 4\nv 0 4 5\nv -1 5 6\nv 1 5 6\nf 1 3 2\nf 4 5 3\n");
    CHECK(warned(cube_at("0 0 5") + R"(<mesh type="obj"><string name="filename" value="bowl.obj"/>)" + emitter +
                 "</mesh>")
              .empty());
    scratch.write("flat.obj", "v -1 4 4\nv 1 4 4\nv 1 4 6\nf 1 3 2\n");
    check_one(warned(cube_at("0 0 5") + R"(<mesh type="obj"><string name="filename" value="flat.obj"/>)" + emitter +
                     "</mesh>"),
              "3:", "the opposite order turn it round");
}

TEST_CASE_METHOD(WarningFixture, "Coincident faces that are wound against each other", "[scene_warnings]") {
    const auto obj = [&](const std::string &name, const std::string &faces) {
        scratch.write(name, "v -1 -1 5\nv 1 -1 5\nv 1.5 0 5\nv 1 1 5\nv -1 1 5\nv 0 0 6\n" + faces);
        return lamp_down + "\n<mesh type=\"obj\"><string name=\"filename\" value=\"" + name + "\"/></mesh>";
    };
    check_one(warned(obj("both.obj", "f 1 2 5\nf 2 1 6\nf 5 2 1\nf 1 2 6\n")), "4:",
              "faces coincide that are wound against each other: a ray that gets there meets one of them by chance, "
              "its front or "
              "its back (2 triangles in all, the first in both.obj)");
    check_one(warned(obj("quads.obj", "f 5 4 2 1\nf 1 2 4 5\n")), "4:", "(2 triangles in all"); // other diagonals
    check_one(warned(obj("pentagons.obj", "f 1 2 3 4 5\nf 4 3 2 1 5\n")), "4:", "in all");
    // Between meshes, parallelograms too, with -0 for 0
    check_one(warned(lamp_down + "\n" + square_at(0, true, "") + "\n" + square_at(0, false, "")),
              "4:", "(2 triangles in all, the first in , and in  at scene.xml:5:1)");
    check_one(warned(lamp_down + "\n" + square_at(0, true, "") + "\n" +
                     R"(<mesh type="parallelogram"><point name="origin" value="-1 -0 4"/>)"
                     R"(<vector name="u" value="2 0 0"/><vector name="v" value="0 0 2"/></mesh>)"),
              "4:", "2 triangles");
    check_one(warned(lamp_down + "\n" + cube_at("0 0 5") + cube_at("0 2 5")), "4:", "2 triangles");
    // The same side, beside each other, a fold, another plane
    CHECK(warned(obj("same.obj", "f 1 2 4 5\nf 2 4 5 1\n")).empty());
    CHECK(warned(obj("beside.obj", "f 1 2 5\nf 2 5 4\n")).empty());
    CHECK(warned(obj("beside2.obj", "f 1 2 4\nf 1 5 4\n")).empty());
    CHECK(warned(obj("fold.obj", "f 1 2 5\nf 2 1 6\n")).empty());
    CHECK(warned(lamp_down + square_at(0, true, "") + square_at(1e-9, false, "")).empty());
    CHECK(warned(lamp_down + cube_at("0 0 5") + cube_at("0 2.1 5")).empty());
}

TEST_CASE("Coincident faces are found among many", "[scene_warnings]") {
    TriangleMesh strip;
    for (unsigned i = 0; i < 20000; ++i)
        strip.positions.push_back({double(i / 2), double(i % 2), 5});
    for (unsigned i = 0; i + 2 < strip.positions.size(); ++i)
        strip.triangles.push_back({{{i, OPAL_NONE}, {i + 1 + i % 2, OPAL_NONE}, {i + 2 - i % 2, OPAL_NONE}}});
    SceneDescription scene = scene_of({diffuse(strip)});
    scene.camera.far_clip = 1e6;
    CHECK(scene_warnings(scene).empty());
    const auto [a, b, c] = strip.triangles[12345];
    strip.triangles.push_back({{c, b, a}});
    scene.meshes[0].shape = strip;
    REQUIRE(scene_warnings(scene).size() == 1);
    CHECK_THAT(scene_warnings(scene)[0], Catch::Contains("1 triangle in all"));
}

TEST_CASE_METHOD(WarningFixture, "A light that its toWorld turns round", "[scene_warnings]") {
    scratch.write("up.obj", "v -1 0 4\nv 1 0 4\nv 1 0 6\nf 1 3 2\n");
    scratch.write("up_normals.obj", "v -1 0 4\nv 1 0 4\nv 1 0 6\nvn 0 1 0\nf 1//1 3//1 2//1\n");
    const auto mirrored = [](const std::string &file, const std::string &scale, const std::string &more) {
        return fmt::format("{}\n<mesh type=\"obj\"><string name=\"filename\" value=\"{}\"/>"
                           "<transform name=\"toWorld\"><scale value=\"{}\"/></transform>{}</mesh>",
                           cube_at("0 0 5"), file, scale, more);
    };
    load(mirrored("up.obj", "-1 1 1", emitter));
    check_one(loaded, "4:", "toWorld mirrors this light");
    for (const std::string &harmless : {mirrored("up.obj", "-1 1 1", ""), mirrored("up.obj", "-1 1 -1", emitter),
                                        mirrored("up_normals.obj", "-1 1 1", emitter)}) {
        load(harmless);
        for (const std::string &line : loaded)
            CHECK_THAT(line, !Catch::Contains("mirrors"));
    }
}

TEST_CASE_METHOD(WarningFixture, "What a scene leaves to defaults is noted once", "[scene_warnings]") {
    const std::string body = cube_at("0 0 5") + "\n" + lamp_down;
    CHECK(notes(load(body)) == Lines{"scene.xml:1:1: no sampleCount: 1 sample a pixel",
                                     "scene.xml:3:1: 2 meshes without <bsdf>: diffuse, albedo 0.5"});
    CHECK(notes(load(body), true).size() == 1);
    CHECK(notes(load(body, "", "\n<sampler type=\"independent\"/>"))[0] ==
          "scene.xml:2:1: no sampleCount: 1 sample a pixel");
    SceneDescription normals = load(body);
    normals.strategy[AXIS_integrator] = CHOICE_integrator_normals;
    CHECK(notes(normals, true).empty());
}

TEST_CASE_METHOD(WarningFixture, "a spot that lights no mesh is told", "[scene_warnings]") {
    const auto spot = [](const char *direction, double cutoff) {
        return fmt::format(R"(<emitter type="spot"><point name="position" value="0 9 5"/>)"
                           R"(<vector name="direction" value="{}"/><float name="cutoffAngle" value="{}"/></emitter>)",
                           direction, cutoff);
    };
    const std::string cube = cube_at("0 0 5") + "\n";
    CHECK(warned(cube + spot("0 -1 0", 1)).empty());
    CHECK(warned(cube + spot("0 1 0", 180)).empty());
    CHECK(warned(cube + spot("1 0 0", 85)).empty()); // 90 degrees to the cube's middle, which spans 11
    const std::string away = "scene.xml:4:1: a spot lights nothing: no mesh lies within cutoffAngle of the axis";
    CHECK(warned(cube + spot("0 1 0", 60)) == Lines{away});
    CHECK_THAT(warned(cube + spot("0 1 0", 60) + spot("1 0 0", 70)).at(0),
               Catch::Contains(": 2 spots light nothing: "));
}
