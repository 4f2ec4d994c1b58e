// Points on lights against the density that hitting them is weighed with, for each way to choose emitter and triangle.
#include "densities/targets.h"
#include "selftest/checks.h"

#include <cmath>

namespace opal {

Findings light_findings(KernelProbe &probe, const Sampled &lights, const std::string &subject, const Effort &effort) {
    Sampled sampled = lights;
    sampled.relative_error = effort.quadrature_error;
    const DensityCheck check = check_density(probe, sampled, effort.nu, effort.nv, effort.samples, effort.seed);
    return {p_value("lights: points against density, smallest p", check.test.result.p_value, subject),
            at_most("lights: integral of the pdf, off by", std::abs(check.test.mass.value - 1), 1e-3, subject)};
}

Findings run_lights(const Device &device, const SelftestOptions &options) {
    Findings findings;
    Effort effort = effort_of(options);
    effort.seed += 500;
    for (const char *name : {"light:parallelogram", "light:mesh", "light:many"})
        for (const char *choice : {"uniform", "power"}) {
            const std::map<std::string, std::string> axes = {{"emitter-choice", choice},
                                                             {"triangle-choice", choice[0] == 'u' ? "uniform" : "area"},
                                                             {"specialise", "off"}};
            const Target target = open_target(name, {}, axes, device, options.build, *options.sources);
            effort.seed++;
            append(findings, light_findings(*target.probe, target.sampled, target.description, effort));
        }
    return summary_of(findings);
}

} // namespace opal
