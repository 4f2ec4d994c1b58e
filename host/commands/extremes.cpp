// opal extremes: where single precision ends. Scenes are stretched over many decades, single against double precision.
#include "base/error.h"
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "extremes/report.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct ExtremesOptions {
    DeviceOptions device;
    std::string json, plot, cl_dir;
    std::vector<std::string> names;
    extremes::StressSettings settings;
    bool quick = false, list = false;
    std::optional<unsigned> side, spp; // if the command line gives them
};

std::vector<const extremes::StressRow *> chosen(const std::vector<std::string> &names) {
    std::vector<const extremes::StressRow *> rows;
    for (const std::string &name : names)
        rows.push_back(&find_row(extremes::stress_rows(), "row", name));
    for (const extremes::StressRow &row : extremes::stress_rows())
        if (names.empty())
            rows.push_back(&row);
    return rows;
}

int run(ExtremesOptions o) {
    if (o.list) {
        for (const extremes::StressRow &row : extremes::stress_rows())
            print("{:<18}{}\n", row.name, row.stretched);
        return 0;
    }
    const auto rows = chosen(o.names);
    prepare_json(o.json);
    if (!o.plot.empty())
        check_output(o.plot);
    if (o.quick)
        o.settings.side = o.settings.spp = 32;
    o.settings.side = o.side.value_or(o.settings.side);
    o.settings.spp = o.spp.value_or(o.settings.spp);
    const DevicePick pick = choose_device(o.device);
    lanes_for(pick.info, 0, MathMode::double_precision); // refuses a device without doubles before anything is rendered
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.cl_dir);
    o.settings.sources = &sources;
    info(fmt::format("device  {}, {} x {} pixels, {} samples each, seed {}", text_of(pick), o.settings.side,
                     o.settings.side, o.settings.spp, o.settings.seed));

    std::vector<extremes::StressResult> results;
    nlohmann::json report = object({{"device", pick.info.name},
                                    {"driver", pick.info.driver},
                                    {"side", o.settings.side},
                                    {"spp", o.settings.spp},
                                    {"seed", o.settings.seed},
                                    {"version", OPAL_VERSION},
                                    {"rows", nlohmann::json::array()}});
    bool kept = true;
    const size_t stride = o.quick ? 3 : 1;
    size_t done = 0, values = 0;
    for (const extremes::StressRow *row : rows)
        values += extremes::values_of(*row, stride).size();
    RunningProgress progress("extremes");
    for (const extremes::StressRow *row : rows) {
        results.push_back(extremes::run_stress(*row, device, o.settings, stride,
                                               [&] { progress.update(double(++done), double(values)); }));
        print_text(extremes::table_of(results.back()));
        report["rows"].push_back(extremes::json_of(results.back()));
        kept = kept && results.back().kept;
    }
    write_json(o.json, "extremes", report);
    if (!o.plot.empty())
        write_safely(o.plot, extremes::svg_of(results));
    return kept ? exit_done : exit_check_failed;
}

} // namespace

Command extremes_command() {
    auto o = std::make_shared<ExtremesOptions>();
    return {
        .name = "extremes",
        .help = "Compare single with double precision on scenes of extreme sizes and values",
        .options = {{.flags = "--row",
                     .target = &o->names,
                     .help = "What to stretch (--list); all of them where none is named",
                     .check = Accepts{[](const std::string &name) { find_row(extremes::stress_rows(), "row", name); },
                                      names_of(extremes::stress_rows())},
                     .type = "NAME"},
                    {.flags = "--list", .target = &o->list, .help = "List what can be stretched"},
                    {.flags = "--quick", .target = &o->quick, .help = "Every third value, small pictures"},
                    {.flags = "--side",
                     .target = &o->side,
                     .help = "Pixels along each side",
                     .check = Range{1, 4096},
                     .default_text = std::to_string(o->settings.side)},
                    {.flags = "--spp",
                     .target = &o->spp,
                     .help = "Samples of each pixel",
                     .check = Range{1, 1 << 24},
                     .default_text = std::to_string(o->settings.spp)},
                    {.flags = "--seed", .target = &o->settings.seed, .help = "Seed of the random numbers"},
                    json_row(o->json, "all figures"),
                    {.flags = "--plot", .target = &o->plot, .help = "SVG of error against parameter", .type = "FILE"},
                    cl_dir_row(o->cl_dir),
                    device_row(o->device),
                    threads_row(o->device)},
        .examples = {"opal extremes --quick", "opal extremes --row distance --plot distance.svg"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
