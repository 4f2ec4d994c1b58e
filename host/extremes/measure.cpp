#include "extremes/measure.h"

#include "render/renderer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal::extremes {

namespace {

// The limits of fault_of. Single precision is correct if
// - the energy agrees with double within the row's tolerance or `max_sigmas` standard errors of the difference,
// - that standard error is within the tolerance or `max_noise_ratio` times the picture's noise,
// - the energy agrees with the truth within `truth_tolerance` or the noise,
// - no sample is NaN or infinite, and no more than a ray in a million leaks or shadows itself.
constexpr double max_sigmas = 3, max_noise_ratio = 2, truth_tolerance = 1e-3, max_stray_rays = 1e-6;
constexpr double tiny = 1e-300; // keeps divisors positive

Film render(const StressRow &row, SceneDescription scene, double value, const Device &device,
            const StressSettings &settings, MathMode math) {
    const unsigned side = row.value_means == ValueMeaning::spp ? 1 : row.side.value_or(settings.side);
    const unsigned spp = row.value_means == ValueMeaning::spp ? unsigned(value) : row.spp.value_or(settings.spp);
    const unsigned first = row.value_means == ValueMeaning::first_sample ? unsigned(value) : 0;
    if (row.value_means != ValueMeaning::height)
        scene.camera.width = scene.camera.height = int(side);
    scene.spp = spp;
    RenderOptions options;
    options.build.math = math;
    options.build.lanes = lanes_for(device.info, 0, math);
    options.sources = settings.sources;
    Renderer renderer(device, flatten(scene, options.build.lanes), options);
    renderer.restart(settings.seed, first);
    renderer.render(first + spp);
    return renderer.film();
}

double mean_of(const Film &film, size_t p) { return film.count[p] ? luminance(film.sum[p]) / film.count[p] : 0; }

// The standard error of the mean difference of two films, from the differences of their pixels.
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

double relative(double a, double b) { return a == b ? 0 : std::abs(a - b) / std::max(std::abs(b), tiny); }

std::string fault_of(const StressRow &row, const StressPoint &p) {
    std::vector<std::string> faults;
    if (p.invalid_single)
        faults.push_back(
            fmt::format("{} samples NaN or infinite{}", p.invalid_single, p.invalid_oracle ? " (in double too)" : ""));
    if (!(p.error <= std::max(row.tolerance, max_sigmas * p.paired_noise)))
        faults.push_back(fmt::format("energy off by {:.2g}", p.error));
    if (!(p.paired_noise <= std::max(row.tolerance, max_noise_ratio * p.noise)))
        faults.push_back(fmt::format("pixels off by {:.2g}", p.paired_noise));
    const double truth_noise = max_sigmas * std::sqrt(2.0) * p.noise; // the truth may be a picture with the same noise
    if (p.single_truth && !(*p.single_truth <= std::max(truth_tolerance, truth_noise)))
        faults.push_back(fmt::format("off the truth by {:.2g}", *p.single_truth));
    if (p.leaks.value_or(0) > max_stray_rays)
        faults.push_back(fmt::format("{:.2g} of the rays leak", *p.leaks));
    if (p.shadows.value_or(0) > max_stray_rays)
        faults.push_back(fmt::format("{:.2g} of the rays meet their own plane", *p.shadows));
    return fmt::format("{}", fmt::join(faults, ", "));
}

StressPoint measure_numeric(const StressRow &row, double value, const Device &device, const StressSettings &settings) {
    const NumericResult result = row.numeric(value, device, settings);
    StressPoint p{};
    p.value = value;
    p.single = result.single;
    p.oracle = result.oracle;
    p.error = result.error;
    p.leaks = result.leaks;
    p.invalid_single = result.invalid_single;
    p.invalid_oracle = result.invalid_oracle;
    p.fault = fault_of(row, p);
    return p;
}

StressPoint measure(const StressRow &row, double value, const Device &device, const StressSettings &settings,
                    std::optional<double> truth) {
    if (row.numeric)
        return measure_numeric(row, value, device, settings);
    const auto film = [&](const SceneDescription &scene, MathMode math) {
        return render(row, scene, value, device, settings, math);
    };
    const Film single = film(row.picture(value), MathMode::precise),
               oracle = film(row.picture(value), MathMode::double_precision);
    const FilmStatistics s = statistics_of(single), o = statistics_of(oracle);
    StressPoint p{};
    p.value = value;
    p.single = s.mean_luminance;
    p.oracle = o.mean_luminance;
    p.noise = s.stderr_luminance / std::max(std::abs(s.mean_luminance), tiny);
    p.error = relative(p.single, p.oracle);
    p.paired_noise = paired_error(single, oracle) / std::max(std::abs(p.oracle), tiny);
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

bool promised(const StressRow &row, double value) { return value >= row.promised_from && value <= row.promised_to; }

// Sets the working range: the longest run of points without a fault around the start.
void find_working_range(StressResult &s) {
    s.from = s.to = std::nan("");
    const auto start =
        std::min_element(s.points.begin(), s.points.end(), [&](const StressPoint &a, const StressPoint &b) {
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

std::vector<double> values_of(const StressRow &row, size_t stride) {
    std::vector<double> values;
    for (size_t i = 0; i < row.values.size(); i++)
        if (const double value = row.values[i]; i % stride == 0 || i + 1 == row.values.size() || value == row.start ||
                                                value == row.promised_from || value == row.promised_to)
            values.push_back(value);
    return values;
}

StressResult run_stress(const StressRow &row, const Device &device, const StressSettings &settings, size_t stride,
                        const std::function<void()> &on_value) {
    StressResult s{&row, {}, 0, 0, true};
    std::optional<double> invariant;
    if (row.invariant)
        invariant =
            statistics_of(render(row, row.picture(row.start), row.start, device, settings, MathMode::double_precision))
                .mean_luminance;
    for (const double value : values_of(row, stride)) {
        s.points.push_back(
            measure(row, value, device, settings, row.truth ? std::optional(row.truth(value)) : invariant));
        s.kept = s.kept && (!promised(row, value) || s.points.back().fault.empty());
        if (on_value)
            on_value();
    }
    find_working_range(s);
    return s;
}

std::string breaking_point(const StressResult &s) {
    if (std::isnan(s.from))
        return fmt::format("wrong at the start, {:g}", s.row->start);
    std::string words = fmt::format("correct from {:g} to {:g}", s.from, s.to);
    std::string beyond;
    for (size_t i = 0; i < s.points.size(); i++) {
        const auto correct = [&](const StressPoint &p) { return p.value >= s.from && p.value <= s.to; };
        const bool neighbour =
            (i > 0 && correct(s.points[i - 1])) || (i + 1 < s.points.size() && correct(s.points[i + 1]));
        if (!correct(s.points[i]) && neighbour)
            beyond += fmt::format("; at {:g} {}", s.points[i].value, s.points[i].fault);
    }
    return words + (beyond.empty() ? ", all of what was tried" : beyond);
}

} // namespace opal::extremes
