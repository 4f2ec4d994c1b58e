#include "sweep/convergence_plot.h"

#include "plot/svg.h"

#include <fmt/format.h>

#include <cmath>

namespace opal {

namespace {

// The size of the plot and its margins, pixels.
constexpr double width = 930, height = 500, left = 110, right = 250, top = 20, bottom = 60;

const char *const style_sheet = R"(<style>
svg { font: 13px system-ui, sans-serif } svg text { fill: #222 }
.decade { stroke: #ccc } .minor { stroke: #eee } .bar { stroke-width: 1.5 }
.strategy:hover path { stroke-width: 5 } svg:hover .strategy { opacity: .25 } svg:hover .strategy:hover { opacity: 1 }
svg:not(:has(.strategy:hover)) .strategy { opacity: 1 }
</style>
)";

// The axis over [least, most], widened to multiples of half a decade.
LogAxis axis_of(double least, double most, double from, double to) {
    const double low = std::floor(std::log10(least) * 2 - 0.1) / 2, high = std::ceil(std::log10(most) * 2 + 0.1) / 2;
    return {low, high, from, to};
}

std::string grid(const LogAxis &x, const LogAxis &y) {
    std::string svg;
    for (const bool horizontal : {true, false}) {
        const LogAxis &a = horizontal ? x : y;
        const bool label_all = a.high - a.low < 2; // with less than two decades, 2 and 5 have labels, too
        for (int decade = int(std::floor(a.low)); decade <= a.high; decade++)
            for (const int digit : {1, 2, 5}) {
                const double value = digit * std::pow(10, decade), pixel = a(value);
                if (std::log10(value) < a.low - 1e-9 || std::log10(value) > a.high + 1e-9)
                    continue;
                const std::string style = digit == 1 ? "class='decade'" : "class='minor'";
                svg += horizontal ? svg_line(pixel, top, pixel, height - bottom, style)
                                  : svg_line(left, pixel, width - right, pixel, style);
                if (digit == 1 || label_all)
                    svg +=
                        horizontal
                            ? svg_text(pixel, height - bottom + 18, "text-anchor='middle'", fmt::format("{:g}", value))
                            : svg_text(left - 8, pixel + 4, "text-anchor='end'", fmt::format("{}e{}", digit, decade));
            }
    }
    svg += svg_text((left + width - right) / 2, height - 14, "text-anchor='middle'", "time, seconds (fewer is better)");
    return svg + svg_text(0, 0,
                          fmt::format("text-anchor='middle' transform='translate(18 {}) rotate(-90)'",
                                      (top + height - bottom) / 2),
                          "relative mean squared error (less is better)");
}

// Whether the logarithmic axes have a place for it.
bool can_be_plotted(const PointSummary &p) {
    const auto is_good = [](double x) { return x > 0 && std::isfinite(x); };
    return is_good(p.rel_mse.estimate) && is_good(p.seconds);
}

std::string curve(const StrategySummary &s, const std::string &color, const LogAxis &x, const LogAxis &y) {
    std::string path, marks;
    for (const PointSummary &p : s.points) {
        if (!can_be_plotted(p))
            continue;
        const double px = x(p.seconds), py = y(p.rel_mse.estimate);
        path += fmt::format("{}{:.1f} {:.1f} ", path.empty() ? "M" : "L", px, py);
        const double low = std::fmax(p.rel_mse.low, std::pow(10, y.low)),
                     high = std::fmin(p.rel_mse.high, std::pow(10, y.high));
        marks += svg_line(px, y(low), px, y(high), "class='bar'") +
                 svg_line(px - 4, y(low), px + 4, y(low), "class='bar'") +
                 svg_line(px - 4, y(high), px + 4, y(high), "class='bar'");
        marks +=
            fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='4.5' fill='{}'><title>{}\n{} samples per pixel, {:.3g} "
                        "s\nrelMSE {:.3g} "
                        "[{:.3g}, {:.3g}]\nMSE {:.3g} [{:.3g}, {:.3g}]\n{} replicates</title></circle>\n",
                        px, py, color, html_text(s.record->label), p.spp, p.seconds, p.rel_mse.estimate, p.rel_mse.low,
                        p.rel_mse.high, p.mse.estimate, p.mse.low, p.mse.high, p.replicates);
    }
    return fmt::format("<path d='{}' fill='none' stroke-width='2'/>\n", path) + marks;
}

} // namespace

// The colours of Okabe and Ito, which colour-blind people can tell apart, then darker ones.
std::string strategy_color(size_t index) {
    static const char *const colors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9",
                                         "#555555", "#7b3294", "#8c510a", "#1b7837", "#b2182b", "#01665e"};
    return colors[index % std::size(colors)];
}

std::string convergence_plot(const SweepSummary &summary) {
    double x0 = INFINITY, x1 = 0, y0 = INFINITY, y1 = 0;
    for (const StrategySummary &s : summary.strategies)
        for (const PointSummary &p : s.points)
            if (can_be_plotted(p)) {
                x0 = std::fmin(x0, p.seconds), x1 = std::fmax(x1, p.seconds);
                y0 = std::fmin(y0, p.rel_mse.estimate), y1 = std::fmax(y1, p.rel_mse.estimate);
            }
    if (!(x1 > 0 && y1 > 0))
        return "<p>Nothing to plot: no error could be told from the reference's own.</p>\n";
    const LogAxis x = axis_of(x0, x1, left, width - right), y = axis_of(y0, y1, height - bottom, top);
    std::string svg = fmt::format(
        "<svg viewBox='0 0 {} {}' role='img' aria-label='relative mean squared error against time'>\n", width, height);
    svg += style_sheet + grid(x, y);
    double legend = top + 14;
    for (size_t i = 0; i < summary.strategies.size(); i++, legend += 22) {
        const std::string color = strategy_color(i);
        svg += fmt::format("<g class='strategy' stroke='{}'>\n", color) + curve(summary.strategies[i], color, x, y);
        svg += fmt::format("<circle cx='{}' cy='{}' r='4.5' fill='{}'/>", width - right + 16, legend - 4, color);
        svg += svg_text(width - right + 28, legend, "stroke='none'", summary.strategies[i].record->label) + "</g>\n";
    }
    return svg + "</svg>\n";
}

} // namespace opal
