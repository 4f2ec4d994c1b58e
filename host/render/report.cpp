#include "render/report.h"

#include "base/json.h"
#include "base/log.h"
#include "base/values.h"
#include "scene/options.h"

namespace opal {

using nlohmann::json;

json strategy_json(const SceneDescription &scene) {
    json j = {{"integrator", scene.integrator_type}};
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

json report_json(const SceneDescription &scene, const DeviceInfo &device, int lanes, unsigned seed, const Film &film,
                 const RenderSeconds &seconds) {
    const FilmStatistics s = statistics_of(film);
    json j;
    j["scene"] = scene.file.string();
    j["device"] = device.name;
    j["driver"] = device.driver;
    j["lanes"] = lanes;
    j["strategy"] = strategy_json(scene);
    j["width"] = film.width;
    j["height"] = film.height;
    j["spp"] = double(s.samples + s.invalid) / (double(film.width) * film.height);
    j["seed"] = seed;
    j["mean_rgb"] = s.mean_rgb;
    j["mean_luminance"] = s.mean_luminance;
    j["stderr_luminance"] = s.empty_pixels ? json() : json(s.stderr_luminance); // null: unknown
    j["empty_pixels"] = s.empty_pixels;
    j["single_sample_pixels"] = s.single_sample_pixels;
    j["invalid_samples"] = s.invalid;
    j["invalid_places"] = json::array();
    for (const InvalidSample &p : film.invalid_places)
        j["invalid_places"].push_back({{"x", p.x}, {"y", p.y}, {"sample", p.sample}});
    j["samples_per_second"] = seconds.render > 0 ? double(s.samples + s.invalid) / seconds.render : 0;
    j["seconds"] = {{"load", seconds.load},
                    {"bvh", seconds.bvh},
                    {"compile", seconds.compile},
                    {"render", seconds.render},
                    {"write", seconds.write}};
    j["warnings"] = warnings();
    j["version"] = OPAL_VERSION;
    return j;
}

void add_metadata(Image &image, const json &report, const std::string &command_line) {
    for (const auto &[key, value] : report.items())
        image.metadata["opal." + key] = value.is_string() ? value.get<std::string>() : dump(value);
    image.metadata["opal.command_line"] = command_line;
}

} // namespace opal
