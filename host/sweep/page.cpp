#include "sweep/page.h"

#include "base/base64.h"
#include "base/read_file.h"
#include "plot/svg.h"
#include "sweep/convergence_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal {

namespace {

const char *const page_head = R"(<!DOCTYPE html>
<html lang="en"><head><meta charset="utf-8"><meta name="viewport" content="width=device-width">
<style>
body { font: 16px/1.5 system-ui, sans-serif; max-width: 1000px; margin: 2em auto; padding: 0 1em }
body { color: #222; background: #fff }
h1 { font-size: 1.6em } h2 { margin-top: 2em; font-size: 1.25em }
.verdict { background: #f3f6fa; border-left: 4px solid #0072b2; padding: .6em 1.2em }
.verdict li:first-child { font-weight: 600 }
table { border-collapse: collapse; font-size: .9em; font-variant-numeric: tabular-nums }
th, td { padding: .3em .7em; border-bottom: 1px solid #ddd; text-align: right; vertical-align: top }
th:first-child, td:first-child { text-align: left } td small { display: block; color: #666; white-space: nowrap }
.dot { display: inline-block; width: .7em; height: .7em; border-radius: 50%; margin-right: .5em }
svg { width: 100% }
.grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(300px, 1fr)); gap: 1em }
figure { margin: 0 } .lens { overflow: hidden; cursor: zoom-in }
.lens img { display: block; width: 100%; image-rendering: pixelated }
figure.large { grid-column: 1 / -1 } figure.large .lens { cursor: zoom-out } .lens + .lens { margin-top: 4px }
figcaption { font-size: .9em } code, pre { background: #f4f4f4; padding: .1em .3em }
pre { padding: .8em; white-space: pre-wrap; overflow-wrap: anywhere }
</style>
)";

const char *const page_tail = R"(<script>
const lenses = [...document.querySelectorAll('.lens')];
const zoom = (x, y, scale) => lenses.forEach(lens => {
    lens.firstChild.style.transformOrigin = `${100 * x}% ${100 * y}%`;
    lens.firstChild.style.transform = `scale(${scale})`;
});
for (const lens of lenses) {
    lens.onmousemove = event => {
        const box = lens.getBoundingClientRect();
        zoom((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height, 4);
    };
    lens.onmouseleave = () => zoom(0, 0, 1);
    lens.onclick = () => lens.parentElement.classList.toggle('large');
}
</script>
</body></html>
)";

bool bounded(const stats::Interval &i) { return std::isfinite(i.high) && i.low > 0; }

std::string seconds_text(double s) {
    return s < 100    ? fmt::format("{:.2g} s", s)
           : s < 6000 ? fmt::format("{:.0f} s", s)
                      : fmt::format("{:.1f} h", s / 3600);
}

// A table cell with the estimate and, in small print, the interval if it is known.
template <class Format> std::string interval_cell(const stats::Interval &i, Format format, bool known) {
    return "<td>" + format(i.estimate) +
           (known ? "<small>" + format(i.low) + " to " + format(i.high) + "</small>" : "") + "</td>";
}

std::string number_text(double x) {
    return fmt::format("{:.{}f}", x, x < 0.1 ? 4 : x < 1 ? 3 : x < 10 ? 2 : x < 100 ? 1 : 0);
}

// The level of each strategy's test of bias, which gives a level of 1 % over all strategies (Bonferroni).
double bias_level(const SweepSummary &summary) { return 0.01 / double(summary.strategies.size()); }

std::string strategy_table(const SweepSummary &summary) {
    std::string html = "<table><tr><th>strategy</th>";
    for (double level : time_levels)
        html += fmt::format("<th>time to<br>relMSE {}</th>", error_text(level));
    html += "<th>time relative<br>to the best</th><th>speed to the<br>same MSE, relative<br>to the "
            "first</th><th>slope</th><th>bias</th><th>compile</th></tr>\n";
    for (size_t i = 0; i < summary.strategies.size(); i++) {
        const StrategySummary &s = summary.strategies[i];
        html += fmt::format("<tr><td><span class='dot' style='background:{}'></span>{}</td>", strategy_color(i),
                            html_text(s.record->label));
        for (const stats::Interval &time : s.times)
            html += interval_cell(time, seconds_text, bounded(time));
        const bool best = i == summary.best, first = i == 0;
        html +=
            best ? "<td>the best</td>"
                 : interval_cell(
                       s.relative_time, [](double x) { return number_text(x) + "&times;"; }, bounded(s.relative_time));
        html += first ? "<td>1</td>" : interval_cell(s.efficiency, number_text, bounded(s.efficiency));
        html += std::isfinite(s.slope.estimate)
                    ? interval_cell(
                          s.slope, [](double x) { return fmt::format("{:.3f}", x); }, std::isfinite(s.slope.high))
                    : "<td>&ndash;</td>";
        html += s.bias_p < bias_level(summary)
                    ? fmt::format("<td><b>{:+.2g} %</b><small>p = {:.1g}</small></td>", 100 * s.bias, s.bias_p)
                    : "<td>none seen</td>";
        html += fmt::format("<td>{}</td></tr>\n", seconds_text(s.record->compile_seconds));
    }
    return html + "</table>\n";
}

std::string embedded_png(const std::filesystem::path &png, const std::string &what) {
    if (!is_whole_picture(png))
        return fmt::format("<p>{}: the picture is missing; a sweep with this strategy makes it again</p>", what);
    return fmt::format("<div class='lens'><img alt=\"{}\" title=\"{}\" src=\"data:image/png;base64,{}\"></div>", what,
                       what, base64(read_file(png)));
}

std::string equal_time_images(const SweepSummary &summary, const std::filesystem::path &folder) {
    std::string html = "<div class='grid'>\n<figure>" + embedded_png(folder / "reference.png", "reference") +
                       "<figcaption><b>the reference</b>, what all of them tend to</figcaption></figure>\n";
    for (const StrategySummary &s : summary.strategies) {
        const EqualTimeImage &image = s.record->shot;
        if (image.file.empty())
            continue;
        const std::string label = html_text(s.record->label);
        html += "<figure>" + embedded_png(folder / (image.file + ".png"), label) +
                embedded_png(folder / (image.file + "_error.png"), label + ": error");
        html +=
            fmt::format("<figcaption><b>{}</b>: {} samples per pixel in {:.3g} s, relMSE {}</figcaption></figure>\n",
                        label, image.spp, image.seconds, error_text(image.rel_mse));
    }
    return html + "</div>\n";
}

std::string devices_of(const SweepRecord &r) {
    std::string text;
    for (const DeviceRecord &d : r.devices)
        text += fmt::format("{}device {}, {} (driver {})", text.empty() ? "" : ", and ", d.index, d.name, d.driver);
    return text;
}

std::string measurement_text(const SweepRecord &r) {
    const ReferenceRecord &ref = r.reference;
    std::string html = fmt::format(
        "<p>{}, {} &times; {} pixels{}, on {}, by opal {}. Seconds are {}; compiling is not among them. "
        "Each point is the mean of {} renders with seeds of their own, made in rounds: one of every strategy, then the "
        "next, "
        "so that what disturbed the machine disturbed all. An interval holds the true value with 95 % confidence: "
        "Student's t on the logarithm for errors; for times and their ratios the bootstrap over the rounds, with the "
        "same draws for all strategies.</p>\n",
        html_text(r.scene), r.width, r.height, r.crop.empty() ? "" : " (of these " + r.crop + ")",
        html_text(devices_of(r)), r.version,
        r.clock == "cpu" ? "CPU seconds of all cores over their number, what the kernels take on a machine of their own"
                         : "the device's own kernel times",
        r.replicates);
    if (r.kernel == "general")
        html +=
            "<p>The general kernel, which serves any scene and strategy, rendered all strategies whose names say "
            "nothing else. Where few paths are asked for, kernels of their own would take longer to compile than "
            "they save. It takes 1.05 to 1.5 times as long as a strategy's own kernel, more for emitter sampling and "
            "MIS than for BSDF sampling, so that the ratios of times here may be off by a quarter. "
            "<code>--specialise on</code> measures each strategy with its own.</p>\n";
    html += "<p><b>relMSE</b> is the mean over pixels and channels of (image &minus; reference)&sup2; / "
            "(reference&sup2; + (1 % of the reference's mean)&sup2;): "
            "at 1e-2 the typical error is a tenth of each pixel's value. ";
    html += ref.spp ? fmt::format("The reference has {} samples per pixel of <code>{}</code> ({:.3g} s), two halves of "
                                  "samples that no other image here "
                                  "uses; what its own noise adds to the errors is estimated from the halves' "
                                  "difference and subtracted.</p>\n",
                                  ref.spp, html_text(ref.made_by), ref.seconds)
                    : fmt::format("The reference is <code>{}</code>; {}.</p>\n", html_text(ref.made_by),
                                  ref.variance_known ? "its variance, kept in its layers, is subtracted"
                                                     : "it holds no variance, so that its own noise counts as error");
    html += "<p><b>slope</b>: of log MSE against log samples per pixel; &minus;1 for independent samples, which is why "
            "the time to an error "
            "follows from the largest render. A strategy whose samples are not independent has times along its own "
            "slope. The time relative to the best is the ratio of the times to relMSE 1e-2. "
            "<b>bias</b>: of the mean luminance against the reference, where a test at level 1 % over all strategies "
            "sees one. <b>compile</b>: seconds until the "
            "kernel was ready when it was first built here; a driver's cache makes it shorter.</p>\n";
    if (!r.left_out_spp.empty())
        html += fmt::format("<p>Left out for the budget of {:g} s: {} samples per pixel.</p>\n", r.budget,
                            fmt::join(r.left_out_spp, ", "));
    return html;
}

unsigned long long invalid_samples(const StrategyRecord &s) {
    unsigned long long count = 0;
    for (const SweepPoint &p : s.points)
        for (const Replicate &r : p.replicates)
            count += r.invalid;
    return count;
}

std::string known_seconds(const stats::Interval &time) {
    return std::isfinite(time.estimate) ? seconds_text(time.estimate) : "unknown";
}

// "the fastest", "3.1 times longer".
std::string against_fastest(const SweepSummary &summary, const StrategySummary &s) {
    return &s == &summary.strategies[summary.best] ? "the fastest"
           : is_slower(s)                          ? number_text(s.relative_time.estimate) + " times longer"
                                                   : "not told apart from the fastest";
}

std::string verdict_list(const std::vector<std::string> &sentences) {
    std::string html = "<ul class='verdict'>\n";
    for (const std::string &sentence : sentences)
        html += "<li>" + html_text(sentence) + "</li>\n";
    return html + "</ul>\n";
}

} // namespace

bool is_slower(const StrategySummary &s) { return bounded(s.relative_time) && s.relative_time.low > 1; }

std::vector<std::string> verdict(const SweepRecord &record, const SweepSummary &summary) {
    const StrategySummary &best = summary.strategies[summary.best];
    const double seconds = best.ranking_time().estimate;
    std::string where = std::filesystem::path(record.scene).filename().string();
    for (const DeviceRecord &d : record.devices)
        where += fmt::format("{}{}",
                             record.devices.size() == 1 ? " and "
                             : &d == &record.devices[0] ? " on "
                                                        : " and ",
                             d.name);
    std::vector<std::string> sentences = {fmt::format("On {}, {} is the fastest: it {} relMSE {} in {}.", where,
                                                      best.record->label,
                                                      seconds > best.points.back().seconds ? "would reach" : "reaches",
                                                      error_text(ranking_level), seconds_text(seconds))};
    std::vector<const StrategySummary *> others;
    for (const StrategySummary &s : summary.strategies)
        if (&s != &best)
            others.push_back(&s);
    std::sort(others.begin(), others.end(),
              [](auto a, auto b) { return a->relative_time.estimate < b->relative_time.estimate; });
    for (const StrategySummary *s : others)
        sentences.push_back(fmt::format(
            fmt::runtime(
                is_slower(*s)
                    ? "{} needs {}, {} times longer (95 % interval {} to {})."
                    : "{} needs {}; that is not significantly different ({} times longer, 95 % interval {} to {})."),
            s->record->label, seconds_text(s->ranking_time().estimate), number_text(s->relative_time.estimate),
            number_text(s->relative_time.low), number_text(s->relative_time.high)));
    for (const StrategySummary &s : summary.strategies)
        if (s.bias_p < bias_level(summary))
            sentences.push_back(
                fmt::format("{} is biased: its mean luminance is {:+.2g} % off the reference (p = {:.1g}).",
                            s.record->label, 100 * s.bias, s.bias_p));
    for (const StrategySummary &s : summary.strategies)
        if (const unsigned long long invalid = invalid_samples(*s.record))
            sentences.push_back(
                fmt::format("{}: {} samples were NaN or infinite and are left out.", s.record->label, invalid));
    return sentences;
}

std::string html_page(const SweepRecord &record, const SweepSummary &summary, const std::filesystem::path &folder) {
    const std::string name = html_text(std::filesystem::path(record.scene).stem().string());
    std::string html = page_head;
    html += "<title>Opal sweep of " + name + "</title></head>\n<body>\n<h1>" + name +
            ": what each strategy costs and buys</h1>\n";
    html += verdict_list(verdict(record, summary));
    html += "<h2>Error against time</h2>\n<p>Both axes are logarithmic; bars are 95 % intervals. Lower left is better. "
            "Point at a mark for its figures.</p>\n";
    html += convergence_plot(summary);
    html += "<h2>Time to an error</h2>\n<p>Seconds, extrapolated where no render took as long. Small print: 95 % "
            "intervals. relMSE asks the same of all pixels; MSE, in the "
            "column of efficiencies, is decided by the brightest, such as the edges of lamps.</p>\n" +
            strategy_table(summary);
    html += "<h2>What each gives in the same time</h2>\n<p>Under each image its error, |image &minus; reference| / "
            "reference: dark blue is none, yellow is as "
            "large as the pixel itself. Point at one to see the same place of all four times as large; click to "
            "enlarge.</p>\n";
    html += equal_time_images(summary, folder);
    html += "<h2>How it was measured</h2>\n" + measurement_text(record);
    html += "<h2>To repeat it</h2>\n<pre>" + html_text(record.command) + "</pre>\n";
    return html + page_tail;
}

std::string text_table(const std::string &name, const std::vector<ValueSweep> &sweeps) {
    size_t value_width = name.size(), label_width = std::string("strategy").size();
    for (const ValueSweep &sweep : sweeps) {
        value_width = std::max(value_width, sweep.value.size());
        for (const StrategySummary &s : sweep.summary.strategies)
            label_width = std::max(label_width, s.record->label.size());
    }
    const auto line = [&](const std::string &value, const std::string &label, const std::string &seconds,
                          const std::string &interval, const std::string &relative) {
        return fmt::format("{:<{}}  {:<{}}  {:<19}  {:<22}  {}\n", value, value_width, label, label_width, seconds,
                           interval, relative);
    };
    std::string text =
        line(name, "strategy", "time to relMSE " + error_text(ranking_level), "95 % interval", "against the fastest");
    for (const ValueSweep &sweep : sweeps)
        for (const StrategySummary &s : sweep.summary.strategies) {
            const stats::Interval time = s.ranking_time();
            text += line(sweep.value, s.record->label, known_seconds(time),
                         bounded(time) ? seconds_text(time.low) + " to " + seconds_text(time.high) : "unknown",
                         against_fastest(sweep.summary, s));
        }
    return text;
}

std::string html_table_page(const std::string &scene, const std::string &name, const std::vector<ValueSweep> &sweeps) {
    std::vector<std::string> labels; // of all sweeps: a strategy may make sense at some values only
    for (const ValueSweep &sweep : sweeps)
        for (const StrategySummary &s : sweep.summary.strategies)
            if (std::find(labels.begin(), labels.end(), s.record->label) == labels.end())
                labels.push_back(s.record->label);
    const std::string title = html_text(std::filesystem::path(scene).stem().string() + " by " + name);
    std::string html = page_head;
    html += fmt::format("<title>Opal sweeps of {0}</title></head>\n<body>\n<h1>{0}</h1>\n<p>Time to relMSE {1}. Small "
                        "print: the 95 % interval, and how the time stands to that of the fastest at this value. Each "
                        "value links its own sweep.</p>\n<table><tr><th>{2}</th>",
                        title, error_text(ranking_level), html_text(name));
    for (const std::string &label : labels)
        html += "<th>" + html_text(label) + "</th>";
    html += "</tr>\n";
    for (const ValueSweep &sweep : sweeps) {
        html += fmt::format("<tr><td><a href=\"{}/index.html\">{}</a></td>", html_text(sweep.folder),
                            html_text(sweep.value));
        const std::vector<StrategySummary> &strategies = sweep.summary.strategies;
        for (const std::string &label : labels) {
            const auto s = std::find_if(strategies.begin(), strategies.end(),
                                        [&](const StrategySummary &x) { return x.record->label == label; });
            if (s == strategies.end()) {
                html += "<td>&ndash;</td>";
                continue;
            }
            const stats::Interval time = s->ranking_time();
            const bool best = &*s == &strategies[sweep.summary.best];
            html += fmt::format(
                "<td>{0}{1}{2}{3}<small>{4}</small></td>", best ? "<b>" : "", known_seconds(time), best ? "</b>" : "",
                bounded(time) ? fmt::format("<small>{} to {}</small>", seconds_text(time.low), seconds_text(time.high))
                              : "",
                against_fastest(sweep.summary, *s));
        }
        html += "</tr>\n";
    }
    return html + "</table>\n</body></html>\n";
}

} // namespace opal
