// What a user may set of a Strategy, by name and text: the axes of cl/shared/strategy.h and a few numbers. The same
// table serves the command line ("max-depth") and the XML (<integer name="maxDepth">).
#pragma once

#include "scene/strategy.h"

#include <map>
#include <span>
#include <string>

namespace opal {

struct Option {
    std::string name;     // on the command line: "max-depth"
    std::string xml_name; // as a property of the integrator: "maxDepth"
    std::string xml_tag;  // and its type: "integer"
};

std::span<const Option> options(); // every axis but the integrator, then the numbers

// Sets one option, "integrator" included; throws Error, without a place, where the name or the value does not exist.
void set_option(Strategy &strategy, const std::string &name, const std::string &value);

// An integrator as the XML and --integrator name it, and what its name decides beside the integrator axis.
struct IntegratorType {
    std::string name;
    int integrator;          // CHOICE_integrator_*
    bool university = false; // of the 2022 course: its default filter is the box
    int lighting = -1;       // CHOICE_lighting_*, or -1: left to the properties
    int rr = -1;             // CHOICE_rr_*, or -1
};

std::span<const IntegratorType> integrator_types();
const IntegratorType &find_integrator(const std::string &name); // '-' and '_' are alike; Error "unknown integrator ..."
void apply_integrator(Strategy &strategy, const IntegratorType &type);

// Sets options by name ("lighting" -> "mis", "max-depth" -> "5"), as the command line overrides what a scene says.
// Throws Error where a name or a value does not exist.
void override_strategy(Strategy &strategy, const std::map<std::string, std::string> &overrides);

} // namespace opal
