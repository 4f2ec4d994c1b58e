// Deliberately wrong kernels: named text substitutions on Opal's own sources.
#pragma once

#include "support/checks.h"
#include "support/scratch.h"

namespace opal::test {

struct Mutant {
    std::string name;        // what is wrong with it
    std::string file;        // below cl/
    std::string from, to;    // `from` must be in the file exactly once
    bool many_lanes = false; // not in programs of one lane: left out where the device is tested at one lane alone
};

// The sources with that one change. Throws Error where the text is not there, or more than once.
Sources mutated(const Sources &sources, const Mutant &mutant);

// Writes the sources to `folder`/cl, as --cl-dir takes them, and returns that path.
std::string write_kernels(const ScratchFolder &folder, const Sources &sources);
std::string write_kernels(const ScratchFolder &folder, const Mutant &mutant); // Opal's own with that change

// A mutant and the check that must reject it.
struct Control {
    Mutant mutant;
    std::string check_name;
    Check check;
};

// All of them. Mutants of single functions (kernel_mutants.cpp) ...
extern const std::vector<Control> number_mutants, hit_mutants, density_mutants;
// ... and of rendering (render_mutants.cpp).
extern const std::vector<Control> furnace_mutants, light_mutants, strategy_mutants, passing_mutants, choice_mutants,
    film_mutants;

// Runs the controls: prints a line for each with the finding that killed it, and CHECKs that all are killed.
void require_all_killed(const std::vector<Control> &controls, unsigned seed);

} // namespace opal::test
