// The options of a Strategy, by name and text: the axes of cl/shared/strategy.h and a few numbers. One row an option
// serves the command line (--max-depth), the XML (<integer name="maxDepth">), the JSON reports and `opal inspect`.
#pragma once

#include "scene/scene.h"

#include <functional>
#include <map>
#include <span>
#include <string>

namespace opal {

struct StrategyOption {
    std::string name;                                         // on the command line: "max-depth"
    std::string xml_name;                                     // as a property of the integrator: "maxDepth"
    std::string xml_tag;                                      // of that property: "integer"
    std::string values;                                       // what the help shows for the value: "N|none"
    std::string help;                                         // its meaning, unit and default
    std::function<void(Strategy &, const std::string &)> set; // throws Error where the text is no such value
    std::function<std::string(const Strategy &)> text;        // the value, as `set` takes it
    std::vector<std::string> names{};                         // the values that are names
};

std::span<const StrategyOption> strategy_options(); // every axis but the integrator, then the numbers

// Sets one option, "integrator" included. Throws Error, without a place, where the name or the value does not exist.
void set_option(Strategy &strategy, const std::string &name, const std::string &value);

// A name of an integrator, as the XML and --integrator give it, with the choices that the name implies.
struct IntegratorType {
    std::string name;
    int integrator;    // CHOICE_integrator_*
    int lighting = -1; // CHOICE_lighting_*, or -1: left to the properties
    int rr = -1;       // CHOICE_rr_*, or -1
};

std::span<const IntegratorType> integrator_types();
const IntegratorType &find_integrator(const std::string &name); // '-' and '_' are alike; Error "unknown integrator ..."
// The name of a scene's integrator: its type as written, or another that was chosen in its place.
std::string integrator_name(const SceneDescription &scene);
void apply_integrator(Strategy &strategy, const IntegratorType &type);

// Sets options by name ("lighting" -> "mis", "max-depth" -> "5"), as the command line overrides what a scene says.
// Throws Error where a name or a value does not exist.
void override_strategy(Strategy &strategy, const std::map<std::string, std::string> &overrides);

} // namespace opal
