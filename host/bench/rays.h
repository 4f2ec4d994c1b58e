// Ray tracing alone (`opal bench rays`). The device makes rays as a render sends them (cl/kernels/rays.cl) and
// traces them with the traversal that renders.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "flatten/flat_scene.h"
#include "kernels/rays_list.h"

#include <array>
#include <memory>
#include <vector>

namespace cl {
class Program;
}

namespace opal {

// Median and range of some runs.
struct Spread {
    double median = 0, least = 0, greatest = 0;
};
Spread spread_of(std::vector<double> values); // not empty

struct RaySet {
    int kind = RAYS_camera;
    std::vector<std::array<float, TRACE_RAY_PLANES>> rays; // flattened units; o, tmin, d, tmax
};

// t, u, v are of closest hits only; triangle is an index of FlatScene::triangles or -1; any hit: 0 or -1.
struct RayHit {
    float t, u, v;
    int triangle;
};

struct RayTimes {
    Spread mrays_per_second,
        mrays_per_cpu_second; // by the CPU time of this process, which is steady on a shared machine
    std::vector<RayHit> hits;
    double hit_share = 0;
    double node_tests = 0, triangle_tests = 0; // a ray: nodes of 8 children; places of blocks, and listed triangles
};

class RayBench {
public:
    // The scene's integrator and emitters must be those of path tracing, so that shadow rays find the lights.
    RayBench(const Device &device, const FlatScene &scene, const BuildOptions &build, const Sources &sources);
    ~RayBench();

    // Makes about `count` rays, one a pixel. Rays without a start are left out.
    RaySet generate(int kind, size_t count, unsigned seed);

    // Traces closest hits, or any hits for shadow rays: once to warm up, then `runs` times.
    RayTimes time(const RaySet &set, int runs);

    double compile_seconds() const { return compile_seconds_; }

private:
    struct OnDevice; // the programs and the scene's buffers
    struct Batch;
    struct Seconds {
        double device, cpu;
    };
    Seconds trace(cl::Program &program, Batch &batch);
    cl::Program &counting_program();

    const Device device_;
    const FlatScene &scene_;
    BuildOptions build_;
    const Sources &sources_;
    double compile_seconds_ = 0;
    std::unique_ptr<OnDevice> on_device_;
};

// The corners of FlatScene::triangles, in flattened units.
std::vector<std::array<float, 9>> triangles_of(const FlatScene &scene);

} // namespace opal
