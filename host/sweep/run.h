// The course of a sweep: pilots, the reference, the points, the pictures; every finished piece is saved at once.
#pragma once

#include "sweep/measure.h"

namespace opal {

struct SweepPlan {
    std::filesystem::path folder;
    unsigned seed = 0;
    unsigned reference_spp = 0; // 0: 8 times the largest spp
    Clock clock = Clock::kernel;
    const Sources *sources = &Sources::embedded();
    const Image *reference = nullptr; // --reference; nullptr: made by the best strategy
};

// Measures what `record` (its spp, replicates and budget) does not hold yet of the candidates, all on this device:
// pilots, the reference, the points. Replicates go round: one of every strategy, then the next, so that what disturbs
// the machine for a while disturbs all. Throws Interrupted; what was finished is kept. The candidates have their rows
// in the record.
void measure_points(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                    SweepRecord &record);

// Pictures of one kernel time, that of the fastest strategy's largest render; after measure_points on all devices.
void take_pictures(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                   SweepRecord &record);

} // namespace opal
