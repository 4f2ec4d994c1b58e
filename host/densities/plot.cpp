#include "densities/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal {

namespace {

constexpr int side = 400, left = 92, gap = 100, top = 84, bottom = 96, small = 2;
constexpr Ink paper = {1, 1, 1}, ink = {0.1, 0.1, 0.1};
constexpr double most_sigmas = 4;

// How a domain's rectangle is shown: whether u runs to the right (else upwards), and what the axes are called.
struct Axes {
    bool u_right;
    const char *u, *v;
};

Axes axes_of(const stats::Domain &domain) {
    switch (domain.kind) {
    case stats::DomainKind::disk:
        return {false, "R^2", "PHI"};
    case stats::DomainKind::hemisphere:
    case stats::DomainKind::sphere:
        return {false, "COS THETA", "PHI"};
    case stats::DomainKind::triangle:
        return {true, "U", "V"};
    default:
        return {true, "X", "Y"};
    }
}

Ink viridis_of_root(double t) {
    return viridis(std::sqrt(std::max(t, 0.0)));
} // so that what is dim is seen beside a peak

class Panels {
public:
    Panels(const Sampled &sampled, const stats::Grid &grid)
        : canvas_(left + 3 * side + 2 * gap + 24, top + side + bottom, paper), grid_(grid),
          axes_(axes_of(*sampled.domain)) {}

    void title(const std::string &words) { canvas_.text(left, 16, words, 3, ink); }

    // One value a cell; its colour by `map` of (value - low) / (high - low).
    void panel(int place, const std::string &name, const std::vector<double> &values, double low, double high,
               Ink (*map)(double), double map_low) {
        const int x0 = left + place * (side + gap);
        canvas_.fill(x0 - 1, top - 1, side + 2, side + 2, ink);
        const auto color = [&](double value) { return map(map_low + (1 - map_low) * (value - low) / (high - low)); };
        for (int y = 0; y < side; y++)
            for (int x = 0; x < side; x++) {
                const double right = (x + 0.5) / side, up = 1 - (y + 0.5) / side;
                const int iu = int((axes_.u_right ? right : up) * grid_.nu),
                          iv = int((axes_.u_right ? up : right) * grid_.nv);
                canvas_.fill(x0 + x, top + y, 1, 1, color(values[size_t(iv) * size_t(grid_.nu) + size_t(iu)]));
            }
        canvas_.text(x0, top - 24, name, 3, ink);
        label_axes(x0);
        const int bar = top + side + 56;
        for (int x = 0; x < side; x++)
            canvas_.fill(x0 + x, bar, 1, 12, color(low + (high - low) * x / (side - 1)));
        canvas_.text(x0, bar + 18, fmt::format("{:.3g}", low), small, ink);
        const std::string highest = fmt::format("{:.3g}", high);
        canvas_.text(x0 + side - Canvas::text_width(highest, small), bar + 18, highest, small, ink);
    }

    const Image &image() const { return canvas_.image(); }

private:
    void label_axes(int x0) {
        const stats::Rectangle &b = grid_.domain->bounds;
        const double x_low = axes_.u_right ? b.x0 : b.y0, x_high = axes_.u_right ? b.x1 : b.y1;
        const double y_low = axes_.u_right ? b.y0 : b.x0, y_high = axes_.u_right ? b.y1 : b.x1;
        const auto centered = [&](int x, int y, const std::string &words) {
            canvas_.text(x - Canvas::text_width(words, small) / 2, y, words, small, ink);
        };
        centered(x0, top + side + 8, fmt::format("{:.3g}", x_low));
        centered(x0 + side, top + side + 8, fmt::format("{:.3g}", x_high));
        centered(x0 + side / 2, top + side + 8, axes_.u_right ? axes_.u : axes_.v);
        const auto before = [&](int y, const std::string &words) {
            canvas_.text(x0 - 6 - Canvas::text_width(words, small), y, words, small, ink);
        };
        before(top, fmt::format("{:.3g}", y_high));
        before(top + side - 10, fmt::format("{:.3g}", y_low));
        before(top + side / 2 - 5, axes_.u_right ? axes_.v : axes_.u);
    }

    Canvas canvas_;
    const stats::Grid &grid_;
    const Axes axes_;
};

} // namespace

Image plot_density(const Sampled &sampled, const DensityCheck &check, const std::string &title) {
    const stats::Grid &grid = check.histogram.grid;
    const double n = check.histogram.n(), measure = sampled.domain->measure() / double(grid.cells());
    std::vector<double> samples, pdf, residual;
    for (size_t i = 0; i < grid.cells(); i++) {
        const double observed = check.histogram.counts[i], expected = check.test.expected[i];
        samples.push_back(observed / (n * measure));
        pdf.push_back(expected / (n * measure));
        residual.push_back((observed - expected) / std::sqrt(std::max(expected, 1.0)));
    }
    const double highest =
        std::max(*std::max_element(samples.begin(), samples.end()), *std::max_element(pdf.begin(), pdf.end()));
    Panels panels(sampled, grid);
    panels.title(title);
    panels.panel(0, "DENSITY OF SAMPLES", samples, 0, highest > 0 ? highest : 1, viridis_of_root, 0);
    panels.panel(1, "PDF", pdf, 0, highest > 0 ? highest : 1, viridis_of_root, 0);
    panels.panel(2, "RESIDUAL / SIGMA", residual, -most_sigmas, most_sigmas, blue_white_red, -1);
    return panels.image();
}

} // namespace opal
