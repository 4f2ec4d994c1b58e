// The command line: its output, and one clear message with exit code 1 for bad input.
#include "base/command_line.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

using opal::test::Outcome;
using opal::test::run_shell;
using opal::test::ScratchFolder;

namespace {

const std::string opal_binary = OPAL_BINARY;

// A square floor under a light; both are diffuse.
const char *const scene_text = R"(<scene>
  <integrator type="path_mis"/>
  <camera type="perspective"><integer name="width" value="32"/><integer name="height" value="16"/></camera>
  <mesh type="parallelogram">
    <point name="origin" value="-1 -1 5"/><vector name="u" value="2 0 0"/><vector name="v" value="0 2 0"/>
  </mesh>
  <mesh type="parallelogram">
    <point name="origin" value="-1 1 4"/><vector name="u" value="2 0 0"/><vector name="v" value="0 0 1"/>
    <emitter type="area"><color name="radiance" value="1 2 3"/></emitter>
  </mesh>
</scene>
)";

void check_refused(const std::string &arguments, const std::string &reason) {
    const Outcome outcome = run_shell(opal_binary + " " + arguments);
    INFO(arguments << "\n" << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    const size_t message = outcome.err.find("error: ");
    REQUIRE(message != std::string::npos);
    CHECK((message == 0 || outcome.err[message - 1] == '\n')); // after what was said before
    CHECK_THAT(outcome.err.substr(message), Catch::Contains(reason));
    CHECK(outcome.err.find('\n', message) == outcome.err.size() - 1); // one line
}

} // namespace

TEST_CASE("Help and version are printed and succeed", "[commands]") {
    CHECK(run_shell(opal_binary + " --version").out == "opal " OPAL_VERSION "\n");
    for (const char *arguments : {"--help", "devices --help", "inspect --help", "render --help"}) {
        const Outcome outcome = run_shell(opal_binary + " " + arguments);
        CHECK(outcome.exit_code == 0);
        CHECK_THAT(outcome.out, Catch::Contains("Usage: opal"));
        CHECK(outcome.err.empty());
    }
}

TEST_CASE("What is not understood is refused with what there is", "[commands]") {
    check_refused("", "no command given; available: ");
    check_refused("rendre", "unknown command 'rendre'; available: ");
    check_refused("devices --jsno", "--jsno");
    check_refused("inspect", "SCENE.xml");
    check_refused("no-such.xml", "no-such.xml");
}

TEST_CASE("inspect tells what a scene holds and why each feature is in or out", "[commands]") {
    const ScratchFolder folder;
    const std::string inspect = opal_binary + " inspect " + folder.write("scene.xml", scene_text).string();
    const Outcome plain = run_shell(inspect + " --lanes 8 --lighting bsdf --max-depth 7");
    INFO(plain.err);
    REQUIRE(plain.exit_code == 0);
    for (const char *part : {"32 x 16 pixels", "2 diffuse", "1 parallelogram", "2, 4 triangles",
                             "emits 1 2 3 W/(m^2 sr)", "lighting          bsdf", "max-depth         7",
                             "lanes             8\n", "bsdf_diffuse          in ", "bsdf_phong            out "})
        CHECK_THAT(plain.out, Catch::Contains(part));
    const Outcome program = run_shell(inspect + " --cl --lanes 4 --specialise off");
    CHECK_THAT(program.out, Catch::StartsWith("#define LANES 4\n") &&
                                Catch::Contains("#define OPAL_HAS_bsdf_phong 1\n") &&
                                Catch::Contains("#define OPAL_AXIS_lighting -1\n") &&
                                Catch::Contains("#line 1 \"cl/kernels/render.cl\""));
    check_refused("inspect " + (folder / "scene.xml").string() + " --mis balanced",
                  "available: balance, power, one-sample");
    check_refused("inspect " + (folder / "scene.xml").string() + " --cl --cl-dir " + folder.path().string(),
                  "holds no .cl file");
}

TEST_CASE("The command line is kept as a shell would take it", "[commands]") {
    const char *const words[] = {"opal", "render", "a b.xml", "--json=x", "it's", ""};
    opal::set_command_line(6, words);
    CHECK(opal::command_line() == "opal render 'a b.xml' --json=x 'it'\\''s' ''");
}
