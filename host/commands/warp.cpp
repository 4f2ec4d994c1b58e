// opal warp: tests samples of a warp, BSDF or light against their density, and draws both.
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "densities/plot.h"
#include "densities/targets.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct Options {
    DeviceOptions device;
    std::string name, plot, json, math = "precise", cl_dir;
    std::map<std::string, std::string> parameters, axes;
    bool list = false;
    int cells = 40, lanes = 0;
    double samples = 1e6, significance = 1e-3;
    unsigned seed = 0;
};

int print_list() {
    for (const TargetName &row : targets())
        print("{:<20} {}{}\n", row.name, row.help, row.parameters.empty() ? "" : "; parameters " + row.parameters);
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

nlohmann::json json_of(const Target &target, const DensityCheck &check, const Options &o) {
    const stats::TestResult &r = check.test.result;
    return object({{"target", target_name(o.name)},
                   {"description", target.description},
                   {"domain", target.sampled.domain->name},
                   {"samples", check.histogram.n()},
                   {"cells", o.cells},
                   {"seed", o.seed},
                   {"integral", check.test.mass.value},
                   {"integral_error", check.test.mass.error},
                   {"failed", check.histogram.failed},
                   {"outside", check.histogram.outside},
                   {"statistic", r.statistic},
                   {"dof", r.dof},
                   {"p_value", r.p_value},
                   {"significance", o.significance},
                   {"passed", !r.rejected(o.significance)},
                   {"reason", r.reason}});
}

int run(const Options &o) {
    if (o.list)
        return print_list();
    if (o.name.empty())
        throw UsageError("opal warp needs a name; available: " + joined(names_of(targets())));
    prepare_json(o.json);
    if (!o.plot.empty())
        check_output(o.plot);
    const DevicePick pick = choose_device(o.device);
    const Device device = open_device(pick.info);
    BuildOptions build;
    build.lanes = o.lanes ? o.lanes : pick.info.native_lanes;
    build.math = o.math == "fast" ? MathMode::fast : MathMode::precise;
    const Sources sources = load_sources(o.cl_dir);
    info(fmt::format("device  {}, {} lanes, math {}", text_of(pick), build.lanes, o.math));

    Target target = open_target(target_name(o.name), o.parameters, o.axes, device, build, sources);
    const DensityCheck check =
        check_density(*target.probe, target.sampled, o.cells, o.cells, size_t(o.samples), o.seed);
    print_figures(target, check, o);
    write_json(o.json, "warp", json_of(target, check, o));
    if (!o.plot.empty())
        write_png(plot_density(target.sampled, check,
                               fmt::format("{}   P = {:.3g}", target.description, check.test.result.p_value)),
                  o.plot);
    return check.test.result.rejected(o.significance) ? exit_check_failed : exit_done;
}

} // namespace

Command warp_command() {
    auto o = std::make_shared<Options>();
    std::vector<OptionRow> rows = {
        {.flags = "NAME",
         .target = &o->name,
         .help = "What to draw: a warp, bsdf:TYPE or light:KIND (--list); Nori's names (square_to_tent) are known, too",
         .check = Accepts{[](const std::string &name) { find_row(targets(), "warp", target_name(name)); },
                          names_of(targets())},
         .type = ""},
        {.flags = "--list", .target = &o->list, .help = "List the names and their parameters"}};
    for (const TargetParameter &row : target_parameters())
        rows.push_back({.flags = "--" + row.name,
                        .target = MapEntry{&o->parameters, row.name},
                        .help = row.help,
                        .type = "VALUE",
                        .group = "Parameters"});
    for (const char *axis : {"triangle-choice", "emitter-choice"})
        rows.push_back({.flags = std::string("--") + axis,
                        .target = MapEntry{&o->axes, axis},
                        .help = "of light:..., as opal render has it",
                        .type = "NAME",
                        .group = "Parameters"});
    return {
        .name = "warp",
        .help = "Draw samples of a warp, a BSDF or a light, and test whether they have its density",
        .options = append(
            rows,
            {{.flags = "--samples", .target = &o->samples, .help = "How many to draw", .check = Range{1000.0, 1e9}},
             {.flags = "--cells", .target = &o->cells, .help = "Of the grid, along each side", .check = Range{2, 1000}},
             {.flags = "--significance",
              .target = &o->significance,
              .help = "Level of the test",
              .check = Range{1e-12, 0.5}},
             {.flags = "--seed", .target = &o->seed, .help = "Seed of the random numbers"},
             {.flags = "--plot",
              .target = &o->plot,
              .help = "PNG of the samples' density, the pdf and the residual",
              .type = "FILE"},
             json_row(o->json, "the figures"),
             {.flags = "--lanes",
              .target = &o->lanes,
              .help = "Width [the device's]",
              .check = OneOf<int>{{1, 4, 8, 16}}},
             {.flags = "--math",
              .target = &o->math,
              .help = "precise or fast",
              .check = OneOf<std::string>{{"precise", "fast"}}},
             cl_dir_row(o->cl_dir),
             device_row(o->device),
             threads_row(o->device)}),
        .examples = {"opal warp cosine_hemisphere", "opal warp bsdf:microfacet --alpha 0.1 --plot lobe.png"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
