// Warnings where single precision does not hold, each at its line of the scene.
#include "flatten/precision_warnings.h"
#include "read/nori/load.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

// A floor, a lamp above it, and on lines 4 and 5 what a test puts there.
std::vector<std::string> warnings_of(const std::string &camera, const std::string &more) {
    const ScratchFolder folder;
    folder.write("speck.obj", "v 0 0 0\nv 1e-4 0 0\nv 0 1e-4 0\nf 1 2 3\n");
    folder.write("dust.obj", "v 0 0 0\nv 1e-15 0 0\nv 0 1e-15 0\nf 1 2 3\n");
    const auto file =
        folder.write("scene.xml", R"(<scene><integrator type="path_mis"/>
<mesh type="parallelogram"><point name="origin" value="-1 -1 0"/><vector name="u" value="2 0 0"/>)"
                                  R"(<vector name="v" value="0 2 0"/></mesh>
<mesh type="parallelogram"><point name="origin" value="-1 -1 1"/><vector name="u" value="2 0 0"/>)"
                                  R"(<vector name="v" value="0 2 0"/>
)" + more + "\n" + R"(<emitter type="area"><color name="radiance" value="1 1 1"/></emitter></mesh>
<camera type="perspective"><transform name="toWorld"><lookat origin=")" +
                                      camera + R"(" target="0 0 0" up="0 0 1"/></transform></camera></scene>)");
    const SceneDescription scene = load_scene(file);
    std::vector<std::string> lines = precision_warnings(scene, flatten(scene, 1));
    for (std::string &line : lines)
        line = line.substr(folder.path().string().size() + 1);
    return lines;
}

const std::string near = "0 -3 1";

void check_one(const std::vector<std::string> &lines, const std::string &start, const std::string &reason) {
    INFO(start);
    REQUIRE(lines.size() == 1);
    CHECK_THAT(lines[0], Catch::StartsWith("scene.xml:" + start) && Catch::Contains(reason));
}

} // namespace

TEST_CASE("An ordinary scene brings no warning", "[precision_warnings]") {
    CHECK(warnings_of(near, R"(<bsdf type="diffuse"><color name="albedo" value="1 1 1"/></bsdf>)").empty());
    CHECK(warnings_of(near, R"(<bsdf type="microfacet"><float name="alpha" value="1e-4"/></bsdf>)").empty());
    CHECK(warnings_of(near, R"(<bsdf type="phong"><float name="n" value="1e6"/></bsdf>)").empty());
    CHECK(warnings_of(near, R"(<bsdf type="dielectric"/>)").empty());
    CHECK(warnings_of("0 -300 1", "").empty());
}

TEST_CASE("A plastic that gains light by the fit of what its coat sends back is told", "[precision_warnings]") {
    const auto of = [](const std::string &type, const std::string &properties) {
        return warnings_of(near, fmt::format(R"(<bsdf type="{}">{}</bsdf>)", type, properties));
    };
    const std::string white = R"(<color name="diffuse_reflectance" value="1 1 1"/>)",
                      dense = R"(<float name="intIOR" value="3"/>)";
    CHECK(of("plastic", "").empty());
    CHECK(of("plastic", white).empty());
    CHECK(of("plastic", dense).empty());
    CHECK(of("roughplastic", white + dense).empty());
    check_one(of("plastic", white + dense), "4:", "of the light that enters leaves, as in Mitsuba");
    check_one(of("plastic", R"(<float name="intIOR" value="1"/><float name="extIOR" value="1"/>)"),
              "4:", "the coat reflects nothing");
    check_one(of("roughplastic", R"(<float name="alpha" value="1e-7"/>)"), "4:", "alpha 1e-07 is below 1e-06");
}

TEST_CASE("A principled material that gains light is told with its angle", "[precision_warnings]") {
    const auto of = [](const std::string &type, const std::string &properties) {
        return warnings_of(near, fmt::format(R"(<bsdf type="{}">{}</bsdf>)", type, properties));
    };
    const std::string white = R"(<color name="baseColor" value="1 1 1"/>)";
    CHECK(of("principled", "").empty());
    CHECK(of("principled", white + R"(<float name="metallic" value="1"/>)").empty());
    CHECK(of("principled", white + R"(<float name="specTrans" value="1"/>)").empty());
    CHECK(of("principledthin", "").empty());
    CHECK(of("principledthin", white + R"(<float name="diffTrans" value="2"/>)").empty());
    check_one(of("principled", white), "4:", "1.19 of the light that comes at 88 degrees"); // Mitsuba: 1.187 at 85
    check_one(of("principled", white + R"(<float name="flatness" value="1"/>)"), "4:", "1.45 of the light");
    check_one(of("principledthin", white), "4:", "1.03 of the light");
}

TEST_CASE("What makes light from nothing, or nothing of light, is told with its line", "[precision_warnings]") {
    check_one(warnings_of(near, R"(<bsdf type="diffuse"><color name="albedo" value="0.5 1.1 0.5"/></bsdf>)"),
              "4:", "albedo 1.1 is above 1");
    check_one(warnings_of(near, R"(<bsdf type="twosided"><bsdf type="diffuse"><color name="albedo" value="1.2 0 0"/>)"
                                R"(</bsdf></bsdf>)"),
              "4:", "albedo 1.2 is above 1");
    check_one(warnings_of(near, R"(<bsdf type="phong"><color name="kd" value="0.9 0.9 0.9"/>)"
                                R"(<color name="ks" value="1.4 1.4 1.4"/></bsdf>)"),
              "4:", "reflect 1.15");
    check_one(
        warnings_of(
            near,
            R"(<bsdf type="dielectric"><float name="intIOR" value="1.3"/><float name="extIOR" value="1.3"/></bsdf>)"),
        "4:", "both 1.3");
    check_one(
        warnings_of(
            near,
            R"(<bsdf type="microfacet"><float name="intIOR" value="1.3"/><float name="extIOR" value="1.3"/></bsdf>)"),
        "4:", "both 1.3");
    const auto dust = warnings_of(near, R"(</mesh><mesh type="obj"><string name="filename" value="dust.obj"/>)");
    REQUIRE(dust.size() == 2); // small, too
    CHECK_THAT(dust[1], Catch::StartsWith("scene.xml:4:") && Catch::Contains("no area"));
}

TEST_CASE("Where single precision does not hold is told with its line", "[precision_warnings]") {
    check_one(warnings_of(near, R"(<bsdf type="microfacet"><float name="alpha" value="1e-7"/></bsdf>)"),
              "4:", "alpha 1e-07");
    check_one(warnings_of(near, R"(<bsdf type="phong"><float name="n" value="1e9"/></bsdf>)"), "4:", "n 1e+09");
    check_one(warnings_of(near, R"(</mesh><mesh type="obj"><string name="filename" value="speck.obj"/>)"),
              "4:", "speck.obj is 5.0e-05 of the scene's size");
    check_one(warnings_of(near,
                          R"(<emitter type="area"><color name="radiance" value="1e19 1e19 1e19"/></emitter></mesh>)"
                          R"(<mesh type="parallelogram">
<point name="origin" value="-1 -1 0.5"/><vector name="u" value="2 0 0"/><vector name="v" value="0 2 0"/>)"),
              "3:", "radiance 1.0e+19");
    check_one(warnings_of("0 -1e5 1", ""), "6:", "5e+04 sizes");
}

TEST_CASE("Lights that leave the range of floats in the scene's units are told", "[precision_warnings]") {
    SceneDescription scene;
    Mesh floor;
    floor.shape = Parallelogram{{}, {1e-3, 0, 0}, {0, 1e-3, 0}};
    scene.meshes = {floor};
    const auto warnings_at = [&](double power) {
        scene.lights = {{emitter_point{.position = {}, .power = {0, 0, 0}}, {"a.xml", 6, 1}},
                        {emitter_point{.position = {}, .power = {power, power, power}}, {"a.xml", 7, 3}}};
        return precision_warnings(scene, flatten(scene, 1));
    };
    CHECK(warnings_at(1).empty());
    REQUIRE(warnings_at(1e38).size() == 1);
    CHECK_THAT(warnings_at(1e38)[0], Catch::StartsWith("a.xml:7:3") && Catch::EndsWith("the image is wrong"));
    floor.shape = Parallelogram{{}, {1e3, 0, 0}, {0, 1e3, 0}};
    scene.meshes = {floor};
    REQUIRE(warnings_at(1e-42).size() == 1);
    CHECK_THAT(warnings_at(1e-42)[0], Catch::EndsWith("it emits nothing"));
}
