#include "probe/kernel_probe.h"

#include "device/program.h"
#include "device/scene_buffers.h"

#include <algorithm>
#include <bit>

namespace opal {

namespace {

constexpr size_t items_a_launch = 4096; // constant, as drivers compile a kernel anew for each shape

BuildOptions with_kernels(BuildOptions build) {
    build.kernels = "kernels/probe.cl";
    return build;
}

} // namespace

uint Planes::bits(size_t plane, size_t sample) const { return std::bit_cast<uint>(at(plane, sample)); }

Planes planes_of(std::span<const Vec3> points) {
    Planes planes(3, points.size());
    for (size_t i = 0; i < points.size(); i++)
        for (int axis = 0; axis < 3; axis++)
            planes.at(size_t(axis), i) = float(points[i][axis]);
    return planes;
}

Planes of_radiance(Planes drawn) {
    for (size_t i = 0; i < drawn.count; i++)
        for (size_t channel = 0; channel < 3; channel++)
            drawn.at(BSDF_WEIGHT_R + channel, i) /= drawn.at(BSDF_ETA, i) * drawn.at(BSDF_ETA, i);
    return drawn;
}

Planes corner_numbers() {
    constexpr float values[] = {0, 0x1p-24f, 0.25f, 0.5f, 1 - 0x1p-24f};
    Planes numbers(2 * OPAL_PROBE_PAIRS, 125);
    for (size_t i = 0; i < numbers.count; i++) {
        numbers.at(0, i) = values[i % 5];
        numbers.at(1, i) = values[i / 5 % 5];
        numbers.at(2, i) = values[i / 25];
    }
    return numbers;
}

FlatScene scene_of_bsdfs(const std::vector<Bsdf> &bsdfs) {
    SceneDescription description;
    description.strategy.specialise = Specialise::off;
    description.strategy[AXIS_integrator] = CHOICE_integrator_path; // which asks BSDFs
    for (const Bsdf &bsdf : bsdfs) {
        description.meshes.emplace_back();
        description.meshes.back().bsdf = bsdf;
    }
    return flatten(description, 1);
}

struct KernelProbe::OnDevice {
    cl::Program program;
    std::vector<cl::Buffer> scene;
};

KernelProbe::KernelProbe(const Device &device, const FlatScene &scene, const BuildOptions &build,
                         const Sources &sources)
    : device_(device), scene_(scene), lanes_(build.lanes),
      on_device_(std::make_unique<OnDevice>(
          OnDevice{build_program(device, program_text(scene.features, with_kernels(build), sources), build),
                   upload_scene(device, scene_)})) {} // its buffers may share the memory of scene_

KernelProbe::~KernelProbe() = default;

cl::Buffer KernelProbe::upload(const Planes &planes) { return make_table(device_, planes.values, "a probe's input"); }

// Runs a kernel over the samples of `shape`; the arguments come between the scene's and out, first, stride.
template <class... Arguments>
Planes KernelProbe::run(const char *name, bool with_scene, size_t planes, const Planes &shape,
                        const Arguments &...arguments) {
    Planes out(planes, shape.count);
    if (out.count == 0)
        return out;
    const cl::Buffer buffer = make_zeros<float>(device_, out.values.size(), "a probe's output");
    with_device(device_.info, [&] {
        cl::Kernel kernel(on_device_->program, name);
        cl_uint place = 0;
        for (const cl::Buffer &table : on_device_->scene)
            if (with_scene)
                kernel.setArg(place++, table);
        (kernel.setArg(place++, arguments), ...);
        kernel.setArg(place++, buffer);
        kernel.setArg(place + 1, cl_uint(out.stride));
        const LaunchScope launching(device_, kernel);
        const cl::NDRange local(group_size(device_.info));
        for (size_t first = 0; first < out.stride; first += items_a_launch * size_t(lanes_)) {
            kernel.setArg(place, cl_uint(first));
            device_.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items_a_launch), local);
        }
        return device_.handles->queue.finish();
    });
    out.values = read_buffer<float>(device_, buffer, out.values.size());
    return out;
}

Planes KernelProbe::numbers(size_t count, const NumberOptions &options) {
    Settings settings = scene_.settings;
    settings.seed = options.seed;
    settings.spp = options.spp;
    settings.choices[AXIS_sampler] = options.sampler;
    with_device(device_.info, [&] {
        return device_.handles->queue.enqueueWriteBuffer(on_device_->scene[0], CL_TRUE, 0, sizeof settings, &settings);
    });
    return run("numbers", true, 2 * OPAL_PROBE_PAIRS, Planes(0, count), cl_uint(options.pixel_step),
               cl_uint(options.sample_step), cl_uint(options.first_dimension));
}

Planes KernelProbe::warp_sample(int warp, float parameter, const Planes &numbers) {
    return run("warp_sample", false, WARP_PLANES, numbers, cl_int(warp), cl_float(parameter), upload(numbers));
}

Planes KernelProbe::warp_pdf(int warp, float parameter, std::span<const Vec3> points) {
    const Planes input = planes_of(points);
    return run("warp_pdf", false, 1, input, cl_int(warp), cl_float(parameter), upload(input));
}

Planes KernelProbe::bsdf_sample(unsigned id, Vec3 wi, const Planes &numbers) {
    return run("bsdf_draw", true, BSDF_PLANES, numbers, cl_uint(id), cl_float(wi.x), cl_float(wi.y), cl_float(wi.z),
               upload(numbers));
}

Planes KernelProbe::bsdf_eval(unsigned id, Vec3 wi, std::span<const Vec3> points) {
    const Planes input = planes_of(points);
    return run("bsdf_value", true, EVAL_PLANES, input, cl_uint(id), cl_float(wi.x), cl_float(wi.y), cl_float(wi.z),
               upload(input));
}

Planes KernelProbe::light_sample(std::span<const Vec3> from, const Planes &numbers) {
    return run("light_draw", true, LIGHT_PLANES, numbers, upload(planes_of(from)), upload(numbers));
}

Planes KernelProbe::light_sample(Vec3 from, const Planes &numbers) {
    return light_sample(std::vector<Vec3>(numbers.count, from), numbers);
}

Planes KernelProbe::camera_rays(const Planes &film) { return run("camera_rays", true, RAY_PLANES, film, upload(film)); }

Planes KernelProbe::trace(const Planes &rays) { return run("trace", true, HIT_PLANES, rays, upload(rays)); }

} // namespace opal
