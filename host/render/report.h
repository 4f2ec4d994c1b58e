// The report of a render: one JSON object, for --json and for the header of the EXR.
#pragma once

#include "device/context.h"
#include "film/film.h"
#include "render/stop_rules.h"
#include "scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <optional>

namespace opal {

// Seconds of the stages of a render, in wall time except for `render`, which is kernel time.
struct RenderSeconds {
    double load = 0, bvh = 0, compile = 0, render = 0, write = 0;
};

// The strategy: a key for each axis with the choice's name on the command line, and the numeric options.
nlohmann::json strategy_json(const SceneDescription &scene);

// A finished render: text() is its line for people, json() all there is.
struct RenderReport {
    const SceneDescription &scene;
    const Film &film;
    const DeviceInfo &device;
    int lanes = 1;
    unsigned seed = 0;
    RenderSeconds seconds{};
    FilmStatistics statistics = statistics_of(film); // a pass over all pixels, made once

    double spp() const; // samples a pixel, on average
    std::string text() const;
    nlohmann::json json() const; // with the warnings so far
};

// How a stop rule ended a render. The interval holds the true mean luminance with that confidence. Error and interval
// are unknown where pixels have no sample: what those would add to the mean is unknown.
struct StopReport {
    static constexpr double confidence = 0.95;
    StopRule rule;
    StopResult stopped;
    double spp = 0, seconds = 0; // samples a pixel and kernel time of the film
    double wall_seconds = 0;     // since the start of the process
    double relative_error = 0;   // of the mean luminance, as its standard error; infinite: unknown
    std::optional<std::array<double, 2>> interval{};
    bool met = true; // false: the target error was not reached

    std::string text() const;
    std::string warning() const; // empty where the rule was met
    nlohmann::json json() const;
};
StopReport report_stop(const StopRule &rule, const StopResult &stopped, const RenderReport &render);

// What is wrong with an image although samples were rendered: a render that has such a fault has failed.
struct ImageFault {
    size_t invalid_pixels = 0; // NaN or infinite
    bool samples_lost = false; // all is black, although the samples are not or are not finite

    explicit operator bool() const { return invalid_pixels > 0 || samples_lost; }
    std::string text() const; // empty where there is none
};
ImageFault find_fault(const Image &image, const FilmStatistics &statistics);

// What the image lacks: invalid samples, pixels without one.
std::vector<std::string> film_warnings(const RenderReport &render);

// Adds the report to the image's metadata, which become header attributes: "opal.KEY" for each key.
void add_metadata(Image &image, const nlohmann::json &report, const std::string &command_line);

} // namespace opal
