// The memory that a whole render takes.
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>

using namespace opal::test;

namespace {

// A hilly field of 2 * side * side triangles in quadrilaterals, as an OBJ file.
std::string field(int side) {
    std::string text;
    for (int y = 0; y <= side; y++)
        for (int x = 0; x <= side; x++) {
            const double u = 2.0 * x / side - 1, v = 2.0 * y / side - 1;
            text += fmt::format("v {:.7g} {:.7g} {:.7g}\n", u, v, 0.1 * std::sin(37 * u) * std::cos(53 * v));
        }
    for (int y = 0; y < side; y++)
        for (int x = 1; x <= side; x++) {
            const int a = y * (side + 1) + x, b = a + side + 1;
            text += fmt::format("f {} {} {} {}\n", a, a + 1, b + 1, b);
        }
    return text;
}

} // namespace

TEST_CASE("A render of a million triangles takes at most 110 bytes for each", "[memory][alone]") {
    const ScratchFolder folder;
    // The peak of a render of the field, in bytes. The first render compiles.
    const auto peak = [&](int side) {
        folder.write("field.obj", field(side));
        folder.write("field.xml",
                     R"(<scene><integrator type="path_mis"/>
  <camera type="perspective"><transform name="toWorld"><lookat origin="0 -1 2.5" target="0 0 0" up="0 1 0"/></transform>
    <float name="fov" value="40"/><integer name="width" value="64"/><integer name="height" value="64"/></camera>
  <mesh type="obj"><string name="filename" value="field.obj"/></mesh>
  <mesh type="parallelogram"><point name="origin" value="-1 -1 3"/><vector name="u" value="0 2 0"/>
    <vector name="v" value="2 0 0"/><emitter type="area"><color name="radiance" value="3 3 3"/></emitter></mesh>
</scene>)");
        const std::vector<std::string> render{"render",   folder / "field.xml", "--spp",    "1",
                                              "--device", wanted_device(),      "--no-png", "--quiet",
                                              "-o",       folder / "field.exr"};
        peak_bytes_of_opal(render);
        return peak_bytes_of_opal(render);
    };
    constexpr int side = 708; // 1 002 528 triangles
    const double bytes = (peak(side) - peak(8)) / (2.0 * side * side);
    INFO(bytes << " bytes a triangle");
    CHECK(bytes <= 110);
    CHECK(bytes > 60); // the tree alone: else this measures nothing
}

TEST_CASE("A render of 1920 x 1080 pixels takes at most 124 bytes for each, whatever its filter", "[memory][alone]") {
    const ScratchFolder folder;
    const std::string box = OPAL_SOURCE_DIR "/scenes/cbox_mis.xml";
    std::string gaussian = read_text(box);
    const std::string filter = "type=\"box\"";
    REQUIRE(gaussian.find(filter) != std::string::npos);
    gaussian.replace(gaussian.find(filter), filter.size(), "type=\"gaussian\"");
    std::filesystem::create_directory_symlink(OPAL_SOURCE_DIR "/scenes/meshes", folder / "meshes");
    for (const std::string &scene : {box, folder.write("gaussian.xml", gaussian).string()}) {
        const auto peak = [&](int width, int height) {
            return peak_bytes_of_opal({"render", scene, "--width", std::to_string(width), "--height",
                                       std::to_string(height), "--spp", "6", "--device", wanted_device(), "--quiet",
                                       "-o", folder / "out.exr"});
        };
        peak(16, 16); // compiles
        const double bytes = (peak(1920, 1080) - peak(16, 16)) / (1920.0 * 1080);
        INFO(scene << ": " << bytes << " bytes a pixel");
        CHECK(bytes <= 124);
        CHECK(bytes > 60); // the film alone: else this measures nothing
    }
}

TEST_CASE("What does not fit into memory is told before it is begun", "[memory][alone]") {
    const ScratchFolder folder;
    const std::string exr = folder / "large.exr", box = OPAL_SOURCE_DIR "/scenes/cbox_mis.xml";
    const std::string opal = " '" OPAL_BINARY "' ";
    SECTION("an image, under ulimit -v") {
        const Outcome outcome = run_shell("ulimit -v 3000000; timeout 60" + opal + box +
                                          " --width 8000 --height 8000 --spp 1 --device cpu -o '" + exr + "'");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains("error: an image of 8000 x 8000 pixels: about ") &&
                                    Catch::Contains(" are left (ulimit -v or -d)"));
    }
    SECTION("an image that fits under ulimit -v") {
        const Outcome outcome =
            run_shell("ulimit -v 3000000; timeout 60" + opal + box +
                      " --width 3300 --height 3300 --time 0.1s --device cpu --no-png -o '" + exr + "'");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
    }
    SECTION("an image of more pixels than kernels count") {
        const Outcome outcome = run_shell("timeout 60" + opal + box + " --width 65535 --height 65535 -o '" + exr + "'");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains("possible are 1.432e+09 pixels at the most"));
    }
    SECTION("a tree") {
        folder.write("field.obj", field(708));
        const std::string scene =
            folder.write("field.xml", "<scene><camera type='perspective'/><mesh type='obj'><string name='filename' "
                                      "value='field.obj'/></mesh></scene>");
        const Outcome outcome = run_shell("ulimit -v 180000; timeout 60" + opal + "inspect '" + scene + "'");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains("the tree of 1002528 triangles: about "));
    }
}
