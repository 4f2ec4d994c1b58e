#include "commands/options.h"

#include "base/table.h"
#include "scene/options.h"
#include "strategies/check.h"

#include <fmt/format.h>

namespace opal {

namespace {

std::string integrator_help() {
    return fmt::format("{} [the scene's]\n  {}", axes()[AXIS_integrator].help,
                       fmt::join(names_of(integrator_types()), ", "));
}

void add_override(CLI::App &app, SceneOptions &options, const std::string &name, const std::string &type,
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
    for (const StrategyOption &option : strategy_options())
        add_override(app, options, option.name, option.values, option.help);
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
