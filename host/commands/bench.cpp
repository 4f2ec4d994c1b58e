// opal bench: how fast a scene's rays and paths are on this device.
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/table.h"
#include "bench/report.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "image/image.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>

namespace opal {

namespace {

struct RayKind {
    std::string name, help;
};

const std::vector<RayKind> &ray_kinds() {
#define OPAL_ROW(name, help) {#name, help},
    static const std::vector<RayKind> kinds = {OPAL_RAY_KINDS(OPAL_ROW)};
#undef OPAL_ROW
    return kinds;
}

struct RayOptions {
    SceneOptions scene;
    DeviceOptions device;
    std::string kind, json, dump_rays, dump_hits, dump_triangles;
    unsigned rays = 1u << 20, seed = 0;
    int runs = 7;
};

template <class T> std::string bytes_of(const std::vector<T> &rows) {
    return std::string(reinterpret_cast<const char *>(rows.data()), rows.size() * sizeof(T));
}

void write_dumps(const RayOptions &o, const FlatScene &flat, const RaySet &set, const RayTimes &times) {
    static_assert(std::endian::native == std::endian::little && sizeof(RayHit) == 16);
    if (!o.dump_rays.empty())
        write_safely(o.dump_rays, bytes_of(set.rays));
    if (!o.dump_hits.empty())
        write_safely(o.dump_hits, bytes_of(times.hits));
    if (!o.dump_triangles.empty()) {
        const std::vector<std::array<float, 9>> triangles = triangles_of(flat);
        write_safely(o.dump_triangles,
                     bytes_of(std::vector<uint32_t>{uint32_t(triangles.size())}) + bytes_of(triangles));
    }
}

void check_ray_options(const RayOptions &o) {
    for (const auto &[flag, file] : {std::pair("--dump-rays", &o.dump_rays),
                                     {"--dump-hits", &o.dump_hits},
                                     {"--dump-triangles", &o.dump_triangles}})
        if (!file->empty() && o.kind.empty())
            throw UsageError(fmt::format("{} is of one kind of rays: name it with --kind; available: {}", flag,
                                         joined(names_of(ray_kinds()))));
}

void check_ray_outputs(const RayOptions &o) {
    prepare_json(o.json);
    for (const std::string *file : {&o.dump_rays, &o.dump_hits, &o.dump_triangles})
        if (!file->empty())
            check_output(*file);
}

int run_rays(const RayOptions &o) {
    check_ray_options(o);
    SceneDescription scene = load_scene(o.scene);
    check_ray_outputs(o);
    scene.strategy[AXIS_integrator] = CHOICE_integrator_path; // for any scene: its shadow rays go to points on lights
    scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_independent;
    const auto [pick, build] = choose_kernel(o.device, scene);
    const FlatScene flat = flatten(scene, build.lanes);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene.cl_dir);
    RunningProgress progress("bench");
    RayBench bench(device, flat, build, sources);

    const BenchSubject subject{scene, flat, pick, build.lanes};
    nlohmann::json report = subject.json();
    info(subject.scene_text());
    info(subject.device_text());
    info(subject.tree_text());
    for (int kind = 0; kind < RAYS_KINDS; kind++) {
        const std::string &name = ray_kinds()[size_t(kind)].name;
        if (!o.kind.empty() && o.kind != name)
            continue;
        const RaySet set = bench.generate(kind, o.rays, o.seed);
        if (set.rays.empty()) {
            const std::string what = fmt::format("{}: no {} rays: the camera sees nothing that they could start from",
                                                 scene.file.string(), name);
            if (!o.kind.empty())
                throw Error(what);
            warn(what);
            continue;
        }
        const RayFigures figures{name, set.rays.size(), bench.time(set, o.runs)};
        report["kinds"][name] = figures.json();
        if (!o.kind.empty()) {
            report.update(figures.json());
            report["kind"] = name;
            write_dumps(o, flat, set, figures.times);
        }
        print_text(figures.text());
        progress.update(kind + 1, RAYS_KINDS);
    }
    report["compile_seconds"] = bench.compile_seconds();
    write_json(o.json, "bench rays", report);
    return 0;
}

Command rays_command() {
    auto o = std::make_shared<RayOptions>();
    std::string kinds = "Which rays [all]";
    for (const RayKind &kind : ray_kinds())
        kinds += fmt::format("\n  {}: {}", kind.name, kind.help);
    return {
        .name = "rays",
        .help = "Trace camera, bounce and shadow rays of a scene, and nothing else",
        .options = append(
            scene_rows(o->scene),
            {device_row(o->device),
             threads_row(o->device),
             {.flags = "--kind",
              .target = &o->kind,
              .help = kinds,
              .check = Accepts{[](const std::string &name) { find_row(ray_kinds(), "kind of rays", name); },
                               names_of(ray_kinds())},
              .type = "KIND"},
             {.flags = "--rays",
              .target = &o->rays,
              .help = "Rays of a kind that are tried, about; those that start nowhere are left out",
              .check = Range{1u, 1u << 26}},
             {.flags = "--runs",
              .target = &o->runs,
              .help = "Times that all rays are traced; the median is told",
              .check = Range{1, 10000}},
             {.flags = "--seed", .target = &o->seed, .help = "Of the rays"},
             json_row(o->json, "the figures, with mrays_per_second for one --kind, and in `kinds` for each"),
             {.flags = "--dump-rays",
              .target = &o->dump_rays,
              .help = "With --kind: the rays, little-endian float32 ox oy oz tmin dx dy dz tmax each, in the units of "
                      "--dump-triangles",
              .type = "FILE"},
             {.flags = "--dump-hits",
              .target = &o->dump_hits,
              .help = "With --kind: the answers, float32 t u v and int32 triangle each, -1 for none\n"
                      "  shadow rays: triangle is 0 (blocked) or -1, t u v are 0",
              .type = "FILE"},
             {.flags = "--dump-triangles",
              .target = &o->dump_triangles,
              .help = "With --kind: uint32 count, then 9 float32 a triangle, in the order of the hits' indices; "
                      "parallelograms\n"
                      "  are two triangles each, degenerate triangles are dropped; flattened = (world - center) * "
                      "scale of the JSON",
              .type = "FILE"}}),
        .examples = {"opal bench rays scenes/mixed_room.xml",
                     "opal bench rays scenes/mixed_room.xml --kind shadow --json rays.json"},
        .run = [o] { return run_rays(*o); }};
}

struct RenderBenchOptions {
    SceneOptions scene;
    DeviceOptions device;
    std::string json;
    double seconds = 0.5;
    int rounds = 5;
};

int run_renders(const RenderBenchOptions &o) {
    const SceneDescription scene = load_scene(o.scene);
    prepare_json(o.json);
    const KernelChoice choice = choose_kernel(o.device, scene);
    const DevicePick &pick = choice.pick;
    const BuildOptions &build = choice.build; // clang captures no structured binding before version 16
    const FlatScene flat = flatten(scene, build.lanes);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene.cl_dir);
    BuildOptions fresh = build;
    fresh.cache_salt = fmt::format("{}", std::chrono::system_clock::now().time_since_epoch().count());
    RunningProgress progress("bench");
    RenderBench bench(device, flat, build, sources, o.seconds, o.rounds);
    const double cold = bench.compile_seconds(fresh), warm = bench.compile_seconds(fresh);

    const BenchSubject subject{scene, flat, pick, build.lanes};
    info(subject.device_text());
    const RenderFigures figures{bench.spp(), bench.rates(), bench.counts(), cold, warm};
    print_text(figures.text());
    nlohmann::json report = subject.json();
    report.update(figures.json());
    std::vector<int> widths = {1, 4, 8, 16};
    if (pick.info.type == "gpu") // renders with 1 lane only, and its compiler takes minutes for more
        std::erase_if(widths, [&](int lanes) { return lanes > pick.info.native_lanes; });
    const size_t races = 3 + widths.size();
    size_t done = 0;
    const auto race = [&](const std::string &name, const FlatScene &variant, const BuildOptions &kernel) {
        const RaceFigures row{name, bench.race(variant, kernel)};
        print_text(row.text());
        progress.update(double(++done), double(races));
        return row;
    };
    const auto race_twice = [&](const char *stage) {
        BuildOptions twice = build;
        twice.repeat_stage = stage;
        const RaceFigures row = race(fmt::format("{} twice", stage), flat, twice);
        report["twice"][stage] = row.json();
        return row.race;
    };
    TimeShares shares;
    shares.traversal = share_of(race_twice("traversal"));
    shares.sampling = share_of(race_twice("sampling"));
    print_text(shares.text());
    report["share"] = shares.json();
    for (int lanes : widths) {
        BuildOptions other = build;
        other.lanes = lanes;
        report["widths"][std::to_string(lanes)] =
            race(fmt::format("{} lane{}", lanes, lanes == 1 ? "" : "s"), flatten(scene, lanes), other).json();
    }
    SceneDescription anything = scene;
    anything.strategy.specialise = Specialise::off;
    report["general"] = race("general kernel", flatten(anything, build.lanes), build).json();
    write_json(o.json, "bench render", report);
    return 0;
}

Command renders_command() {
    auto o = std::make_shared<RenderBenchOptions>();
    return {.name = "render",
            .help = "Render the scene: paths and rays a second, where time goes, other widths, the general kernel",
            .options = append(
                scene_rows(o->scene),
                {device_row(o->device),
                 threads_row(o->device),
                 {.flags = "--seconds",
                  .target = &o->seconds,
                  .help = "Of each render, about",
                  .check = Range{0.001, 100.0}},
                 {.flags = "--rounds",
                  .target = &o->rounds,
                  .help = "Times that each is rendered, in turn with the kernel that `opal render` takes; the median "
                          "is told",
                  .check = Range{1, 1000}},
                 json_row(o->json, "the figures")}),
            .examples = {"opal bench render scenes/mixed_room.xml",
                         "opal bench render scenes/mixed_room.xml --seconds 2 --rounds 9"},
            .run = [o] { return run_renders(*o); }};
}

} // namespace

Command bench_command() {
    return {.name = "bench",
            .help = "Measure the speed of a scene: its rays alone, or the whole render",
            .subcommands = {rays_command(), renders_command()}};
}

} // namespace opal
