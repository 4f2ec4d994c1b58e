// opal bench: how fast a scene's rays and paths are on this device.
#include "base/json.h"
#include "base/log.h"
#include "base/table.h"
#include "bench/rays.h"
#include "bench/renders.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "image/image.h"

#include <fmt/format.h>

#include <bit>
#include <chrono>

namespace opal {

namespace {

using nlohmann::json;

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
    std::string device, kind, json, dump_rays, dump_hits, dump_triangles;
    unsigned rays = 1u << 20, seed = 0;
    int runs = 7;
};

json scene_json(const SceneDescription &scene, const FlatScene &flat, const DeviceInfo &device, int lanes) {
    const size_t bytes = flat.nodes.size() * sizeof(BvhNode) + flat.blocks.size() * sizeof(TriangleBlock);
    return {{"scene", scene.file.string()},
            {"device", device.name},
            {"driver", device.driver},
            {"lanes", lanes},
            {"math", name_of(scene.strategy.math)},
            {"triangles", flat.triangles.size()},
            {"listed_triangles", flat.face_list_triangles},
            {"nodes", flat.nodes.size()},
            {"blocks", flat.blocks.size()},
            {"hierarchy_bytes", bytes},
            {"bytes_per_triangle", flat.triangles.empty() ? 0 : double(bytes) / double(flat.triangles.size())},
            {"sah_cost", flat.sah_cost},
            {"build_seconds", flat.bvh_seconds},
            {"center", {flat.center.x, flat.center.y, flat.center.z}},
            {"scale", flat.scale},
            {"version", OPAL_VERSION}};
}

json times_json(const RaySet &set, const RayTimes &times) {
    const Spread &rate = times.mrays_per_second;
    return {{"rays", set.rays.size()},
            {"mrays_per_second", rate.median},
            {"least", rate.least},
            {"greatest", rate.greatest},
            {"mrays_per_cpu_second", times.mrays_per_cpu_second.median},
            {"hit_share", times.hit_share},
            {"node_tests_per_ray", times.node_tests},
            {"triangle_tests_per_ray", times.triangle_tests}};
}

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
            throw Error(fmt::format("{} is of one kind of rays: name it with --kind; available: {}", flag,
                                    joined(names_of(ray_kinds()))));
    if (!o.kind.empty())
        find_row(ray_kinds(), "kind of rays", o.kind);
    for (const std::string *file : {&o.json, &o.dump_rays, &o.dump_hits, &o.dump_triangles})
        if (!file->empty())
            check_writable(*file);
}

// The device that renders the scene, and the kernel's width and math there.
struct Place {
    DevicePick pick;
    BuildOptions build;
};

Place place_of(const std::string &device, const SceneDescription &scene) {
    Place place{pick_device(device, list_devices()), {}};
    place.build.lanes = lanes_for(place.pick.info, scene.strategy.lanes, scene.strategy.math);
    place.build.math = scene.strategy.math;
    return place;
}

int run_rays(const RayOptions &o) {
    check_ray_options(o);
    SceneDescription scene = load_scene(o.scene);
    scene.strategy[AXIS_integrator] =
        CHOICE_integrator_path; // whatever the image estimates: shadow rays go to the lights
    scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_independent;
    const auto [pick, build] = place_of(o.device, scene);
    const FlatScene flat = flatten(scene, build.lanes);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene);
    RayBench bench(device, flat, build, sources);

    json report = scene_json(scene, flat, pick.info, build.lanes);
    info(fmt::format("scene   {}: {} triangles, {} of them listed beside the tree", scene.file.string(),
                     flat.triangles.size(), flat.face_list_triangles));
    info(fmt::format("device  {} (driver {}; {}), {} lanes", pick.info.name, pick.info.driver, pick.reason,
                     build.lanes));
    info(fmt::format("tree    {} nodes, {} blocks, {} ({:.1f} bytes a triangle), SAH cost {:.4g}, built in {:.3g} s",
                     flat.nodes.size(), flat.blocks.size(), bytes_text(report["hierarchy_bytes"].get<size_t>()),
                     report["bytes_per_triangle"].get<double>(), flat.sah_cost, flat.bvh_seconds));
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
        const RayTimes times = bench.time(set, o.runs);
        const json row = times_json(set, times);
        report["kinds"][name] = row;
        if (!o.kind.empty()) {
            report.update(row);
            report["kind"] = name;
            write_dumps(o, flat, set, times);
        }
        const Spread &rate = times.mrays_per_second;
        print("{:<8}{:.4g} [{:.4g}, {:.4g}] Mrays/s, {:.4g} a CPU-second, {} rays, {:.3g} % hit, {:.4g} nodes and "
              "{:.4g} triangles tested a ray\n",
              name, rate.median, rate.least, rate.greatest, times.mrays_per_cpu_second.median, set.rays.size(),
              100 * times.hit_share, times.node_tests, times.triangle_tests);
    }
    report["compile_seconds"] = bench.compile_seconds();
    if (!o.json.empty())
        write_safely(o.json, dump(report, 2) + "\n");
    return 0;
}

RunCommand setup_rays(CLI::App &app) {
    auto o = std::make_shared<RayOptions>();
    add_scene_options(app, o->scene);
    add_device_option(app, o->device);
    std::string kinds = "Which rays [all]";
    for (const RayKind &kind : ray_kinds())
        kinds += fmt::format("\n  {}: {}", kind.name, kind.help);
    app.add_option("--kind", o->kind, kinds)->type_name("KIND");
    app.add_option("--rays", o->rays, "Rays of a kind that are tried, about; those that start nowhere are left out")
        ->check(CLI::Range(1u, 1u << 26))
        ->capture_default_str();
    app.add_option("--runs", o->runs, "Times that all rays are traced; the median is told")
        ->check(CLI::Range(1, 10000))
        ->capture_default_str();
    app.add_option("--seed", o->seed, "Of the rays")->capture_default_str();
    app.add_option("--json", o->json,
                   "File for the figures; mrays_per_second is there for one --kind, and in `kinds` for each")
        ->type_name("FILE");
    app.add_option("--dump-rays", o->dump_rays,
                   "With --kind: the rays, little-endian float32 ox oy oz tmin dx dy dz tmax each, in the units of "
                   "--dump-triangles")
        ->type_name("FILE");
    app.add_option("--dump-hits", o->dump_hits,
                   "With --kind: the answers, float32 t u v and int32 triangle each, -1 for none\n"
                   "  shadow rays: triangle is 0 (blocked) or -1, t u v are 0")
        ->type_name("FILE");
    app.add_option(
           "--dump-triangles", o->dump_triangles,
           "With --kind: uint32 count, then 9 float32 a triangle, in the order of the hits' indices; parallelograms\n"
           "  are two triangles each, degenerate triangles are dropped; flattened = (world - center) * scale of the "
           "JSON")
        ->type_name("FILE");
    return [o] { return run_rays(*o); };
}

struct RenderBenchOptions {
    SceneOptions scene;
    std::string device, json;
    double seconds = 0.5;
    int rounds = 5;
};

json spread_json(const Spread &s) { return {{"median", s.median}, {"least", s.least}, {"greatest", s.greatest}}; }

std::string spread_text(const Spread &s, double unit = 1) {
    return fmt::format("{:.4g} [{:.4g}, {:.4g}]", s.median / unit, s.least / unit, s.greatest / unit);
}

// A variant beside the base: a line of text and of JSON.
json told(const std::string &name, const Race &race) {
    print("{:<28}{} M paths/s a CPU-second, {} times the time, compiled in {:.3g} s\n", name,
          spread_text(race.rates.paths_per_cpu_second, 1e6), spread_text(race.time), race.compile_seconds);
    return {{"paths_per_second", spread_json(race.rates.paths_per_second)},
            {"paths_per_cpu_second", spread_json(race.rates.paths_per_cpu_second)},
            {"time", spread_json(race.time)},
            {"compile_seconds", race.compile_seconds}};
}

int run_renders(const RenderBenchOptions &o) {
    if (!o.json.empty())
        check_writable(o.json);
    const SceneDescription scene = load_scene(o.scene);
    const auto [pick, build] = place_of(o.device, scene);
    const FlatScene flat = flatten(scene, build.lanes);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene);
    BuildOptions fresh = build;
    fresh.note = fmt::format("{}", std::chrono::system_clock::now().time_since_epoch().count());
    RenderBench bench(device, flat, build, sources, o.seconds, o.rounds);
    const double cold = bench.compile_seconds(fresh), warm = bench.compile_seconds(fresh);

    info(fmt::format("device  {} (driver {}; {}), {} lanes", pick.info.name, pick.info.driver, pick.reason,
                     build.lanes));
    const PathRates rates = bench.rates();
    const PathCounts counts = bench.counts();
    const double rays = counts.rays + counts.shadow_rays;
    print("{:<28}{} M/s, {} M a CPU-second ({} spp a run)\n", "paths", spread_text(rates.paths_per_second, 1e6),
          spread_text(rates.paths_per_cpu_second, 1e6), bench.spp());
    print("{:<28}{:.4g} M/s: {:.3g} rays and {:.3g} shadow rays a path\n", "rays",
          rays * rates.paths_per_second.median / 1e6, counts.rays, counts.shadow_rays);
    print("{:<28}{:.3g} % on average\n{:<28}{:.3g} s cold, {:.3g} s warm\n", "lanes busy", 100 * counts.lanes_busy,
          "compilation", cold, warm);

    json report = scene_json(scene, flat, pick.info, build.lanes);
    report.update({{"spp", bench.spp()},
                   {"paths_per_second", spread_json(rates.paths_per_second)},
                   {"paths_per_cpu_second", spread_json(rates.paths_per_cpu_second)},
                   {"rays_per_path", counts.rays},
                   {"shadow_rays_per_path", counts.shadow_rays},
                   {"rays_per_second", rays * rates.paths_per_second.median},
                   {"lanes_busy", counts.lanes_busy},
                   {"compile_seconds", {{"cold", cold}, {"warm", warm}}}});
    double shading = 1;
    for (const char *stage : {"traversal", "sampling"}) {
        BuildOptions twice = build;
        twice.twice = stage;
        report["twice"][stage] = told(fmt::format("{} twice", stage), bench.race(flat, twice));
        const double share = report["twice"][stage]["time"]["median"].get<double>() - 1;
        report["share"][stage] = share;
        shading -= share;
    }
    report["share"]["shading"] = shading;
    print("{:<28}{:.3g} % traversal, {:.3g} % random numbers, {:.3g} % shading and all else\n", "share of time",
          100 * report["share"]["traversal"].get<double>(), 100 * report["share"]["sampling"].get<double>(),
          100 * shading);
    for (int lanes : {1, 4, 8, 16}) {
        if (pick.info.type == "gpu" && lanes > pick.info.native_lanes)
            continue; // minutes of compilation for widths that a GPU never renders with
        BuildOptions other = build;
        other.lanes = lanes;
        report["widths"][std::to_string(lanes)] =
            told(fmt::format("{} lanes", lanes), bench.race(flatten(scene, lanes), other));
    }
    SceneDescription anything = scene;
    anything.strategy.specialise = false;
    report["general"] = told("general kernel", bench.race(flatten(anything, build.lanes), build));
    if (!o.json.empty())
        write_safely(o.json, dump(report, 2) + "\n");
    return 0;
}

RunCommand setup_renders(CLI::App &app) {
    auto o = std::make_shared<RenderBenchOptions>();
    add_scene_options(app, o->scene);
    add_device_option(app, o->device);
    app.add_option("--seconds", o->seconds, "Of each render, about")
        ->check(CLI::Range(0.001, 100.0))
        ->capture_default_str();
    app.add_option("--rounds", o->rounds,
                   "Times that each is rendered, in turn with the kernel that `opal render` takes; the median is told")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--json", o->json, "File for the figures")->type_name("FILE");
    return [o] { return run_renders(*o); };
}

} // namespace

RunCommand setup_bench(CLI::App &app) {
    app.require_subcommand(1);
    auto runs = std::make_shared<std::map<const CLI::App *, RunCommand>>();
    CLI::App *rays = app.add_subcommand("rays", "Trace camera, bounce and shadow rays of a scene, and nothing else");
    (*runs)[rays] = setup_rays(*rays);
    CLI::App *renders = app.add_subcommand(
        "render", "Render the scene: paths and rays a second, where time goes, other widths, the general kernel");
    (*runs)[renders] = setup_renders(*renders);
    return [&app, runs] { return runs->at(app.get_subcommands().front())(); };
}

} // namespace opal
