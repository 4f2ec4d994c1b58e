// `opal render` as its users meet it: files, statistics, refusals, Ctrl-C.
#include "base/exit_code.h"
#include "base/json.h"
#include "image/image.h"
#include "support/mutants.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <thread>
#include <unistd.h>

using namespace opal;
using namespace opal::test;

namespace {

// A light of radiance (1, 2, 3) that fills the view: the image has that colour, whatever the strategy.
const char *const scene_text = R"(<scene>
  <integrator type="path_mis"/>
  <sampler type="independent"><integer name="sampleCount" value="4"/></sampler>
  <camera type="perspective"><integer name="width" value="24"/><integer name="height" value="12"/></camera>
  <mesh type="parallelogram">
    <point name="origin" value="5 -5 3"/><vector name="u" value="-10 0 0"/><vector name="v" value="0 10 0"/>
    <bsdf type="diffuse"><color name="albedo" value="0 0 0"/></bsdf>
    <emitter type="area"><color name="radiance" value="1 2 3"/></emitter>
  </mesh>
</scene>
)";

struct SceneFolder {
    ScratchFolder scratch;
    std::string scene = scratch.write("plain.xml", scene_text).string();
    std::string render(const std::string &arguments) const {
        return "cd " + scratch.path().string() + " && " + OPAL_BINARY + " " + scene + " " + arguments;
    }
    size_t files() const {
        const std::filesystem::directory_iterator begin(scratch.path());
        return static_cast<size_t>(std::distance(begin, std::filesystem::directory_iterator()));
    }
};

void check_refused(const SceneFolder &folder, const std::string &arguments, const std::string &reason, int code) {
    const Outcome outcome = run_shell(folder.render(arguments));
    INFO(arguments << "\n" << outcome.err);
    CHECK(outcome.exit_code == code);
    CHECK_THAT(outcome.err, Catch::Contains("error: ") && Catch::Contains(reason));
    CHECK(folder.files() == 1); // the scene
}

} // namespace

TEST_CASE("A render leaves EXR and PNG in the current folder, named after the scene", "[render_command]") {
    const SceneFolder folder;
    const Outcome outcome = run_shell(folder.render("--quiet --json stats.json --layers variance"));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK(outcome.err.empty());
    const Image image = read_exr(folder.scratch / "plain.exr");
    CHECK(image.width == 24);
    CHECK(image.height == 12);
    CHECK(image.get("G").values.front() == Approx(2).epsilon(1e-6));
    CHECK(image.get("variance.B").values.front() == Approx(0).margin(1e-9));
    CHECK(std::filesystem::exists(folder.scratch / "plain.png"));
    const auto stats = nlohmann::json::parse(read_text(folder.scratch / "stats.json"));
    for (const char *key :
         {"scene", "device", "driver", "lanes", "strategy", "width", "height", "spp", "seed", "mean_rgb",
          "mean_luminance", "stderr_luminance", "invalid_samples", "samples_per_second", "seconds"})
        CHECK(stats.contains(key));
    for (const char *key : {"load", "bvh", "compile", "render", "write"})
        CHECK(stats["seconds"].contains(key));
    CHECK(stats["mean_rgb"][2].get<double>() == Approx(3).epsilon(1e-6));
    CHECK(stats["spp"] == 4);
    CHECK(stats["invalid_samples"] == 0);
}

TEST_CASE("A black image is told where the scene has lights, and what lets nothing be seen with its line",
          "[render_command]") {
    const SceneFolder folder;
    const auto render = [&](const std::string &from, const std::string &to, const std::string &arguments) {
        std::string text = scene_text;
        text.replace(text.find(from), from.size(), to);
        folder.scratch.write("plain.xml", text);
        const Outcome outcome = run_shell(folder.render("--no-png " + arguments));
        CHECK(outcome.exit_code == 0);
        return outcome.err;
    };
    const std::string black = "plain.xml:1:1: the image is black, although the scene has lights: none of 1152 samples";
    const std::string beside = render("5 -5 3", "50 -5 3", "--quiet");
    CHECK_THAT(beside, Catch::Contains(black) && !Catch::Contains("nearClip"));
    const std::string behind = render("5 -5 3", "5 -5 -3", "--quiet");
    CHECK_THAT(behind, Catch::Contains(black) && Catch::Contains("plain.xml:4:3: the camera sees no mesh") &&
                           Catch::Contains("plain.xml:5:3: the only light faces away"));
    CHECK(render("1 2 3", "0 0 1", "--quiet").empty());
    const std::string count = R"(<integer name="sampleCount" value="4"/>)",
                      note = "plain.xml:3:3: no sampleCount: 1 sample";
    CHECK_THAT(render(count, "", ""), Catch::Contains(note));
    CHECK_THAT(render(count, "", "--spp 2"), !Catch::Contains(note));
    CHECK_THAT(render(count, count, ""), !Catch::Contains(note));
}

TEST_CASE("Size, samples and output are the command line's where given", "[render_command]") {
    const SceneFolder folder;
    REQUIRE(run_shell(folder.render("-o out.exr --no-png --width 8 --spp 1 --lanes 1")).exit_code == 0);
    CHECK(read_exr(folder.scratch / "out.exr").height == 4); // the scene's aspect
    CHECK(folder.files() == 2);
}

TEST_CASE("The values of -D stand in the image and in the JSON", "[render_command]") {
    const SceneFolder folder;
    std::string text = read_text(folder.scratch / "plain.xml");
    REQUIRE(text.find("value=\"24\"") != std::string::npos);
    text.replace(text.find("value=\"24\""), 10, "value=\"$w\"");
    folder.scratch.write("plain.xml", text);
    REQUIRE(run_shell(folder.render("-Dw=16 -o out.exr --json out.json --no-png --spp 1")).exit_code == 0);
    const Image image = read_exr(folder.scratch / "out.exr");
    CHECK((image.width == 16 && image.text("opal.definitions") == "{\"w\":\"16\"}"));
    CHECK(nlohmann::json::parse(read_text(folder.scratch / "out.json"))["definitions"]["w"] == "16");
    CHECK(run_shell(folder.render("-D w=16 -D v=1")).exit_code == exit_usage);
    CHECK(run_shell(folder.render("-D w")).exit_code == exit_usage);
    CHECK(run_shell(folder.render("")).exit_code == exit_failed);
}

TEST_CASE("--threads bounds the threads of a CPU device, and changes no bit", "[render_command]") {
    const SceneFolder folder;
    const Outcome one = run_shell(folder.render("--threads 1 -o one.exr --no-png"));
    INFO(one.err);
    REQUIRE(one.exit_code == 0);
    CHECK_THAT(one.err, Catch::Contains("1 thread"));
    REQUIRE(run_shell(folder.render("-o all.exr --no-png")).exit_code == 0);
    CHECK(read_exr(folder.scratch / "one.exr").get("G").values == read_exr(folder.scratch / "all.exr").get("G").values);
    const Outcome many = run_shell(folder.render("--threads 60000"));
    CHECK(many.exit_code == exit_usage);
    CHECK_THAT(many.err, Catch::Contains("--threads: 60000 is out of range; "));
}

TEST_CASE("What cannot be rendered or written is refused, and nothing is left behind", "[render_command]") {
    const SceneFolder folder;
    check_refused(folder, "--spp 0", "--spp", exit_usage);
    check_refused(folder, "--width 0", "--width", exit_usage);
    check_refused(folder, "--device 99", "no OpenCL device \"99\"; available: 0 (", exit_failed);
    check_refused(folder, "-o none/out.exr", "there is no folder none", exit_failed);
    check_refused(folder, "-o out.jpg", "-o out.jpg: the ending '.jpg' names no format of Opal's; possible: FILE.exr",
                  exit_usage);
    check_refused(folder, "-o out", "-o out: the ending is missing; possible: FILE.exr", exit_usage);
    check_refused(folder, "--crop 18,0,7,4", "--crop 18,0,7,4: is no part of the image of 24 x 12 pixels", exit_failed);
    check_refused(folder, "--crop 0,0,0,4", "is no part of the image", exit_failed);
    check_refused(folder, "--crop -1,0,4,4", "is no part of the image", exit_failed);
    check_refused(folder, "--crop 1,2,3", "--crop 1,2,3: wants X,Y,W,H", exit_usage);
    check_refused(folder, "--crop 1,2,3,x", "--crop 1,2,3,x: ", exit_usage);
    check_refused(folder, "-o - --json -", "-o - and --json -: stdout takes one of them", exit_usage);
    check_refused(folder, "-o out.png --no-png", "nothing would be written", exit_usage);
    check_refused(folder, "-o out.png --layers variance", "a PNG holds no layers", exit_usage);
    check_refused(folder, "--no-png --exposure 1", "they shape the PNG, and none is written", exit_usage);
    check_refused(folder, folder.scene, "2 scenes: their images need a folder, -o FOLDER/", exit_usage);
    check_refused(folder, folder.scene + " -o out/", "both images would be out/plain.exr", exit_usage);
    check_refused(folder, "--no-png -o /dev/full", "No space left on device", exit_failed);
    check_refused(folder, "--width 65535 --height 65535",
                  "an image of 65535 x 65535 pixels: possible are 1.432e+09 pixels at the most", exit_failed);
    check_refused(folder, "--lanes 3", "unknown lanes '3'; available: auto, 1, 4, 8, 16", exit_usage);
    check_refused(folder, "--lighting bsdf --mis one-sample", "makes no sense", exit_failed);
}

TEST_CASE("The ending of -o says what is written", "[render_command]") {
    const SceneFolder folder;
    REQUIRE(run_shell(folder.render("-o out.PNG --exposure -1")).exit_code == 0);
    CHECK(std::filesystem::exists(folder.scratch / "out.PNG"));
    CHECK(folder.files() == 2);
    REQUIRE(run_shell(folder.render("-o - --quiet >stdout.exr")).exit_code == 0);
    CHECK(read_exr(folder.scratch / "stdout.exr").get("G").values.front() == Approx(2).epsilon(1e-6));
    CHECK(folder.files() == 3);
    const Outcome full = run_shell(folder.render("-o - >/dev/full"));
    CHECK(full.exit_code == 1);
    CHECK_THAT(full.err, Catch::Contains("error: stdout: cannot be written: No space left on device"));
    CHECK(run_shell(folder.render("-o /dev/null")).exit_code == 0);
    CHECK(folder.files() == 3);
}

TEST_CASE("A crop is a part of the image, and the file and the statistics say which", "[render_command]") {
    const SceneFolder folder;
    REQUIRE(run_shell(folder.render("--no-png -o whole.exr --width 48")).exit_code == 0);
    const Outcome outcome =
        run_shell(folder.render("--no-png -o part.exr --width 48 --crop 30,10,7,5 --json part.json"));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK_THAT(outcome.err, Catch::Contains("7 x 5 at (30, 10) of 48 x 24 pixels"));
    const Image whole = read_exr(folder.scratch / "whole.exr"), part = read_exr(folder.scratch / "part.exr");
    CHECK(part.crop == Crop{30, 10, 7, 5, 48, 24});
    CHECK(part.get("G").values == cropped(whole, part.crop).get("G").values);
    const auto stats = nlohmann::json::parse(read_text(folder.scratch / "part.json"));
    CHECK(stats["width"] == 7);
    CHECK(stats["spp"] == 4);
    CHECK(stats["crop"]["y"] == 10);
    CHECK(stats["crop"]["of_width"] == 48);
}

TEST_CASE("Several scenes go into one folder, and one that fails does not stop the others", "[render_command]") {
    const SceneFolder folder;
    std::string broken = scene_text, thin = scene_text;
    folder.scratch.write("broken.xml", broken.replace(broken.find("parallelogram"), 13, "parallelgram"));
    folder.scratch.write("black.v2.xml", thin.replace(thin.find("5 -5 3"), 6, "50 -5 3"));
    folder.scratch.write("third.xml", scene_text);
    const Outcome outcome = run_shell(folder.render("broken.xml black.v2.xml third.xml -o out/"));
    INFO(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::Contains("unknown mesh type 'parallelgram'") &&
                                Catch::Contains("error: 1 of 4 scenes failed: broken.xml"));
    for (const char *name : {"plain", "black.v2", "third"})
        for (const char *ending : {".exr", ".png"})
            CHECK(std::filesystem::exists(folder.scratch / "out" / (std::string(name) + ending)));
    CHECK_FALSE(std::filesystem::exists(folder.scratch / "out/broken.exr"));
    // The warning of one scene is not in the header of the next.
    CHECK_THAT(read_exr(folder.scratch / "out/black.v2.exr").text("opal.warnings"), Catch::Contains("black"));
    CHECK(read_exr(folder.scratch / "out/third.exr").text("opal.warnings") == "[]");
}

TEST_CASE("A message that cannot be printed costs neither image nor JSON", "[render_command]") {
    for (const char *streams : {"2>/dev/full", "2>&-", ">/dev/full", ">&-", "<&- >&- 2>&-", "2>&1 | true"}) {
        INFO(streams);
        const SceneFolder folder;
        CHECK(run_shell(folder.render(std::string("--json stats.json ") + streams)).exit_code == 0);
        CHECK(folder.files() == 4); // with the scene, and nothing else
        CHECK(read_exr(folder.scratch / "plain.exr").get("R").values.front() == Approx(1).epsilon(1e-6));
        CHECK(nlohmann::json::parse(read_text(folder.scratch / "stats.json"))["spp"] == 4);
    }
}

TEST_CASE("Names of any bytes keep the image and the JSON", "[render_command]") {
    SceneFolder folder;
    folder.scratch.write(
        "k\344se.obj",
        "v -1 -1 4\nv 1 -1 4\nv 0 1 4\nf 1 2 3\nf 1 1 2\n"); // the second has no area: a warning names it
    std::string text = scene_text;
    text.insert(text.find("</scene>"), "<mesh type=\"obj\"><string name=\"filename\" value=\"k\344se.obj\"/></mesh>\n");
    folder.scene = folder.scratch.write("sz\344ne.xml", text);
    const Outcome outcome = run_shell(folder.render("-o b\344r.exr --json stats.json"));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const auto stats = nlohmann::json::parse(read_text(folder.scratch / "stats.json"));
    CHECK_THAT(stats["scene"].get<std::string>(), Catch::EndsWith("sz\\xe4ne.xml"));
    CHECK_THAT(stats["warnings"][0].get<std::string>(), Catch::Contains("k\\xe4se.obj:5:1: dropped 1 triangles"));
    const Image image = read_exr(folder.scratch / "b\344r.exr");
    CHECK(image.text("opal.scene") == stats["scene"].get<std::string>());
    CHECK(image.text("opal.dialect") == "upstream");
    CHECK_THAT(image.text("opal.warnings"), Catch::Contains("k\\\\xe4se.obj"));
}

TEST_CASE("A line tells that files are being written where that takes long", "[render_command]") {
    const SceneFolder folder;
    const std::string pipe = folder.scratch / "pipe"; // which nobody reads for three seconds
    const std::filesystem::path copy = folder.scratch / "copy.exr";
    const Outcome outcome = run_shell("mkfifo " + pipe + "; ( sleep 3; cat " + pipe + " >" + copy.string() + " ) & " +
                                      folder.render("-o " + pipe) + " && wait");
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK_THAT(outcome.err, Catch::Contains("writing 1 s\n"));
    CHECK(read_exr(copy).get("B").values.front() == Approx(3).epsilon(1e-6));
}

TEST_CASE("Ctrl-C writes what there is and exits with a code of its own", "[render_command]") {
    const SceneFolder folder;
    const std::string started = folder.scratch / "started";
    // The shell tells its process id, then becomes opal.
    const std::string command = "echo $$ >" + started + ".tmp && mv " + started + ".tmp " + started + " && exec " +
                                OPAL_BINARY + " " + folder.scene + " --spp 1000000000 -o " +
                                (folder.scratch / "out.exr").string();
    Outcome outcome;
    std::thread render([&] { outcome = run_shell("sh -c '" + command + "'"); });
    while (!std::filesystem::exists(started))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const pid_t process = std::stoi(read_text(started));
    // Before rendering has begun an interrupt ends the process at once.
    std::this_thread::sleep_for(std::chrono::seconds(5));
    kill(process, SIGINT);
    render.join();
    CHECK(outcome.exit_code == 130);
    CHECK_THAT(outcome.err, Catch::Contains("warning: interrupted: the image holds "));
    CHECK(read_exr(folder.scratch / "out.exr").get("R").values.front() == Approx(1).epsilon(1e-4));
}

TEST_CASE("What a driver remarks on the kernels is no error, and told by --verbose", "[render_command]") {
    const SceneFolder folder;
    const ScratchFolder kernels;
    // PoCL caches a build with its remarks, by the text without directives: the typedef makes that text a new one.
    const std::string remark = "a remark of the test";
    Sources sources = Sources::embedded();
    sources.files["kernels/render.cl"].insert(0, "#warning " + remark + "\ntypedef int a_remark_of_the_test;\n");
    const std::string arguments = "--no-png --cl-dir " + write_kernels(kernels, sources);
    const Outcome told = run_shell("export OPAL_KERNEL_FLAGS= && " + folder.render("--verbose " + arguments));
    INFO(told.err);
    CHECK(told.exit_code == 0);
    CHECK_THAT(told.err, Catch::Contains(remark) && Catch::Contains("-cl-std=CL1.2"));
    const Outcome plain = run_shell("export OPAL_KERNEL_FLAGS= && " + folder.render(arguments));
    CHECK(plain.exit_code == 0);
    CHECK_THAT(plain.err, !Catch::Contains(remark));
    const Outcome strict = run_shell(folder.render(arguments));
    CHECK(strict.exit_code == 1);
    CHECK_THAT(strict.err, Catch::Contains(remark) && Catch::Contains("the kernels do not build"));
}

TEST_CASE("Fast math warns where its functions are coarse, and only there", "[render_command]") {
    const SceneFolder folder;
    const auto warned = [](const Outcome &outcome) {
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
        return outcome.err.find("warning: --math fast: ") != std::string::npos;
    };
    CHECK_FALSE(warned(run_shell(folder.render("--math fast"))));
    const ScratchFolder kernels;
    const std::string coarse =
        " --cl-dir " + write_kernels(kernels, {"exp off by 0.05 %", "kernels/selftest_list.h", "MATH(exp, exp(x)",
                                               "MATH(exp, exp(x) * (real)(1.0005)"});
    const Outcome fast = run_shell(folder.render("--math fast" + coarse));
    CHECK(warned(fast));
    CHECK_THAT(fast.err, Catch::Contains("error of exp, ulp") && !Catch::Contains("error of log"));
    CHECK_FALSE(warned(run_shell(folder.render("--math precise" + coarse))));
}
