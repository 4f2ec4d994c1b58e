// Replays the rays that `opal bench rays` dumped through Embree 3, and compares the hits.
//
//   embree_rays TRIANGLES RAYS closest|any [--hits OUT] [--compare HITS] [--runs 7] [--threads N] [--robust]
//
// TRIANGLES: uint32 count, then 9 float32 a triangle. RAYS: 8 float32 a ray: ox oy oz tmin dx dy dz tmax. HITS: float32
// t, u, v and int32 triangle a ray, -1 for none; for `any` only the triangle counts, 0 or -1. All little-endian. Prints
// one JSON object: mrays_per_second is the median of the runs, each over all rays on all cores, mrays_per_cpu_second by
// the process's time on them (what other processes take does not count); `different` counts, against HITS, rays that
// one hits and the other misses, points that are apart, and other triangles at the same point (a shared edge). Points
// are apart that differ by more than 1e-4 of their distance and by more than single precision can tell of coordinates
// of the scene's size, 2e-6 of it.
#include <embree3/rtcore.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include <pmmintrin.h>
#include <xmmintrin.h>

namespace {

struct Ray {
    float ox, oy, oz, tmin, dx, dy, dz, tmax;
};
struct Hit {
    float t, u, v;
    int32_t triangle;
};
struct Triangle {
    float corners[9];
};
static_assert(sizeof(Ray) == 32 && sizeof(Hit) == 16 && sizeof(Triangle) == 36);

struct Options {
    std::string triangles, rays, hits, compare;
    bool any = false, robust = false;
    int runs = 7;
    unsigned threads = std::max(1u, std::thread::hardware_concurrency());
};

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The rest of a file as records, after `skip` bytes.
template <typename T> std::vector<T> read_records(const std::string &path, size_t skip = 0) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file)
        throw std::runtime_error("cannot read '" + path + "'");
    const size_t size = size_t(file.tellg());
    if (size < skip || (size - skip) % sizeof(T) != 0)
        throw std::runtime_error("'" + path + "': " + std::to_string(size) + " bytes are not whole records of " +
                                 std::to_string(sizeof(T)));
    std::vector<T> records((size - skip) / sizeof(T));
    file.seekg(std::streamoff(skip));
    file.read(reinterpret_cast<char *>(records.data()), std::streamsize(size - skip));
    return records;
}

std::vector<Triangle> read_triangles(const std::string &path) {
    auto triangles = read_records<Triangle>(path, sizeof(uint32_t));
    uint32_t count = 0;
    std::ifstream(path, std::ios::binary).read(reinterpret_cast<char *>(&count), sizeof count);
    if (count != triangles.size())
        throw std::runtime_error("'" + path + "' announces " + std::to_string(count) + " triangles and holds " +
                                 std::to_string(triangles.size()));
    return triangles;
}

RTCScene build_scene(RTCDevice device, const std::vector<Triangle> &triangles, bool robust) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcSetSceneFlags(scene, robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    RTCGeometry mesh = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetGeometryBuildQuality(mesh, RTC_BUILD_QUALITY_HIGH);
    const size_t corners = 3 * triangles.size();
    void *points = rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, corners);
    std::memcpy(points, triangles.data(), triangles.size() * sizeof(Triangle));
    auto *indices = static_cast<uint32_t *>(
        rtcSetNewGeometryBuffer(mesh, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, triangles.size()));
    for (size_t i = 0; i < corners; ++i)
        indices[i] = uint32_t(i);
    rtcCommitGeometry(mesh);
    rtcAttachGeometry(scene, mesh);
    rtcReleaseGeometry(mesh);
    rtcCommitScene(scene);
    return scene;
}

RTCRay embree_ray(const Ray &r) {
    RTCRay ray{};
    ray.org_x = r.ox, ray.org_y = r.oy, ray.org_z = r.oz, ray.tnear = r.tmin;
    ray.dir_x = r.dx, ray.dir_y = r.dy, ray.dir_z = r.dz, ray.tfar = r.tmax;
    ray.mask = 0xffffffffu;
    return ray;
}

Hit closest_hit(RTCScene scene, RTCIntersectContext *context, const Ray &r) {
    RTCRayHit query{embree_ray(r), {}};
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(scene, context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID)
        return {0, 0, 0, -1};
    return {query.ray.tfar, query.hit.u, query.hit.v, int32_t(query.hit.primID)};
}

Hit any_hit(RTCScene scene, RTCIntersectContext *context, const Ray &r) {
    RTCRay ray = embree_ray(r);
    rtcOccluded1(scene, context, &ray);
    return {0, 0, 0, ray.tfar < 0 ? 0 : -1}; // an occluded ray comes back with tfar = -inf
}

// Runs body(first, last) over [0, count) in chunks that the threads take as they get free.
template <typename Body> void parallel_chunks(size_t count, unsigned threads, Body body) {
    constexpr size_t chunk = 4096;
    std::atomic<size_t> next{0};
    auto work = [&] {
        _MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON); // as Embree's manual asks of the threads that trace
        _MM_SET_DENORMALS_ZERO_MODE(_MM_DENORMALS_ZERO_ON);
        for (size_t first; (first = next.fetch_add(chunk)) < count;)
            body(first, std::min(first + chunk, count));
    };
    std::vector<std::thread> pool;
    for (unsigned i = 0; i < threads; ++i)
        pool.emplace_back(work);
    for (std::thread &t : pool)
        t.join();
}

template <bool any>
double trace_all(RTCScene scene, const std::vector<Ray> &rays, std::vector<Hit> &hits, unsigned threads) {
    const auto start = std::chrono::steady_clock::now();
    parallel_chunks(rays.size(), threads, [&](size_t first, size_t last) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        for (size_t i = first; i < last; ++i)
            hits[i] = any ? any_hit(scene, &context, rays[i]) : closest_hit(scene, &context, rays[i]);
    });
    return seconds_since(start);
}

struct Differences {
    size_t hit_or_miss = 0, distance = 0, triangle = 0;
};

// The largest coordinate of all triangles.
float size_of(const std::vector<Triangle> &triangles) {
    float size = 0;
    for (const Triangle &t : triangles)
        for (float x : t.corners)
            size = std::max(size, std::abs(x));
    return size;
}

Differences differences(const std::vector<Hit> &ours, const std::vector<Hit> &given, const std::vector<Ray> &rays,
                        float size, bool any) {
    if (ours.size() != given.size())
        throw std::runtime_error("the hits to compare are " + std::to_string(given.size()) + ", the rays " +
                                 std::to_string(ours.size()));
    Differences found;
    for (size_t i = 0; i < ours.size(); ++i) {
        const Hit &a = ours[i], &b = given[i];
        if ((a.triangle < 0) != (b.triangle < 0))
            ++found.hit_or_miss;
        else if (a.triangle < 0 || any)
            continue;
        else if (!(std::abs(a.t - b.t) <= std::max(1e-4f * std::max(std::abs(a.t), std::abs(b.t)),
                                                   2e-6f * size / std::hypot(rays[i].dx, rays[i].dy, rays[i].dz))))
            ++found.distance;
        else if (a.triangle != b.triangle)
            ++found.triangle;
    }
    return found;
}

Options parse(int argc, char **argv) {
    std::vector<std::string> args(argv + 1, argv + argc), files;
    Options o;
    for (size_t i = 0; i < args.size(); ++i) {
        auto value = [&] {
            if (++i == args.size())
                throw std::runtime_error(args[i - 1] + " needs a value");
            return args[i];
        };
        if (args[i] == "--hits")
            o.hits = value();
        else if (args[i] == "--compare")
            o.compare = value();
        else if (args[i] == "--runs")
            o.runs = std::max(1, std::stoi(value()));
        else if (args[i] == "--threads")
            o.threads = unsigned(std::max(1, std::stoi(value())));
        else if (args[i] == "--robust")
            o.robust = true;
        else
            files.push_back(args[i]);
    }
    if (files.size() != 3 || (files[2] != "closest" && files[2] != "any"))
        throw std::runtime_error("usage: embree_rays TRIANGLES RAYS closest|any [--hits OUT] [--compare HITS] [--runs "
                                 "7] [--threads N] [--robust]");
    o.triangles = files[0], o.rays = files[1], o.any = files[2] == "any";
    return o;
}

void replay(const Options &o) {
    const auto triangles = read_triangles(o.triangles);
    const auto rays = read_records<Ray>(o.rays);
    RTCDevice device = rtcNewDevice(nullptr);
    const auto start = std::chrono::steady_clock::now();
    RTCScene scene = build_scene(device, triangles, o.robust);
    const double build = seconds_since(start);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE)
        throw std::runtime_error("Embree could not build the scene");

    std::vector<Hit> hits(rays.size());
    auto trace = o.any ? trace_all<true> : trace_all<false>;
    trace(scene, rays, hits, o.threads); // warm
    std::vector<double> rates, cpu_rates;
    for (int i = 0; i < o.runs; ++i) {
        const std::clock_t before = std::clock();
        rates.push_back(double(rays.size()) / trace(scene, rays, hits, o.threads) * 1e-6);
        cpu_rates.push_back(double(rays.size()) / (double(std::clock() - before) / CLOCKS_PER_SEC) * 1e-6);
    }
    std::sort(rates.begin(), rates.end());
    std::sort(cpu_rates.begin(), cpu_rates.end());
    std::printf("{\"mrays_per_second\": %.6g, \"least\": %.6g, \"greatest\": %.6g, \"mrays_per_cpu_second\": %.6g, "
                "\"rays\": %zu, "
                "\"triangles\": %zu, "
                "\"build_seconds\": %.6g",
                rates[rates.size() / 2], rates.front(), rates.back(), cpu_rates[cpu_rates.size() / 2], rays.size(),
                triangles.size(), build);
    if (!o.compare.empty()) {
        const Differences d = differences(hits, read_records<Hit>(o.compare), rays, size_of(triangles), o.any);
        std::printf(", \"different\": {\"hit_or_miss\": %zu, \"distance\": %zu, \"triangle\": %zu}", d.hit_or_miss,
                    d.distance, d.triangle);
    }
    std::printf("}\n");
    if (!o.hits.empty()) {
        std::ofstream out(o.hits, std::ios::binary);
        if (!out.write(reinterpret_cast<const char *>(hits.data()), std::streamsize(hits.size() * sizeof(Hit))).flush())
            throw std::runtime_error("cannot write '" + o.hits + "'");
    }
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
}

} // namespace

int main(int argc, char **argv) {
    try {
        replay(parse(argc, argv));
    } catch (const std::exception &e) {
        std::fprintf(stderr, "embree_rays: %s\n", e.what());
        return 1;
    }
}
