// The warps, BSDFs and lights that `opal warp` can test, by name.
#pragma once

#include "densities/sampled.h"

#include <map>
#include <memory>
#include <string>

namespace opal {

struct Target {
    std::unique_ptr<KernelProbe> probe;
    Sampled sampled;
    std::string description; // "microfacet alpha 0.1, wi at 60 degrees"
};

struct TargetName {
    std::string name;       // "beckmann", "bsdf:phong", "light:mesh"
    std::string parameters; // "alpha" ...
    std::string help{};     // what is sampled, and its density
};
const std::vector<TargetName> &targets();
// The target that is meant: Nori's names begin with "square_to_".
std::string target_name(const std::string &typed);

// An emitter of scenes by its parameters as the command line names them; what is required and not given is made up.
Light light_of_parameters(uint kind, const std::map<std::string, std::string> &parameters);

// A parameter as the command line names it.
struct TargetParameter {
    std::string name, help;
};
const std::vector<TargetParameter> &target_parameters();

// Parameters by name ("alpha" -> "0.1"); `axes` by strategy option ("triangle-choice" -> "uniform"). Throws Error for
// names and values that do not exist.
Target open_target(const std::string &name, const std::map<std::string, std::string> &parameters,
                   const std::map<std::string, std::string> &axes, const Device &device, const BuildOptions &build,
                   const Sources &sources);

} // namespace opal
