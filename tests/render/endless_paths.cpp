// Paths that lose no energy must end, too: Russian roulette never lets a path survive for certain. Where nothing ends
// them, they go on from launch to launch, and the user ends the render.
#include "image/image.h"
#include "support/device.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/scratch.h"

using namespace opal;
using namespace opal::test;

namespace {

std::string parallelogram(const std::string &origin, const std::string &u, const std::string &v,
                          const std::string &rest) {
    return "<mesh type='parallelogram'><point name='origin' value='" + origin + "'/><vector name='u' value='" + u +
           "'/><vector name='v' value='" + v + "'/>" + rest + "</mesh>\n";
}

// A closed box of mirrors over [-1, 1]^3, the camera inside, a lamp outside.
std::string mirror_box() {
    std::string mirror = "<bsdf type='mirror'/>";
    return "<scene><integrator type='path_tracer_recursive'/>\n"
           "<sampler type='independent'><integer name='sampleCount' value='2'/></sampler>\n"
           "<camera type='perspective'><integer name='width' value='8'/><integer name='height' value='8'/></camera>\n" +
           parallelogram("-1 -1 -1", "2 0 0", "0 2 0", mirror) + parallelogram("-1 -1 1", "0 2 0", "2 0 0", mirror) +
           parallelogram("-1 -1 -1", "0 2 0", "0 0 2", mirror) + parallelogram("1 -1 -1", "0 0 2", "0 2 0", mirror) +
           parallelogram("-1 -1 -1", "0 0 2", "2 0 0", mirror) + parallelogram("-1 1 -1", "2 0 0", "0 0 2", mirror) +
           parallelogram("5 5 5", "1 0 0", "0 1 0",
                         "<emitter type='area'><color name='radiance' value='1 1 1'/></emitter>") +
           "</scene>\n";
}

} // namespace

TEST_CASE("A path between mirrors ends by roulette", "[endless_paths]") {
    ScratchFolder folder;
    auto scene = folder.write("mirrors.xml", mirror_box());
    for (const std::string rr : {"throughput", "throughput-eta"}) {
        INFO(rr);
        Outcome run = run_shell("timeout 120 '" OPAL_BINARY "' render '" + scene.string() + "' --quiet --no-png --rr " +
                                rr + " --json '" + (folder / "mirrors.json").string() + "' -o '" +
                                (folder / "mirrors.exr").string() + "'");
        INFO(run.err);
        REQUIRE(run.exit_code == 0);
        CHECK(read_text(folder / "mirrors.json").find("\"mean_luminance\": 0.0,") !=
              std::string::npos); // no light leaks in
    }
}

TEST_CASE("Paths that go on from launch to launch give the same bits", "[endless_paths]") {
    const SceneDescription scene =
        with_strategy(gallery(40, 30), {{"integrator", "path"}, {"rr", "off"}, {"max-depth", "none"}});
    for (const int lanes : {1, 8})
        for (const MathMode math : {MathMode::precise, MathMode::double_precision})
            for (const Specialise specialise : {Specialise::on, Specialise::off}) {
                if (math == MathMode::double_precision && !device().info.fp64)
                    continue;
                INFO(lanes << " lanes, math " << int(math) << ", general " << (specialise == Specialise::off));
                SceneDescription endless = scene;
                endless.strategy.specialise = specialise;
                REQUIRE(flatten(endless, lanes).features[FEATURE_endless_paths]);
                RenderSetup setup{.lanes = lanes, .max_pass_samples = 1, .math = math};
                setup.launch_seconds = 1000;
                const Film whole = render(endless, 16, 5, setup);
                setup.launch_seconds = 1e-9; // the least rounds that a launch can have
                const Film parts = render(endless, 16, 5, setup);
                CHECK(whole.sum == parts.sum);
                CHECK(whole.squares == parts.squares);
                CHECK(whole.count == parts.count);
                if (math == MathMode::precise) {         // in double the two programs round differently
                    endless.strategy.max_depth = 10'000; // no path is that long, and no launch ends early
                    REQUIRE_FALSE(flatten(endless, lanes).features[FEATURE_endless_paths]);
                    CHECK(whole.sum == render(endless, 16, 5, {.lanes = lanes}).sum);
                }
            }
}

TEST_CASE("A render whose paths never end keeps to its time and to one Ctrl-C", "[endless_paths]") {
    ScratchFolder folder;
    const std::string scene = folder.write("mirrors.xml", mirror_box()), exr = folder / "mirrors.exr",
                      said = folder / "said.txt";
    for (const std::string ends : {"--rr off", "--rr fixed --rr-prob 1", "--rr off --max-depth 2000000000",
                                   "--rr throughput --rr-depth 2000000000"})
        for (const std::string kernel : {"on", "off"}) {
            INFO(ends << ", --specialise " << kernel);
            const std::string render = " '" OPAL_BINARY "' render '" + scene + "' --no-png " + ends + " --specialise " +
                                       kernel + " -o '" + exr + "'";
            const Outcome timed = run_shell("timeout 60" + render + " --quiet --time 0.2s");
            INFO(timed.err);
            CHECK(timed.exit_code == 1);
            CHECK_THAT(timed.err, Catch::Contains("no sample was finished in the time"));
            CHECK(read_exr(exr).number("opal.empty_pixels") == 64);
            std::filesystem::remove(exr);
            std::filesystem::remove(said); // of the run before
            // The shell interrupts Opal once its progress shows that it renders, and kills it should it not end.
            const Outcome stopped = run_shell("timeout -k 1 120" + render + " >'" + said +
                                              "' 2>&1 & job=$!\n"
                                              "for i in $(seq 600); do grep -q '^render' '" +
                                              said +
                                              "' && break; sleep 0.1; done\n"
                                              "pkill -INT -P $job; wait $job; exit $?");
            INFO(read_text(said));
            CHECK(stopped.exit_code == 130);
            CHECK(read_exr(exr).number("opal.empty_pixels") == 64);
        }
}
