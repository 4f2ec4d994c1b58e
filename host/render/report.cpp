#include "render/report.h"

#include "base/command_line.h"
#include "base/json.h"
#include "base/log.h"
#include "base/printable.h"
#include "base/values.h"
#include "image/metrics.h"
#include "scene/options.h"
#include "stats/special.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace opal {

using nlohmann::json;

namespace {

double samples_per_second(const FilmStatistics &s, const RenderSeconds &seconds) {
    return seconds.render > 0 ? double(s.samples + s.invalid) / seconds.render : 0;
}

// A number as a number where the attribute holds it: a seed of more than 31 bits stays exact as text.
Attribute attribute_of(const json &value) {
    if (value.is_string())
        return as_utf8(value.get_ref<const std::string &>());
    if (value.is_number_float())
        return value.get<float>();
    if (value.is_number_integer() && std::in_range<int>(value.get<long long>()))
        return value.get<int>();
    return dump(value);
}

} // namespace

json strategy_json(const SceneDescription &scene) {
    json j = object({{"integrator", integrator_name(scene)}});
    for (const StrategyOption &option : strategy_options()) {
        if (option.name == "lanes") // the report has its own key, the number that was used
            continue;
        const std::string text = option.text(scene.strategy);
        if (option.xml_tag == "float")
            j[option.name] = parse_number(text);
        else if (option.xml_tag == "integer" && text != "none")
            j[option.name] = parse_integer(text);
        else
            j[option.name] = text;
    }
    return j;
}

double RenderReport::spp() const {
    return double(statistics.samples + statistics.invalid) / (double(film.width) * film.height);
}

std::string RenderReport::text() const {
    const FilmStatistics &s = statistics;
    const std::string of =
        s.empty_pixels ? "of the pixels that have samples" : fmt::format("+- {:.2g}", s.stderr_luminance);
    return fmt::format("result  mean luminance {:.6g} {}, {:.4g} M paths/s over {:.3g} s of kernel time",
                       s.mean_luminance, of, 1e-6 * samples_per_second(s, seconds), seconds.render);
}

nlohmann::json RenderReport::json() const {
    const FilmStatistics &s = statistics;
    nlohmann::json j;
    j["scene"] = scene.file.string();
    j["scene_hash"] = scene.hash;
    j["dialect"] = name_of(scene.dialect);
    j["definitions"] = scene.definitions;
    j["device"] = device.name;
    j["driver"] = device.driver;
    j["lanes"] = lanes;
    j["strategy"] = strategy_json(scene);
    j["kernel"] = scene.strategy.is_general() ? "general" : "special";
    j["width"] = film.width;
    j["height"] = film.height;
    if (film.crop != Crop{})
        j["crop"] = json_of(film.crop);
    j["spp"] = spp();
    j["seed"] = seed;
    j["mean_rgb"] = s.mean_rgb;
    j["mean_luminance"] = s.mean_luminance;
    j["stderr_luminance"] = s.empty_pixels ? nlohmann::json() : nlohmann::json(s.stderr_luminance); // null: unknown
    j["empty_pixels"] = s.empty_pixels;
    j["single_sample_pixels"] = s.single_sample_pixels;
    j["invalid_samples"] = s.invalid;
    j["invalid_places"] = nlohmann::json::array();
    for (const InvalidSample &p : film.invalid_places)
        j["invalid_places"].push_back(object({{"x", p.x}, {"y", p.y}, {"sample", p.sample}}));
    j["samples_per_second"] = samples_per_second(s, seconds);
    j["seconds"] = object({{"load", seconds.load},
                           {"bvh", seconds.bvh},
                           {"compile", seconds.compile},
                           {"render", seconds.render},
                           {"write", seconds.write}});
    j["warnings"] = warnings();
    j["version"] = OPAL_VERSION;
    return j;
}

StopReport report_stop(const StopRule &rule, const StopResult &stopped, const RenderReport &render) {
    const FilmStatistics &s = render.statistics;
    StopReport report{rule, stopped, render.spp(), render.seconds.render, seconds_since_start()};
    report.relative_error = s.empty_pixels         ? INFINITY
                            : s.mean_luminance > 0 ? s.stderr_luminance / s.mean_luminance
                                                   : 0;
    const double half = stats::normal_quantile(0.5 + StopReport::confidence / 2) * s.stderr_luminance;
    if (s.empty_pixels == 0)
        report.interval = {s.mean_luminance - half, s.mean_luminance + half};
    if (rule.relative_error > 0)
        report.met = s.mean_luminance > 0 && report.relative_error <= rule.relative_error;
    return report;
}

std::string StopReport::text() const {
    std::string words =
        fmt::format("stop    after {:.4g} samples a pixel, {:.4g} s of kernel time, {:.4g} s since the start: ", spp,
                    seconds, wall_seconds);
    words += !interval ? "the mean luminance of the whole image is unknown"
                       : fmt::format("relative standard error {:.3g} % of the mean luminance, which is in [{:.6g}, "
                                     "{:.6g}] with confidence {:g} %",
                                     100 * relative_error, (*interval)[0], (*interval)[1], 100 * confidence);
    if (rule.relative_error > 0)
        words += fmt::format("; a pilot of {} samples a pixel ({:.3g} s) decided and is not in the image",
                             stopped.pilot_spp, stopped.pilot_seconds);
    return words;
}

std::string StopReport::warning() const {
    if (met)
        return "";
    const std::string asked = fmt::format("--target-error {:g} %: ", 100 * rule.relative_error);
    return asked + (interval ? fmt::format("reached {:.3g} %", 100 * relative_error) : "not reached");
}

nlohmann::json StopReport::json() const {
    const bool by_error = rule.relative_error > 0, by_wall = rule.wall_seconds > 0;
    nlohmann::json j = object({{"rule", by_error  ? "target-error"
                                        : by_wall ? "time-limit"
                                                  : "time"},
                               {"target", by_error  ? rule.relative_error
                                          : by_wall ? rule.wall_seconds
                                                    : rule.seconds},
                               {"reached", by_error  ? relative_error
                                           : by_wall ? wall_seconds
                                                     : seconds},
                               {"kernel_seconds", seconds},
                               {"wall_seconds", wall_seconds},
                               {"relative_error", relative_error},
                               {"confidence", confidence},
                               {"mean_luminance_interval", nullptr}});
    if (interval)
        j["mean_luminance_interval"] = *interval;
    if (by_error)
        j.update(object({{"met", met}, {"pilot_spp", stopped.pilot_spp}, {"pilot_seconds", stopped.pilot_seconds}}));
    return j;
}

ImageFault find_fault(const Image &image, const FilmStatistics &s) {
    bool black = true;
    for (const char *channel : {"R", "G", "B"})
        black = black && std::ranges::all_of(image.get(channel).values, [](float value) { return value == 0; });
    const bool samples_black = s.samples > 0 ? s.mean_rgb == std::array<double, 3>{} : s.invalid == 0;
    return {invalid_pixels(image).count, black && !samples_black};
}

std::string ImageFault::text() const {
    if (invalid_pixels > 0)
        return fmt::format("{} pixels of the image are NaN or infinite: their radiances or weights are beyond single "
                           "precision",
                           invalid_pixels);
    return samples_lost ? "the image is black although its samples are not" : "";
}

std::vector<std::string> film_warnings(const RenderReport &render) {
    const Film &film = render.film;
    std::vector<std::string> lines;
    if (film.invalid) {
        std::string places;
        for (const InvalidSample &p : film.invalid_places)
            places += fmt::format(" pixel ({}, {}) sample {};", p.x, p.y, p.sample);
        lines.push_back(fmt::format("{} samples were NaN or infinite and are left out of the image; the first:{}",
                                    film.invalid, places));
    }
    const FilmStatistics &s = render.statistics;
    const bool asks_lights = integrator_of(render.scene.strategy).has(OPAL_ASKS_LIGHTS);
    if (s.samples > 0 && s.mean_rgb == std::array<double, 3>{} && asks_lights && has_light(render.scene))
        lines.push_back(
            fmt::format("{}: the image is black, although the scene has lights: none of {} samples found light",
                        render.scene.place.text(), s.samples));
    if (s.empty_pixels == 0)
        return lines;
    const size_t pixels = size_t(film.width) * size_t(film.height);
    std::string words = fmt::format(
        "{} of {} pixels ({:.3g} %) have no {}sample: the image shows nothing there, and its mean is that "
        "of the others, with unknown error",
        s.empty_pixels, pixels, 100 * double(s.empty_pixels) / double(pixels), film.invalid ? "valid " : "");
    if (!film.invalid)
        words += fmt::format("; one sample of every pixel takes about {:.2g} s",
                             render.seconds.render * double(pixels) / double(s.samples));
    lines.push_back(words);
    return lines;
}

void add_metadata(Image &image, const json &report, const std::string &command_line) {
    for (const auto &[key, value] : report.items())
        if (key != "crop") // write_exr notes Image::crop
            image.metadata["opal." + key] = attribute_of(value);
    image.metadata["opal.command_line"] = as_utf8(command_line);
}

} // namespace opal
