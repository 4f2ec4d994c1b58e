// Whole renders, timed against each other (`opal bench render`, `opal inspect --bench`).
#pragma once

#include "bench/rays.h"
#include "render/renderer.h"

namespace opal {

struct PathRates {
    Spread paths_per_second, paths_per_cpu_second;
};

// Averages over paths.
struct PathCounts {
    double rays = 0, shadow_rays = 0;
    double lanes_busy = 0; // of a round's lanes, the share that traces a ray
};

// A variant of the kernel beside the base, A B A B.
struct Race {
    PathRates rates; // of the variant
    Spread time;     // its time over the base's: by CPU time on a CPU device, else by the device's
    double compile_seconds = 0;
};

class RenderBench {
public:
    // Renders take about `seconds` each, `rounds` times. References must outlive this.
    RenderBench(const Device &device, const FlatScene &scene, const BuildOptions &build, const Sources &sources,
                double seconds, int rounds);

    PathRates rates();
    PathCounts counts() const;
    Race race(const FlatScene &scene, const BuildOptions &build);
    double compile_seconds(const BuildOptions &build) const { return renderer_of(scene_, build).compile_seconds(); }
    unsigned spp() const { return spp_; }

private:
    struct Timed {
        double device, cpu; // seconds
    };
    Renderer renderer_of(const FlatScene &scene, const BuildOptions &build) const;
    Timed render(Renderer &renderer, unsigned seed) const;
    PathRates rates_of(const std::vector<Timed> &runs) const;

    const Device device_;
    const FlatScene &scene_;
    BuildOptions build_;
    const Sources &sources_;
    Renderer base_;
    unsigned spp_ = 1;
    int rounds_;
};

// The scene with a feature (FEATURE_*) compiled in that it does not need.
FlatScene with_feature(const FlatScene &scene, unsigned feature);

} // namespace opal
