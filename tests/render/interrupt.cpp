// Ctrl-C: the binary writes the image so far, tells how many samples it has, and exits with a code of its own.
#include "base/json.h"
#include "base/signals.h"
#include "image/image.h"
#include "support/device.h"
#include "support/scratch.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <fstream>
#include <thread>
#include <unistd.h>

using namespace opal;
using namespace opal::test;

namespace {

// CPU seconds that all threads of a process have taken.
double cpu_seconds(const std::string &process) {
    std::ifstream stat("/proc/" + process + "/stat");
    std::string word;
    double ticks = 0;
    for (int field = 1; field <= 15 && stat >> word; field++) // proc(5): 14 utime, 15 stime; "(opal)" is one word
        ticks += field >= 14 ? std::stod(word) : 0;
    return ticks / double(sysconf(_SC_CLK_TCK));
}

// Runs a render and sends it SIGINT when it has taken that many CPU seconds.
Outcome interrupted_after(double seconds, const ScratchFolder &folder, const std::string &arguments) {
    const std::string started = folder / "started";
    Outcome outcome;
    std::thread render([&] { // the shell tells its process id, then becomes opal
        outcome = run_shell("sh -c 'echo $$ >" + started + ".new && mv " + started + ".new " + started +
                            " && exec " OPAL_BINARY " render " + arguments + "'");
    });
    while (!std::filesystem::exists(started))
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    const std::string process = std::to_string(std::stoi(read_text(started)));
    while (cpu_seconds(process) < seconds && std::filesystem::exists("/proc/" + process))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(std::stoi(process), SIGINT);
    render.join();
    return outcome;
}

} // namespace

TEST_CASE("An interrupted first pass tells of the pixels without a sample, and claims nothing of them",
          "[interrupt][alone]") {
    if (device().info.type == "gpu") {
        WARN("not tested: one launch holds the whole image here");
        return;
    }
    // 32 launches of long paths, some 20 CPU seconds. The kernel is compiled before, so that CPU time is rendering.
    const std::string render = OPAL_SOURCE_DIR "/scenes/furnace.xml --specialise on --rr off --max-depth 100 --no-png";
    REQUIRE(run_shell(OPAL_BINARY " " + render + " --width 8 --spp 1 -o /dev/null").exit_code == 0);
    for (const std::string rule : {"", " --target-error 10%", " --time 1h"}) {
        INFO(rule);
        const ScratchFolder folder;
        const std::string exr = folder / "out.exr", json = folder / "out.json";
        const Outcome outcome = interrupted_after(
            2, folder, render + " --width 1024 --height 1024 --spp 1000 -o " + exr + " --json " + json + rule);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 130);
        CHECK_THAT(outcome.err, Catch::Contains(" of 1048576 pixels (") && Catch::Contains(" have no sample"));
        CHECK_THAT(outcome.err, !Catch::Contains("+-") && !Catch::Contains("confidence"));
        const nlohmann::json report = nlohmann::json::parse(read_text(json));
        CHECK(report["empty_pixels"] > 0);
        CHECK(report["stderr_luminance"].is_null());
        CHECK(report["mean_luminance"].get<double>() == Approx(0.5).epsilon(0.05));
        CHECK(read_exr(exr).text("opal.empty_pixels") == report["empty_pixels"].dump());
        if (!rule.empty()) {
            CHECK(report["stop"]["mean_luminance_interval"].is_null());
            CHECK(report["stop"]["relative_error"].is_null());
        }
        if (report.contains("stop") && report["stop"]["rule"] == "target-error")
            CHECK(report["stop"]["met"] == false);
    }
}

TEST_CASE("An interrupted render leaves an image of the samples it finished", "[interrupt][alone]") {
    const auto [signal, code] = GENERATE(std::pair("INT", 130), std::pair("TERM", 143), std::pair("HUP", 129));
    const ScratchFolder folder;
    const std::string exr = folder / "out.exr", said = folder / "said.txt";
    // The shell interrupts Opal once its progress shows that it renders, and kills it should it not end. A shell's
    // background job ignores SIGINT unless it asks for it, as Opal does. Signals that come at once are one, as those
    // of `timeout`, which signals its command and then its process group.
    const Outcome outcome = run_shell("timeout -k 1 120 " OPAL_BINARY " render " OPAL_SOURCE_DIR
                                      "/scenes/furnace.xml --width 64 --height 64 --spp 100000000 --no-png -o " +
                                      exr + " > " + said +
                                      " 2>&1 & job=$!\n"
                                      "for i in $(seq 600); do grep -q '^render' " +
                                      said +
                                      " && break; sleep 0.1; done\n"
                                      "for i in 1 2; do pkill -" +
                                      std::string(signal) + " -P $job; done; wait $job; exit $?");
    INFO(read_text(said));
    CHECK(outcome.exit_code == code);
    CHECK_THAT(read_text(said),
               Catch::Contains("interrupted: the image holds") && Catch::Contains("of 100000000 samples a pixel"));
    const Image image = read_exr(exr);
    CHECK(image.width == 64);
    CHECK(image.text("opal.interrupted") == "true");
    CHECK(image.text("opal.asked_spp") == "100000000");
    CHECK(image.text("opal.invalid_samples") == "0");
    const double spp = image.number("opal.spp");
    CHECK(spp > 1);
    CHECK(spp < 1e8);
    double mean = 0;
    for (float value : image.get("G").values)
        mean += double(value) / double(image.get("G").values.size());
    CHECK(mean == Approx(0.5).epsilon(0.05));
}

TEST_CASE("Under nohup a closed terminal stops nothing", "[interrupt][alone]") {
    const ScratchFolder folder;
    const std::string exr = folder / "out.exr", said = folder / "said.txt";
    // Without `timeout`, which would take the signal's ignoring from Opal.
    const Outcome outcome = run_shell("trap '' HUP; " OPAL_BINARY " render " OPAL_SOURCE_DIR
                                      "/scenes/furnace.xml --width 64 --height 64 --time 1s --no-png -o " +
                                      exr + " > " + said +
                                      " 2>&1 & job=$!\n"
                                      "while kill -HUP $job 2>/dev/null; do sleep 0.1; done\n"
                                      "wait $job; exit $?");
    INFO(read_text(said));
    CHECK(outcome.exit_code == 0);
    CHECK(read_exr(exr).text("opal.interrupted") == "false");
}
