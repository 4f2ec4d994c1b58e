#include "commands/options.h"

#include "base/table.h"
#include "scene/options.h"
#include "strategies/check.h"

#include <fmt/format.h>

namespace opal {

namespace {

constexpr const char *scenes_own = " [the scene's]";

std::string axis_help(const Axis &axis) {
    std::string help = axis.help + scenes_own;
    for (const Choice &choice : axis.choices)
        help += fmt::format("\n  {}: {}", choice.name, choice.help);
    return help;
}

std::string integrator_help() {
    return fmt::format("{}{}\n  {}", axes()[AXIS_integrator].help, scenes_own,
                       fmt::join(names_of(integrator_types()), ", "));
}

struct NumberHelp {
    std::string name;
    const char *type, *help;
};

// The options beside the axes (scene/options.h).
const std::vector<NumberHelp> numbers = {
    {"max-depth", "N|none",
     "segments of the longest path: 1 shows lights, 2 adds direct light [the scene's, else none]"},
    {"rr-depth", "N", "Russian roulette from this many segments on [the scene's, else 3]"},
    {"rr-prob", "P", "--rr fixed: probability to survive, above 0 to 1 [the scene's, else 0.95]"},
    {"math", "MODE",
     "precise: single precision; fast: the same with relaxed math; double: double precision, where the device has it "
     "[precise]"},
    {"lanes", "N|auto",
     "paths that a work-item carries: 1, 4, 8, 16, or auto: what the device's vectors hold, 1 on a GPU [auto]"},
    {"specialise", "on|off", "compile what the scene needs, or one kernel that can do everything [on]"},
};

void add_override(CLI::App &app, SceneOptions &options, const std::string &name, const char *type,
                  const std::string &help) {
    app.add_option_function<std::string>(
           "--" + name, [&options, name](const std::string &value) { options.overrides[name] = value; }, help)
        ->type_name(type)
        ->group("Strategy");
}

} // namespace

void add_scene_options(CLI::App &app, SceneOptions &options) {
    app.add_option("SCENE.xml", options.file, "The scene, in Nori's format")->required()->type_name("");
    add_strategy_options(app, options);
}

void add_strategy_options(CLI::App &app, SceneOptions &options) {
    add_override(app, options, "integrator", "NAME", integrator_help());
    for (const Option &option : opal::options()) {
        const auto axis =
            std::find_if(axes().begin(), axes().end(), [&](const Axis &a) { return a.name == option.name; });
        if (axis != axes().end())
            add_override(app, options, option.name, "NAME", axis_help(*axis));
        else {
            const NumberHelp &row = find_row(numbers, "strategy option", option.name);
            add_override(app, options, row.name, row.type, row.help);
        }
    }
    app.add_flag("--lenient", options.load.lenient, "An unknown property of the scene warns instead of failing");
    app.add_option("--cl-dir", options.cl_dir, "Read the kernels from this copy of cl/ [those in the binary]")
        ->type_name("FOLDER");
}

void add_device_option(CLI::App &app, std::string &device) {
    app.add_option("--device", device,
                   "An index of `opal devices`, cpu, gpu, or part of a name [the first GPU, else the CPU]")
        ->type_name("DEVICE");
}

SceneDescription load_scene(const SceneOptions &options) {
    SceneDescription scene = load_scene(options.file, options.load);
    override_strategy(scene.strategy, options.overrides);
    check_strategy(scene);
    return scene;
}

Sources load_sources(const SceneOptions &options) {
    return options.cl_dir.empty() ? Sources::embedded() : Sources::from_folder(options.cl_dir);
}

} // namespace opal
