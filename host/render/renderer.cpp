#include "render/renderer.h"

#include "base/memory.h"
#include "base/progress.h"
#include "base/signals.h"
#include "device/program.h"
#include "device/scene_buffers.h"
#include "shared/film.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <thread>

namespace opal {

namespace {

// The buffer of a pass's samples. Kernels index its floats by 32 bits.
constexpr unsigned long long sample_bytes = 4ull * OPAL_SAMPLE_FLOATS;
constexpr unsigned long long max_sample_buffer_bytes = 256ull << 20,
                             max_buffer_samples = (1ull << 32) / OPAL_SAMPLE_FLOATS;
// CPU: the film and the samples of a pass take about so many bytes a pixel. Small images may take more.
constexpr unsigned long long cpu_bytes_a_pixel = 120, small_sample_buffer_bytes = 64ull << 20;

// The memory of a pixel when the film is read and the image written: double sums, layers and files, as the device's
// film is freed band by band; measured. Each thread that writes reserves a heap and a stack.
constexpr double host_bytes_a_pixel = 72, host_bytes_a_wide_pixel = 104, bytes_a_writer = 72 << 20;

// Pixels of a band of the film, whose sums are a buffer of 29 MB. PoCL compiles kernels apart for launches of more than
// 65535 work-groups: at 8 lanes a band has no more, so images of all sizes share one compilation.
constexpr unsigned band_pixels = 8 * 65535;

// A work-item renders one chunk of the samples of one tile. Tiles are cut into chunks for about so many work-items a
// pass that all cores stay busy to its end.
constexpr unsigned max_chunks = 4096, max_samples_a_chunk = 64;
// CPU: tiles of 8 x 8 pixels keep 16 lanes full for most of the time.
constexpr unsigned cpu_tile_side = 8, cpu_items_a_core = 64, max_cpu_items_a_launch = 512;
// GPU: one pixel for each work-item, and enough of them to hide the latency of its memory.
constexpr unsigned gpu_tile_side = 1, gpu_items = 1u << 17, max_gpu_items_a_launch = 1u << 20;

// Where paths may be endless: rounds of the loop in a launch, at least some for each time that the state is kept, and
// no more than take seconds, whatever a clock says.
constexpr double least_rounds = 16, max_rounds = 1 << 24;

unsigned ceil_div(unsigned a, unsigned b) { return (a + b - 1) / b; }

// The numbers 0 .. count - 1, sorted by the fractional parts of their multiples of the golden ratio. Launches are
// strips of the image from its top down; in this order the finished ones lie evenly over the image whenever a pass is
// stopped.
std::vector<unsigned> spread_order(unsigned count) {
    const auto place = [](unsigned i) { return std::fmod(i * std::numbers::phi, 1.0); };
    std::vector<unsigned> order(count);
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, place);
    return order;
}

} // namespace

cl::Program build_film_program(const Device &device, const BuildOptions &options, const Sources &sources, int sampler,
                               double *seconds) {
    Features features; // no feature: the text is the same for all scenes
    features.axes[AXIS_sampler] = sampler;
    const BuildOptions build{.lanes = options.lanes, .math = options.math, .kernels = "kernels/film.cl"};
    return build_program(device, program_text(features, build, sources), build, seconds);
}

// Consecutive pixels of the film: planes of their sums, and of the filter's weighted sums where it is wide.
struct Renderer::FilmBand {
    size_t first = 0, pixels = 0;
    cl::Buffer sums, counts, weighted;
};

struct Renderer::OnDevice {
    FlatScene tables; // that the buffers of `scene` may share
    std::vector<cl::Buffer> scene;
    cl::Buffer samples, invalid;
    cl::Buffer unfinished, any_unfinished; // the items of a launch, where paths may be endless; one word
    std::vector<FilmBand> bands;
    cl::Kernel render, gather, gather_around, clear;
};

Renderer::LaunchShape Renderer::launch_shape() const {
    const bool gpu = device_.info.type == "gpu";
    LaunchShape s{};
    s.tile_width = s.tile_height = gpu ? gpu_tile_side : cpu_tile_side;
    s.local_size = unsigned(group_size(device_.info));
    s.tiles = ceil_div(settings_.film.width, s.tile_width) * ceil_div(settings_.film.height, s.tile_height);
    const unsigned wanted_items = gpu ? gpu_items : cpu_items_a_core * std::max(1u, device_.info.compute_units);
    s.chunks = std::clamp(wanted_items / s.tiles, 1u, max_chunks);
    const unsigned max_items = gpu ? max_gpu_items_a_launch : max_cpu_items_a_launch;
    s.items_a_launch = ceil_div(std::min(max_items, s.tiles * s.chunks), s.local_size) * s.local_size;
    return s;
}

Renderer::Renderer(const Device &device, FlatScene scene, const RenderOptions &options)
    : device_(device), settings_(scene.settings), crop_(scene.crop), options_(options),
      pixels_(size_t(scene.settings.film.width) * scene.settings.film.height),
      wide_filter_(is_wide_filter(scene.settings)), endless_paths_(scene.features[FEATURE_endless_paths]),
      on_device_(std::make_unique<OnDevice>()) {
    const std::string what = fmt::format("{} x {} pixels", settings_.film.width, settings_.film.height);
    if (pixels_ > max_buffer_samples)
        throw Error(fmt::format("an image of {}: possible are {:.4g} pixels at the most, as kernels count their "
                                "samples by 32 bits",
                                what, double(max_buffer_samples)));
    shape_ = launch_shape();
    const unsigned long long film_bytes =
        4ull * (FILM_PLANES + 1 + (wide_filter_ ? FILM_WEIGHTED_PLANES : 0)); // of a pixel; the 1 is its count
    unsigned long long bytes =
        std::min({max_sample_buffer_bytes, device.info.max_allocation, sample_bytes * max_buffer_samples});
    if (device.info.type == "cpu")
        bytes = std::min(bytes, std::max(small_sample_buffer_bytes, pixels_ * (cpu_bytes_a_pixel - film_bytes)));
    buffer_spp_ = unsigned(
        std::clamp<unsigned long long>(bytes / sample_bytes / pixels_, 1, 1ull * max_samples_a_chunk * max_chunks));
    const unsigned long long device_bytes = pixels_ * (film_bytes + sample_bytes * buffer_spp_);
    check_room(device, device_bytes, fmt::format("the film of {} and its samples", what));
    // The host's memory at its peak, which comes when the film is read and the image written.
    const double read_bytes = double(pixels_) * (wide_filter_ ? host_bytes_a_wide_pixel : host_bytes_a_pixel);
    const double reserved =
        double(pixels_ * Film::bytes_a_pixel(wide_filter_)) + bytes_a_writer * std::thread::hardware_concurrency();
    const bool shared = shares_memory(device);
    check_memory(shared ? std::max(read_bytes, double(device_bytes)) : read_bytes,
                 shared ? std::max(reserved + double(pixels_ * film_bytes), double(device_bytes)) : reserved,
                 fmt::format("an image of {}", what));

    const RunningProgress compiling("compile");
    const EndedBySignals compilation;
    double film_seconds = 0;
    const cl::Program program = build_program(device, program_text(scene.features, options.build, *options.sources),
                                              options.build, &compile_seconds_);
    const int film_sampler = wide_filter_ ? scene.features.axes[AXIS_sampler] : -1;
    const cl::Program film_program =
        build_film_program(device, options.build, *options.sources, film_sampler, &film_seconds);
    on_device_->tables = std::move(scene);
    on_device_->scene = upload_scene(device, on_device_->tables);
    if (!shares_memory(device))
        on_device_->tables = {};
    on_device_->samples =
        make_buffer(device, CL_MEM_READ_WRITE, pixels_ * sample_bytes * buffer_spp_, nullptr, "the samples of a pass");
    on_device_->invalid = make_zeros<cl_uint>(device, 1 + 2 * OPAL_INVALID_RECORDS, "the list of invalid samples");
    on_device_->any_unfinished = make_zeros<cl_uint>(device, 1, "a word");
    on_device_->unfinished = on_device_->any_unfinished; // a place that no kernel reads, but where paths may be endless
    for (size_t first = 0; first < pixels_; first += band_pixels) {
        const size_t pixels = std::min<size_t>(band_pixels, pixels_ - first);
        const auto planes = [&](unsigned count) { // gather writes them in the first pass
            return make_buffer(device, CL_MEM_READ_WRITE, 4ull * count * pixels, nullptr, "a part of the film");
        };
        on_device_->bands.push_back({first, pixels, planes(FILM_PLANES), planes(1),
                                     wide_filter_ ? planes(FILM_WEIGHTED_PLANES) : cl::Buffer()});
    }

    with_device(device.info, [&] {
        on_device_->render = cl::Kernel(program, "render");
        on_device_->gather = cl::Kernel(film_program, "gather");
        on_device_->gather_around = cl::Kernel(film_program, by_strips() ? "gather_strips" : "gather_around");
        on_device_->clear = cl::Kernel(film_program, "clear");
        cl_uint argument = 0;
        for (const cl::Buffer &buffer : on_device_->scene)
            on_device_->render.setArg(argument++, buffer);
        return 0;
    });
    set_film_arguments();
    compile_seconds_ += film_seconds + warm_up();
    if (endless_paths_)
        make_room_for_unfinished();
}

Renderer::~Renderer() = default;

void Renderer::set_film_arguments() {
    with_device(device_.info, [&] {
        on_device_->render.setArg(cl_uint(on_device_->scene.size()), on_device_->samples);
        for (cl::Kernel *kernel : {&on_device_->clear, &on_device_->gather, &on_device_->gather_around}) {
            kernel->setArg(0, on_device_->scene[0]);
            kernel->setArg(1, on_device_->samples);
        }
        on_device_->gather.setArg(9, on_device_->invalid);
        return 0;
    });
}

void Renderer::share_film(const Renderer &other) {
    if (pixels_ != other.pixels_ || buffer_spp_ != other.buffer_spp_ || wide_filter_ != other.wide_filter_)
        throw std::logic_error("share_film: the other renderer's film is of another shape");
    on_device_->samples = other.on_device_->samples;
    on_device_->bands = other.on_device_->bands;
    on_device_->invalid = other.on_device_->invalid;
    empty_ = true;
    set_film_arguments();
}

// Launches the render kernel without any sample to render, because drivers finish compiling at a kernel's first launch
// of a shape. Returns the seconds, which count as compile time.
double Renderer::warm_up() {
    const auto start = std::chrono::steady_clock::now();
    with_device(device_.info, [&] {
        on_device_->render.setArg(cl_uint(on_device_->scene.size()) + 1, cl_uint(0));
        set_pass_arguments(on_device_->render, cl_uint(on_device_->scene.size()) + 2, 0, 0);
        set_round_arguments(0, false);
        return launch(on_device_->render, shape_.items_a_launch);
    });
    kernel_seconds_ = 0;
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Where paths may be endless: the launch of no rounds has told how many bytes an unfinished item takes.
void Renderer::make_room_for_unfinished() {
    const unsigned long long bytes = read_buffer<cl_uint>(device_, on_device_->any_unfinished, 1)[0];
    on_device_->unfinished =
        make_buffer(device_, CL_MEM_READ_WRITE, bytes * shape_.items_a_launch, nullptr, "unfinished paths");
}

void Renderer::restart(unsigned seed, unsigned first_sample) {
    settings_.seed = seed;
    next_sample_ = first_sample;
    empty_ = true;
    kernel_seconds_ = 0;
    with_device(device_.info, [&] {
        device_.handles->queue.enqueueWriteBuffer(on_device_->scene[0], CL_TRUE, 0, sizeof settings_, &settings_);
        device_.handles->queue.enqueueFillBuffer(on_device_->invalid, cl_uint(0), 0,
                                                 (1 + 2 * OPAL_INVALID_RECORDS) * 4ull);
        return device_.handles->queue.finish();
    });
}

// Launches `items` work-items, rounded up to whole work-groups, waits for them and returns the kernel's seconds.
double Renderer::launch(const cl::Kernel &kernel, unsigned items) {
    const LaunchScope scope(device_, kernel);
    cl::Event event;
    const unsigned padded = ceil_div(items, shape_.local_size) * shape_.local_size;
    device_.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(padded),
                                                cl::NDRange(shape_.local_size), nullptr, &event);
    event.wait();
    const double seconds = 1e-9 * double(event.getProfilingInfo<CL_PROFILING_COMMAND_END>() -
                                         event.getProfilingInfo<CL_PROFILING_COMMAND_START>());
    kernel_seconds_ += seconds;
    return seconds;
}

// The samples of each pixel in the next pass: as many as let a launch take about launch_seconds, by the last pass. Each
// chunk has a multiple of the lanes, if it can, because so many samples of a pixel are stored and added as vectors. The
// first pass is a pilot with one sample a chunk.
unsigned Renderer::next_pass_samples(unsigned left) const {
    unsigned samples = shape_.chunks;
    if (seconds_a_sample_ > 0) {
        const double launches = std::max(1.0, double(shape_.tiles) * shape_.chunks / shape_.items_a_launch);
        const double fitting = options_.launch_seconds * launches / seconds_a_sample_;
        samples = std::max(1u, unsigned(std::min(fitting, 1e9) / shape_.chunks)) * shape_.chunks;
    }
    samples = std::clamp(options_.max_pass_samples ? options_.max_pass_samples : samples, 1u, buffer_spp_);
    const unsigned vectors = shape_.chunks * unsigned(options_.build.lanes);
    if (samples > vectors && !options_.max_pass_samples)
        samples -= samples % vectors;
    return std::min(samples, left);
}

void Renderer::set_pass_arguments(cl::Kernel &kernel, unsigned first_argument, unsigned chunk_samples,
                                  unsigned pass_samples) {
    for (unsigned value : {shape_.tiles * shape_.chunks, shape_.tile_width, shape_.tile_height, shape_.chunks,
                           chunk_samples, next_sample_, pass_samples})
        kernel.setArg(first_argument++, cl_uint(value));
}

// most_rounds: of a launch where paths may be endless. again: it goes on with those that the last one has left.
void Renderer::set_round_arguments(unsigned most_rounds, bool again) {
    cl_uint argument = cl_uint(on_device_->scene.size()) + 9; // after those of the pass
    on_device_->render.setArg(argument++, on_device_->unfinished);
    on_device_->render.setArg(argument++, on_device_->any_unfinished);
    on_device_->render.setArg(argument++, cl_uint(most_rounds));
    on_device_->render.setArg(argument, cl_uint(again));
}

// Renders a launch's items to their end. Where paths may be endless, that takes several launches of about
// launch_seconds, and goes_on is asked between them. Returns false if it says no.
bool Renderer::render_items(const std::function<bool()> &goes_on) {
    if (!endless_paths_) {
        launch(on_device_->render, shape_.items_a_launch);
        return true;
    }
    double rounds = most_rounds_;
    for (bool again = false;; again = true) {
        set_round_arguments(unsigned(rounds), again);
        device_.handles->queue.enqueueFillBuffer(on_device_->any_unfinished, cl_uint(0), 0, sizeof(cl_uint));
        const auto start = std::chrono::steady_clock::now(); // no event's: some drivers' clocks stand still
        launch(on_device_->render, shape_.items_a_launch);
        if (!read_buffer<cl_uint>(device_, on_device_->any_unfinished, 1)[0])
            return true;
        const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        rounds = std::clamp(rounds * std::clamp(options_.launch_seconds / seconds, 0.1, 2.0), least_rounds, max_rounds);
        if (!again) // later ones have fewer items to go on with
            most_rounds_ = rounds;
        if (!goes_on())
            return false;
    }
}

bool Renderer::render_pass(unsigned samples, const OnLaunch &on_launch) {
    const unsigned chunk_samples = ceil_div(samples, shape_.chunks), items = shape_.tiles * shape_.chunks;
    const cl_uint first_item_argument = cl_uint(on_device_->scene.size()) + 1; // after the tables and the samples
    set_pass_arguments(on_device_->render, first_item_argument + 1, chunk_samples, samples);
    set_pass_arguments(on_device_->clear, 3, chunk_samples, samples);
    const double seconds_before = kernel_seconds_;
    bool stopped = false;
    unsigned done = 0;
    const auto goes_on = [&] {
        return !on_launch || on_launch(next_sample_ + samples * double(done) / items, kernel_seconds_);
    };
    for (const unsigned index : spread_order(ceil_div(items, shape_.items_a_launch))) {
        const unsigned first = index * shape_.items_a_launch;
        on_device_->render.setArg(first_item_argument, cl_uint(first));
        if (stopped || !render_items(goes_on)) { // marks the samples of this launch as missing
            stopped = true;
            on_device_->clear.setArg(2, cl_uint(first));
            launch(on_device_->clear, shape_.items_a_launch);
            continue;
        }
        done += std::min(shape_.items_a_launch, items - first);
        stopped = !goes_on();
    }
    seconds_a_sample_ = (kernel_seconds_ - seconds_before) / samples;
    gather(samples);
    next_sample_ += samples;
    return !stopped;
}

// Are wide filters gathered for by gather_strips (cl/film/many_lanes/strips.cl)?
bool Renderer::by_strips() const {
    return options_.build.lanes > 1 && settings_.filter_radius <= OPAL_STRIP_REACH + 0.5f;
}

// Adds the pass, `samples` of each pixel from next_sample_ on, to all bands.
void Renderer::gather(unsigned samples) {
    const unsigned pixels = unsigned(std::min<size_t>(band_pixels, pixels_)), lanes = unsigned(options_.build.lanes);
    const unsigned width = settings_.film.width, items = ceil_div(pixels, lanes);
    const unsigned rows = ceil_div(pixels - 1, width) + 1; // that a band touches, at the most
    const unsigned items_around =
        by_strips() ? ceil_div(width, OPAL_STRIP_VECTORS * lanes) * ceil_div(rows, OPAL_STRIP_ROWS) : items;
    for (const FilmBand &band : on_device_->bands) {
        const auto launch_kernel = [&](cl::Kernel &kernel, unsigned count, std::initializer_list<cl::Buffer> film) {
            cl_uint argument = 2; // after the settings and the samples
            for (const size_t value : {size_t(next_sample_), size_t(samples), band.first, band.pixels, size_t(empty_)})
                kernel.setArg(argument++, cl_uint(value));
            for (const cl::Buffer &buffer : film)
                kernel.setArg(argument++, buffer);
            launch(kernel, count); // of one shape, whatever the band's size
        };
        launch_kernel(on_device_->gather, items, {band.sums, band.counts});
        if (wide_filter_)
            launch_kernel(on_device_->gather_around, items_around, {band.weighted});
    }
    empty_ = false;
}

bool Renderer::render(unsigned end, const OnLaunch &on_launch) {
    return with_device(device_.info, [&] {
        while (next_sample_ < end)
            if (!render_pass(next_pass_samples(end - next_sample_), on_launch))
                return false;
        return true;
    });
}

// Calls visit(pixel of the band) for the band's pixels that are shown, in their order: the device's film is larger than
// the image by what wide filters need around a crop.
template <class Visit> void Renderer::visit_shown(const FilmBand &band, Visit visit) const {
    const PixelWindow &film = settings_.film;
    const size_t left = size_t(crop_.x) - film.left, top = size_t(crop_.y) - film.top;
    const size_t end = band.first + band.pixels, bottom = std::min(top + size_t(crop_.height), end / film.width + 1);
    for (size_t y = std::max(top, band.first / film.width); y < bottom; y++) {
        const size_t row = y * film.width + left;
        for (size_t p = std::max(row, band.first); p < std::min(row + size_t(crop_.width), end); p++)
            visit(p - band.first);
    }
}

// Adds the band's pixels to the end of `film`.
void Renderer::read_band(const FilmBand &band, Film &film) const {
    const auto sum = [&](const float *planes, unsigned plane, unsigned low, size_t pixel) { // hi + lo
        return double(planes[plane * band.pixels + pixel]) + double(planes[low * band.pixels + pixel]);
    };
    read_mapped<cl_uint>(device_, band.counts, band.pixels, [&](const cl_uint *counts) {
        visit_shown(band, [&](size_t pixel) { film.count.push_back(counts[pixel]); });
    });
    read_mapped<float>(device_, band.sums, FILM_PLANES * band.pixels, [&](const float *planes) {
        visit_shown(band, [&](size_t pixel) {
            auto &own = film.sum.emplace_back();
            for (unsigned c = 0; c < 3; c++)
                own[c] = sum(planes, FILM_SUM + c, FILM_SUM_LOW + c, pixel);
            auto &squares = film.squares.emplace_back();
            for (unsigned c = 0; c < 4; c++)
                squares[c] = sum(planes, FILM_SQUARES + c, FILM_SQUARES_LOW + c, pixel);
        });
    });
    if (wide_filter_)
        read_mapped<float>(device_, band.weighted, FILM_WEIGHTED_PLANES * band.pixels, [&](const float *planes) {
            visit_shown(band, [&](size_t pixel) {
                auto &weighted = film.weighted.emplace_back();
                for (unsigned c = 0; c < 4; c++)
                    weighted[c] = sum(planes, FILM_WEIGHTED + c, FILM_WEIGHTED_LOW + c, pixel);
            });
        });
}

template <class AfterBand> Film Renderer::read_film(AfterBand after_band) const {
    const size_t shown = size_t(crop_.width) * size_t(crop_.height);
    Film film;
    film.width = crop_.width;
    film.height = crop_.height;
    film.crop = crop_.is_whole() ? Crop{} : crop_;
    film.sum.reserve(shown); // and not resized: memory is taken band by band, as the device's may be freed
    film.squares.reserve(shown);
    film.weighted.reserve(wide_filter_ ? shown : 0);
    film.count.reserve(shown);
    for (FilmBand &band : on_device_->bands) {
        if (!empty_)
            read_band(band, film);
        after_band(band);
    }
    film.sum.resize(shown); // with zeros, where nothing was rendered
    film.squares.resize(shown);
    film.weighted.resize(wide_filter_ ? shown : 0);
    film.count.resize(shown);
    const std::vector<cl_uint> invalid =
        read_buffer<cl_uint>(device_, on_device_->invalid, 1 + 2 * OPAL_INVALID_RECORDS);
    film.invalid = invalid[0];
    for (unsigned i = 0; i < std::min<unsigned>(invalid[0], OPAL_INVALID_RECORDS); i++)
        film.invalid_places.push_back({settings_.film.left + invalid[1 + 2 * i] % settings_.film.width,
                                       settings_.film.top + invalid[1 + 2 * i] / settings_.film.width,
                                       invalid[2 + 2 * i]});
    return film;
}

Film Renderer::film() const {
    return read_film([](FilmBand &) {});
}

Film Renderer::take_film() {
    on_device_->samples = cl::Buffer();
    return read_film([](FilmBand &band) { band.sums = band.counts = band.weighted = cl::Buffer(); });
}

} // namespace opal
