// opal extremes: where does single precision end? Scenes stretched over many decades, single against double precision.
#include "base/error.h"
#include "base/json.h"
#include "base/log.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "extremes/report.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct ExtremesOptions {
    std::string device, json, plot, cl_dir;
    std::vector<std::string> names;
    extremes::StressSettings settings;
    bool quick = false, list = false;
    CLI::Option *side = nullptr, *spp = nullptr;
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
    for (const std::string &file : {o.json, o.plot})
        if (!file.empty())
            check_writable(file);
    if (o.quick) {
        o.settings.side = o.side->count() ? o.settings.side : 32;
        o.settings.spp = o.spp->count() ? o.settings.spp : 32;
    }
    const DevicePick pick = pick_device(o.device, list_devices());
    lanes_for(pick.info, 0, MathMode::double_precision); // refuses a device without doubles before anything is rendered
    const Device device = open_device(pick.info);
    const Sources sources = o.cl_dir.empty() ? Sources::embedded() : Sources::from_folder(o.cl_dir);
    o.settings.sources = &sources;
    info(fmt::format("device  {} (driver {}; {}), {} x {} pixels, {} samples each, seed {}", pick.info.name,
                     pick.info.driver, pick.reason, o.settings.side, o.settings.side, o.settings.spp, o.settings.seed));

    std::vector<extremes::StressResult> results;
    nlohmann::json report = {{"device", pick.info.name},       {"driver", pick.info.driver}, {"side", o.settings.side},
                             {"spp", o.settings.spp},          {"seed", o.settings.seed},    {"version", OPAL_VERSION},
                             {"rows", nlohmann::json::array()}};
    bool kept = true;
    for (const extremes::StressRow *row : rows) {
        results.push_back(extremes::run_stress(*row, device, o.settings, o.quick ? 3 : 1));
        print_text(extremes::table_of(results.back()));
        report["rows"].push_back(extremes::json_of(results.back()));
        kept = kept && results.back().kept;
    }
    if (!o.json.empty())
        write_safely(o.json, dump(report, 2) + "\n");
    if (!o.plot.empty())
        write_safely(o.plot, extremes::svg_of(results));
    return kept ? 0 : 1;
}

} // namespace

RunCommand setup_extremes(CLI::App &app) {
    auto o = std::make_shared<ExtremesOptions>();
    app.add_option("--row", o->names, "What to stretch (--list); all of them where none is named");
    app.add_flag("--list", o->list, "List what can be stretched");
    app.add_flag("--quick", o->quick, "Every third value, small pictures");
    o->side = app.add_option("--side", o->settings.side, "Pixels along each side")
                  ->check(CLI::Range(1, 4096))
                  ->capture_default_str();
    o->spp = app.add_option("--spp", o->settings.spp, "Samples of each pixel")
                 ->check(CLI::Range(1, 1 << 24))
                 ->capture_default_str();
    app.add_option("--seed", o->settings.seed, "Of the random numbers")->capture_default_str();
    app.add_option("--json", o->json, "All figures")->type_name("FILE");
    app.add_option("--plot", o->plot, "SVG of error against parameter")->type_name("FILE");
    app.add_option("--cl-dir", o->cl_dir, "Read the kernels from this copy of cl/")->type_name("FOLDER");
    add_device_option(app, o->device);
    return [o] { return run(*o); };
}

} // namespace opal
