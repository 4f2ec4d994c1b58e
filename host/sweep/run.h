// The run of a sweep: pilots, the reference, the points and the images at equal time. Each result is saved at once.
#pragma once

#include "sweep/measure.h"

namespace opal {

struct SweepPlan {
    std::filesystem::path folder;
    unsigned seed = 0;
    unsigned reference_spp = 0; // 0: reference_factor times the largest spp
    Clock clock = Clock::kernel;
    const Sources *sources = &Sources::embedded();
    const Image *reference = nullptr; // of --reference; nullptr: the best strategy renders one
};

enum class SweepPart { points, images, all };

// Measures what `record` lacks of the candidates, all on this device. Each candidate must have its StrategyRecord.
// - points: the pilots, the reference, and the points. Replicates go in rounds, one of every strategy each, so that a
//   disturbance of the machine affects all strategies.
// - images: each candidate's image, all in one time: that of the fastest strategy for the most samples. The points of
//   all devices must be there.
// A strategy is compiled once, and freed after its image. Returns the number of renderers made. Throws Interrupted;
// finished results are kept.
size_t run_sweep(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                 SweepRecord &record, SweepPart part = SweepPart::all);

} // namespace opal
