// The suite's own p-values: uniform where nothing is wrong, or its verdicts mean nothing.
#include "stats/hypothesis.h"
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

namespace {

// Of comparisons that are independent of each other and by continuous statistics: not the exact ones, and not Sobol's, whose
// error is smaller than the variance says.
void add(std::vector<double> &values, const Findings &findings) {
    for (const Finding &finding : findings)
        if (finding.p > 0 && finding.p < 1 && finding.what.find("sobol") == std::string::npos)
            values.push_back(finding.p);
}

} // namespace

TEST_CASE("The p-values of the suite are uniform", "[p_values]") {
    const Sources &sources = Sources::embedded();
    std::vector<double> values;
    for (unsigned round = 0; round < 3; round++) {
        const unsigned seed = test_seed(400 + round);
        for (const Check &check : {Check(check_independence), Check(check_warps), Check(check_bsdfs), Check(check_albedos), Check(check_furnace), Check(check_triangle_light)})
            add(values, check(sources, seed));
    }
    const stats::TestResult result = stats::ks_uniform_test(values);
    INFO(values.size() << " p-values, Kolmogorov-Smirnov p = " << result.p_value);
    CHECK(values.size() > 150);
    CHECK(result.p_value >= check_level);
}
