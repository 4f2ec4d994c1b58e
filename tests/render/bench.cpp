// `opal bench`: it prints all figures, and its dumped hits are those of its dumped rays and triangles.
#include "base/exit_code.h"
#include "base/json.h"
#include "bench/report.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <cstring>

using namespace opal::test;

namespace {

using nlohmann::json;
using Point = std::array<double, 3>;

struct Ray {
    float o[3], tmin, d[3], tmax;
};
struct Hit {
    float t, u, v;
    int triangle;
};
struct Triangle {
    float corner[3][3];
};

Outcome bench(const std::string &arguments) {
    return run_shell(std::string(OPAL_BINARY) + " bench " + arguments + " --device " + wanted_device());
}

template <class T> std::vector<T> records(const std::filesystem::path &file, size_t skip = 0) {
    const std::string bytes = read_text(file);
    REQUIRE(bytes.size() >= skip);
    REQUIRE((bytes.size() - skip) % sizeof(T) == 0);
    std::vector<T> rows((bytes.size() - skip) / sizeof(T));
    std::memcpy(rows.data(), bytes.data() + skip, bytes.size() - skip);
    return rows;
}

struct Dump {
    std::vector<Ray> rays;
    std::vector<Hit> hits;
    std::vector<Triangle> triangles;
    json stats;
};

Dump dump_of(const std::string &scene, const std::string &kind, const std::string &more = "") {
    const ScratchFolder folder;
    const auto file = [&](const char *name) { return (folder / name).string(); };
    const Outcome outcome =
        bench("rays " + scene + " --kind " + kind + " --rays 4000 --runs 2 --json " + file("json") + " --dump-rays " +
              file("rays") + " --dump-hits " + file("hits") + " --dump-triangles " + file("triangles") + more);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    Dump dump{records<Ray>(file("rays")), records<Hit>(file("hits")), records<Triangle>(file("triangles"), 4),
              json::parse(read_text(file("json")))};
    CHECK(records<uint32_t>(file("triangles"))[0] == dump.triangles.size());
    CHECK(dump.hits.size() == dump.rays.size());
    CHECK(dump.stats["rays"] == dump.rays.size());
    CHECK(dump.stats["triangles"] == dump.triangles.size());
    return dump;
}

Point minus(const float (&a)[3], const float (&b)[3]) {
    return {double(a[0]) - b[0], double(a[1]) - b[1], double(a[2]) - b[2]};
}
Point cross(Point a, Point b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double dot(Point a, Point b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

// Where a ray meets a triangle's plane, and the smallest barycentric weight there (Moeller and Trumbore 1997, in
// double).
struct Meeting {
    double t, u, v, inside;
};
Meeting meet(const Ray &ray, const Triangle &p) {
    const Point e1 = minus(p.corner[1], p.corner[0]), e2 = minus(p.corner[2], p.corner[0]),
                s = minus(ray.o, p.corner[0]);
    const Point d{ray.d[0], ray.d[1], ray.d[2]}, h = cross(d, e2), q = cross(s, e1);
    const double determinant = dot(e1, h), u = dot(s, h) / determinant, v = dot(d, q) / determinant;
    return {dot(e2, q) / determinant, u, v, std::min({u, v, 1 - u - v})};
}

// How many rays have an answer that no rounding explains. Single precision resolves about 2e-6 of coordinates up to 1,
// and 1e-4 of a weight.
size_t wrong_hits(const Dump &dump, bool any) {
    size_t wrong = 0;
    for (size_t i = 0; i < dump.rays.size(); i++) {
        const Ray &ray = dump.rays[i];
        const Hit &hit = dump.hits[i];
        const double length = std::sqrt(dot({ray.d[0], ray.d[1], ray.d[2]}, {ray.d[0], ray.d[1], ray.d[2]}));
        double sure = INFINITY;
        bool possible = false;
        for (const Triangle &triangle : dump.triangles) {
            const Meeting m = meet(ray, triangle);
            const double slack = 1e-4 * std::abs(m.t) + 2e-6 / length;
            if (m.inside > 1e-4 && m.t > ray.tmin + slack && m.t < ray.tmax - slack)
                sure = std::min(sure, m.t + slack);
            possible = possible || (m.inside > -1e-4 && m.t > ray.tmin - slack && m.t < ray.tmax + slack);
        }
        if (hit.triangle < 0) {
            wrong += hit.triangle != -1 || std::isfinite(sure);
        } else if (any) {
            wrong += hit.triangle != 0 || !possible;
        } else {
            const Meeting m = meet(ray, dump.triangles.at(size_t(hit.triangle)));
            const double slack = 1e-4 * std::abs(m.t) + 2e-6 / length;
            wrong += std::abs(m.t - hit.t) > slack || m.inside < -1e-4 || hit.t > sure ||
                     std::abs(m.u - hit.u) > 1e-3 || std::abs(m.v - hit.v) > 1e-3;
        }
    }
    return wrong;
}

const std::string scenes = OPAL_SOURCE_DIR "/scenes/";

} // namespace

TEST_CASE("Dumped hits are those of the dumped rays and triangles, listed and in the tree", "[bench][alone]") {
    for (const std::string &scene : {scenes + "cbox_mis.xml", scenes + "mesh_light.xml"})
        for (const std::string kind : {"camera", "bounce", "shadow"}) {
            Dump dump = dump_of(scene, kind);
            INFO(scene << " " << kind);
            CHECK(dump.rays.size() > 1000);
            CHECK(wrong_hits(dump, kind == "shadow") == 0);
            // A control of this check: it finds an answer that was moved to another ray.
            std::rotate(dump.hits.begin(), dump.hits.begin() + 1, dump.hits.end());
            CHECK(wrong_hits(dump, kind == "shadow") > dump.rays.size() / 50);
        }
}

TEST_CASE("Widths answer the same rays alike", "[bench][alone]") {
    const Dump one = dump_of(scenes + "mesh_light.xml", "bounce", " --lanes 1"),
               eight = dump_of(scenes + "mesh_light.xml", "bounce", " --lanes 8");
    CHECK(wrong_hits(one, false) == 0);
    REQUIRE(one.rays.size() == eight.rays.size());
    size_t different = 0;
    for (size_t i = 0; i < one.hits.size(); i++)
        different += one.hits[i].triangle != eight.hits[i].triangle;
    CHECK(different < one.hits.size() / 1000);
}

TEST_CASE("Camera rays leave one point, bounces have no end, shadow rays end at the light", "[bench][alone]") {
    const Dump camera = dump_of(scenes + "cbox_mis.xml", "camera"), bounce = dump_of(scenes + "cbox_mis.xml", "bounce"),
               shadow = dump_of(scenes + "cbox_mis.xml", "shadow");
    for (const Ray &ray : camera.rays)
        CHECK(std::memcmp(ray.o, camera.rays[0].o, sizeof ray.o) == 0);
    for (const Ray &ray : bounce.rays)
        CHECK((ray.tmin == 0 && ray.tmax >= 1e30f));
    for (const Ray &ray : shadow.rays)
        CHECK((ray.tmin == 0 && ray.tmax == 1));
    const double blocked = shadow.stats["hit_share"], met = bounce.stats["hit_share"];
    CHECK((blocked > 0.01 && blocked < 0.6));
    CHECK(met > 0.5);
}

TEST_CASE("Figures of all kinds, and of one", "[bench][alone]") {
    const ScratchFolder folder;
    const std::string file = (folder / "stats.json").string();
    const Outcome outcome = bench("rays " + scenes + "mesh_light.xml --rays 4000 --runs 3 --json " + file);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json all = json::parse(read_text(file));
    for (const char *key : {"scene", "device", "driver", "lanes", "triangles", "nodes", "blocks", "hierarchy_bytes",
                            "bytes_per_triangle", "sah_cost", "build_seconds", "compile_seconds"})
        CHECK(all.contains(key));
    CHECK(!all.contains("mrays_per_second"));
    for (const char *kind : {"camera", "bounce", "shadow"}) {
        const json &row = all["kinds"][kind];
        INFO(row.dump());
        CHECK((row["least"] > 0.0 && row["least"] <= row["mrays_per_second"] &&
               row["mrays_per_second"] <= row["greatest"]));
        CHECK(row["mrays_per_cpu_second"] > 0.0);
        CHECK((row["node_tests_per_ray"] >= 1.0 && row["node_tests_per_ray"] < 100.0));
        CHECK((row["triangle_tests_per_ray"] > 0.0 && row["triangle_tests_per_ray"] < double(all["triangles"])));
        CHECK_THAT(outcome.out, Catch::Contains(kind));
    }
    const json one = dump_of(scenes + "cbox_mis.xml", "shadow").stats;
    CHECK((one["kind"] == "shadow" && one["mrays_per_second"] > 0.0 && one["node_tests_per_ray"] == 0.0));
}

TEST_CASE("Degenerate triangles are in no dump; without a light shadow rays go anywhere", "[bench][alone]") {
    const ScratchFolder folder;
    folder.write("two.obj", "v -1 -1 5\nv 1 -1 5\nv 0 1 5\nv 0 0 4\nf 1 2 3\nf 1 2 2\nf 1 4 3\n");
    const std::string scene =
        folder
            .write("two.xml", "<scene><integrator type=\"normals\"/><camera type=\"perspective\"/><mesh type=\"obj\">"
                              "<string name=\"filename\" value=\"two.obj\"/></mesh></scene>")
            .string();
    const Dump dump = dump_of(scene, "camera");
    CHECK(dump.triangles.size() == 2);
    CHECK(wrong_hits(dump, false) == 0);
    CHECK(dump_of(scene, "shadow").rays.size() > 10);
}

TEST_CASE("What makes no sense is refused, and nothing is written", "[bench][alone]") {
    const ScratchFolder folder;
    const std::string scene = scenes + "cbox_mis.xml", out = (folder / "out").string();
    for (const auto &[arguments, reason, code] :
         {std::tuple<std::string, std::string, int>{
              "rays " + scene + " --dump-rays " + out,
              "--dump-rays is of one kind of rays: name it with --kind; available: camera, bounce, shadow",
              opal::exit_usage},
          {"rays " + scene + " --dump-hits " + out, "--dump-hits", opal::exit_usage},
          {"rays " + scene + " --dump-triangles " + out, "--dump-triangles", opal::exit_usage},
          {"rays " + scene + " --kind camra --dump-rays " + out, "available: camera, bounce, shadow", opal::exit_usage},
          {"rays " + scene + " --kind camera --json " + out + "/no/where", "no/where", opal::exit_failed},
          {"rays " + scene + " --rays 0", "--rays", opal::exit_usage},
          {"rays " + out + ".xml", "out.xml", opal::exit_failed},
          {"ray " + scene, "did you mean 'rays'?", opal::exit_usage}}) {
        const Outcome outcome = bench(arguments);
        INFO(arguments << "\n" << outcome.err);
        CHECK(outcome.exit_code == code);
        CHECK_THAT(outcome.err, Catch::Contains("error: ") && Catch::Contains(reason));
        CHECK(std::filesystem::is_empty(folder.path()));
    }
    folder.write("away.obj", "v -1 -1 -5\nv 1 -1 -5\nv 0 1 -5\nf 1 2 3\n");
    const std::string away =
        folder
            .write("away.xml", "<scene><integrator type=\"normals\"/><camera type=\"perspective\"/><mesh type=\"obj\">"
                               "<string name=\"filename\" value=\"away.obj\"/></mesh></scene>")
            .string();
    CHECK_THAT(bench("rays " + away + " --kind bounce").err, Catch::Contains("no bounce rays"));
    const Outcome all = bench("rays " + away + " --runs 1 --rays 1000");
    CHECK(all.exit_code == 0);
    CHECK_THAT(all.err, Catch::Contains("warning: ") && Catch::Contains("no shadow rays"));
}

TEST_CASE("a share of the time has a range, or is below what can be told", "[bench][alone]") {
    // Done twice, sampling took 0.9 to 1.02 times the time: the machine's noise is larger than its share.
    const opal::Race traversal{{}, {1.5, 1.4, 1.7}, 0}, sampling{{}, {0.9048, 0.9, 1.02}, 0};
    const opal::TimeShares shares{share_of(traversal), share_of(sampling)};
    CHECK(shares.text() == "share of time               traversal 50 % [40, 70], random numbers below what can be told "
                           "(at most 2 %), shading and all else 50 % [28, 60]\n");
    CHECK(shares.json()["sampling"]["median"] == 0.0);
}

TEST_CASE("bench render times the kernel and its variants", "[bench][alone]") {
    const ScratchFolder folder;
    const std::string file = (folder / "json").string();
    const Outcome outcome = bench("render " + scenes + "cbox_mis.xml --seconds 0.01 --rounds 2 --json " + file);
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    const json stats = json::parse(read_text(file));
    CHECK(stats["paths_per_second"]["least"] > 0.0);
    // A path of the Cornell box has a camera ray, and more rays unless that one meets the lamp or nothing.
    CHECK((stats["rays_per_path"] > 1.5 && stats["rays_per_path"] < 6.0));
    CHECK((stats["shadow_rays_per_path"] > 0.5 && stats["shadow_rays_per_path"] < stats["rays_per_path"]));
    CHECK((stats["lanes_busy"] > 0.5 && stats["lanes_busy"] <= 1.0));
    CHECK(stats["compile_seconds"]["cold"] > 2 * stats["compile_seconds"]["warm"].get<double>());
    CHECK(stats["share"]["traversal"]["median"] > 0.1);
    for (const char *stage : {"traversal", "sampling", "shading"})
        for (const char *figure : {"median", "least", "greatest"})
            CHECK((stats["share"][stage][figure] >= 0.0 && stats["share"][stage][figure] <= 1.0));
    for (const char *lanes : {"1", "4", "8", "16"})
        CHECK(stats["widths"][lanes]["time"]["median"] > 0.0);
    CHECK(stats["general"]["time"]["median"] > 1.0);
}

TEST_CASE("bench_growth measures each size, and names and leaves out the peers that are missing", "[bench][alone]") {
    const ScratchFolder folder;
    const std::string script = "CXX=false " OPAL_SOURCE_DIR "/scripts/bench_growth --opal " OPAL_BINARY;
    const std::string json = (folder / "growth.json").string();
    const Outcome outcome = run_shell(script + " --parts meshes --meshes 4,9 --rounds 1 --python false --json " + json);
    INFO(outcome.out << outcome.err);
    REQUIRE(outcome.exit_code == 0);
    CHECK_THAT(outcome.out, Catch::Contains("without Mitsuba: ") && Catch::Contains("without Embree: "));
    const nlohmann::json said = nlohmann::json::parse(read_text(json));
    CHECK(said["missing"].size() == 2);
    REQUIRE(said["parts"]["meshes"].size() == 2);
    for (const auto &row : said["parts"]["meshes"])
        CHECK((row["Opal"]["cpu"] > 0 && row["Opal"]["peak_mb"] > 1 && !row.contains("Mitsuba")));
    const Outcome refused = run_shell(script + " --parts meshes,tress");
    CHECK(refused.exit_code == 2);
    CHECK_THAT(refused.err, Catch::Contains("--parts: no tress; available: triangles, meshes"));
}
