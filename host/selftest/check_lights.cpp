// Points on lights against the density that hitting them is weighed with, for each way to choose emitter and triangle.
#include "densities/targets.h"
#include "selftest/selftest.h"

#include <cmath>

namespace opal {

Findings check_lights(const Device &device, const SelftestOptions &options) {
    double smallest_p = 1, mass_error = 0, cases = 0;
    unsigned seed = options.seed + 500;
    for (const char *name : {"light:parallelogram", "light:mesh", "light:many"})
        for (const char *choice : {"uniform", "power"}) {
            const std::map<std::string, std::string> axes = {{"emitter-choice", choice},
                                                             {"triangle-choice", choice[0] == 'u' ? "uniform" : "area"},
                                                             {"specialise", "off"}};
            Target target = open_target(name, {}, axes, device, options.build, *options.sources);
            target.sampled.relative_error = options.full ? 2e-3 : 1e-2;
            const DensityCheck check = check_density(*target.probe, target.sampled, selftest_cells(options),
                                                     selftest_cells(options), selftest_samples(options), ++seed);
            smallest_p = std::min(smallest_p, check.test.result.p_value);
            mass_error = worst_of(mass_error, std::abs(check.test.mass.value - 1));
            cases++;
        }
    return {at_least("lights: points against density, smallest p", stats::sidak_p(smallest_p, cases), selftest_level),
            at_most("lights: integral of the pdf, off by", mass_error, 1e-3)};
}

} // namespace opal
