// Are two images of one scene estimates of the same picture? Welch's test on tiles and on the whole.
#pragma once

#include "stats/hypothesis.h"

#include <span>
#include <vector>

namespace opal::stats {

// An estimate with its error: for each channel width * height means and as many variances OF THESE MEANS, top row
// first. `dof` of each variance: samples (or batches) - 1; infinite where it is known.
struct Estimate {
    int width = 0, height = 0;
    std::vector<std::span<const float>> mean, variance;
    double samples = 0; // a pixel; 0: unknown
    double dof = 0;     // of each variance: samples (or batches) - 1; infinite where it is known
};

struct TileOptions {
    int size = 8; // pixels a side; a variance from few samples is too rough to divide by, pooled over a tile it is not
    double relative_floor = default_relative_floor; // of a tile's standard error, times its larger mean
    // Variance of a large area's mean over what independent pixels would have: 1 for a box of one pixel; for a wider
    // filter with weights w over pixel offsets 1 / sum w^2, since neighbours share samples.
    double variance_inflation = 1;
    double sure_hits = 100;            // see tile_test; 0: no allowance for rare hits
    double region_significance = 0.01; // tiles whose own p is below belong to a region
};

// Pixels [x, x + width) x [y, y + height).
struct PixelBox {
    int x = 0, y = 0, width = 0, height = 0;
};

// Tiles that touch by an edge, of one channel, each too bright (or each too dark) in the first image.
struct Region {
    size_t channel = 0;
    PixelBox box;                  // that holds them
    int tiles = 0;                 // 0: there is none
    double statistic = 0;          // sum of their z / sqrt(tiles) (Stouffer)
    double mean_a = 0, mean_b = 0; // over the region's pixels
};

struct TileTest {
    int columns = 0, rows = 0, size = 0;
    size_t channels = 0;
    // [channel][row][column]: z is the normal quantile of the tile's p with the sign of a - b (+-infinity where p is
    // 0), so that tiles of different degrees of freedom compare.
    std::vector<double> z, p;
    std::vector<TestResult> whole; // of each channel, all pixels one tile: sees a small bias that is everywhere
    size_t worst_channel = 0;
    PixelBox worst_tile;
    double worst_z = 0;
    Region region;      // the one of the most tiles; between equals, of the larger |statistic|
    double p_value = 0; // Sidak over all tiles, channels and the wholes
    std::string reason; // where the images cannot be compared; p_value is then 0
    bool rejected(double significance) const { return !(p_value >= significance); }
};

// For each tile t = (sum a - sum b) / sqrt(sum va + sum vb) with Welch's degrees of freedom over all its pixels.
//
// Light that comes by rare samples (a sliver of a lamp, a caustic) may miss a whole tile, which then states an error
// that is too small. So for tiles (not for the whole image) an estimate's variance is taken to be at least
//  - that of the other image's samples there in this one's number, where both sample counts are known (where they are
//  the same
//    this widens the error by sqrt 2 at the most);
//  - where the estimate has fewer than `sure_hits` effective hits, (mean / error)^2: mean * quantum, the variance of
//  rare hits as
//    large as this image's own are (quantum = sum of its variances / sum of its means), with the larger of both means;
// and to the darker one's is added the variance that what it lacks would have, if it came by hits as large beside the
// light around them as this image's are: a deficit counts where such hits should have come, and did not.
TileTest tile_test(const Estimate &a, const Estimate &b, const TileOptions &options = {});

} // namespace opal::stats
