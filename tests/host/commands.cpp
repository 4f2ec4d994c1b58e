// The command line: its output, and one clear message for bad input, with exit code 2 where the command line is wrong
// and 1 else.
#include "base/command_line.h"
#include "base/exit_code.h"
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

void check_refused(const std::string &arguments, const std::string &reason, int code = opal::exit_usage) {
    const Outcome outcome = run_shell(opal_binary + " " + arguments);
    INFO(arguments << "\n" << outcome.out << outcome.err);
    CHECK(outcome.exit_code == code);
    const size_t message = outcome.err.find("error: ");
    REQUIRE(message != std::string::npos);
    CHECK((message == 0 || outcome.err[message - 1] == '\n')); // after what was said before
    CHECK_THAT(outcome.err.substr(message), Catch::Contains(reason));
    CHECK(outcome.err.find('\n', message) == outcome.err.size() - 1); // one line
}

} // namespace

TEST_CASE("Help and version are printed and succeed", "[commands]") {
    CHECK(run_shell(opal_binary + " --version").out == "opal " OPAL_VERSION "\n");
    CHECK(run_shell(opal_binary + " -V").out == "opal " OPAL_VERSION "\n");
    for (const char *arguments : {"--help", "devices --help", "inspect -h", "render scene.xml --help", "help",
                                  "help render", "help bench rays"}) {
        const Outcome outcome = run_shell(opal_binary + " " + arguments);
        CHECK(outcome.exit_code == 0);
        CHECK_THAT(outcome.out, Catch::Contains("Usage: opal"));
        CHECK(outcome.err.empty());
    }
}

TEST_CASE("What is not understood is refused with what there is, and with what was meant", "[commands]") {
    const ScratchFolder folder;
    const std::string scene = folder.write("scene.xml", scene_text);
    check_refused("rendr", "unknown command 'rendr'; did you mean 'render'? available: ");
    check_refused("bench ray " + scene, "did you mean 'rays'?");
    check_refused("bench", "opal bench needs a command: rays, render");
    check_refused("help rendr", "did you mean 'render'?");
    check_refused("devices --jsno", "unknown flag '--jsno' of opal devices; did you mean '--json'?");
    check_refused(scene + " --ssp 4", "did you mean '--spp'?");
    check_refused(scene + " --samp 4", "unknown flag '--samp'");
    check_refused(scene + " --spp abc", "--spp: 'abc' is no whole number; possible: 1 to 4294967295");
    check_refused(scene + " --spp 16k", "--spp: '16k' is no whole number; did you mean 16000? possible: ");
    check_refused(scene + " --spp 0", "--spp: 0 is out of range; possible: 1 to 4294967295");
    check_refused(scene + " --spp", "--spp needs a value");
    check_refused(scene + " --spp --no-png", "--spp needs a value");
    check_refused(scene + " --spp 1 --spp 2", "--spp is given twice");
    check_refused(scene + " --no-png=1", "--no-png takes no value");
    check_refused(scene + " --time soon", "--time: 'soon' is no duration");
    check_refused(scene + " --lighting nee", "--lighting: unknown lighting 'nee'; did you mean 'emitter'?");
    check_refused(scene + " --integrator path_tracer",
                  "--integrator: unknown integrator 'path_tracer'; did you mean 'path'?");
    check_refused(scene + " --sampler indep", "did you mean 'independent'?");
    check_refused(scene + " more", "2 scenes: their images need a folder");
    check_refused("inspect", "opal inspect needs SCENE.xml");
    check_refused("no-such.xml", "no-such.xml", opal::exit_failed);
}

TEST_CASE("opal alone shows where to begin, and is no success", "[commands]") {
    const Outcome outcome = run_shell(opal_binary);
    CHECK(outcome.exit_code == opal::exit_usage);
    CHECK(outcome.out.empty());
    CHECK_THAT(outcome.err, Catch::Contains("opal scenes/cbox_mis.xml") && Catch::Contains("opal --help"));
}

TEST_CASE("version says what the binary is made of", "[commands]") {
    const Outcome outcome = run_shell("cd / && " + opal_binary + " version");
    CHECK(outcome.exit_code == 0);
    for (const char *part :
         {"opal " OPAL_VERSION "\n", "commit  ", "compiler  ", "OpenEXR  ", "OpenCL loader  /", "OpenCL driver  "})
        CHECK_THAT(outcome.out, Catch::Contains(part));
}

TEST_CASE("The manual page and the completions name every command and flag", "[commands]") {
    const Outcome man = run_shell(opal_binary + " man"), bash = run_shell(opal_binary + " completion bash"),
                  zsh = run_shell(opal_binary + " completion zsh");
    CHECK((man.exit_code == 0 && bash.exit_code == 0 && zsh.exit_code == 0));
    for (const char *name : {"render", "selftest", "completion"})
        for (const Outcome *text : {&man, &bash, &zsh})
            CHECK_THAT(text->out, Catch::Contains(name));
    CHECK_THAT(man.out, Catch::Contains(".SH EXIT STATUS") && Catch::Contains("\\-\\-emitter\\-choice"));
    const ScratchFolder folder;
    const std::string file = folder.write("opal.bash", bash.out);
    const auto completed = [&](const std::string &words) { // the last word is being typed
        const Outcome outcome = run_shell("bash -c '. " + file + "; COMP_WORDS=(" + words +
                                          "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _opal; echo \"${COMPREPLY[*]}\"'");
        return outcome.out;
    };
    CHECK(completed("opal rend") == "render\n");
    CHECK(completed("opal render --tar") == "--target-error\n");
    CHECK(completed("opal bench ra") == "rays\n");
    CHECK(completed("opal bench rays a.xml --kind bo") == "bounce\n");
    CHECK(completed("opal a.xml --lighting em") == "emitter\n");
}

TEST_CASE("The manual page is right roff", "[commands]") {
    const ScratchFolder folder;
    const std::string page = folder.write("opal.1", run_shell(opal_binary + " man").out);
    const Outcome outcome = run_shell("command -v groff >/dev/null || exit 0; groff -man -Tutf8 -ww " + page);
    CHECK(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
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
                  "holds no .cl file", opal::exit_failed);
}

TEST_CASE("inspect tells the textures of materials and lights, and BSDFs within others", "[commands]") {
    const ScratchFolder folder;
    const std::string scene = folder.write("scene.xml", R"(<scene version="3.0.0">
  <shape type="rectangle"><bsdf type="mask"><float name="opacity" value="0.25"/>
    <bsdf type="twosided">
      <bsdf type="diffuse"><texture name="reflectance" type="checkerboard"/></bsdf><bsdf type="conductor"/>
    </bsdf></bsdf></shape>
  <emitter type="spot"><texture name="texture" type="checkerboard"/></emitter></scene>)");
    const Outcome outcome = run_shell(opal_binary + " inspect " + scene);
    INFO(outcome.err);
    CHECK_THAT(outcome.out, Catch::Contains("mask, opacity 0.25 (twosided (diffuse, albedo 1 1 1 times a checkerboard "
                                            "of 0.4 0.4 0.4 and 0.2 0.2 0.2; mirror))\n") &&
                                Catch::Contains("smooth false times a checkerboard of 0.4 0.4 0.4 and 0.2 0.2 0.2\n"));
}

TEST_CASE("The command line is kept as a shell would take it", "[commands]") {
    const char *const words[] = {"opal", "render", "a b.xml", "--json=x", "it's", ""};
    opal::set_command_line(6, words);
    CHECK(opal::command_line() == "opal render 'a b.xml' --json=x 'it'\\''s' ''");
}
