// flatten of wild scenes that are made from bytes: coordinates at the ends of single precision, copies, needles, grids,
// parallelograms and lights.
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/oracles.h"

#include "flatten/precision_warnings.h"
#include "flatten/scene_warnings.h"
#include "strategies/check.h"

#include <fuzzer/FuzzedDataProvider.h>

#include <limits>

namespace opal::fuzz {

namespace {

// As parse_number gives them: finite in single precision.
double coordinate(FuzzedDataProvider &bytes) {
    static constexpr double nasty[] = {0,        -0.,      1,           -1,          0.5,     1e-7,   -1e-7, 1e-20,
                                       1e-38,    1.4e-45,  3.4e38,      1e38,        -1e38,   1e19,   -1e19, 1.844e19,
                                       16777216, 16777217, 1 + 0x1p-23, 1 - 0x1p-24, 1e6,     1e-6,   2,     3,
                                       1e30,     1e-30,    -1e-30,      1e-12,       1.0 / 3, -3.4e38};
    switch (bytes.ConsumeIntegral<uint8_t>() % 4) {
    case 0:
        return bytes.PickValueInArray(nasty);
    case 1:
        return bytes.ConsumeIntegral<int8_t>();
    case 2:
        return bytes.ConsumeIntegral<int16_t>() / 256.0;
    default:
        const double number = std::ldexp(bytes.ConsumeIntegral<int8_t>(), bytes.ConsumeIntegral<int8_t>());
        constexpr double most = std::numeric_limits<float>::max();
        return std::clamp(number, -most, most);
    }
}

Vec3 point(FuzzedDataProvider &bytes) {
    const double x = coordinate(bytes), y = coordinate(bytes);
    return {x, y, coordinate(bytes)};
}

Color color(FuzzedDataProvider &bytes) {
    const Vec3 p = point(bytes);
    return {std::abs(p.x), std::abs(p.y), std::abs(p.z)};
}

// Triangles between some points: the corners are drawn by a generator, all the same, or fans around an edge.
TriangleMesh triangles(FuzzedDataProvider &bytes) {
    TriangleMesh mesh;
    enum { free_corners, copies, needles, grid, kinds };
    const int kind = bytes.ConsumeIntegralInRange(0, kinds - 1);
    const unsigned points = bytes.ConsumeIntegralInRange(3u, 24u);
    const Vec3 origin = point(bytes), u = point(bytes), v = point(bytes);
    for (unsigned i = 0; i < points; i++)
        mesh.positions.push_back(kind == grid ? origin + u * double(i % 5) + v * double(i / 5) : point(bytes));
    const Vec3 normal = point(bytes);
    if (length(normal) > 0 && bytes.ConsumeBool())
        mesh.normals.push_back(normalize(normal));
    const unsigned most = bytes.ConsumeProbability<float>() < 0.1f ? 400 : 40;
    const unsigned count = bytes.ConsumeIntegralInRange(1u, most);
    unsigned state = bytes.ConsumeIntegral<uint16_t>();
    const auto draw = [&] {
        state = state * 1664525u + 1013904223u;
        return (state >> 8) % points;
    };
    for (unsigned i = 0; i < count; i++) {
        std::array<TriangleMesh::Corner, 3> corners{};
        for (unsigned k = 0; k < 3; k++) {
            corners[k].position = kind == copies || (kind == needles && k < 2) ? k : draw();
            corners[k].normal = mesh.normals.empty() ? OPAL_NONE : 0;
        }
        mesh.triangles.push_back(corners);
    }
    for (Vec3 &p : mesh.positions) // a grid's may have left the range
        for (double *x : {&p.x, &p.y, &p.z})
            *x = std::clamp<double>(*x, std::numeric_limits<float>::lowest(), std::numeric_limits<float>::max());
    return mesh;
}

void add_object(FuzzedDataProvider &bytes, SceneDescription &scene) {
    Mesh mesh;
    if (bytes.ConsumeBool())
        mesh.radiance = color(bytes);
    mesh.emits_on_both_sides = bytes.ConsumeBool();
    switch (bytes.ConsumeIntegralInRange(0, 9)) {
    case 0:
        scene.lights.push_back({emitter_point{.position = point(bytes), .power = color(bytes)}, {}});
        return;
    case 1:
        scene.lights.push_back({emitter_constant{.radiance = color(bytes)}, {}});
        return;
    case 8:
    case 9: {
        const Vec3 direction = point(bytes), position = point(bytes);
        if (!(length(direction) > 0)) // the reader refuses it
            return;
        if (bytes.ConsumeBool()) {
            scene.lights.push_back({emitter_directional{direction, color(bytes)}, {}});
            return;
        }
        const double cutoff = bytes.ConsumeFloatingPointInRange(0., 180.),
                     beam = bytes.ConsumeFloatingPointInRange(0., 180.);
        const Color intensity = color(bytes);
        scene.lights.push_back({emitter_spot{position, direction, intensity, cutoff, beam, bytes.ConsumeBool()}, {}});
        return;
    }
    case 2: {
        const Parallelogram shape{point(bytes), point(bytes), point(bytes)};
        if (!(length(cross(shape.u, shape.v)) > 1e-12 * length(shape.u) * length(shape.v))) // the reader refuses it
            return;
        mesh.shape = shape;
        break;
    }
    default:
        mesh.shape = triangles(bytes);
    }
    scene.meshes.push_back(std::move(mesh));
}

} // namespace

void try_input(std::string_view input) {
    FuzzedDataProvider bytes(reinterpret_cast<const uint8_t *>(input.data()), input.size());
    SceneDescription scene;
    for (int axis = 0; axis < AXIS_COUNT; axis++)
        if (bytes.ConsumeBool())
            scene.strategy.choices[size_t(axis)] =
                bytes.ConsumeIntegralInRange(0, int(axes()[size_t(axis)].choices.size()) - 1);
    const int lanes = bytes.ConsumeBool() ? 16 : 1;
    scene.camera.to_world.rows[0][3] = coordinate(bytes);
    while (bytes.remaining_bytes() > 0 && scene.meshes.size() + scene.lights.size() < 8)
        add_object(bytes, scene);
    try {
        const FlatScene flat = flatten(scene, lanes);
        check(flat);
        require(!precision_warnings(scene, flat).empty() || has_finite_lights(flat), "what is not finite is warned of");
        scene_warnings(scene);
        check_strategy(scene);
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz
