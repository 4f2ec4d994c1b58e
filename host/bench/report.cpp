#include "bench/report.h"

#include "base/json.h"
#include "base/units.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

nlohmann::json spread_json(const Spread &s) {
    return object({{"median", s.median}, {"least", s.least}, {"greatest", s.greatest}});
}

std::string spread_text(const Spread &s, double unit = 1) {
    return fmt::format("{:.4g} [{:.4g}, {:.4g}]", s.median / unit, s.least / unit, s.greatest / unit);
}

std::string share_text(const std::string &stage, const Spread &share) {
    if (share.least > 0)
        return fmt::format("{} {:.3g} % [{:.3g}, {:.3g}]", stage, 100 * share.median, 100 * share.least,
                           100 * share.greatest);
    return fmt::format("{} below what can be told (at most {:.3g} %)", stage, 100 * share.greatest);
}

} // namespace

double BenchSubject::bytes_a_triangle() const {
    return flat.triangles.empty() ? 0 : double(flat.tree_bytes()) / double(flat.triangles.size());
}

std::string BenchSubject::scene_text() const {
    return fmt::format("scene   {}: {} triangles, {} of them listed beside the tree", scene.file.string(),
                       flat.triangles.size(), flat.face_list_triangles);
}

std::string BenchSubject::device_text() const { return fmt::format("device  {}, {} lanes", text_of(device), lanes); }

std::string BenchSubject::tree_text() const {
    return fmt::format("tree    {} nodes, {} blocks, {} ({:.1f} bytes a triangle), SAH cost {:.4g}, built in {:.3g} s",
                       flat.nodes.size(), flat.triangle_blocks.size(), bytes_text(flat.tree_bytes()),
                       bytes_a_triangle(), flat.sah_cost, flat.bvh_seconds);
}

nlohmann::json BenchSubject::json() const {
    return object({{"scene", scene.file.string()},
                   {"scene_hash", scene.hash},
                   {"dialect", name_of(scene.dialect)},
                   {"definitions", scene.definitions},
                   {"device", device.info.name},
                   {"driver", device.info.driver},
                   {"lanes", lanes},
                   {"math", name_of(scene.strategy.math)},
                   {"triangles", flat.triangles.size()},
                   {"listed_triangles", flat.face_list_triangles},
                   {"nodes", flat.nodes.size()},
                   {"blocks", flat.triangle_blocks.size()},
                   {"hierarchy_bytes", flat.tree_bytes()},
                   {"bytes_per_triangle", bytes_a_triangle()},
                   {"sah_cost", flat.sah_cost},
                   {"build_seconds", flat.bvh_seconds},
                   {"center", {flat.center.x, flat.center.y, flat.center.z}},
                   {"scale", flat.scale},
                   {"version", OPAL_VERSION}});
}

std::string RayFigures::text() const {
    const Spread &rate = times.mrays_per_second;
    return fmt::format("{:<8}{:.4g} [{:.4g}, {:.4g}] Mrays/s, {:.4g} a CPU-second, {} rays, {:.3g} % hit, {:.4g} nodes "
                       "and {:.4g} triangles tested a ray\n",
                       kind, rate.median, rate.least, rate.greatest, times.mrays_per_cpu_second.median, rays,
                       100 * times.hit_share, times.node_tests, times.triangle_tests);
}

nlohmann::json RayFigures::json() const {
    const Spread &rate = times.mrays_per_second;
    return object({{"rays", rays},
                   {"mrays_per_second", rate.median},
                   {"least", rate.least},
                   {"greatest", rate.greatest},
                   {"mrays_per_cpu_second", times.mrays_per_cpu_second.median},
                   {"hit_share", times.hit_share},
                   {"node_tests_per_ray", times.node_tests},
                   {"triangle_tests_per_ray", times.triangle_tests}});
}

double RenderFigures::rays_per_second() const {
    return (counts.rays + counts.shadow_rays) * rates.paths_per_second.median;
}

std::string RenderFigures::text() const {
    return fmt::format("{:<28}{} M/s, {} M a CPU-second ({} spp a run)\n", "paths",
                       spread_text(rates.paths_per_second, 1e6), spread_text(rates.paths_per_cpu_second, 1e6), spp) +
           fmt::format("{:<28}{:.4g} M/s: {:.3g} rays and {:.3g} shadow rays a path\n", "rays", rays_per_second() / 1e6,
                       counts.rays, counts.shadow_rays) +
           fmt::format("{:<28}{:.3g} % on average\n{:<28}{:.3g} s cold, {:.3g} s warm\n", "lanes busy",
                       100 * counts.lanes_busy, "compilation", compile_cold, compile_warm);
}

nlohmann::json RenderFigures::json() const {
    return object({{"spp", spp},
                   {"paths_per_second", spread_json(rates.paths_per_second)},
                   {"paths_per_cpu_second", spread_json(rates.paths_per_cpu_second)},
                   {"rays_per_path", counts.rays},
                   {"shadow_rays_per_path", counts.shadow_rays},
                   {"rays_per_second", rays_per_second()},
                   {"lanes_busy", counts.lanes_busy},
                   {"compile_seconds", object({{"cold", compile_cold}, {"warm", compile_warm}})}});
}

std::string RaceFigures::text() const {
    return fmt::format("{:<28}{} M paths/s a CPU-second, {} times the time, compiled in {:.3g} s\n", name,
                       spread_text(race.rates.paths_per_cpu_second, 1e6), spread_text(race.time), race.compile_seconds);
}

nlohmann::json RaceFigures::json() const {
    return object({{"paths_per_second", spread_json(race.rates.paths_per_second)},
                   {"paths_per_cpu_second", spread_json(race.rates.paths_per_cpu_second)},
                   {"time", spread_json(race.time)},
                   {"compile_seconds", race.compile_seconds}});
}

Spread share_of(const Race &twice) {
    const auto share = [](double time) { return std::clamp(time - 1, 0.0, 1.0); };
    return {share(twice.time.median), share(twice.time.least), share(twice.time.greatest)};
}

Spread TimeShares::shading() const {
    const auto rest = [](double a, double b) { return std::max(1 - a - b, 0.0); };
    return {rest(traversal.median, sampling.median), rest(traversal.greatest, sampling.greatest),
            rest(traversal.least, sampling.least)};
}

std::string TimeShares::text() const {
    return fmt::format("{:<28}{}, {}, {}\n", "share of time", share_text("traversal", traversal),
                       share_text("random numbers", sampling), share_text("shading and all else", shading()));
}

nlohmann::json TimeShares::json() const {
    return object({{"traversal", spread_json(traversal)},
                   {"sampling", spread_json(sampling)},
                   {"shading", spread_json(shading())}});
}

} // namespace opal
