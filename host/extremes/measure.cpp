#include "extremes/measure.h"

#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal::extremes {

namespace {

// Correct: energy within this of double precision, or within three standard errors of the difference, which may not
// itself exceed the noise of the picture; no sample NaN or infinite; leaks and self-shadows no more than a ray in a
// million.
constexpr double sigmas = 3, rays_astray = 1e-6;

Film render(const Row &row, SceneDescription scene, double value, const Device &device, const How &how, MathMode math) {
    const unsigned side = row.value_is == Value::spp ? 1 : row.side.value_or(how.side);
    const unsigned spp = row.value_is == Value::spp ? unsigned(value) : row.spp.value_or(how.spp);
    const unsigned first = row.value_is == Value::first_sample ? unsigned(value) : 0;
    if (row.value_is != Value::height)
        scene.camera.width = scene.camera.height = int(side);
    scene.spp = spp;
    RenderOptions options;
    options.build.math = math;
    options.build.lanes = lanes_for(device.info, 0, math);
    options.sources = how.sources;
    Renderer renderer(device, flatten(scene, options.build.lanes), options);
    renderer.restart(how.seed, first);
    renderer.render(first + spp);
    return renderer.film();
}

double mean_of(const Film &film, size_t p) { return film.count[p] ? luminance(film.sum[p]) / film.count[p] : 0; }

// Standard error of the mean difference of two films, by the differences of their pixels.
double paired_error(const Film &a, const Film &b) {
    const size_t n = a.sum.size();
    double sum = 0, squares = 0;
    for (size_t p = 0; p < n; p++) {
        const double d = mean_of(a, p) - mean_of(b, p);
        sum += d;
        squares += d * d;
    }
    return n < 2 ? 0 : std::sqrt(std::max(0.0, squares - sum * sum / double(n)) / (double(n) * double(n - 1)));
}

double relative(double a, double b) { return a == b ? 0 : std::abs(a - b) / std::max(std::abs(b), 1e-300); }

std::string fault_of(const Row &row, const Point &p) {
    std::vector<std::string> faults;
    if (p.invalid_single)
        faults.push_back(
            fmt::format("{} samples NaN or infinite{}", p.invalid_single, p.invalid_oracle ? " (in double too)" : ""));
    if (!(p.error <= std::max(row.tolerance, sigmas * p.paired_noise)))
        faults.push_back(fmt::format("energy off by {:.2g}", p.error));
    if (!(p.paired_noise <= std::max(row.tolerance, 2 * p.noise)))
        faults.push_back(fmt::format("pixels off by {:.2g}", p.paired_noise));
    if (p.single_truth &&
        !(*p.single_truth <=
          std::max(1e-3, sigmas * std::sqrt(2.0) * p.noise))) // the truth may be a picture with noise, too
        faults.push_back(fmt::format("off the truth by {:.2g}", *p.single_truth));
    if (p.leaks.value_or(0) > rays_astray)
        faults.push_back(fmt::format("{:.2g} of the rays leak", *p.leaks));
    if (p.shadows.value_or(0) > rays_astray)
        faults.push_back(fmt::format("{:.2g} of the rays meet their own plane", *p.shadows));
    return fmt::format("{}", fmt::join(faults, ", "));
}

Point measure_probe(const Row &row, double value, const Device &device, const How &how) {
    const Probed probed = row.probe(value, device, how);
    Point p{};
    p.value = value;
    p.single = probed.single;
    p.oracle = probed.oracle;
    p.error = probed.error;
    p.leaks = probed.leaks;
    p.invalid_single = probed.invalid_single;
    p.invalid_oracle = probed.invalid_oracle;
    p.fault = fault_of(row, p);
    return p;
}

Point measure(const Row &row, double value, const Device &device, const How &how, std::optional<double> truth) {
    if (row.probe)
        return measure_probe(row, value, device, how);
    const auto film = [&](const SceneDescription &scene, MathMode math) {
        return render(row, scene, value, device, how, math);
    };
    const Film single = film(row.picture(value), MathMode::precise),
               oracle = film(row.picture(value), MathMode::double_precision);
    const FilmStatistics s = statistics_of(single), o = statistics_of(oracle);
    Point p{};
    p.value = value;
    p.single = s.mean_luminance;
    p.oracle = o.mean_luminance;
    p.noise = s.stderr_luminance / std::max(std::abs(s.mean_luminance), 1e-300);
    p.error = relative(p.single, p.oracle);
    p.paired_noise = paired_error(single, oracle) / std::max(std::abs(p.oracle), 1e-300);
    if (truth) {
        p.single_truth = relative(p.single, *truth);
        p.oracle_truth = relative(p.oracle, *truth);
    }
    if (row.closed)
        p.leaks = statistics_of(film(row.closed(value), MathMode::precise)).mean_luminance;
    if (row.open)
        p.shadows = 1 - statistics_of(film(row.open(value), MathMode::precise)).mean_luminance;
    p.invalid_single = single.invalid;
    p.invalid_oracle = oracle.invalid;
    p.fault = fault_of(row, p);
    return p;
}

bool promised(const Row &row, double value) { return value >= row.promised_from && value <= row.promised_to; }

// The longest stretch of points without fault that holds the start.
void find_working_range(Sweep &s) {
    s.from = s.to = std::nan("");
    const auto start = std::min_element(s.points.begin(), s.points.end(), [&](const Point &a, const Point &b) {
        return std::abs(a.value - s.row->start) < std::abs(b.value - s.row->start);
    });
    if (start == s.points.end() || !start->fault.empty())
        return;
    auto first = start, last = start;
    while (first != s.points.begin() && (first - 1)->fault.empty())
        --first;
    while (last + 1 != s.points.end() && (last + 1)->fault.empty())
        ++last;
    s.from = std::min(first->value, last->value);
    s.to = std::max(first->value, last->value);
}

} // namespace

Sweep sweep(const Row &row, const Device &device, const How &how, size_t stride) {
    Sweep s{&row, {}, 0, 0, true};
    std::optional<double> invariant;
    if (row.invariant)
        invariant =
            statistics_of(render(row, row.picture(row.start), row.start, device, how, MathMode::double_precision))
                .mean_luminance;
    for (size_t i = 0; i < row.values.size(); i++) {
        const double value = row.values[i];
        if (i % stride && i + 1 < row.values.size() && value != row.start && value != row.promised_from &&
            value != row.promised_to)
            continue;
        s.points.push_back(measure(row, value, device, how, row.truth ? std::optional(row.truth(value)) : invariant));
        s.kept = s.kept && (!promised(row, value) || s.points.back().fault.empty());
    }
    find_working_range(s);
    return s;
}

std::string breaking_point(const Sweep &s) {
    if (std::isnan(s.from))
        return fmt::format("wrong at the start, {:g}", s.row->start);
    std::string words = fmt::format("correct from {:g} to {:g}", s.from, s.to);
    std::string beyond;
    for (size_t i = 0; i < s.points.size(); i++) {
        const auto correct = [&](const Point &p) { return p.value >= s.from && p.value <= s.to; };
        const bool neighbour =
            (i > 0 && correct(s.points[i - 1])) || (i + 1 < s.points.size() && correct(s.points[i + 1]));
        if (!correct(s.points[i]) && neighbour)
            beyond += fmt::format("; at {:g} {}", s.points[i].value, s.points[i].fault);
    }
    return words + (beyond.empty() ? ", all of what was tried" : beyond);
}

} // namespace opal::extremes
