// The film's kernels on samples of the test's own making.
#include "render/renderer.h"
#include "shared/film.h"
#include "stats/moments.h"
#include "support/checks.h"
#include "support/kernels.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

namespace opal::test {

namespace {

constexpr unsigned pixels = 3;
constexpr unsigned samples = 1u << 18;

// `samples` samples a pixel. Pixel 0: one value throughout, which a plain sum of floats would lose as it grows. Pixel
// 1: very different sizes. Pixel 2: with NaN and infinity among them.
std::vector<float> slots_of(unsigned seed) {
    std::mt19937 random(seed);
    std::vector<float> slots(size_t(3) * pixels * samples);
    for (size_t i = 0; i < slots.size(); i++) {
        const size_t pixel = i / (3 * samples);
        slots[i] = pixel == 0   ? 0.1f
                   : pixel == 1 ? std::ldexp(float(random() >> 8), int(random() % 40) - 44)
                                : float(random() >> 8) * 0x1p-24f;
    }
    float *last = slots.data() + size_t(3) * 2 * samples;
    last[3 * 5] = NAN;
    last[3 * 70 + 1] = INFINITY;
    last[3 * 71 + 2] = -INFINITY;
    return slots;
}

// Appends `count` samples of a pixel as a pass of kernels of so many lanes leaves them (samples.cl of cl/film).
void append_samples(std::vector<float> &pass, const float *slots, unsigned count, int lanes) {
    if (lanes == 1) {
        pass.insert(pass.end(), slots, slots + 3 * size_t(count));
        return;
    }
    for (unsigned c = 0; c < 3; c++)
        for (unsigned s = 0; s < count; s++)
            pass.push_back(slots[3 * size_t(s) + c]);
}

bool close(double value, double truth) { return std::abs(value - truth) <= 1e-9 * std::abs(truth); }

} // namespace

Findings check_film(const Sources &sources, unsigned seed) {
    const std::vector<float> slots = slots_of(seed);
    Settings settings{};
    settings.width = pixels;
    settings.height = 1;
    settings.film = {0, 0, pixels, 1};
    Findings findings;
    for (int lanes : tested_lanes()) {
        BuildOptions build;
        build.lanes = lanes;
        const cl::Program program = build_film_program(device(), build, sources);
        const Output<cl_uint> invalid(1 + 2 * OPAL_INVALID_RECORDS);
        // In two passes, so that the sums of one go on in the next, and in two bands.
        const unsigned first = samples / 4 + 5; // which no number of lanes divides
        std::vector<float> planes[FILM_PLANES];
        std::vector<cl_uint> counted;
        for (const auto &[band_first, band_pixels] : {std::pair{0u, 2u}, std::pair{2u, pixels - 2}}) {
            const Output<float> film(FILM_PLANES * band_pixels);
            const Output<cl_uint> counts(band_pixels);
            for (const cl::Buffer &written : {film.buffer, counts.buffer}) // the first pass finds anything there
                device().handles->queue.enqueueFillBuffer(written, cl_uchar(0xff), 0, 4ul * band_pixels);
            for (const auto &[from, count] : {std::pair{0u, first}, std::pair{first, samples - first}}) {
                std::vector<float> pass;
                for (unsigned p = 0; p < pixels; p++)
                    append_samples(pass, slots.data() + 3 * (size_t(p) * samples + from), count, lanes);
                run(program, "gather", (band_pixels + size_t(lanes) - 1) / size_t(lanes),
                    std::vector<Settings>{settings}, pass, cl_uint(from), cl_uint(count), cl_uint(band_first),
                    cl_uint(band_pixels), cl_uint(from == 0), film, counts, invalid);
            }
            const std::vector<float> sums = film.read();
            for (unsigned plane = 0; plane < FILM_PLANES; plane++)
                planes[plane].insert(planes[plane].end(), sums.begin() + plane * band_pixels,
                                     sums.begin() + (plane + 1) * band_pixels);
            for (cl_uint count : counts.read())
                counted.push_back(count);
        }
        const auto value = [&](unsigned plane, unsigned low, unsigned p) {
            return double(planes[plane][p]) + double(planes[low][p]);
        };
        for (unsigned p = 0; p < pixels; p++)
            for (unsigned c = 0; c < 3; c++) {
                stats::CompensatedSum sum, squares;
                for (unsigned s = 0; s < samples; s++) {
                    const float *color = &slots[3 * (size_t(p) * samples + s)];
                    if (!std::isfinite(color[0] + color[1] + color[2]))
                        continue;
                    sum.add(color[c]);
                    squares.add(double(color[c] * color[c]));
                }
                const std::string where = std::to_string(lanes) + " lanes, pixel " + std::to_string(p) + ": ";
                findings.push_back(exact(where + "sum", close(value(FILM_SUM + c, FILM_SUM_LOW + c, p), sum.value())));
                findings.push_back(
                    exact(where + "squares", close(value(FILM_SQUARES + c, FILM_SQUARES_LOW + c, p), squares.value())));
            }
        findings.push_back(exact("samples counted", counted == std::vector<cl_uint>{samples, samples, samples - 3}));
        const std::vector<cl_uint> found = invalid.read();
        findings.push_back(
            exact("invalid samples counted and placed", std::vector<cl_uint>(found.begin(), found.begin() + 7) ==
                                                            std::vector<cl_uint>{3, 2, 5, 2, 70, 2, 71}));
    }
    return findings;
}

Findings check_largest_film() {
    constexpr unsigned width = 1u << 14, last = 4, value = 3, spp = 1; // `last` pixels at the end are a band
    constexpr unsigned tile = 8;
    constexpr unsigned long long sample_bytes = 4 * OPAL_SAMPLE_FLOATS;
    // On a device without a buffer for the samples of 2^28 pixels the image has as many rows of tiles as there is room.
    const unsigned long long rows_of_tiles = device().info.max_allocation / (sample_bytes * width * tile);
    const unsigned height = tile * unsigned(std::min<unsigned long long>(width / tile, rows_of_tiles));
    if (height < width)
        WARN("the largest image is not tested: a buffer of the device has room for " << height << " of " << width
                                                                                     << " rows");
    Settings settings{};
    settings.width = width;
    settings.height = height;
    settings.film = {0, 0, width, height};
    settings.filter = FILTER_tent;
    settings.filter_radius = 1;
    const unsigned long long all = 1ull * width * height;
    Findings findings;
    for (int lanes : tested_lanes()) {
        const std::string where = std::to_string(lanes) + " lanes: ";
        BuildOptions build;
        build.lanes = lanes;
        const cl::Program program = build_film_program(device(), build, Sources::embedded());
        struct Samples {
            cl::Buffer buffer;
        } const samples{make_buffer(device(), CL_MEM_READ_WRITE, sample_bytes * all, nullptr, "a test's samples")};
        // Two rows of one value: what the filter reaches.
        const std::vector<float> rows(size_t(OPAL_SAMPLE_FLOATS) * 2 * width, float(value));
        const unsigned long long place = sample_bytes * (all - 2 * width);
        with_device(device().info, [&] {
            return device().handles->queue.enqueueWriteBuffer(samples.buffer, CL_TRUE, place, 4 * rows.size(),
                                                              rows.data());
        });
        const std::vector<Settings> table{settings};
        const Output<float> film(FILM_PLANES * last), weighted(FILM_WEIGHTED_PLANES * last);
        const Output<cl_uint> counts(last), invalid(1 + 2 * OPAL_INVALID_RECORDS);
        run(program, "gather", last, table, samples, 0u, spp, cl_uint(all - last), last, 1u, film, counts, invalid);
        run(program, "gather_around", last, table, samples, 0u, spp, cl_uint(all - last), last, 1u, weighted);
        const std::vector<float> sums = film.read(), around = weighted.read();
        for (unsigned p = 0; p < last; p++) {
            findings.push_back(exact(where + "sum", sums[FILM_SUM * last + p] == float(value)));
            const float mean = around[FILM_WEIGHTED * last + p] / around[(FILM_WEIGHTED + 3) * last + p];
            findings.push_back(exact(where + "weighted mean", std::abs(mean - float(value)) < 1e-5f));
        }
        findings.push_back(exact(where + "counts", counts.read() == std::vector<cl_uint>(last, 1)));
        // The last tile of 8 x 8 pixels becomes empty, and the pixel before its last row does not.
        const unsigned tiles = width / tile * (height / tile);
        run(program, "clear", 1, table, samples, tiles - 1, tiles, tile, tile, 1u, spp, 0u, spp);
        std::vector<cl_uint> words(OPAL_SAMPLE_FLOATS * (tile + 1));
        with_device(device().info, [&] {
            return device().handles->queue.enqueueReadBuffer(samples.buffer, CL_TRUE, sample_bytes * (all - tile - 1),
                                                             4 * words.size(), words.data());
        });
        for (unsigned p = 0; p <= tile; p++)
            findings.push_back(
                exact(where + "cleared", (words[OPAL_SAMPLE_FLOATS * p] == OPAL_SAMPLE_EMPTY) == (p > 0)));
    }
    return findings;
}

Findings check_crops(const Sources &sources, unsigned seed) {
    Findings findings;
    SceneDescription scene = with_strategy(gallery(23, 17), {{"specialise", "off"}, {"sampler", "sobol"}});
    for (int kind : {FILTER_box, FILTER_gaussian})
        for (int lanes : tested_lanes()) {
            RenderSetup setup;
            setup.lanes = lanes;
            setup.sources = &sources;
            scene.camera.filter.kind = kind;
            scene.camera.filter.radius = kind == FILTER_box ? 0.5 : 2;
            scene.camera.crop = {};
            const Film whole = render(scene, 3, seed, setup);
            // In the middle, at a corner, over whole rows, and a single pixel.
            for (const Crop &crop :
                 {Crop{5, 4, 9, 7, 23, 17}, {14, 11, 9, 6, 23, 17}, {0, 3, 23, 2, 23, 17}, {22, 0, 1, 1, 23, 17}}) {
                scene.camera.crop = crop;
                const Film part = render(scene, 3, seed, setup);
                const Image shown = image_of(part, true), expected = cropped(image_of(whole, true), crop);
                const std::string what = fmt::format("{}, filter {}", text_of(crop), kind);
                bool same = shown.crop == crop && shown.layers.size() == expected.layers.size();
                for (const Layer &layer : shown.layers)
                    same = same && layer.values == expected.get(layer.name).values;
                findings.push_back(exact("bits of " + what, same));
                findings.push_back(
                    exact("counts of " + what, part.count == std::vector<unsigned>(part.count.size(), 3)));
            }
        }
    return findings;
}

Findings check_passes(const Sources &sources, unsigned seed) {
    Findings findings;
    for (int lanes : tested_lanes()) {
        std::vector<Film> films;
        for (unsigned most : {0u, 3u}) {
            RenderSetup setup;
            setup.lanes = lanes;
            setup.sources = &sources;
            setup.max_pass_samples = most;
            films.push_back(render(with_strategy(gallery(9, 9), {{"specialise", "off"}}), 17, seed, setup));
        }
        findings.push_back(exact("sums", films[0].sum == films[1].sum));
        findings.push_back(exact("squares", films[0].squares == films[1].squares));
        findings.push_back(exact("counts", films[0].count == films[1].count));
    }
    return findings;
}

} // namespace opal::test
