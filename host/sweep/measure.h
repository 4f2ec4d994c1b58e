// The measurements of a sweep: timed renders of one strategy, and pilots.
#pragma once

#include "render/renderer.h"
#include "strategies/presets.h"
#include "sweep/record.h"

#include <cmath>
#include <memory>

namespace opal {

// The clock of a sweep's seconds. kernel: the device's own profile. cpu, for CPU devices: CPU time of this process
// divided by the device's compute units, an estimate of the kernel time on an idle machine that stays steady on a busy
// one.
enum class Clock { kernel, cpu };

// One strategy, compiled for a device: it renders any number of samples.
class CompiledStrategy {
public:
    CompiledStrategy(const Device &device, const Candidate &candidate, const Sources &sources,
                     Clock clock = Clock::kernel);

    // Shares the memory of the film with a strategy of the same image, as only one renders at a time.
    void share_film(const CompiledStrategy &other) { renderer_->share_film(*other.renderer_); }

    struct RenderResult {
        Film film;
        Image image;
        double seconds = 0;
    };
    // Renders samples [first, first + spp) of `seed`. Throws Interrupted, and Error if paths that may be endless do not
    // end within that many seconds on the wall.
    RenderResult render(unsigned spp, unsigned seed, unsigned first = 0, double most_seconds = INFINITY);

    double compile_seconds() const { return renderer_->compile_seconds(); }
    int lanes() const { return lanes_; }
    bool uses_mis() const { return strategy_[AXIS_lighting] == CHOICE_lighting_mis; }

private:
    std::string label_;
    Strategy strategy_;
    Clock clock_;
    double cores_; // compute units of the device
    int lanes_;
    std::unique_ptr<Renderer> renderer_;
};

struct Interrupted {}; // thrown after Ctrl-C

// First sample indices of pilots and of the reference's two halves. Replicates begin at 0: no sample is used twice.
constexpr unsigned first_pilot_sample = 1u << 30, first_reference_sample_a = 2u << 30,
                   first_reference_sample_b = 3u << 30;

// A short render whose samples estimate the cost of a strategy and are no part of any result.
struct Pilot {
    unsigned spp = 0;
    double seconds_a_sample = 0;        // for one sample of each pixel
    std::vector<double> mean, variance; // of a sample's luminance, for each pixel
    bool mis = false;                   // the strategy uses multiple importance sampling
};
// Renders a pilot of about `seconds` by the strategy's clock.
Pilot run_pilot(CompiledStrategy &strategy, unsigned seed, double seconds);

// Estimates each strategy's seconds to relMSE 1: the relative variance of one sample, averaged over the pixels, times
// the seconds for a sample of each pixel. Two corrections guard against pilots that have missed rare bright samples:
// - Variances are relative to the median of all pilots' means in each pixel. Where a pilot's mean is farther from that
//   median than its variance explains, the squared distance counts instead.
// - A strategy without MIS cannot be much better than with it: the balance heuristic's variance exceeds that of
//   any single technique by at most (1 - 1/2) mean^2 (Veach 1997, theorem 9.2), which gives a lower bound.
std::vector<double> pilot_costs(const std::vector<Pilot> &pilots);

} // namespace opal
