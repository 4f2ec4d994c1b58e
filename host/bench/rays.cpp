#include "bench/rays.h"

#include "bvh/box.h"
#include "device/program.h"
#include "device/scene_buffers.h"
#include "shared/counters.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <ctime>

namespace opal {

namespace {

constexpr size_t items_a_launch = 4096;

size_t round_up(size_t n, size_t step) { return (n + step - 1) / step * step; }

BuildOptions with_kernels(BuildOptions build, bool count_tests) {
    build.kernels = "kernels/rays.cl";
    build.count_tests = count_tests;
    return build;
}

Box bounds_of(const FlatScene &scene) {
    Box box = Box::empty();
    for (const auto &t : triangles_of(scene))
        for (size_t corner = 0; corner < 9; corner += 3)
            box.add(std::array{t[corner], t[corner + 1], t[corner + 2]});
    return box;
}

} // namespace

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    const double median = values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
    return {median, values.front(), values.back()};
}

std::vector<std::array<float, 9>> triangles_of(const FlatScene &scene) {
    std::vector<std::array<float, 9>> triangles(scene.triangles.size());
    for (const TriangleBlock &block : scene.triangle_blocks)
        for (int place = 0; place < 8; place++)
            if (block.id[place] != OPAL_NONE)
                for (int corner = 0; corner < 3; corner++)
                    for (int axis = 0; axis < 3; axis++)
                        triangles[block.id[place]][size_t(3 * corner + axis)] = block.vertex[corner][axis][place];
    return triangles;
}

struct RayBench::OnDevice {
    cl::Program program, counting;
    std::vector<cl::Buffer> scene;
};

RayBench::RayBench(const Device &device, const FlatScene &scene, const BuildOptions &build, const Sources &sources)
    : device_(device), scene_(scene), build_(build), sources_(sources), on_device_(std::make_unique<OnDevice>()) {
    on_device_->program = build_program(device, program_text(scene.features, with_kernels(build, false), sources),
                                        build, &compile_seconds_);
    on_device_->scene = upload_scene(device, scene);
}

RayBench::~RayBench() = default;

cl::Program &RayBench::counting_program() {
    if (!on_device_->counting())
        on_device_->counting =
            build_program(device_, program_text(scene_.features, with_kernels(build_, true), sources_), build_);
    return on_device_->counting;
}

RaySet RayBench::generate(int kind, size_t count, unsigned seed) {
    // A film of the scene's aspect with about `count` pixels, in whole tiles.
    Settings settings = scene_.settings;
    const double scale = std::sqrt(double(count) / (double(settings.width) * settings.height));
    const auto side = [scale](unsigned pixels) { return unsigned(std::max(8.0, 8 * std::round(pixels * scale / 8))); };
    settings.width = side(settings.width);
    settings.height = side(settings.height);
    settings.seed = seed;
    const size_t stride = round_up(size_t(settings.width) * settings.height, 16);
    const Box box = bounds_of(scene_);
    const cl::Buffer buffer = make_zeros<float>(device_, TRACE_RAY_PLANES * stride, "the rays");
    with_device(device_.info, [&] {
        device_.handles->queue.enqueueWriteBuffer(on_device_->scene[0], CL_TRUE, 0, sizeof settings, &settings);
        cl::Kernel kernel(on_device_->program, "generate");
        cl_uint place = 0;
        for (const cl::Buffer &table : on_device_->scene)
            kernel.setArg(place++, table);
        kernel.setArg(place++, cl_uint(kind));
        for (size_t axis = 0; axis < 3; axis++)
            kernel.setArg(place++, cl_float(box.lo[axis]));
        for (size_t axis = 0; axis < 3; axis++)
            kernel.setArg(place++, cl_float(box.hi[axis] - box.lo[axis]));
        kernel.setArg(place++, buffer);
        kernel.setArg(place + 1, cl_uint(stride));
        const LaunchScope launching(device_, kernel);
        for (size_t first = 0; first < stride; first += items_a_launch * size_t(build_.lanes)) {
            kernel.setArg(place, cl_uint(first));
            device_.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(items_a_launch),
                                                        cl::NDRange(group_size(device_.info)));
        }
        return device_.handles->queue.finish();
    });
    const std::vector<float> planes = read_buffer<float>(device_, buffer, TRACE_RAY_PLANES * stride);
    RaySet set{kind, {}};
    for (size_t i = 0; i < stride; i++) {
        if (planes[TRACE_TMAX * stride + i] < 0)
            continue;
        std::array<float, TRACE_RAY_PLANES> ray;
        for (size_t plane = 0; plane < ray.size(); plane++)
            ray[plane] = planes[plane * stride + i];
        set.rays.push_back(ray);
    }
    return set;
}

// Rays on the device, the buffer for their hits, and their distribution to work-items.
struct RayBench::Batch {
    const char *kernel;
    size_t count, stride, items, rays_an_item;
    cl::Buffer rays, hits, tests;
};

// Traces them all and returns the seconds on the device, and those of this process on all cores.
RayBench::Seconds RayBench::trace(cl::Program &program, Batch &batch) {
    return with_device(device_.info, [&] {
        cl::Kernel kernel(program, batch.kernel);
        cl_uint place = 0;
        for (const cl::Buffer &table : on_device_->scene)
            kernel.setArg(place++, table);
        for (const cl::Buffer *buffer : {&batch.rays, &batch.hits, &batch.tests})
            kernel.setArg(place++, *buffer);
        for (size_t value : {batch.count, batch.stride, batch.rays_an_item})
            kernel.setArg(place++, cl_uint(value));
        const LaunchScope launching(device_, kernel);
        cl::Event event;
        const std::clock_t before = std::clock();
        device_.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(batch.items),
                                                    cl::NDRange(group_size(device_.info)), nullptr, &event);
        event.wait();
        return Seconds{1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                     event.getProfilingInfo<CL_PROFILING_COMMAND_START>()),
                       double(std::clock() - before) / CLOCKS_PER_SEC};
    });
}

RayTimes RayBench::time(const RaySet &set, int runs) {
    const size_t lanes = size_t(build_.lanes), count = set.rays.size();
    Batch batch;
    batch.kernel = set.kind == RAYS_shadow ? "any_hits" : "closest_hits";
    batch.count = count;
    batch.stride = round_up(count, 16);
    // One shape of launch for all sets of rays, as drivers compile a kernel for each shape. A thousand rays an item
    // keep the cost of an item small.
    const bool gpu = device_.info.type == "gpu";
    batch.rays_an_item = gpu ? lanes : round_up((count + 1023) / 1024, lanes);
    batch.items = gpu ? round_up((count + lanes - 1) / lanes, group_size(device_.info)) : 1024;
    std::vector<float> planes(TRACE_RAY_PLANES * batch.stride);
    for (size_t i = 0; i < count; i++)
        for (size_t plane = 0; plane < TRACE_RAY_PLANES; plane++)
            planes[plane * batch.stride + i] = set.rays[i][plane];
    batch.rays = make_table(device_, planes, "the rays");
    batch.hits = make_zeros<float>(device_, TRACE_HIT_PLANES * batch.stride, "the hits");
    batch.tests = make_zeros<cl_uint>(device_, COUNTERS * batch.items, "the counts of tests");

    trace(on_device_->program, batch);
    std::vector<double> rates, cpu_rates;
    for (int run = 0; run < runs; run++) {
        const Seconds seconds = trace(on_device_->program, batch);
        rates.push_back(1e-6 * double(count) / seconds.device);
        cpu_rates.push_back(1e-6 * double(count) / seconds.cpu);
    }
    RayTimes times;
    times.mrays_per_second = spread_of(rates);
    times.mrays_per_cpu_second = spread_of(cpu_rates);

    const std::vector<float> hits = read_buffer<float>(device_, batch.hits, TRACE_HIT_PLANES * batch.stride);
    const auto value = [&](size_t plane, size_t i) { return hits[plane * batch.stride + i]; };
    for (size_t i = 0; i < count; i++) {
        times.hits.push_back(
            {value(TRACE_T, i), value(TRACE_U, i), value(TRACE_V, i), std::bit_cast<int>(value(TRACE_TRIANGLE, i))});
        times.hit_share += times.hits.back().triangle >= 0 ? 1.0 / double(count) : 0;
    }

    trace(counting_program(), batch);
    double tests[COUNTERS] = {};
    const std::vector<cl_uint> counted = read_buffer<cl_uint>(device_, batch.tests, COUNTERS * batch.items);
    for (size_t i = 0; i < counted.size(); i++)
        tests[i % COUNTERS] += counted[i] / double(count);
    const bool tree = scene_.features[FEATURE_tree];
    times.node_tests = tests[COUNTER_nodes] + (tree ? 1 : 0); // the root is met by all
    times.triangle_tests =
        OPAL_WIDTH * tests[COUNTER_blocks] + (scene_.features[FEATURE_face_list] ? scene_.face_list_triangles : 0);
    return times;
}

} // namespace opal
