// Runs the kernels' functions one by one on a device (cl/kernels/probe.cl).
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "flatten/flat_scene.h"
#include "kernels/probe_list.h"
#include "stats/histogram.h"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace cl {
class Buffer;
}

namespace opal {

// Values of many samples as the probe kernels read and write them: a structure of arrays, one plane a value.
struct Planes {
    size_t count = 0, stride = 0; // samples; floats a plane, a multiple of 16
    std::vector<float> values;
    Planes() = default;
    Planes(size_t planes, size_t samples) : count(samples), stride((samples + 15) / 16 * 16), values(planes * stride) {}
    float &at(size_t plane, size_t sample) { return values[plane * stride + sample]; }
    float at(size_t plane, size_t sample) const { return values[plane * stride + sample]; }
    uint bits(size_t plane, size_t sample) const; // of an integer
    Vec3 vec3(size_t plane, size_t sample) const {
        return {at(plane, sample), at(plane + 1, sample), at(plane + 2, sample)};
    }
};

// Which of a sampler's numbers are drawn: index i is sample i * sample_step of pixel i * pixel_step.
struct NumberOptions {
    unsigned seed = 0, first_dimension = 0, pixel_step = 0, sample_step = 1;
    int sampler = CHOICE_sampler_independent;
    unsigned spp = 1; // strata of the stratified sampler
};

class KernelProbe {
public:
    // `scene` has the BSDFs, emitters and triangles; its features decide what is compiled. Error: the build failed.
    KernelProbe(const Device &device, const FlatScene &scene, const BuildOptions &build,
                const Sources &sources = Sources::embedded());
    ~KernelProbe();

    // 2 OPAL_PROBE_PAIRS planes of `count` numbers in [0, 1).
    Planes numbers(size_t count, const NumberOptions &options);

    Planes warp_sample(int warp, float parameter, const Planes &numbers);     // WARP_*
    Planes warp_pdf(int warp, float parameter, std::span<const Vec3> points); // one plane
    // Of the BSDF of mesh `id`:
    Planes bsdf_sample(unsigned id, Vec3 wi, const Planes &numbers);      // BSDF_*: plane 0, 1 direction, 2 lobe
    Planes bsdf_eval(unsigned id, Vec3 wi, std::span<const Vec3> points); // EVAL_*
    // LIGHT_*, seen from a point for each sample, in flattened units:
    Planes light_sample(std::span<const Vec3> from, const Planes &numbers);
    Planes light_sample(Vec3 from, const Planes &numbers);
    Planes camera_rays(const Planes &film); // FILM_* -> RAY_*, of the scene's camera
    Planes trace(const Planes &rays);       // RAY_* -> HIT_*

    const FlatScene &scene() const { return scene_; }
    const Device &device() const { return device_; }

private:
    struct OnDevice; // the program and the scene's buffers
    template <class... Arguments>
    Planes run(const char *kernel, bool with_scene, size_t planes, const Planes &shape, const Arguments &...);
    cl::Buffer upload(const Planes &planes);

    const Device device_;
    FlatScene scene_;
    int lanes_;
    std::unique_ptr<OnDevice> on_device_;
};

// A scene of meshes without triangles that have these BSDFs, in this order. Every feature is on and every axis decided
// at run time, so that one compiled program serves all.
FlatScene scene_of_bsdfs(const std::vector<Bsdf> &bsdfs);

Planes planes_of(std::span<const Vec3> points);

// BSDF samples with the factor of radiance as their weight, as paths have it (cl/integrators/steps.cl): over eta^2.
Planes of_radiance(Planes bsdf_samples);

// Numbers at the corners and edges of the unit cube: each of 0, 2^-24, 1/4, 1/2, 1 - 2^-24 for the three first planes.
Planes corner_numbers();

} // namespace opal
