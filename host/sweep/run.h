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

// Measures the pilots, the reference and the points of the candidates that `record` lacks, all on this device.
// Replicates go in rounds, one of every strategy each, so that a disturbance of the machine affects all strategies.
// Each candidate must have its StrategyRecord. Throws Interrupted; finished results are kept.
void measure_points(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                    SweepRecord &record);

// Renders each candidate for the same time, the one that the fastest strategy takes for the most samples. Needs
// measure_points on all devices.
void render_equal_time_images(const SweepPlan &plan, const Device &device, const std::vector<Candidate> &candidates,
                              SweepRecord &record);

} // namespace opal
