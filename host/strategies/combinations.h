// Strategies to hold against each other on one scene.
#pragma once

#include "scene/scene.h"

namespace opal {

struct NamedStrategy {
    std::string name; // "lighting=mis,mis=power": the axes on which the set differs, or the text as given
    Strategy strategy;
};

// 'lighting=mis,mis=power' changes the scene's strategy as the command line's options would. Throws Error for what does
// not exist or makes no sense on this scene.
NamedStrategy named_strategy(const SceneDescription &scene, const std::string &text);
bool is_same(const Strategy &a, const Strategy &b);

// 'a;b' in its parts, without blanks around them.
std::vector<std::string> split(const std::string &text, char separator);

// 'lighting=mis,mis=power;lighting=emitter'. Throws Error besides where one is there twice.
std::vector<NamedStrategy> named_strategies(const SceneDescription &scene, const std::string &text);

// The combinations of choices that estimate what the scene's integrator does, without bias and in finite time, each
// once: an axis that changes nothing here (the MIS heuristic without MIS, the choice among one emitter) keeps the
// scene's choice. Left out: BSDF sampling where there are point lights, endless paths. All of them if there are at most
// `most`, else a covering set: every pair of choices that occurs in one of them occurs in the set (greedy; Cohen et
// al., IEEE TSE 23, 1997). The scene's own strategy comes first where it is among them.
std::vector<NamedStrategy> sensible_strategies(const SceneDescription &scene, size_t most = 12);

} // namespace opal
