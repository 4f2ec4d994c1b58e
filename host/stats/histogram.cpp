#include "stats/histogram.h"

#include <algorithm>
#include <cmath>

namespace opal::stats {
namespace {

// Index of the cell of x, for [lo, hi] cut into n cells. hi belongs to the last one.
size_t bin(double x, double lo, double hi, int n) {
    return size_t(std::clamp(int((x - lo) / (hi - lo) * n), 0, n - 1));
}

} // namespace

Density each(std::function<double(Vec3)> density) {
    return [density](std::span<const Vec3> points, std::span<double> values) {
        std::transform(points.begin(), points.end(), values.begin(), density);
    };
}

Rectangle Grid::cell(size_t index) const {
    const Rectangle &b = domain->bounds;
    auto u = [&](size_t i) { return b.x0 + (b.x1 - b.x0) * double(i) / nu; };
    auto v = [&](size_t i) { return b.y0 + (b.y1 - b.y0) * double(i) / nv; };
    size_t iu = index % size_t(nu), iv = index / size_t(nu);
    return {u(iu), u(iu + 1), v(iv), v(iv + 1)};
}

size_t Grid::index(Point2 uv) const {
    const Rectangle &b = domain->bounds;
    return bin(uv.y, b.y0, b.y1, nv) * size_t(nu) + bin(uv.x, b.x0, b.x1, nu);
}

void Histogram::add(Vec3 point) {
    if (auto uv = to_rectangle(*grid.domain, point))
        ++counts[grid.index(*uv)];
    else
        ++outside;
}

double Histogram::n() const {
    double sum = outside + failed;
    for (double count : counts)
        sum += count;
    return sum;
}

QuadratureOptions expectation_options(double n) {
    QuadratureOptions options;
    options.relative = 1e-5;
    options.absolute = 1e-3 / n; // a thousandth of a hit
    return options;
}

std::vector<Integral> integrate_density(const Grid &grid, const Density &density, const QuadratureOptions &options) {
    std::vector<Rectangle> cells;
    for (size_t i = 0; i < grid.cells(); ++i)
        cells.push_back(grid.cell(i));
    std::vector<Vec3> positions;
    auto in_rectangle = [&](std::span<const Point2> points, std::span<double> values) {
        positions.clear();
        for (Point2 p : points)
            positions.push_back(from_rectangle(*grid.domain, p));
        density(positions, values);
        for (double &value : values)
            value /= grid.domain->area_ratio;
    };
    return integrate_cells(in_rectangle, cells, options);
}

Integral total(std::span<const Integral> cells) {
    CompensatedSum value, error;
    bool converged = true;
    for (const Integral &cell : cells) {
        value.add(cell.value);
        error.add(cell.error);
        converged = converged && cell.converged;
    }
    return {value.value(), error.value(), converged};
}

DensityTest density_test(const Histogram &histogram, const Density &density, bool may_fail,
                         std::vector<double> splits_u, std::vector<double> splits_v, const ChiSquareOptions &options,
                         double relative_error) {
    DensityTest test;
    double n = histogram.n();
    QuadratureOptions quadrature = expectation_options(n);
    quadrature.relative = relative_error;
    quadrature.splits_x = std::move(splits_u);
    quadrature.splits_y = std::move(splits_v);
    std::vector<Integral> cells = integrate_density(histogram.grid, density, quadrature);
    test.mass = total(cells);
    for (const Integral &cell : cells)
        test.expected.push_back(n * cell.value);
    if (!test.mass.converged) {
        test.result.reason =
            "the density's integral is not finite or did not converge: " + std::to_string(test.mass.value) +
            " with an error of " + std::to_string(test.mass.error);
        return test;
    }
    std::vector<double> observed = histogram.counts, expected = test.expected;
    observed.insert(observed.end(), {histogram.outside, histogram.failed});
    double missing = 1 - test.mass.value; // rounding may leave a little of 0
    bool no_mass = std::abs(missing) <= options.mass_tolerance && histogram.failed == 0;
    expected.insert(expected.end(), {0.0, may_fail && !no_mass ? n * missing : 0.0});
    test.result = chi_square_test(observed, expected, options);
    return test;
}

} // namespace opal::stats
