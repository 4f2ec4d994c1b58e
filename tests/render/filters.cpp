// Reconstruction filters.
#include "image/image.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

TEST_CASE("Filters keep constants, weigh as they should and blur an edge as known", "[filters][stat]") {
    require_all_pass(check_filters(Sources::embedded(), test_seed(60)));
}

TEST_CASE("A filter far wider than the image ends at once: it asks no pixel without samples", "[filters]") {
    const ScratchFolder folder;
    const auto image = [&](const std::string &type, double radius, int width) {
        const std::string scene = folder.write(
            "scene.xml",
            fmt::format("<scene><camera type='perspective'><integer name='width' value='{}'/><integer name='height' "
                        "value='16'/><rfilter type='{}'><float name='radius' value='{}'/></rfilter></camera><mesh "
                        "type='parallelogram'><point name='origin' value='-3 -3 5'/><vector name='u' value='0 3 0'/>"
                        "<vector name='v' value='5 0 0'/><emitter type='area'><color name='radiance' value='1 2 "
                        "3'/></emitter></mesh></scene>",
                        width, type, radius));
        const Outcome outcome = run_shell("cd " + folder.path().string() + " && timeout 60 " OPAL_BINARY " render " +
                                          scene + " --spp 4 --no-png -o out.exr");
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
        return read_exr(folder / "out.exr");
    };
    for (const int width : {16, 19}) { // of the lanes' width, and rows that share lanes
        const Image far = image("gaussian", 1e9, width), near = image("gaussian", 20, width);
        CHECK(far.get("R").values == near.get("R").values);
        CHECK(image("gaussian", 1e38, width).get("R").values == near.get("R").values);
        CHECK(far.get("R").values.front() != far.get("R").values.back());
        // A filter that is flat over the whole image gives its mean.
        const Image flat = image("mitchell", 1e38, width);
        double mean = 0;
        for (float value : flat.get("R").values)
            mean += double(value) / double(flat.get("R").values.size());
        CHECK(mean > 0);
        for (float value : flat.get("R").values)
            CHECK(value == Approx(mean));
    }
}
