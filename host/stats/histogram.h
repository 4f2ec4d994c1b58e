// Samples counted on a grid over a domain, and what a density says the counts should be.
#pragma once

#include "stats/domain.h"
#include "stats/hypothesis.h"

namespace opal::stats {

// A density over the domain's own measure (1 / area or 1 / sr), asked for many points at once.
using Density = std::function<void(std::span<const Vec3> points, std::span<double> values)>;
Density each(std::function<double(Vec3)> density); // from one that takes a point at a time

struct Grid {
    const Domain *domain = nullptr;
    int nu = 0, nv = 0; // cells along u and v of the domain's rectangle
    size_t cells() const { return size_t(nu) * size_t(nv); }
    Rectangle cell(size_t index) const; // index = iv * nu + iu
    size_t index(Point2 uv) const;
};

struct Histogram {
    explicit Histogram(const Grid &g) : grid(g), counts(g.cells()) {}
    void add(Vec3 point);
    void add_failed() { ++failed; } // a draw that gave no sample (weight 0)
    Grid grid;
    std::vector<double> counts;
    double outside = 0, failed = 0;
    double n() const; // all draws
};

// How a density is integrated for a test with n draws: an error far below the noise sqrt(n p) of a cell's count.
QuadratureOptions expectation_options(double n);

// The density's integral over each cell of the grid, by adaptive quadrature. options.splits are in (u, v).
std::vector<Integral> integrate_density(const Grid &grid, const Density &density, const QuadratureOptions &options);
Integral total(std::span<const Integral> cells); // converged where each cell is

struct DensityTest {
    Integral mass;                // integral of the density over the domain
    std::vector<double> expected; // counts, n * integral of each cell
    TestResult result;
};

// Chi-square of the histogram against the density. Points outside are rejected at once. `may_fail` says that draws
// without a sample are right, with the probability 1 - mass that the density leaves; else such a draw counts as one
// outside. relative_error: that quadrature shall reach in a cell. Also rejected: an integral that did not converge,
// since what it says cannot be held against anything.
DensityTest density_test(const Histogram &histogram, const Density &density, bool may_fail = false,
                         std::vector<double> splits_u = {}, std::vector<double> splits_v = {},
                         const ChiSquareOptions &options = {}, double relative_error = 1e-5);

} // namespace opal::stats
