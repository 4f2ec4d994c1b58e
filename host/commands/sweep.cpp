// opal sweep: error against time of several strategies on one scene.
#include "base/command_line.h"
#include "base/error.h"
#include "base/exit_code.h"
#include "base/file_use.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/log.h"
#include "base/printable.h"
#include "base/signals.h"
#include "base/table.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "commands/vary.h"
#include "image/metrics.h"
#include "plot/svg.h"
#include "render/kernel_choice.h"
#include "render/report.h"
#include "scene/options.h"
#include "sweep/convergence_plot.h"
#include "sweep/lock.h"
#include "sweep/page.h"
#include "sweep/run.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <iterator>
#include <numeric>

#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace opal {

namespace {

// What the names of the files begin with that a sweep writes into its folder.
const std::vector<std::string> own_files = {"sweep.json", "sweep.csv",   "convergence.svg", "index.html",
                                            "reference.", "equal_time_", "vary.json",       ".sweep.lock"};

struct Options {
    SceneOptions scene;
    std::vector<std::string> strategies, math;
    std::vector<unsigned> spp = {4, 16, 64};
    unsigned replicates = 5, seed = 0, reference_spp = 0, width = 0, threads = 0;
    std::vector<std::string> devices;
    std::string reference, crop, budget, out, vary, json, clock = "kernel";
    bool quiet = false;
};

std::string hash_of(const Sources &sources) {
    FileHashes hashes;
    for (const auto &[file, text] : sources.files) {
        hashes.add(file);
        hashes.add(text);
    }
    return hashes.value();
}

Image read_reference(const std::string &file, const SceneDescription &scene, FileHashes &hashes) {
    Image image = read_exr(file, &hashes);
    const Crop part = scene.camera.window(), place = image.place();
    if (place != part && place != Crop{0, 0, part.of_width, part.of_height, part.of_width, part.of_height})
        throw Error(fmt::format("--reference {}: has {} pixels, the scene {}", file, text_of(place), text_of(part)));
    image = cropped(image, part);
    for (const char *channel : {"R", "G", "B"})
        if (!image.find(channel))
            throw Error(fmt::format("--reference {}: has no layer {}, which a render has", file, channel));
    if (const double empty = image.number("opal.empty_pixels"))
        throw Error(fmt::format("--reference {}: {} of its pixels have no sample", file, empty));
    if (const size_t invalid = invalid_pixels(image).count)
        throw Error(fmt::format("--reference {}: {} of its pixels are NaN or infinite", file, invalid));
    const std::string of = image.text("opal.scene");
    if (!of.empty() && std::filesystem::path(of).filename() != as_utf8(scene.file.filename().string()))
        throw Error(fmt::format("--reference {}: is an image of {}, not of {}", file, of, scene.file.string()));
    return image;
}

// The kernels of all strategies whose names say nothing else: of one kind, so that their times compare. --specialise
// auto decides by the paths that the points of one strategy and its image ask for, for all devices.
std::string kernel_of(const SweepRecord &r, const SceneDescription &scene, const std::vector<DevicePick> &devices) {
    const Crop window = scene.camera.window();
    const double spp = double(r.replicates) * std::accumulate(r.spp.begin(), r.spp.end(), 0.0) + r.spp.back(),
                 paths = double(window.width) * window.height * spp;
    Strategy strategy = scene.strategy;
    strategy.few_paths = std::ranges::all_of(
        devices, [&](const DevicePick &device) { return suits_general_kernel(device.info, paths); });
    return strategy.is_general() ? "general" : "special";
}

// The record of this sweep before anything is measured. reference_hash: of the file of --reference.
SweepRecord fresh_record(const Options &o, const SceneDescription &scene, const Sources &sources,
                         const std::string &reference_hash, const std::vector<DevicePick> &devices) {
    SweepRecord r;
    r.version = OPAL_VERSION;
    r.scene = scene.file.string();
    r.scene_hash = scene.hash;
    r.kernels_hash = hash_of(sources);
    r.dialect = name_of(scene.dialect);
    r.definitions = scene.definitions;
    for (const StrategyOption &option : strategy_options())
        r.options[option.name] = option.text(scene.strategy);
    r.seed = o.seed;
    for (const DevicePick &d : devices)
        r.devices.push_back({d.info.index,
                             d.info.threads ? fmt::format("{}, threads: {}", d.info.name, d.info.threads) : d.info.name,
                             d.info.driver});
    r.reference_file = o.reference;
    r.reference_hash = reference_hash;
    r.reference_spp = o.reference_spp;
    r.clock = o.clock;
    r.width = scene.camera.width;
    r.height = scene.camera.height;
    r.crop = scene.camera.crop == Crop{} ? "" : text_of(scene.camera.crop);
    r.command = command_line();
    r.integrator = integrator_name(scene);
    r.replicates = o.replicates;
    r.spp = o.spp;
    std::sort(r.spp.begin(), r.spp.end());
    r.spp.erase(std::unique(r.spp.begin(), r.spp.end()), r.spp.end());
    r.budget = o.budget.empty() ? 0 : parse_seconds(o.budget);
    r.kernel = kernel_of(r, scene, devices);
    return r;
}

std::vector<DevicePick> pick_devices(const Options &o) {
    const std::vector<DeviceInfo> known = list_devices();
    std::vector<DevicePick> picks;
    for (const std::string &wanted : o.devices.empty() ? std::vector<std::string>{""} : o.devices) {
        picks.push_back(pick_device(wanted, known));
        if (o.threads)
            picks.back().info = with_threads(picks.back().info, o.threads);
        for (size_t i = 0; i + 1 < picks.size(); i++)
            if (picks[i].info.index == picks.back().info.index)
                throw Error(fmt::format("--device: '{}' and '{}' are the same device, {}", o.devices[i], wanted,
                                        picks[i].info.name));
    }
    for (const DevicePick &pick : picks)
        if (o.clock == "cpu" && pick.info.type != "cpu")
            throw Error(fmt::format("--clock cpu: {} is no CPU; possible: kernel", pick.info.name));
    return picks;
}

// Each strategy on each device. If there are several devices, the names say which.
std::vector<Candidate> cross(const std::vector<Candidate> &strategies, const std::vector<DevicePick> &devices) {
    if (devices.size() == 1)
        return strategies;
    std::vector<Candidate> all;
    for (size_t d = 0; d < devices.size(); d++)
        for (Candidate c : strategies) {
            c.device = d;
            c.name += fmt::format(",device={}", devices[d].info.index);
            c.label += fmt::format("; device {}", devices[d].info.index);
            all.push_back(c);
        }
    return all;
}

void write_results(const SweepRecord &record, const std::filesystem::path &folder) {
    const SweepSummary summary = summarise(record);
    save(record, folder, json_of(summary));
    write_safely(folder / "sweep.csv", csv(summary));
    write_safely(folder / "convergence.svg", svg_file(convergence_plot(summary)));
    write_safely(folder / "index.html", html_page(record, summary, folder));
    for (const std::string &sentence : verdict(record, summary))
        print("{}\n", sentence);
    info(fmt::format("wrote   {}", (folder / "index.html").string()));
}

int run_part(SweepPart part, const SweepPlan &plan, const DevicePick &pick, const std::vector<Candidate> &candidates,
             SweepRecord &record) {
    const Device device = open_device(pick.info);
    if (part != SweepPart::images) {
        info(fmt::format("device  {}: {}", pick.info.index, text_of(pick)));
        info(fmt::format("kernel  {}",
                         record.kernel == "general" ? "the general one, for all strategies" : "one for each strategy"));
    }
    watch_interrupts();
    try {
        run_sweep(plan, device, candidates, record, part);
    } catch (const Interrupted &) {
        warn("interrupted: the same command goes on where it stopped");
        return interrupt_exit_code();
    }
    return 0;
}

// Runs the sweep of one device in a process of its own, as a process can load one driver only. Its results are in the
// folder.
int run_part_apart(SweepPart part, const SweepPlan &plan, const DevicePick &pick,
                   const std::vector<Candidate> &candidates, SweepRecord &record) {
    const pid_t child = fork();
    if (child < 0)
        throw Error("no process could be started for device " + pick.info.name);
    if (child == 0) {
        prctl(PR_SET_PDEATHSIG, SIGTERM); // so that it ends with its parent
        int code = 1;
        try {
            code = run_part(part, plan, pick, candidates, record);
        } catch (const std::exception &error) {
            tell_error(error);
        }
        _exit(code);
    }
    watch_interrupts(); // the child gets the signal too, and ends
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    record = load_record(plan.folder);
    if (interrupted())
        return interrupt_exit_code();
    if (WIFSIGNALED(status))
        throw Error(fmt::format("{}: the driver ended the process by signal {}", pick.info.name, WTERMSIG(status)));
    return WEXITSTATUS(status);
}

// Makes the sweep of one scene in that folder, and its record.
int sweep(const Options &o, SceneDescription scene, const std::filesystem::path &folder, SweepRecord &record) {
    set_size(scene.camera, o.width, 0);
    set_crop(scene.camera, o.crop);
    const std::vector<Candidate> strategies = as_usage([&] { return parse_strategies(scene, o.strategies, o.math); });
    const Sources sources = load_sources(o.scene.cl_dir);
    SweepPlan plan{.folder = folder,
                   .seed = o.seed,
                   .reference_spp = o.reference_spp,
                   .clock = o.clock == "cpu" ? Clock::cpu : Clock::kernel,
                   .sources = &sources};
    Image reference;
    std::string reference_hash;
    if (!o.reference.empty()) {
        FileHashes hashes;
        reference = read_reference(o.reference, scene, hashes);
        reference_hash = hashes.value();
        plan.reference = &reference;
    }
    const std::vector<DevicePick> devices = pick_devices(o);
    std::vector<Candidate> candidates = cross(strategies, devices);
    const SweepRecord fresh = fresh_record(o, scene, sources, reference_hash, devices);
    check_own_files(plan.folder, own_files); // before the record is read, which is both
    make_folder(plan.folder);
    const FolderLock lock(plan.folder);
    record = resume(plan.folder, fresh);
    for (Candidate &c : candidates) { // all rows at once, as references to them are kept
        record.strategy(c.name, c.label).device = c.device;
        c.scene.strategy.few_paths = record.kernel == "general";
    }
    save(record, plan.folder); // fails early if the folder cannot be written
    if (devices.size() == 1) {
        if (const int code = run_part(SweepPart::all, plan, devices[0], candidates, record))
            return code;
    } else
        for (const SweepPart part : {SweepPart::points, SweepPart::images})
            for (size_t d = 0; d < devices.size(); d++) {
                std::vector<Candidate> own;
                std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(own),
                             [&](const Candidate &c) { return c.device == d; });
                if (const int code = run_part_apart(part, plan, devices[d], own, record))
                    return code;
            }
    write_results(record, plan.folder);
    return exit_done;
}

nlohmann::json report_of(const SweepRecord &record, const SweepSummary &summary, const std::filesystem::path &folder) {
    const std::vector<StrategySummary> &strategies = summary.strategies;
    nlohmann::json not_told_apart = nlohmann::json::array(), devices = nlohmann::json::array();
    for (size_t i = 0; i < strategies.size(); i++)
        if (i != summary.best && !is_slower(strategies[i]))
            not_told_apart.push_back(strategies[i].record->name);
    for (const DeviceRecord &device : record.devices)
        devices.push_back(object({{"name", device.name}, {"driver", device.driver}}));
    return object({{"scene", record.scene},
                   {"scene_hash", record.scene_hash},
                   {"dialect", record.dialect},
                   {"definitions", record.definitions},
                   {"devices", devices},
                   {"clock", record.clock},
                   {"kernel", record.kernel},
                   {"width", record.width},
                   {"height", record.height},
                   {"replicates", record.replicates},
                   {"spp", record.spp},
                   {"left_out_spp", record.left_out_spp},
                   {"reference", object({{"made_by", record.reference.made_by}, {"spp", record.reference.spp}})},
                   {"folder", folder.string()},
                   {"fastest", strategies[summary.best].record->name},
                   {"not_told_apart", not_told_apart},
                   {"strategies", json_of(summary)}});
}

int sweep_values(const Options &o, const std::filesystem::path &folder) {
    Variation variation = load_variation(o.scene, o.vary);
    std::vector<SweepRecord> records(variation.variants.size()); // the summaries refer to them
    std::vector<ValueSweep> sweeps;
    make_folder(folder);
    const FolderLock lock(folder);
    for (size_t i = 0; i < records.size(); i++) {
        Variant &variant = variation.variants[i];
        print("{}={}\n", variation.name, variant.value);
        if (const int code = sweep(o, std::move(variant.scene), folder / variant.folder, records[i]))
            return code;
        sweeps.push_back({variant.value, variant.folder, summarise(records[i])});
    }
    nlohmann::json values = nlohmann::json::array();
    for (size_t i = 0; i < sweeps.size(); i++) {
        values.push_back(report_of(records[i], sweeps[i].summary, folder / sweeps[i].folder));
        values.back()["value"] = sweeps[i].value;
    }
    const nlohmann::json report = object({{"vary", variation.name}, {"values", values}});
    const std::string scene = o.scene.file.string();
    write_json(folder / "vary.json", "sweep", report);
    write_json(o.json, "sweep", report);
    write_safely(folder / "index.html", html_table_page(scene, variation.name, sweeps));
    print_text(text_table(variation.name, sweeps));
    info(fmt::format("wrote   {}", (folder / "index.html").string()));
    return exit_done;
}

int run(const Options &o) {
    set_quiet(o.quiet);
    const std::filesystem::path folder = o.out.empty() ? o.scene.file.stem().string() + "_sweep" : o.out;
    const bool varied = !o.vary.empty();
    if (std::filesystem::exists(folder / (varied ? "sweep.json" : "vary.json"))) // index.html can be of one only
        throw Error(fmt::format("{}: holds a sweep {} --vary; give another folder with -o", folder.string(),
                                varied ? "without" : "with"));
    prepare_json(o.json, {folder, own_files});
    if (varied)
        return sweep_values(o, folder);
    SweepRecord record;
    const int code = sweep(o, load_scene(o.scene), folder, record);
    if (code == exit_done)
        write_json(o.json, "sweep", report_of(record, summarise(record), folder));
    return code;
}

} // namespace

Command sweep_command() {
    auto o = std::make_shared<Options>();
    std::vector<OptionRow> rows = scene_rows(o->scene);
    std::erase_if(rows, [](const OptionRow &row) { return row.flags == "--math"; }); // --math takes several modes here
    OptionRow vary =
        vary_row(o->vary, "runs one sweep for each, with its own reference and budget, in the folder "
                          "NAME=V inside that of -o, and writes a table of all values (index.html, vary.json)");
    vary.excludes = "--reference";
    return {
        .name = "sweep",
        .help = "Measure error against time of several strategies on a scene, as one HTML page",
        .options = append(
            rows,
            {{.flags = "--math",
              .target = &o->math,
              .help = "Measure each strategy with each of these modes: precise,fast",
              .check = Accepts{[](const std::string &name) { find_row(math_modes(), "math", name); },
                               names_of(math_modes())},
              .type = "MODE,...",
              .comma_separated = true},
             {.flags = "--device",
              .target = &o->devices,
              .help = "Measure each strategy on each of these devices: an index of `opal devices`, cpu, gpu, or part "
                      "of a name "
                      "[the first GPU, else the CPU]",
              .type = "DEVICE,...",
              .comma_separated = true},
             {.flags = "--threads",
              .target = &o->threads,
              .help = "Threads that CPU devices may use [all that `opal devices` shows as units]",
              .check = Range{1u, 65535u}},
             {.flags = "--strategies",
              .target = &o->strategies,
              .help = "course, all, or lists axis=value,... after the scene; the first is the baseline [course]\n"
                      "  course: hemisphere sampling, light sampling and MIS of both kinds; all: samplers and choices "
                      "besides",
              .type = "STRATEGY...",
              .many_words = true},
             {.flags = "--spp",
              .target = &o->spp,
              .help = "Samples per pixel of the points",
              .check = Range{1u, first_pilot_sample},
              .type = "N,...",
              .comma_separated = true},
             {.flags = "--replicates",
              .target = &o->replicates,
              .help = "Renders of each point, with seeds of their own; an interval needs at least 2",
              .check = Range{2u, 1000000u}},
             {.flags = "--seed", .target = &o->seed, .help = "Seed of the random numbers of the first replicate"},
             {.flags = "--reference",
              .target = &o->reference,
              .help = "EXR with which the images are compared [made by the best strategy]",
              .type = "FILE"},
             {.flags = "--reference-spp",
              .target = &o->reference_spp,
              .help = "Samples per pixel of the reference that is made [8 times the largest --spp]"},
             {.flags = "--budget",
              .target = &o->budget,
              .help = "Limit for the kernel time of the whole sweep: the largest --spp are left out "
                      "until it fits",
              .check = Accepts{parse_seconds},
              .type = "TIME"},
             {.flags = "--clock",
              .target = &o->clock,
              .help = "kernel: seconds of the device's own profile; cpu: CPU seconds of all cores, divided by the "
                      "number of cores. Take cpu if other programs run on the machine",
              .check = OneOf<std::string>{{"kernel", "cpu"}}},
             {.flags = "--width",
              .target = &o->width,
              .help = "Pixels; keeps the aspect [the scene's]",
              .check = Range{1, 65535}},
             crop_row(o->crop),
             vary,
             {.flags = "-o,--output",
              .target = &o->out,
              .help = "Folder; a sweep that is already there is continued [SCENE_sweep]",
              .type = "FOLDER"},
             json_row(o->json, "the verdict and its figures"),
             {.flags = "--quiet", .target = &o->quiet, .help = "Print the verdict, warnings and errors only"}}),
        .examples = {"opal sweep scenes/cbox_mis.xml",
                     "opal sweep scenes/mixed_room.xml --strategies all --budget 10min -o sweep"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
