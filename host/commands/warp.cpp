// opal warp: does what is drawn follow the density that is stated? Figures and a picture.
#include "base/log.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "densities/plot.h"
#include "densities/targets.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct Options {
    std::string name, device, plot, math = "precise", cl_dir;
    std::map<std::string, std::string> parameters, axes;
    bool list = false;
    int cells = 40, lanes = 0;
    double samples = 1e6, significance = 1e-3;
    unsigned seed = 0;
};

int print_list() {
    for (const TargetName &row : targets())
        print("{:<20} {}\n", row.name, row.parameters);
    return 0;
}

void print_figures(const Target &target, const DensityCheck &check, const Options &o) {
    const stats::TestResult &r = check.test.result;
    const double n = check.histogram.n();
    print("{}: {:g} samples on {} x {} cells of the {}\n", target.description, n, o.cells, o.cells,
          target.sampled.domain->name);
    print("  integral of the pdf  {:.7g} (+- {:.1g})\n", check.test.mass.value, check.test.mass.error);
    if (target.sampled.may_fail)
        print("  without a sample     {:.7g} of all draws ({:.7g} expected)\n", check.histogram.failed / n,
              1 - check.test.mass.value);
    print("  outside the domain   {:g}\n", check.histogram.outside);
    print("  chi-square           {:.6g}, {:g} degrees of freedom, p = {:.4g}\n", r.statistic, r.dof, r.p_value);
    print_text(r.rejected(o.significance) ? fmt::format("REJECTED at level {:g} {}\n", o.significance, r.reason)
                                          : fmt::format("accepted at level {:g}\n", o.significance));
}

int run(const Options &o) {
    if (o.list)
        return print_list();
    if (o.name.empty())
        throw Error("opal warp needs a name; available: " + joined(names_of(targets())));
    if (!o.plot.empty())
        check_writable(o.plot);
    find_row(targets(), "warp", o.name);
    const DevicePick pick = pick_device(o.device, list_devices());
    const Device device = open_device(pick.info);
    BuildOptions build;
    build.lanes = o.lanes ? o.lanes : pick.info.native_lanes;
    build.math = o.math == "fast" ? MathMode::fast : MathMode::precise;
    const Sources sources = o.cl_dir.empty() ? Sources::embedded() : Sources::from_folder(o.cl_dir);
    info(fmt::format("device  {} (driver {}; {}), {} lanes, math {}", pick.info.name, pick.info.driver, pick.reason,
                     build.lanes, o.math));

    Target target = open_target(o.name, o.parameters, o.axes, device, build, sources);
    const DensityCheck check =
        check_density(*target.probe, target.sampled, o.cells, o.cells, size_t(o.samples), o.seed);
    print_figures(target, check, o);
    if (!o.plot.empty())
        write_png(plot_density(target.sampled, check,
                               fmt::format("{}   P = {:.3g}", target.description, check.test.result.p_value)),
                  o.plot);
    return check.test.result.rejected(o.significance) ? 1 : 0;
}

} // namespace

RunCommand setup_warp(CLI::App &app) {
    auto o = std::make_shared<Options>();
    app.add_option("NAME", o->name, "What to draw: a warp, bsdf:TYPE or light:KIND (--list)")->type_name("");
    app.add_flag("--list", o->list, "List the names and their parameters");
    for (const TargetParameter &row : target_parameters())
        app.add_option_function<std::string>(
               "--" + row.name, [o, name = row.name](const std::string &value) { o->parameters[name] = value; },
               row.help)
            ->group("Parameters");
    for (const char *axis : {"triangle-choice", "emitter-choice"})
        app.add_option_function<std::string>(
               std::string("--") + axis, [o, axis](const std::string &value) { o->axes[axis] = value; },
               "of light:..., as opal render has it")
            ->group("Parameters");
    app.add_option("--samples", o->samples, "How many to draw")->check(CLI::Range(1000.0, 1e9))->capture_default_str();
    app.add_option("--cells", o->cells, "Of the grid, along each side")
        ->check(CLI::Range(2, 1000))
        ->capture_default_str();
    app.add_option("--significance", o->significance, "Level of the test")
        ->check(CLI::Range(1e-12, 0.5))
        ->capture_default_str();
    app.add_option("--seed", o->seed, "Of the random numbers")->capture_default_str();
    app.add_option("--plot", o->plot, "PNG of the samples' density, the pdf and the residual");
    app.add_option("--lanes", o->lanes, "Width [the device's]")->check(CLI::IsMember({1, 4, 8, 16}));
    app.add_option("--math", o->math, "precise or fast")
        ->check(CLI::IsMember({"precise", "fast"}))
        ->capture_default_str();
    app.add_option("--cl-dir", o->cl_dir, "Read the kernels from this copy of cl/")->type_name("FOLDER");
    add_device_option(app, o->device);
    return [o] { return run(*o); };
}

} // namespace opal
