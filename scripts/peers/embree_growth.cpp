// Reads an OBJ file and builds Embree 3's tree of its triangles (robust, high build quality, shared vertices), as a
// renderer would: what that takes in time and memory, without any picture.
//
//   embree_growth MODEL.obj
//
// Prints one JSON object: triangles, and the CPU seconds of reading and of building. The peak of memory is the
// process's own. Of the file, `v` and `f` lines count; a face is cut into a fan.
#include <embree3/rtcore.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

constexpr size_t padding = 4; // floats that Embree may read past the last vertex

struct Mesh {
    std::vector<float> positions;
    std::vector<uint32_t> corners;
};

Mesh read_obj(const char *path) {
    std::ifstream file(path);
    if (!file)
        throw std::runtime_error(std::string("cannot read '") + path + "'");
    Mesh mesh;
    for (std::string line; std::getline(file, line);) {
        const char *at = line.c_str() + 1;
        char *end = nullptr;
        if (line.starts_with("v "))
            for (int i = 0; i < 3; i++, at = end)
                mesh.positions.push_back(std::strtof(at, &end));
        if (!line.starts_with("f "))
            continue;
        uint32_t first = 0, last = 0;
        for (int i = 0;; i++, at = end) {
            const uint32_t corner = uint32_t(std::strtoul(at, &end, 10)) - 1;
            if (end == at)
                break;
            while (*end == '/' || (*end >= '0' && *end <= '9')) // texture coordinates and normals
                end++;
            if (i == 0)
                first = corner;
            if (i > 1)
                mesh.corners.insert(mesh.corners.end(), {first, last, corner});
            last = corner;
        }
    }
    return mesh;
}

double cpu_seconds() { return double(std::clock()) / CLOCKS_PER_SEC; }

void build(RTCDevice device, Mesh &mesh) {
    const size_t vertices = mesh.positions.size() / 3;
    mesh.positions.resize(mesh.positions.size() + padding);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, mesh.positions.data(), 0,
                               3 * sizeof(float), vertices);
    rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, mesh.corners.data(), 0,
                               3 * sizeof(uint32_t), mesh.corners.size() / 3);
    rtcCommitGeometry(geometry);
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    rtcSetSceneBuildQuality(scene, RTC_BUILD_QUALITY_HIGH);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    rtcReleaseScene(scene);
}

} // namespace

int main(int count, char **arguments) {
    try {
        if (count != 2)
            throw std::runtime_error("usage: embree_growth MODEL.obj");
        Mesh mesh = read_obj(arguments[1]);
        const double read = cpu_seconds();
        RTCDevice device = rtcNewDevice(nullptr);
        build(device, mesh);
        if (const RTCError error = rtcGetDeviceError(device))
            throw std::runtime_error("Embree: error " + std::to_string(error));
        rtcReleaseDevice(device);
        std::printf("{\"triangles\": %zu, \"read\": %.4f, \"build\": %.4f, \"version\": \"%s\"}\n",
                    mesh.corners.size() / 3, read, cpu_seconds() - read, RTC_VERSION_STRING);
        return 0;
    } catch (const std::exception &error) {
        std::fprintf(stderr, "embree_growth: %s\n", error.what());
        return 1;
    }
}
