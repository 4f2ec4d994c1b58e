// The course of a sweep: pilots, the reference, the points, the pictures; every finished piece is saved at once.
#pragma once

#include "sweep/measure.h"

namespace opal {

struct SweepPlan {
    std::filesystem::path folder;
    unsigned seed = 0;
    unsigned reference_spp = 0; // 0: 8 times the largest spp
    const Sources *sources = &Sources::embedded();
    const Image *reference = nullptr; // --reference; nullptr: made by the best strategy
};

// Measures what `record` (its spp, replicates and budget) does not hold yet. Throws Interrupted; what was finished is kept.
void run_sweep(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates, SweepRecord &record);

} // namespace opal
