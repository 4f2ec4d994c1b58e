#include "render/renderer.h"

#include "device/scene_buffers.h"
#include "shared/film.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>

namespace opal {

namespace {

constexpr unsigned long long slot_bytes = 4 * OPAL_SAMPLE_FLOATS, slots_budget = 256ull << 20;
constexpr unsigned most_chunks = 4096;

unsigned ceil_div(unsigned a, unsigned b) { return (a + b - 1) / b; }

// 0 .. count - 1 by the fractional parts of their multiples of the golden ratio. Launches are strips of the image from
// its top on; taken in this order, those that are done lie evenly over it, whenever a pass is stopped.
std::vector<unsigned> spread_order(unsigned count) {
    const auto place = [](unsigned i) { return std::fmod(i * std::numbers::phi, 1.0); };
    std::vector<unsigned> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, place);
    return order;
}

} // namespace

// CPU: tiles of 8 x 8 pixels, which keep 16 lanes full for long, and enough work-items for all cores even for one
// pixel. GPU: a pixel a work-item, as many as it has room for.
Renderer::Shape Renderer::shape_of_launches() const {
    const bool gpu = device_.info.type == "gpu";
    Shape s{};
    s.tile_width = s.tile_height = gpu ? 1 : 8;
    s.local_size = unsigned(group_size(device_.info));
    s.tiles = ceil_div(settings_.width, s.tile_width) * ceil_div(settings_.height, s.tile_height);
    const unsigned wanted = gpu ? 1u << 17 : 64 * std::max(1u, device_.info.compute_units);
    s.chunks = std::clamp(wanted / s.tiles, 1u, most_chunks);
    const unsigned most = gpu ? 1u << 20 : 512;
    s.items_a_launch = ceil_div(std::min(most, s.tiles * s.chunks), s.local_size) * s.local_size;
    return s;
}

Renderer::Renderer(const Device &device, const FlatScene &scene, const RenderOptions &options)
    : device_(device), settings_(scene.settings), options_(options),
      pixels_(size_t(scene.settings.width) * scene.settings.height), wide_filter_(scene.features[FEATURE_wide_filter]) {
    shape_ = shape_of_launches();
    // Slot numbers have 32 bits, three floats a slot; there is room for at least one sample of each pixel.
    const unsigned long long most = std::min({slots_budget, device.info.max_allocation, slot_bytes * 0x55555555ull});
    slot_samples_ = unsigned(std::clamp<unsigned long long>(most / slot_bytes / pixels_, 1, 64ull * most_chunks));
    check_room(device, pixels_ * (slot_bytes * slot_samples_ + 4ull * FILM_PLANES + 4), "the film and its samples");

    const cl::Program program = build_program(device, program_text(scene.features, options.build, *options.sources),
                                              options.build, &compile_seconds_);
    scene_ = upload_scene(device, scene);
    slots_ =
        make_buffer(device, CL_MEM_READ_WRITE, pixels_ * slot_bytes * slot_samples_, nullptr, "the samples of a pass");
    film_ = make_zeros<float>(device, pixels_ * FILM_PLANES, "the film");
    counts_ = make_zeros<cl_uint>(device, pixels_, "the film's sample counts");
    invalid_ = make_zeros<cl_uint>(device, 1 + 2 * OPAL_INVALID_RECORDS, "the list of invalid samples");

    with_device(device.info, [&] {
        render_kernel_ = cl::Kernel(program, "render");
        gather_kernel_ = cl::Kernel(program, "gather");
        clear_kernel_ = cl::Kernel(program, "clear");
        cl_uint place = 0;
        for (const cl::Buffer &buffer : scene_)
            render_kernel_.setArg(place++, buffer);
        render_kernel_.setArg(place, slots_);
        clear_kernel_.setArg(0, scene_[0]);
        clear_kernel_.setArg(1, slots_);
        place = 0;
        for (const cl::Buffer &buffer : {scene_[0], slots_, film_, counts_, invalid_})
            gather_kernel_.setArg(place++, buffer);
        return 0;
    });
    compile_seconds_ += warm_up();
}

// Drivers finish compiling at the first launch of a kernel's shape: launches in which every work-item is past the end.
double Renderer::warm_up() {
    const auto start = std::chrono::steady_clock::now();
    with_device(device_.info, [&] {
        render_kernel_.setArg(cl_uint(scene_.size()) + 1, cl_uint(0));
        set_pass_arguments(render_kernel_, cl_uint(scene_.size()) + 2, 0, 0);
        return launch(render_kernel_, shape_.items_a_launch);
    });
    kernel_seconds_ = 0;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Renderer::restart(unsigned seed, unsigned first_sample) {
    settings_.seed = seed;
    next_ = first_sample;
    kernel_seconds_ = 0;
    with_device(device_.info, [&] {
        device_.queue.enqueueWriteBuffer(scene_[0], CL_TRUE, 0, sizeof settings_, &settings_);
        device_.queue.enqueueFillBuffer(film_, cl_uint(0), 0, pixels_ * FILM_PLANES * 4);
        device_.queue.enqueueFillBuffer(counts_, cl_uint(0), 0, pixels_ * 4);
        device_.queue.enqueueFillBuffer(invalid_, cl_uint(0), 0, (1 + 2 * OPAL_INVALID_RECORDS) * 4);
        return device_.queue.finish();
    });
}

// Runs a launch to its end and returns its seconds on the device. Work-items past `items` find nothing to do.
double Renderer::launch(const cl::Kernel &kernel, unsigned items) {
    cl::Event event;
    const unsigned padded = ceil_div(items, shape_.local_size) * shape_.local_size;
    device_.queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(padded), cl::NDRange(shape_.local_size),
                                       nullptr, &event);
    event.wait();
    const double seconds = 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                         event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    kernel_seconds_ += seconds;
    return seconds;
}

// So many that a launch takes about launch_seconds, by the last pass; the first pass is a pilot of one a chunk.
unsigned Renderer::next_pass_samples(unsigned left) const {
    unsigned samples = shape_.chunks;
    if (seconds_a_sample_ > 0) {
        const double launches = std::max(1.0, double(shape_.tiles) * shape_.chunks / shape_.items_a_launch);
        const double fitting = options_.launch_seconds * launches / seconds_a_sample_;
        samples = std::max(1u, unsigned(std::min(fitting, 1e9) / shape_.chunks)) * shape_.chunks;
    }
    if (options_.max_pass_samples)
        samples = options_.max_pass_samples;
    return std::min(std::clamp(samples, 1u, slot_samples_), left);
}

void Renderer::set_pass_arguments(cl::Kernel &kernel, cl_uint place, unsigned chunk_samples, unsigned pass_samples) {
    for (unsigned value : {shape_.tiles * shape_.chunks, shape_.tile_width, shape_.tile_height, shape_.chunks,
                           chunk_samples, next_, pass_samples})
        kernel.setArg(place++, cl_uint(value));
}

bool Renderer::render_pass(unsigned samples, const Continue &go_on) {
    const unsigned chunk_samples = ceil_div(samples, shape_.chunks), items = shape_.tiles * shape_.chunks;
    const cl_uint first_place = cl_uint(scene_.size()) + 1;
    set_pass_arguments(render_kernel_, first_place + 1, chunk_samples, samples);
    set_pass_arguments(clear_kernel_, 3, chunk_samples, samples);
    double seconds = 0;
    bool stopped = false;
    unsigned done = 0;
    for (const unsigned place : spread_order(ceil_div(items, shape_.items_a_launch))) {
        const unsigned first = place * shape_.items_a_launch;
        if (stopped) { // the slots that nothing is rendered into
            clear_kernel_.setArg(2, cl_uint(first));
            launch(clear_kernel_, shape_.items_a_launch);
            continue;
        }
        render_kernel_.setArg(first_place, cl_uint(first));
        seconds += launch(render_kernel_, shape_.items_a_launch);
        done += std::min(shape_.items_a_launch, items - first);
        stopped = go_on && !go_on(next_ + samples * double(done) / items, kernel_seconds_);
    }
    gather_kernel_.setArg(5, cl_uint(next_));
    gather_kernel_.setArg(6, cl_uint(samples));
    launch(gather_kernel_, ceil_div(unsigned(pixels_), unsigned(options_.build.lanes)));
    seconds_a_sample_ = seconds / samples;
    next_ += samples;
    return !stopped;
}

bool Renderer::render(unsigned end, const Continue &go_on) {
    return with_device(device_.info, [&] {
        while (next_ < end)
            if (!render_pass(next_pass_samples(end - next_), go_on))
                return false;
        return true;
    });
}

Film Renderer::film() const {
    Film film;
    film.width = int(settings_.width);
    film.height = int(settings_.height);
    film.count = read_buffer<cl_uint>(device_, counts_, pixels_);
    const std::vector<float> planes = read_buffer<float>(device_, film_, pixels_ * FILM_PLANES);
    const auto value = [&](unsigned plane, unsigned low, size_t pixel) {
        return double(planes[plane * pixels_ + pixel]) + double(planes[low * pixels_ + pixel]);
    };
    film.sum.resize(pixels_);
    film.squares.resize(pixels_);
    film.weighted.resize(wide_filter_ ? pixels_ : 0);
    for (size_t p = 0; p < pixels_; p++) {
        for (unsigned c = 0; c < 3; c++)
            film.sum[p][c] = value(FILM_SUM + c, FILM_SUM_LOW + c, p);
        for (unsigned c = 0; c < 4; c++)
            film.squares[p][c] = value(FILM_SQUARES + c, FILM_SQUARES_LOW + c, p);
        for (unsigned c = 0; wide_filter_ && c < 4; c++)
            film.weighted[p][c] = value(FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c, p);
    }
    const std::vector<cl_uint> invalid = read_buffer<cl_uint>(device_, invalid_, 1 + 2 * OPAL_INVALID_RECORDS);
    film.invalid = invalid[0];
    for (unsigned i = 0; i < std::min<unsigned>(invalid[0], OPAL_INVALID_RECORDS); i++)
        film.invalid_places.push_back(
            {invalid[1 + 2 * i] % settings_.width, invalid[1 + 2 * i] / settings_.width, invalid[2 + 2 * i]});
    return film;
}

} // namespace opal
