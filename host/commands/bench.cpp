// opal bench: how fast a scene's rays and paths are on this device.
#include "bench/rays.h"
#include "base/log.h"
#include "base/table.h"
#include "commands/commands.h"
#include "commands/options.h"
#include "image/image.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <bit>

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
            {"listed_triangles", flat.tiny_triangles.size()},
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

void dump(const RayOptions &o, const FlatScene &flat, const RaySet &set, const RayTimes &times) {
    static_assert(std::endian::native == std::endian::little && sizeof(RayHit) == 16);
    if (!o.dump_rays.empty())
        write_safely(o.dump_rays, bytes_of(set.rays));
    if (!o.dump_hits.empty())
        write_safely(o.dump_hits, bytes_of(times.hits));
    if (!o.dump_triangles.empty()) {
        const std::vector<std::array<float, 9>> triangles = triangles_of(flat);
        write_safely(o.dump_triangles, bytes_of(std::vector<uint32_t>{uint32_t(triangles.size())}) + bytes_of(triangles));
    }
}

void check_ray_options(const RayOptions &o) {
    for (const auto &[flag, file] : {std::pair("--dump-rays", &o.dump_rays), {"--dump-hits", &o.dump_hits}, {"--dump-triangles", &o.dump_triangles}})
        if (!file->empty() && o.kind.empty())
            throw Error(fmt::format("{} is of one kind of rays: name it with --kind; available: {}", flag, joined(names_of(ray_kinds()))));
    if (!o.kind.empty())
        find_row(ray_kinds(), "kind of rays", o.kind);
    for (const std::string *file : {&o.json, &o.dump_rays, &o.dump_hits, &o.dump_triangles})
        if (!file->empty())
            check_writable(*file);
}

int run_rays(const RayOptions &o) {
    check_ray_options(o);
    SceneDescription scene = load_scene(o.scene);
    scene.strategy[AXIS_integrator] = CHOICE_integrator_path; // whatever the image estimates: shadow rays go to the lights
    scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_independent;
    const DevicePick pick = pick_device(o.device, list_devices());
    BuildOptions build;
    build.lanes = lanes_for(pick.info, scene.strategy.lanes, scene.strategy.math);
    build.math = scene.strategy.math;
    const FlatScene flat = flatten(scene, build.lanes);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene);
    RayBench bench(device, flat, build, sources);

    json report = scene_json(scene, flat, pick.info, build.lanes);
    info(fmt::format("scene   {}: {} triangles, {} of them listed beside the tree", scene.file.string(), flat.triangles.size(), flat.tiny_triangles.size()));
    info(fmt::format("device  {} (driver {}; {}), {} lanes", pick.info.name, pick.info.driver, pick.reason, build.lanes));
    info(fmt::format("tree    {} nodes, {} blocks, {} ({:.1f} bytes a triangle), SAH cost {:.4g}, built in {:.3g} s", flat.nodes.size(), flat.blocks.size(),
                     bytes_text(report["hierarchy_bytes"].get<size_t>()), report["bytes_per_triangle"].get<double>(), flat.sah_cost, flat.bvh_seconds));
    for (int kind = 0; kind < RAYS_KINDS; kind++) {
        const std::string &name = ray_kinds()[size_t(kind)].name;
        if (!o.kind.empty() && o.kind != name)
            continue;
        const RaySet set = bench.generate(kind, o.rays, o.seed);
        if (set.rays.empty()) {
            const std::string what = fmt::format("{}: no {} rays: the camera sees nothing that they could start from", scene.file.string(), name);
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
            dump(o, flat, set, times);
        }
        const Spread &rate = times.mrays_per_second;
        fmt::print("{:<8}{:.4g} [{:.4g}, {:.4g}] Mrays/s, {:.4g} a CPU-second, {} rays, {:.3g} % hit, {:.4g} nodes and {:.4g} triangles tested a ray\n",
                   name, rate.median, rate.least, rate.greatest, times.mrays_per_cpu_second.median, set.rays.size(), 100 * times.hit_share, times.node_tests, times.triangle_tests);
    }
    report["compile_seconds"] = bench.compile_seconds();
    if (!o.json.empty())
        write_safely(o.json, report.dump(2) + "\n");
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
    app.add_option("--rays", o->rays, "Rays of a kind that are tried, about; those that start nowhere are left out")->check(CLI::Range(1u, 1u << 26))->capture_default_str();
    app.add_option("--runs", o->runs, "Times that all rays are traced; the median is told")->check(CLI::Range(1, 10000))->capture_default_str();
    app.add_option("--seed", o->seed, "Of the rays")->capture_default_str();
    app.add_option("--json", o->json, "File for the figures; mrays_per_second is there for one --kind, and in `kinds` for each")->type_name("FILE");
    app.add_option("--dump-rays", o->dump_rays,
                   "With --kind: the rays, little-endian float32 ox oy oz tmin dx dy dz tmax each, in the units of --dump-triangles")
        ->type_name("FILE");
    app.add_option("--dump-hits", o->dump_hits,
                   "With --kind: the answers, float32 t u v and int32 triangle each, -1 for none\n"
                   "  shadow rays: triangle is 0 (blocked) or -1, t u v are 0")
        ->type_name("FILE");
    app.add_option("--dump-triangles", o->dump_triangles,
                   "With --kind: uint32 count, then 9 float32 a triangle, in the order of the hits' indices; parallelograms\n"
                   "  are two triangles each, degenerate triangles are dropped; flattened = (world - center) * scale of the JSON")
        ->type_name("FILE");
    return [o] { return run_rays(*o); };
}

} // namespace

RunCommand setup_bench(CLI::App &app) {
    app.require_subcommand(1);
    auto runs = std::make_shared<std::map<const CLI::App *, RunCommand>>();
    CLI::App *rays = app.add_subcommand("rays", "Trace camera, bounce and shadow rays of a scene, and nothing else");
    (*runs)[rays] = setup_rays(*rays);
    return [&app, runs] { return runs->at(app.get_subcommands().front())(); };
}

} // namespace opal
