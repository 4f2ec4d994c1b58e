// All mistakes of a scene are told together; with --lenient, what is unknown warns. Mutated scenes load or fail.
#include "base/log.h"
#include "read/nori/load.h"
#include "read/nori/tests.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <random>
#include <sstream>

using namespace opal;
using opal::test::error_of;

namespace {

const std::string camera = "<camera type='perspective'/>\n";
const std::string square =
    "<point name='origin' value='0 0 0'/><vector name='u' value='1 0 0'/><vector name='v' value='0 2 0'/>";
const std::string light = "<mesh type='parallelogram'>" + square +
                          "<emitter type='area'><color name='radiance' value='1 2 3'/></emitter></mesh>\n";

struct MistakesFixture {
    test::ScratchFolder scratch;
    std::string file() const { return (scratch / "a.xml").string(); }
    SceneDescription load(const std::string &body, bool lenient = false) const {
        return load_scene(scratch.write("a.xml", "<scene>\n" + body + "</scene>"), {.lenient = lenient});
    }
    // The lines of an error, each after the file's name.
    std::vector<std::string> lines_of(const std::string &error) const {
        std::vector<std::string> lines;
        std::istringstream stream(error);
        for (std::string line; std::getline(stream, line);)
            lines.push_back(line.starts_with(file()) ? line.substr(file().size()) : line);
        return lines;
    }
    std::vector<std::string> mistakes_in(const std::string &body, bool lenient = false) const {
        return lines_of(error_of([&] { load(body, lenient); }));
    }
    // The warnings of a lenient load, each after the file's name.
    std::vector<std::string> warnings_of(const std::string &body) const {
        const size_t before = warnings().size();
        load(body, true);
        std::string text;
        for (size_t i = before; i < warnings().size(); i++)
            text += warnings()[i] + "\n";
        return lines_of(text);
    }
};

using Lines = std::vector<std::string>;

} // namespace

TEST_CASE_METHOD(MistakesFixture, "all mistakes are told, in the order of the file", "[mistakes]") {
    scratch.write("bad.obj", "v 0 0 0\nf 1 2 3\n");
    const Lines lines = mistakes_in("<mesh type='obj'><string name='filename' value='bad.obj'/>\n"
                                    "<bsdf type='difuse'/></mesh>\n"
                                    "<mesh type='parallelogram'>\n<point name='origin' value='0 0'/>\n"
                                    "<vector name='u' value='1 0 0'/><vector name='v' value='0 2 0'/>\n"
                                    "<float name='size' value='1'/></mesh>\n"
                                    "<camera type='perspective'>\n<float name='fov' value='180'/>\n"
                                    "<transform name='toWorld'>\n<rotat axis='1 0 0' angle='3'/></transform></camera>\n"
                                    "<emitter type='point'><color name='power' value='-1 -1 -1'/></emitter>\n"
                                    "<float name='x' value='y'/>\n");
    REQUIRE(lines.size() == 8);
    CHECK_THAT(lines[0], Catch::Contains("bad.obj:2") && Catch::EndsWith("(the mesh at " + file() + ":2:1)"));
    CHECK_THAT(lines[1], Catch::StartsWith(":3:1: unknown bsdf type 'difuse'; did you mean 'diffuse'? "));
    CHECK(lines[2] == ":5:1: property 'origin': '0 0' holds 2 numbers, not 3");
    CHECK_THAT(lines[3], Catch::StartsWith(":7:1: unknown property 'size' of mesh 'parallelogram'"));
    CHECK_THAT(lines[4], Catch::StartsWith(":9:1: property 'fov': must be above 0 and below 180"));
    CHECK_THAT(lines[5], Catch::StartsWith(":11:1: unknown operation 'rotat'; did you mean 'rotate'?"));
    CHECK_THAT(lines[6], Catch::StartsWith(":12:23: property 'power': must be 0 or more"));
    CHECK(lines[7] == ":13:1: property 'x': 'y' is not a number");
}

TEST_CASE_METHOD(MistakesFixture, "nothing follows from a mistake that is told", "[mistakes]") {
    const size_t before = warnings().size();
    CHECK(mistakes_in(camera + "<mesh type='obj'><string name='filename'/></mesh>") ==
          Lines{":3:18: <string> lacks the attribute 'value'"});
    CHECK(mistakes_in(camera +
                      "<mesh type='parallelogram'><point name='origin' value='0 0 0'/><vector name='u' value='1 "
                      "0 0'/><vector name='v' value='x 0 0'/></mesh>") ==
          Lines{":3:96: property 'v': 'x' is not a number"});
    CHECK(mistakes_in(camera + "<mesh/>") == Lines{":3:1: <mesh> lacks the attribute 'type'"});
    CHECK(mistakes_in("<camera type='perspective'><float value='1'/><float value='2'/></camera>").size() == 2);
    CHECK(mistakes_in("<camera type='pin-hole'><float name='radius' value='1'/></camera>").size() == 1);
    CHECK(warnings().size() == before); // an empty scene that fails is not called black
}

TEST_CASE_METHOD(MistakesFixture, "twenty mistakes are told, the others counted", "[mistakes]") {
    std::string body = camera;
    for (int i = 0; i < 27; i++)
        body += "<cone/>\n";
    const Lines lines = mistakes_in(body);
    REQUIRE(lines.size() == 21);
    CHECK_THAT(lines[0], Catch::StartsWith(":3:1: unknown tag 'cone'"));
    CHECK_THAT(lines[19], Catch::StartsWith(":22:1: unknown tag 'cone'"));
    CHECK(lines[20] == "... and 7 more mistakes");
}

TEST_CASE_METHOD(MistakesFixture, "the process prints a line for each mistake", "[mistakes]") {
    const std::string scene = scratch.write("a.xml", "<scene>\n<cone/>\n" + camera + "<ball/>\n</scene>").string();
    const test::Outcome outcome = test::run_shell(std::string(OPAL_BINARY) + " inspect " + scene);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::StartsWith("error: " + scene + ":2:1: unknown tag 'cone'") &&
                                Catch::Contains("\nerror: " + scene + ":4:1: unknown tag 'ball'"));
}

TEST_CASE_METHOD(MistakesFixture, "tests tell all their mistakes", "[mistakes]") {
    const std::string text = "<test type='ttest'><string name='references' value='1'/>\n<scene>\n<cone/></scene>\n"
                             "<integer name='sampleCount' value='1'/></test>";
    const Lines lines = lines_of(error_of([&] { load_test(scratch.write("a.xml", text)); }));
    REQUIRE(lines.size() == 2);
    CHECK_THAT(lines[0], Catch::StartsWith(":3:1: unknown tag 'cone'"));
    CHECK_THAT(lines[1], Catch::StartsWith(":4:1: property 'sampleCount': must be at least 2"));
}

TEST_CASE_METHOD(MistakesFixture, "lenient: unknown attributes, properties, tags and children warn", "[mistakes]") {
    const std::string body = camera + light + "<mesh type='parallelogram' class='a'>\n" + square +
                             "<float name='size' value='1'/>\n<medium type='fog'/>\n<camera type='perspective'/>\n"
                             "<transform name='toWorld' order='xyz'>\n<skew value='1'/></transform></mesh>\n";
    const Lines lines = warnings_of(body);
    REQUIRE(lines.size() == 6);
    std::vector<std::string> sorted = lines;
    std::sort(sorted.begin(), sorted.end());
    CHECK_THAT(sorted[0], Catch::StartsWith(":4:1: unknown attribute 'class' of <mesh>"));
    CHECK_THAT(sorted[1], Catch::StartsWith(":5:101: unknown property 'size'"));
    CHECK_THAT(sorted[2], Catch::StartsWith(":6:1: unknown tag 'medium'"));
    CHECK_THAT(sorted[3], Catch::StartsWith(":7:1: no <camera> may stand in <mesh>"));
    CHECK_THAT(sorted[4], Catch::StartsWith(":8:1: unknown attribute 'order' of <transform>"));
    CHECK_THAT(sorted[5], Catch::StartsWith(":9:1: unknown operation 'skew'"));
    CHECK(mistakes_in(body).size() == 6);
}

TEST_CASE_METHOD(MistakesFixture, "lenient: unknown types get something in their place, and it is said", "[mistakes]") {
    const auto check = [&](const std::string &body, const std::string &what, const std::string &instead) {
        INFO(body);
        const Lines lines = warnings_of(body);
        REQUIRE_FALSE(lines.empty());
        CHECK_THAT(lines[0],
                   Catch::Contains(what) && Catch::Contains("available: ") && Catch::EndsWith("; " + instead));
        REQUIRE_FALSE(mistakes_in(body).empty());
        CHECK_THAT(mistakes_in(body)[0], Catch::Contains(what) && !Catch::Contains(instead));
        return load(body, true);
    };
    const std::string mesh = "<mesh type='parallelogram'>" + square;
    const SceneDescription dipole =
        check(camera + light + mesh + "<bsdf type='dipole'><float name='metallic' value='1'/></bsdf></mesh>",
              ":4:128: unknown bsdf type 'dipole'", "a diffuse one of albedo 0.5 stands in for it");
    CHECK(dipole.meshes.at(1).bsdf.as<bsdf_diffuse_record>().albedo.value[0] == 0.5f);
    CHECK(check(camera + light + "<emitter type='sunsky'><string name='filename' value='a.exr'/></emitter>",
                ":4:1: unknown emitter type 'sunsky'", "it is left out")
              .lights.empty());
    CHECK_FALSE(check(camera + light + mesh + "<emitter type='laser'/></mesh>", "unknown emitter type 'laser'",
                      "it is left out")
                    .meshes.at(1)
                    .radiance);
    const Lines misplaced = warnings_of(camera + light + "<emitter type='area'/>");
    REQUIRE(misplaced.size() == 1);
    CHECK(misplaced[0] == ":4:1: emitter 'area' must stand in a <mesh>, not in a <scene>; it is left out");
    CHECK(check(camera + light + "<mesh type='torus'><point name='center' value='0 0 0'/></mesh>",
                ":4:1: unknown mesh type 'torus'", "the shape is left out")
              .meshes.size() == 1);
    CHECK(check(camera + light + "<integrator type='photonmapper'><integer name='photonCount' value='9'/></integrator>",
                "unknown integrator type 'photonmapper'", "path_mis stands in for it")
              .integrator_type == "path_mis");
    const SceneDescription halton =
        check(camera + light + "<sampler type='halton'><integer name='sampleCount' value='9'/></sampler>",
              "unknown sampler type 'halton'", "independent stands in for it");
    CHECK(halton.spp == 9);
    CHECK(halton.strategy[AXIS_sampler] == CHOICE_sampler_independent);
    CHECK(check("<camera type='fisheye'><float name='fov' value='50'/></camera>" + light,
                "unknown camera type 'fisheye'", "a perspective one stands in for it")
              .camera.perspective.fov == 50);
    CHECK(check("<camera type='perspective'><rfilter type='sinc'/></camera>" + light, "unknown rfilter type 'sinc'",
                "the default filter stands in for it")
              .camera.filter.kind == FILTER_gaussian);
}

TEST_CASE_METHOD(MistakesFixture, "lenient: wrong values stay mistakes", "[mistakes]") {
    CHECK(mistakes_in("<camera type='perspective'><float name='fov' value='x'/><float name='y' value='z'/></camera>",
                      true)
              .size() == 2);
    CHECK(mistakes_in(camera + camera, true).size() == 1);
}

TEST_CASE_METHOD(MistakesFixture, "a number too near to 0 for a double is 0", "[mistakes]") {
    const auto near_clip = [&](const std::string &value) {
        return load("<camera type='perspective'><float name='nearClip' value='" + value + "'/></camera>" + light)
            .camera.near_clip;
    };
    CHECK(near_clip("1e-400") == 0);
    CHECK(near_clip("-1e-400") == 0);
    CHECK(near_clip("4e-320") == 4e-320);
    CHECK_THAT(error_of([&] { near_clip("1e400"); }), Catch::Contains("is not a finite number"));
}

// 500 changes of scenes: bytes, tags left out or doubled, attributes left out.
TEST_CASE_METHOD(MistakesFixture, "mutated scenes load or fail", "[mistakes]") {
    scratch.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string scene =
        "<?xml version='1.0' encoding='utf-8'?>\n<scene>\n<integrator type='path_mis'><integer name='maxDepth' "
        "value='5'/></integrator>\n<sampler type='independent'><integer name='sampleCount' "
        "value='16'/></sampler>\n<camera "
        "type='perspective'><transform name='toWorld'><scale value='-1 1 1'/><lookat origin='1 2 3' target='0 0 0' "
        "up='0 1 "
        "0'/></transform><float name='fov' value='30'/><rfilter type='gaussian'><float name='radius' "
        "value='2'/></rfilter></camera>\n<mesh type='obj'><string name='filename' value='a.obj'/><bsdf "
        "type='twosided'><bsdf type='microfacet'><color name='kd' value='0.1 0.2 0.3'/><float name='alpha' "
        "value='0.1'/></bsdf></bsdf></mesh>\n" +
        light +
        "<emitter type='point'><point name='position' value='0 1 2'/><color name='power' value='1 1 1'/></emitter>\n" +
        "<!-- the end --></scene>\n";
    std::mt19937 random(21);
    const auto below = [&](size_t n) { return size_t(random() % n); };
    // A piece of the text from a `first` character to the next `last` one.
    const auto piece = [&](const std::string &text, char first, char last) {
        const size_t start = std::min(text.find(first, below(text.size())), text.size() - 1);
        return std::pair(start, std::min(text.find(last, start + 1), text.size() - 1) - start + 1);
    };
    size_t loaded = 0, failed = 0;
    for (int i = 0; i < 500; i++) {
        std::string text = scene;
        for (size_t changes = 1 + below(3); changes > 0; changes--)
            switch (below(6)) {
            case 0:
                text[below(text.size())] = char(below(256));
                break;
            case 1:
                text.erase(below(text.size()), 1 + below(8));
                break;
            case 2: {
                const auto [start, size] = piece(text, '<', '>');
                text.erase(start, size);
                break;
            }
            case 3: {
                const auto [start, size] = piece(text, '<', '>');
                text.insert(start, text.substr(start, size));
                break;
            }
            case 4: {
                const auto [start, size] = piece(text, ' ', ' ');
                text.erase(start, size - 1);
                break;
            }
            default: {
                const auto [start, size] = piece(text, '\'', '\'');
                text.replace(start, size,
                             std::vector<std::string>{"''", "'-1'", "'1e999'", "'x'", "'0 0 0'"}[below(5)]);
            }
            }
        const std::filesystem::path path = scratch.write("a.xml", text);
        try {
            load_scene(path, {.lenient = i % 2 == 0});
            loaded++;
        } catch (const Error &) {
            failed++;
        }
    }
    INFO(loaded << " loaded, " << failed << " failed");
    CHECK(loaded >= 20);
    CHECK(failed >= 100);
}
