// Combinations of choices: the strategies that can be compared on one scene.
#pragma once

#include "scene/scene.h"

namespace opal {

struct NamedStrategy {
    std::string name; // "lighting=mis,mis=power": the axes on which the set differs, or the text as given
    Strategy strategy;
};

// The scene's strategy with overrides as the command line has them: 'lighting=mis,mis=power'. Error if one does not
// exist or makes no sense on this scene.
NamedStrategy named_strategy(const SceneDescription &scene, const std::string &text);
bool is_same(const Strategy &a, const Strategy &b);

// The axes on which the scene's strategy depends: AXIS_integrator, and those whose choice changes something here.
std::vector<int> acting_axes(const SceneDescription &scene);

// The parts of 'a;b', without blanks around them; empty parts are left out.
std::vector<std::string> split(const std::string &text, char separator);

// The strategies of 'lighting=mis,mis=power;lighting=emitter'. Error as above, and if two are the same.
std::vector<NamedStrategy> named_strategies(const SceneDescription &scene, const std::string &text);

// All unbiased strategies that end and have the expectation of the scene's integrator, each once. An axis that changes
// nothing on this scene (the MIS heuristic without MIS, the choice among one emitter) keeps the scene's choice. BSDF
// sampling is left out if there are delta lights, as points are, which it cannot hit. If there are more than `most`,
// the result is a covering set: every pair of choices that occurs in a strategy occurs in the set (greedy; Cohen et
// al., IEEE TSE 23, 1997). The scene's own strategy comes first if it is among them.
std::vector<NamedStrategy> sensible_strategies(const SceneDescription &scene, size_t most = 12);

} // namespace opal
