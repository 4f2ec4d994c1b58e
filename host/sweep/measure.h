// Renders what a sweep needs.
#pragma once

#include "render/renderer.h"
#include "strategies/presets.h"
#include "sweep/record.h"

#include <memory>

namespace opal {

// What a second is. kernel: of the device's own profile. cpu: of this process on all cores, divided by the device's
// compute units: what the kernels would take on a machine of their own, steady where others work, too; of a CPU device.
enum class Clock { kernel, cpu };

// One strategy, compiled for a device.
class Measured {
public:
    Measured(const Device &device, const Candidate &candidate, const Sources &sources, Clock clock = Clock::kernel);

    struct Rendered {
        Film film;
        Image image;
        double seconds = 0;
    };
    // Samples [first, first + spp) of `seed`. Throws Interrupted.
    Rendered render(unsigned spp, unsigned seed, unsigned first = 0);

    double compile_seconds() const { return renderer_->compile_seconds(); }
    int lanes() const;
    bool takes_both() const { return candidate_.scene.strategy[AXIS_lighting] == CHOICE_lighting_mis; }

private:
    void compile(unsigned spp);
    const Device &device_;
    const Candidate &candidate_;
    const Sources &sources_;
    Clock clock_;
    unsigned compiled_spp_ = 0; // of stratified samples: their strata belong to one number of samples
    std::unique_ptr<FlatScene> flat_;
    std::unique_ptr<Renderer> renderer_;
};

struct Interrupted {}; // by Ctrl-C

// Sample indices of what is not a replicate: disjoint from those, and from each other.
constexpr unsigned pilot_first = 1u << 30, reference_first_a = 2u << 30, reference_first_b = 3u << 30;

struct Pilot {
    unsigned spp = 0;
    double seconds_a_sample = 0;        // of each pixel
    std::vector<double> mean, variance; // of each pixel's luminance; the variance is of one sample
    bool mis = false;                   // takes both kinds of sample
};
// A short render: about `seconds` of kernel time. Its samples are for deciding, and no part of any result.
Pilot run_pilot(Measured &measured, unsigned seed, double seconds);

// For each pilot the seconds to relMSE 1: mean over the pixels of the relative variance of one sample, times its
// seconds. Relative to the median of all pilots, pixel by pixel. A strategy that has not yet met a small light sees no
// variance, but is far from that median: the larger of both counts. One way of sampling alone that seems far better
// than MIS has not met its rare bright samples: the balance heuristic's variance exceeds no single way's by more than
// (1 - 1/2) mean^2 (Veach 1997, theorem 9.2).
std::vector<double> pilot_costs(const std::vector<Pilot> &pilots);

} // namespace opal
