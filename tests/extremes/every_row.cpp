// The whole table of `opal extremes` with 2^22 paths a picture, and 10^8 rays at edges. It takes many minutes.
#include "extremes/measure.h"
#include "support/device.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("Every row keeps what it promises, and nothing is NaN or infinite", "[every_row][stat][long]") {
    if (!device().info.fp64) {
        WARN("the device has no double precision: nothing to hold single against");
        return;
    }
    for (const extremes::StressRow &row : extremes::stress_rows()) {
        const extremes::StressResult s = run_stress(row, device(), {64, 1024, test_seed(71)}, 1);
        INFO(row.name << ": " << extremes::breaking_point(s));
        CHECK(s.kept);
        for (const extremes::StressPoint &p : s.points) {
            INFO("at " << p.value);
            CHECK(p.invalid_single == 0);
            CHECK(p.invalid_oracle == 0);
        }
    }
}

TEST_CASE("No ray of 1e8 at edges and vertices of closed meshes is lost", "[every_row][stat][long]") {
    for (const double scale : {1e-4, 1e-2, 1.0, 1e2, 1e4}) {
        const extremes::StressSettings settings{64, 1024, test_seed(72) + unsigned(std::log10(scale) + 4)};
        INFO("scale " << scale);
        CHECK(extremes::lost_at_edges(scale, 20'000'000, device(), settings, MathMode::precise) == 0);
    }
}
