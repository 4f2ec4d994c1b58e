#include "commands/options.h"

#include "base/error.h"
#include "base/table.h"
#include "base/values.h"
#include "scene/options.h"
#include "strategies/check.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace opal {

namespace {

std::string integrator_help() {
    return fmt::format("{} [the scene's]\n  {}", axes()[AXIS_integrator].help,
                       fmt::join(names_of(integrator_types()), ", "));
}

// The dialects, and auto.
std::vector<std::string> dialect_choices() {
    std::vector<std::string> names = names_of(dialects());
    names.emplace_back("auto");
    return names;
}

// A row that set_option understands. values: names that it takes, if it takes names.
OptionRow override_row(SceneOptions &options, const std::string &name, const std::string &type, const std::string &help,
                       const std::vector<std::string> &values) {
    const auto parse = [name](const std::string &value) {
        Strategy strategy;
        set_option(strategy, name, value);
    };
    return {.flags = "--" + name,
            .target = MapEntry{&options.overrides, name},
            .help = help,
            .check = Accepts{parse, values},
            .type = type,
            .group = strategy_group};
}

} // namespace

std::vector<OptionRow> scene_rows(SceneOptions &options) {
    return append({{.flags = "SCENE.xml",
                    .target = &options.file,
                    .help = "The scene, in the format of Nori or of Mitsuba",
                    .type = "",
                    .required = true}},
                  strategy_rows(options));
}

std::vector<OptionRow> strategy_rows(SceneOptions &options) {
    std::vector<OptionRow> rows = {
        override_row(options, "integrator", "NAME", integrator_help(), names_of(integrator_types()))};
    for (const StrategyOption &option : strategy_options())
        rows.push_back(override_row(options, option.name, option.values, option.help, option.names));
    rows.push_back({.flags = "--lenient",
                    .target = &options.load.lenient,
                    .help = "Warn instead of fail at an attribute, a property, a tag or a type that Opal does not "
                            "know. For a type, the warning says what Opal uses instead"});
    rows.push_back({.flags = "--dialect",
                    .target = &options.load.dialect,
                    .help =
                        "What the scene is written for: upstream (Nori), course (Nori's of 2022: box filter), eth "
                        "(ETH's course, Nori of 2012: the camera's +x points to the right of the image), mitsuba, or "
                        "auto: by its version and its names",
                    .check = OneOf<std::string>{dialect_choices()},
                    .type = "NAME"});
    rows.push_back({.flags = "--sensor",
                    .target = &options.load.sensor,
                    .help = "The camera of a Mitsuba scene that has several: its id, or its number from 0 [0]",
                    .type = "N|ID"});
    rows.push_back({.flags = "-D,--define",
                    .target = &options.load.definitions,
                    .help = "The value for $NAME in the scene's attributes; without it, that of <default name=\"NAME\" "
                            "value=\"...\"/>; may be repeated",
                    .type = "NAME=VALUE"});
    rows.push_back({.flags = "--cl-dir",
                    .target = &options.cl_dir,
                    .help = "Read the kernels from this copy of cl/ [those in the binary]",
                    .type = "FOLDER"});
    return rows;
}

OptionRow cl_dir_row(std::string &cl_dir) {
    return {.flags = "--cl-dir", .target = &cl_dir, .help = "Read the kernels from this copy of cl/", .type = "FOLDER"};
}

OptionRow device_row(DeviceOptions &device) {
    return {.flags = "--device",
            .target = &device.name,
            .help = "An index of `opal devices`, cpu, gpu, or part of a name [the first GPU, else the CPU]",
            .type = "DEVICE"};
}

OptionRow threads_row(DeviceOptions &device) {
    return {.flags = "--threads",
            .target = &device.threads,
            .help = "Threads that a CPU device may use [all that `opal devices` shows as units]",
            .check = Range{1u, 65535u}};
}

DevicePick choose_device(const DeviceOptions &device) {
    DevicePick pick = pick_device(device.name, list_devices());
    if (device.threads)
        pick.info = with_threads(pick.info, device.threads);
    return pick;
}

SceneDescription load_scene(const SceneOptions &options) {
    SceneDescription scene = load_scene(options.file, options.load);
    override_strategy(scene.strategy, options.overrides);
    check_strategy(scene);
    return scene;
}

KernelChoice choose_kernel(const DeviceOptions &device, const SceneDescription &scene) {
    KernelChoice choice{choose_device(device), {}};
    choice.build.lanes = lanes_for(choice.pick.info, scene.strategy.lanes, scene.strategy.math);
    choice.build.math = scene.strategy.math;
    return choice;
}

Sources load_sources(const std::string &cl_dir) {
    return cl_dir.empty() ? Sources::embedded() : Sources::from_folder(cl_dir);
}

OptionRow crop_row(std::string &crop) {
    return {.flags = "--crop",
            .target = &crop,
            .help =
                "Render only this part of the image, in pixels from its top left: the same bits as there in the whole "
                "image",
            .type = "X,Y,W,H"};
}

void set_crop(Camera &camera, const std::string &crop) {
    if (crop.empty())
        return;
    const std::vector<std::string_view> words = split(crop);
    std::vector<int> numbers;
    try {
        std::ranges::transform(words, std::back_inserter(numbers), parse_integer);
    } catch (const Error &error) {
        throw UsageError(fmt::format("--crop {}: {}", crop, error.what()));
    }
    if (numbers.size() != 4)
        throw UsageError(fmt::format("--crop {}: wants X,Y,W,H, four whole numbers of pixels", crop));
    const int x = numbers[0], y = numbers[1], width = numbers[2], height = numbers[3];
    if (x < 0 || y < 0 || width < 1 || height < 1 || width > camera.width - x || height > camera.height - y)
        throw Error(
            fmt::format("--crop {}: is no part of the image of {} x {} pixels", crop, camera.width, camera.height));
    camera.crop = {x, y, width, height, camera.width, camera.height};
}

void set_size(Camera &camera, unsigned width, unsigned height) {
    const auto keep_aspect = [](unsigned given, int its, int other) {
        return std::max(1, int(std::lround(double(given) * other / its)));
    };
    const Camera old = camera;
    if (width || height) {
        camera.width = width ? int(width) : keep_aspect(height, old.height, old.width);
        camera.height = height ? int(height) : keep_aspect(width, old.width, old.height);
    }
    if (const Crop crop = old.crop; crop != Crop{}) { // the film's: the same part of the view, to whole pixels
        const auto scaled = [](int at, int now, int before) { return int(std::lround(double(at) * now / before)); };
        const int x = std::min(scaled(crop.x, camera.width, old.width), camera.width - 1);
        const int y = std::min(scaled(crop.y, camera.height, old.height), camera.height - 1);
        const int right = scaled(crop.x + crop.width, camera.width, old.width);
        const int bottom = scaled(crop.y + crop.height, camera.height, old.height);
        camera.crop = {x, y, std::max(right - x, 1), std::max(bottom - y, 1), camera.width, camera.height};
    }
}

} // namespace opal
