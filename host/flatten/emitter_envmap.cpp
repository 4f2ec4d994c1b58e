#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <algorithm>
#include <numbers>

namespace opal {

namespace {

constexpr double pi = std::numbers::pi;

// The least that a texel counts, as a share of the mean texel: however bright the sun is, a dim sky gets its samples.
// Of these 1 in 256 at most is taken from what is bright.
constexpr double least_share = 1.0 / 256;

// With less contrast there is nothing to leave out (Mitsuba's bound).
constexpr double least_contrast = 0.01;

// As EnvironmentMap::luminance_at, inlined: 34 million calls would take a fifth of a second.
float luminance_of(const EnvironmentMap &map, std::size_t texel) {
    const float *const color = &map.texels[3 * texel];
    return float(luminance({color[0], color[1], color[2]}));
}

// A map as light sampling sees it: what each texel counts. The device computes the same of the record.
class Importance {
public:
    Importance(const EnvironmentMap &map, bool compensate) : map_(&map) {
        const std::size_t texels = std::size_t(map.width) * std::size_t(map.height);
        double sum = 0;
        float darkest = luminance_of(map, 0);
        for (std::size_t i = 0; i < texels; i++) {
            const float luminance = luminance_of(map, i);
            sum += luminance;
            darkest = std::min(darkest, luminance);
        }
        const double mean = sum / double(texels);
        if (compensate && mean - darkest > least_contrast * mean)
            subtracted = float(mean);
        else
            least = float(mean * least_share);
    }

    // Of all texels of a row, and of the first one again.
    void row(int y, std::vector<float> &to) const {
        const int from_pole = std::min(y, map_->height - 1 - y);
        const auto sine = float(std::sin(pi * from_pole / (map_->height - 1)));
        for (std::size_t x = 0; x + 1 < to.size(); x++)
            to[x] = std::max(luminance_of(*map_, std::size_t(y) * (to.size() - 1) + x) - subtracted, least) * sine;
        to.back() = to.front();
    }

    float subtracted = 0, least = 0;

private:
    const EnvironmentMap *map_;
};

// Fills colours, and in `accept` what the cell of each texel counts: the mean of its corners. `other` is the cell
// itself. Returns the sum of these means.
double fill_texels(const EnvironmentMap &map, const Importance &importance, LargeVector<EnvironmentTexel> &texels) {
    const auto width = std::size_t(map.width);
    std::vector<float> above(width + 1), below(width + 1);
    texels.clear();
    texels.reserve(width * std::size_t(map.height)); // and not resize(), which would write all of it once more
    importance.row(0, above);
    double sum = 0;
    const float *color = map.texels.data();
    for (int y = 0; y + 1 < map.height; y++) {
        importance.row(y + 1, below);
        for (std::size_t x = 0; x < width; x++, color += 3) {
            const float mean = (above[x] + above[x + 1] + below[x] + below[x + 1]) / 4;
            texels.push_back({{color[0], color[1], color[2]}, mean, uint(texels.size())});
            sum += double(mean);
        }
        std::swap(above, below);
    }
    for (std::size_t x = 0; x < width; x++, color += 3)
        texels.push_back({{color[0], color[1], color[2]}, 0, 0});
    return sum;
}

// Turns the shares of n cells, over their mean in `accept`, into an alias table, in place and in two walks through it:
// each cell with less than the mean share is filled up by the next one that has more left than that.
// Of Vose's table (flatten/distribution.h) 34 million cells would take too much memory and time.
void build_alias_table_in_place(EnvironmentTexel *cells, uint n, double sum) {
    const double scale = double(n) / sum;
    const auto share = [&](uint i) { return double(cells[i].accept) * scale; };
    const auto next = [&](uint i, bool rich) {
        while (i < n && (cells[i].other != i || (share(i) > 1) != rich))
            i++;
        return i;
    };
    uint poor = next(0, false), rich = next(0, true);
    double left = rich < n ? share(rich) : 0;
    while (rich < n) {
        if (left <= 1) { // it is poor by now
            const uint other = next(rich + 1, true);
            if (other == n)
                break;
            cells[rich].accept = float(left);
            cells[rich].other = other;
            left = share(other) - (1 - left);
            rich = other;
        } else {
            if (poor == n)
                break;
            left -= 1 - share(poor);
            cells[poor].accept = float(share(poor));
            cells[poor].other = rich;
            poor = next(poor + 1, false);
        }
    }
    for (uint i = 0; i < n; i++) // up to rounding, what is left has the mean share
        if (cells[i].other == i)
            cells[i].accept = 1;
}

} // namespace

void add_extent(const emitter_envmap &, Extent &) {}

// pi L on the average through each point of the bounding sphere, whose surface is 4 pi radius^2.
double power_of(const emitter_envmap &light, double radius) {
    return pi * light.map->mean_luminance * light.scale * 4 * pi * radius * radius;
}

emitter_envmap_record flattened(const emitter_envmap &light, const Flattening &) {
    emitter_envmap_record record{};
    const Transform to_world = orthonormal(light.to_world);
    for (std::size_t row = 0; row < 3; row++)
        for (std::size_t axis = 0; axis < 3; axis++)
            record.to_local[row][axis] = float(to_world.rows[axis][row]);
    std::ranges::fill(record.color, float(light.scale));
    record.width = uint(light.map->width);
    record.height = uint(light.map->height);
    return record;
}

void flatten_map(const emitter_envmap &light, bool compensate, emitter_envmap_record &record,
                 LargeVector<EnvironmentTexel> &texels) {
    const EnvironmentMap &map = *light.map;
    Importance importance(map, compensate && light.mis_compensation);
    double sum = fill_texels(map, importance, texels);
    if (!(sum > 0)) { // nothing but the poles is brighter than the mean
        importance = Importance(map, false);
        sum = fill_texels(map, importance, texels);
    }
    const uint cells = record.width * (record.height - 1);
    build_alias_table_in_place(texels.data(), cells, sum);
    record.subtracted = importance.subtracted;
    record.least = importance.least;
    record.density_scale = float(cells / (2 * pi * pi * sum));
}

} // namespace opal
