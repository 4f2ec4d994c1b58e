#include "extremes/report.h"

#include "base/json.h"
#include "plot/svg.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal::extremes {

namespace {

std::string share(const std::optional<double> &value) { return value ? fmt::format("{:.1e}", *value) : "-"; }

nlohmann::json number(const std::optional<double> &value) { return value ? nlohmann::json(*value) : nlohmann::json(); }

// A panel of the plot and its margins, pixels.
constexpr int width = 380, height = 220, left = 46, top = 34, right = 12, bottom = 40, columns = 4;
constexpr double min_error = 1e-9, max_error = 10; // the vertical axis

struct Curve {
    const char *name, *color;
    std::optional<double> (*value)(const StressPoint &);
};
const Curve curves[] = {
    {"single against double", "#c0392b", [](const StressPoint &p) { return std::optional(p.error); }},
    {"single against the truth", "#e69500", [](const StressPoint &p) { return p.single_truth; }},
    {"double against the truth", "#2471a3", [](const StressPoint &p) { return p.oracle_truth; }},
    {"leaking rays", "#8e44ad", [](const StressPoint &p) { return p.leaks; }},
    {"self-shadowed rays", "#229954", [](const StressPoint &p) { return p.shadows; }},
    {"noise of the picture", "#999999", [](const StressPoint &p) { return std::optional(p.noise); }},
};

// The horizontal pixel of the i-th value.
double x_of(size_t i, size_t count) {
    return left + (width - left - right) * (count > 1 ? double(i) / double(count - 1) : 0.5);
}
// The vertical pixel of an error, on a logarithmic scale.
double y_of(double error) {
    const LogAxis axis = {std::log10(min_error), std::log10(max_error), height - bottom, top};
    return axis(std::clamp(std::isfinite(error) ? error : max_error, min_error, max_error));
}

std::string axes_of(const StressResult &s) {
    std::string svg;
    for (int e = -8; e <= 0; e += 2) {
        const double y = y_of(std::pow(10.0, e));
        svg += svg_line(left, y, width - right, y, "stroke='#dddddd'");
        svg += svg_text(left - 4, y + 3, "text-anchor='end'", fmt::format("1e{}", e));
    }
    for (size_t i = 0; i < s.points.size(); i++) {
        const double x = x_of(i, s.points.size()), y = height - bottom + 12;
        svg += svg_text(x, y, fmt::format("text-anchor='end' transform='rotate(-40 {:.1f} {})'", x, y),
                        fmt::format("{:.6g}", s.points[i].value));
    }
    return svg;
}

// A pale background over the promised range.
std::string promised_range(const StressResult &s) {
    double from = width, to = 0;
    for (size_t i = 0; i < s.points.size(); i++)
        if (s.points[i].value >= s.row->promised_from && s.points[i].value <= s.row->promised_to) {
            from = std::min(from, x_of(i, s.points.size()));
            to = std::max(to, x_of(i, s.points.size()));
        }
    return from > to ? ""
                     : fmt::format("<rect x='{:.1f}' y='{}' width='{:.1f}' height='{}' fill='#eef6ee'/>\n", from, top,
                                   to - from, height - top - bottom);
}

std::string panel_of(const StressResult &s) {
    std::string svg = fmt::format("<text x='{}' y='14' font-weight='bold'>{}</text><text x='{}' y='26'>{}</text>\n",
                                  left, s.row->name, left, s.row->stretched);
    svg += promised_range(s) + axes_of(s);
    for (const Curve &curve : curves) {
        std::string points;
        for (size_t i = 0; i < s.points.size(); i++)
            if (const auto value = curve.value(s.points[i]))
                points += fmt::format("{:.1f},{:.1f} ", x_of(i, s.points.size()), y_of(*value));
        if (!points.empty())
            svg += fmt::format("<polyline points='{}' fill='none' stroke='{}' stroke-width='1.6'/>\n", points,
                               curve.color);
    }
    for (size_t i = 0; i < s.points.size(); i++)
        if (!s.points[i].fault.empty())
            svg += fmt::format("<circle cx='{:.1f}' cy='{:.1f}' r='3.5' fill='#c0392b'/>\n", x_of(i, s.points.size()),
                               y_of(s.points[i].error));
    return svg;
}

} // namespace

std::string table_of(const StressResult &s) {
    std::string text = fmt::format("\n{}: {}\n  {:>10} {:>12} {:>12} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8}\n",
                                   s.row->name, s.row->stretched, "value", "single", "double", "error", "paired",
                                   "noise", "leaks", "shadows", "invalid", "of truth");
    for (const StressPoint &p : s.points)
        text +=
            fmt::format("  {:>10.8g} {:>12.6g} {:>12.6g} {:>9.1e} {:>9.1e} {:>9.1e} {:>9} {:>9} {:>8} {:>8}{}{}\n",
                        p.value, p.single, p.oracle, p.error, p.paired_noise, p.noise, share(p.leaks), share(p.shadows),
                        p.invalid_single, share(p.single_truth), p.fault.empty() ? "" : "  ", p.fault);
    return text + fmt::format("  {}{}\n", breaking_point(s), s.kept ? "" : "  PROMISE BROKEN");
}

nlohmann::json json_of(const StressResult &s) {
    nlohmann::json j = {
        {"row", s.row->name},     {"stretched", s.row->stretched},         {"correct_from", s.from},
        {"correct_to", s.to},     {"promised_from", s.row->promised_from}, {"promised_to", s.row->promised_to},
        {"promise_kept", s.kept}, {"breaking_point", breaking_point(s)},   {"points", nlohmann::json::array()}};
    for (const StressPoint &p : s.points)
        j["points"].push_back(object({{"value", p.value},
                                      {"single", p.single},
                                      {"double", p.oracle},
                                      {"error", p.error},
                                      {"paired_noise", p.paired_noise},
                                      {"noise", p.noise},
                                      {"single_truth_error", number(p.single_truth)},
                                      {"double_truth_error", number(p.oracle_truth)},
                                      {"leaks", number(p.leaks)},
                                      {"self_shadows", number(p.shadows)},
                                      {"invalid_single", p.invalid_single},
                                      {"invalid_double", p.invalid_oracle},
                                      {"fault", p.fault}}));
    return j;
}

std::string svg_of(const std::vector<StressResult> &results) {
    const int lines = int((results.size() + columns - 1) / columns);
    std::string svg = fmt::format(
        "<svg xmlns='http://www.w3.org/2000/svg' width='{}' height='{}' font-family='sans-serif' font-size='9'>\n"
        "<rect width='100%' height='100%' fill='white'/>\n",
        columns * width, lines * height + 24);
    for (size_t i = 0; i < results.size(); i++)
        svg += fmt::format("<g transform='translate({} {})'>\n{}</g>\n", int(i % columns) * width,
                           int(i / columns) * height, panel_of(results[i]));
    int x = left;
    for (const Curve &curve : curves) {
        svg += fmt::format("<line x1='{0}' x2='{1}' y1='{2}' y2='{2}' stroke='{3}' stroke-width='2'/><text x='{4}' "
                           "y='{5}'>{6}</text>\n",
                           x, x + 16, lines * height + 10, curve.color, x + 20, lines * height + 13, curve.name);
        x += 160;
    }
    return svg + fmt::format(
                     "<circle cx='{}' cy='{}' r='3.5' fill='#c0392b'/><text x='{}' y='{}'>not correct</text>\n</svg>\n",
                     x, lines * height + 10, x + 8, lines * height + 13);
}

} // namespace opal::extremes
