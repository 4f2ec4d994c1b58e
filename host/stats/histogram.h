// Histograms of samples over a domain, and the test of their counts against a density.
#pragma once

#include "stats/domain.h"
#include "stats/hypothesis.h"

namespace opal::stats {

// A probability density over the domain's measure (1 / area or 1 / sr), evaluated at many points at once.
using Density = std::function<void(std::span<const Vec3> points, std::span<double> values)>;
Density each(std::function<double(Vec3)> density); // from a function of one point

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
    void add_failed() { ++failed; } // a draw without a sample (weight 0)
    Grid grid;
    std::vector<double> counts;
    double outside = 0, failed = 0;
    double n() const; // all draws
};

// Tolerances of the integration for a test with n draws: far below the noise sqrt(n p) of a cell's count.
QuadratureOptions expectation_options(double n);

// The density's integral over each cell of the grid, by adaptive quadrature. options.splits are in (u, v).
std::vector<Integral> integrate_density(const Grid &grid, const Density &density, const QuadratureOptions &options);
Integral total(std::span<const Integral> cells); // converged if every cell is

struct DensityTest {
    Integral mass;                // integral of the density over the domain
    std::vector<double> expected; // counts, n * integral of each cell
    TestResult result;
};

// Pearson's chi-square test of the histogram against the density. Rejects at once if there are points outside the
// domain, or if an integral did not converge. may_fail: draws may give no sample, with probability 1 - mass; without it
// such a draw counts as a point outside. relative_error: of the quadrature in a cell.
DensityTest density_test(const Histogram &histogram, const Density &density, bool may_fail = false,
                         std::vector<double> splits_u = {}, std::vector<double> splits_v = {},
                         const ChiSquareOptions &options = {}, double relative_error = 1e-5);

} // namespace opal::stats
