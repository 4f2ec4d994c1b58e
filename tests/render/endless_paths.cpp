// Paths that lose no energy must end, too: Russian roulette never lets a path survive for certain.
#include "support/scratch.h"

#include <catch2/catch.hpp>

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
    return "<scene><integrator type='path_tracer_recursive'><boolean name='rr' value='true'/></integrator>\n"
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
