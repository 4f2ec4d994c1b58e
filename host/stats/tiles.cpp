#include "stats/tiles.h"

#include "stats/special.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace opal::stats {
namespace {

bool fits(const Estimate &e) {
    size_t pixels = size_t(e.width) * size_t(e.height);
    auto whole = [&](std::span<const float> layer) { return layer.size() == pixels; };
    return pixels > 0 && !e.mean.empty() && e.mean.size() == e.variance.size() &&
           std::all_of(e.mean.begin(), e.mean.end(), whole) && std::all_of(e.variance.begin(), e.variance.end(), whole);
}

// Mean over a box of pixels, the variance of that mean, and Satterthwaite's sum of v^2 / dof.
struct BoxSums {
    double mean = 0, variance = 0, variance_squares = 0;
};

BoxSums sum_box(const Estimate &e, size_t channel, const PixelBox &box) {
    CompensatedSum mean, variance, squares;
    bool negative = false;
    for (int y = box.y; y < box.y + box.height; ++y)
        for (int x = box.x; x < box.x + box.width; ++x) {
            size_t i = size_t(y) * size_t(e.width) + size_t(x);
            double v = e.variance[channel][i];
            negative = negative || v < 0;
            mean.add(e.mean[channel][i]);
            variance.add(v);
            squares.add(v * v / e.dof);
        }
    double n = double(box.width) * box.height;
    return {mean.value() / n, negative ? NAN : variance.value() / (n * n), squares.value() / (n * n * n * n)};
}

// Raises a's variance to that of b, scaled to a's number of samples; see tiles.h.
void borrow_variance(BoxSums &a, const BoxSums &b, double samples_b_over_a) {
    if (!(a.variance < b.variance * samples_b_over_a)) // also where a's is NaN, which must stay
        return;
    a.variance = b.variance * samples_b_over_a;
    a.variance_squares = b.variance_squares * samples_b_over_a * samples_b_over_a;
}

// Size of one hit over the number of samples: the variance of a pixel's mean over its mean, averaged over the pixels
// that have noise.
double quantum_of(const Estimate &e, size_t channel) {
    CompensatedSum mean, variance;
    for (size_t i = 0; i < e.variance[channel].size(); ++i)
        if (e.variance[channel][i] > 0 && std::isfinite(e.variance[channel][i]) && std::isfinite(e.mean[channel][i])) {
            variance.add(e.variance[channel][i]);
            mean.add(std::abs(e.mean[channel][i]));
        }
    return mean.value() > 0 ? variance.value() / mean.value() : 0;
}

// Raises the variance of a box with few hits to that of hits of the quantum's size. own: its sums before other rules.
void allow_for_rare_hits(BoxSums &sums, const BoxSums &own, double sure_hits, double least_variance) {
    if (own.mean * own.mean >= sure_hits * own.variance && (own.mean != 0 || sure_hits == 0))
        return;
    if (least_variance > sums.variance) {
        sums.variance = least_variance;
        sums.variance_squares = 0; // known from the whole image
    }
}

// How far one hit moves a pixel: the variance of a pixel's mean over the square of the mean around it.
double relative_variance_of(const Estimate &e, size_t channel, const std::vector<PixelBox> &tiles) {
    CompensatedSum variance, squares;
    for (const PixelBox &tile : tiles)
        if (const BoxSums sums = sum_box(e, channel, tile); std::isfinite(sums.mean) && std::isfinite(sums.variance)) {
            const double pixels = double(tile.width) * tile.height;
            variance.add(sums.variance * pixels * pixels);
            squares.add(sums.mean * sums.mean * pixels);
        }
    return squares.value() > 0 ? variance.value() / squares.value() : 0;
}

// The darker estimate may lack light that it finds only by rare hits, none of which fell into this box.
void allow_for_missed_hits(BoxSums &darker, const BoxSums &brighter, double relative_variance_a_pixel) {
    const double lacking = brighter.mean - darker.mean;
    if (lacking > 0 && std::isfinite(lacking))
        darker.variance += lacking * std::abs(brighter.mean) * relative_variance_a_pixel;
}

TestResult judge(const BoxSums &a, const BoxSums &b, const TileOptions &o) {
    double variance = a.variance + b.variance, squares = a.variance_squares + b.variance_squares;
    double dof = squares == 0 ? std::numeric_limits<double>::infinity() : variance / squares * variance;
    double scale = std::max(std::abs(a.mean), std::abs(b.mean));
    return difference_test(a.mean - b.mean, std::sqrt(o.variance_inflation * variance), dof, scale, o.relative_floor);
}

struct Channel {
    const Estimate &a, &b;
    size_t index;
    double quantum_a, quantum_b, relative_variance_a, relative_variance_b;
};

TestResult judge_tile(const Channel &c, const PixelBox &box, const TileOptions &o) {
    const BoxSums own_a = sum_box(c.a, c.index, box), own_b = sum_box(c.b, c.index, box);
    BoxSums a = own_a, b = own_b;
    if (c.a.samples > 0 && c.b.samples > 0) {
        borrow_variance(a, own_b, c.b.samples / c.a.samples);
        borrow_variance(b, own_a, c.a.samples / c.b.samples);
    }
    const double pixels = double(box.width) * box.height, mean = std::max(std::abs(a.mean), std::abs(b.mean)) / pixels;
    allow_for_rare_hits(a, own_a, o.sure_hits, mean * c.quantum_a);
    allow_for_rare_hits(b, own_b, o.sure_hits, mean * c.quantum_b);
    if (o.sure_hits > 0) {
        allow_for_missed_hits(a, b, c.relative_variance_a / pixels);
        allow_for_missed_hits(b, a, c.relative_variance_b / pixels);
    }
    return judge(a, b, o);
}

// z with the same sign and two-sided p. A tile that cannot be judged (NaN) gets infinity.
double equivalent_z(const TestResult &test) {
    return std::copysign(-normal_quantile(test.p_value / 2), std::isnan(test.statistic) ? 1 : test.statistic);
}

PixelBox tile_box(const TileTest &t, const Estimate &e, size_t tile) {
    int x = int(tile % size_t(t.columns)) * t.size, y = int(tile / size_t(t.columns)) * t.size;
    return {x, y, std::min(t.size, e.width - x), std::min(t.size, e.height - y)};
}

std::vector<PixelBox> boxes_of(const TileTest &t, const Estimate &e) {
    std::vector<PixelBox> boxes;
    for (size_t tile = 0; tile < size_t(t.columns) * size_t(t.rows); ++tile)
        boxes.push_back(tile_box(t, e, tile));
    return boxes;
}

PixelBox join(const PixelBox &a, const PixelBox &b) {
    int x = std::min(a.x, b.x), y = std::min(a.y, b.y);
    return {x, y, std::max(a.x + a.width, b.x + b.width) - x, std::max(a.y + a.height, b.y + b.height) - y};
}

// The region of `start`: connected tiles that are significant with its sign and not `seen` yet.
std::vector<size_t> flood(const TileTest &t, size_t channel, size_t start, double significance,
                          std::vector<bool> &seen) {
    size_t tiles = size_t(t.columns) * size_t(t.rows), columns = size_t(t.columns), base = channel * tiles;
    std::vector<size_t> found = {start};
    seen[start] = true;
    auto visit = [&](bool exists, size_t tile) {
        if (exists && !seen[tile] && t.p[base + tile] < significance &&
            std::signbit(t.z[base + tile]) == std::signbit(t.z[base + start])) {
            seen[tile] = true;
            found.push_back(tile);
        }
    };
    for (size_t i = 0; i < found.size(); ++i) {
        size_t tile = found[i], column = tile % columns;
        visit(column > 0, tile - 1);
        visit(column + 1 < columns, tile + 1);
        visit(tile >= columns, tile - columns);
        visit(tile + columns < tiles, tile + columns);
    }
    return found;
}

Region describe(const TileTest &t, const Estimate &a, const Estimate &b, size_t channel,
                const std::vector<size_t> &tiles) {
    Region region{channel, tile_box(t, a, tiles[0]), int(tiles.size()), 0, 0, 0};
    double pixels = 0;
    for (size_t tile : tiles) {
        PixelBox box = tile_box(t, a, tile);
        double n = double(box.width) * box.height;
        region.box = join(region.box, box);
        region.statistic += t.z[channel * size_t(t.columns) * size_t(t.rows) + tile] / std::sqrt(double(tiles.size()));
        region.mean_a += n * sum_box(a, channel, box).mean;
        region.mean_b += n * sum_box(b, channel, box).mean;
        pixels += n;
    }
    region.mean_a /= pixels;
    region.mean_b /= pixels;
    return region;
}

Region largest_region(const TileTest &t, const Estimate &a, const Estimate &b, double significance) {
    Region largest;
    size_t tiles = size_t(t.columns) * size_t(t.rows);
    for (size_t channel = 0; channel < t.channels; ++channel) {
        std::vector<bool> seen(tiles);
        for (size_t start = 0; start < tiles; ++start) {
            if (seen[start] || !(t.p[channel * tiles + start] < significance))
                continue;
            Region region = describe(t, a, b, channel, flood(t, channel, start, significance, seen));
            if (region.tiles > largest.tiles ||
                (region.tiles == largest.tiles && std::abs(region.statistic) > std::abs(largest.statistic)))
                largest = region;
        }
    }
    return largest;
}

} // namespace

TileTest tile_test(const Estimate &a, const Estimate &b, const TileOptions &options) {
    TileTest t;
    if (!fits(a) || !fits(b) || a.width != b.width || a.height != b.height || a.mean.size() != b.mean.size()) {
        t.reason = "the images differ in size or channels, or lack variances";
        return t;
    }
    t.size = options.size;
    t.columns = (a.width + t.size - 1) / t.size;
    t.rows = (a.height + t.size - 1) / t.size;
    t.channels = a.mean.size();
    const std::vector<PixelBox> boxes = boxes_of(t, a);
    size_t tiles = boxes.size();
    double smallest = 1;
    for (size_t channel = 0; channel < t.channels; ++channel) {
        const Channel both{a,
                           b,
                           channel,
                           quantum_of(a, channel),
                           quantum_of(b, channel),
                           relative_variance_of(a, channel, boxes),
                           relative_variance_of(b, channel, boxes)};
        const PixelBox everything{0, 0, a.width, a.height};
        t.whole.push_back(judge(sum_box(a, channel, everything), sum_box(b, channel, everything), options));
        smallest = std::min(smallest, t.whole.back().p_value);
        for (size_t tile = 0; tile < tiles; ++tile) {
            TestResult test = judge_tile(both, boxes[tile], options);
            t.z.push_back(equivalent_z(test));
            t.p.push_back(test.p_value);
            smallest = std::min(smallest, test.p_value);
            if (t.z.size() == 1 || std::abs(t.z.back()) > std::abs(t.worst_z)) {
                t.worst_channel = channel;
                t.worst_tile = boxes[tile];
                t.worst_z = t.z.back();
            }
        }
    }
    t.p_value = sidak_p(smallest, double(t.channels * (tiles + 1)));
    t.region = largest_region(t, a, b, options.region_significance);
    return t;
}

} // namespace opal::stats
