// The strategies that a sweep compares.
#pragma once

#include "scene/scene.h"

#include <string>
#include <vector>

namespace opal {

struct Candidate {
    std::string name;       // "lighting=mis,mis=power": what --strategies takes; the key in sweep.json
    std::string label;      // for people: "MIS, power"
    SceneDescription scene; // with the strategy set and checked
    size_t device = 0;      // place among those that are compared
};

// words: presets (`course`, `all`) and lists "axis=value,..." as named_strategy takes them; empty: `course`. math:
// modes to cross them with; may be empty. Error: what does not exist or makes no sense, a strategy that is there twice,
// and strategies that do not estimate one image (another integrator or max-depth). A preset leaves out what the scene
// cannot do without bias (lighting bsdf with point lights).
std::vector<Candidate> parse_strategies(const SceneDescription &scene, const std::vector<std::string> &words,
                                        const std::vector<std::string> &math);

} // namespace opal
