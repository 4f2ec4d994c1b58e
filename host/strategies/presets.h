// Presets: named lists of strategies for a sweep, and the parser of --strategies.
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace opal {

struct Candidate {
    std::string name;       // as --strategies takes it, and the key in sweep.json: "lighting=mis,mis=power"
    std::string label;      // for the page: "MIS, power"
    SceneDescription scene; // with the strategy set and checked
    size_t device = 0;      // index among the compared devices
};

// The strategies named by `words`: presets (`course`, `all`), or lists "axis=value,..." as named_strategy takes them;
// none: `course`. Each is crossed with the modes in `math`, if there are any. A preset leaves out strategies that are
// biased on this scene (lighting bsdf with point and other delta lights), and choices that the scene has already. Error
// if a strategy does not exist, makes no sense, is there twice, or has another expectation than the others (another
// integrator or max-depth).
std::vector<Candidate> parse_strategies(const SceneDescription &scene, const std::vector<std::string> &words,
                                        const std::vector<std::string> &math);

} // namespace opal
