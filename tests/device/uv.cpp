// Texture coordinates of surfaces and the derivatives of their points, as Mitsuba 3.9.1 has them. The figures were
// measured with that renderer.
#include "read/mitsuba/meshes.h"
#include "selftest/brute_force.h"
#include "support/plain_scenes.h"
#include "support/probe.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace opal;
using namespace opal::test;

namespace {

// Where a ray meets a surface.
struct Met {
    Vec3 o, d; // of the ray
    std::array<double, 2> uv;
    Vec3 dpdu, dpdv;
};

// Sphere, rectangle and cube as they are. Mitsuba's tables for other to_world, mirroring ones too, are these with rays
// and derivatives transformed; flip_normals leaves all figures as they are.
const std::vector<Met> on_sphere = {{{3, 0, 0}, {-1, 0, 0}, {0, 0.5}, {0, 6.283185, 0}, {0, 0, -3.141593}},
                                    {{0, 3, 0}, {0, -1, 0}, {0.25, 0.5}, {-6.283185, 0, 0}, {0, 0, -3.141593}},
                                    {{-3, 0, 0}, {1, 0, 0}, {0.5, 0.5}, {0, -6.283185, 0}, {0, 0, -3.141593}},
                                    {{0, -3, 0}, {0, 1, 0}, {0.75, 0.5}, {6.283185, 0, 0}, {0, 0, -3.141593}},
                                    {{0, 0, 3}, {0, 0, -1}, {0, 1.897275e-08}, {0, 0, 0}, {3.141593, 0, 0}},
                                    {{0, 0, -3}, {0, 0, 1}, {0, 1}, {0, 0, 0}, {3.141593, 0, 0}},
                                    {{1.8, 1.44, 1.92},
                                     {-0.6, -0.48, -0.64},
                                     {0.1073883, 0.2789343},
                                     {-3.015929, 3.76991, 0},
                                     {1.57003, 1.256024, -2.413921}},
                                    {{-1.8, 1.92, -1.44},
                                     {0.6, -0.64, 0.48},
                                     {0.3698677, 0.6593634},
                                     {-4.021238, -3.76991, 0},
                                     {1.031359, -1.100116, -2.75602}}};
const std::vector<Met> on_rectangle = {{{-0.9, -0.9, 5}, {0, 0, -1}, {0.05, 0.05}, {2, 0, 0}, {0, 2, 0}},
                                       {{0.9, -0.9, 5}, {0, 0, -1}, {0.95, 0.05}, {2, 0, 0}, {0, 2, 0}},
                                       {{0.9, 0.9, 5}, {0, 0, -1}, {0.95, 0.95}, {2, 0, 0}, {0, 2, 0}},
                                       {{-0.9, 0.9, 5}, {0, 0, -1}, {0.05, 0.95}, {2, 0, 0}, {0, 2, 0}},
                                       {{0.2, -0.4, 5}, {0, 0, -1}, {0.6, 0.3}, {2, 0, 0}, {0, 2, 0}}};
const std::vector<Met> on_cube = {{{5, 0.25, -0.75}, {-1, 0, 0}, {0.625, 0.875}, {0, 2, 0}, {0, 0, -2}},
                                  {{-5, 0.25, -0.75}, {1, 0, 0}, {0.625, 0.125}, {0, 2, 0}, {0, 0, 2}},
                                  {{0.5, 5, -0.75}, {0, -1, 0}, {0.25, 0.875}, {-2, 0, 0}, {0, 0, -2}},
                                  {{0.5, -5, -0.75}, {0, 1, 0}, {0.125, 0.75}, {0, 0, 2}, {2, 0, 0}},
                                  {{0.5, 0.25, 5}, {0, 0, -1}, {0.625, 0.75}, {0, 2, 0}, {2, 0, 0}},
                                  {{0.5, 0.25, -5}, {0, 0, 1}, {0.375, 0.75}, {0, -2, 0}, {2, 0, 0}}};

std::vector<Met> moved(std::vector<Met> rows, const Transform &by) {
    for (Met &row : rows)
        row = {by.point(row.o), by.vector(row.d), row.uv, by.vector(row.dpdu), by.vector(row.dpdv)};
    return rows;
}

// A mesh whose material has a texture.
Mesh textured(Shape shape) {
    Mesh mesh = diffuse(std::move(shape));
    mesh.bsdf.textures[bsdf_parameters(BSDF_diffuse)[0].texture_word] = CheckerboardTexture{};
    return mesh;
}

// What the rays of the rows meet on the device, in world units, at each width and precision.
template <class Check> void for_each_kernel(const Shape &shape, const std::vector<Met> &rows, Check check) {
    for (int lanes : tested_lanes())
        for (const MathMode math : {MathMode::precise, MathMode::double_precision}) {
            if (math == MathMode::double_precision && !device().info.fp64)
                continue;
            FlatScene scene = flatten(scene_of({textured(shape)}), lanes);
            scene.features.list[FEATURE_tangents].on = true;
            std::vector<HostRay> rays;
            for (const Met &row : rows)
                rays.push_back({(row.o - scene.center) * scene.scale, row.d * scene.scale, 0, 1e30});
            BuildOptions build;
            build.lanes = lanes;
            build.math = math;
            KernelProbe probe(device(), scene, build);
            const Planes found = probe.trace(planes_of_rays(rays));
            for (size_t i = 0; i < rows.size(); i++) {
                INFO("ray " << i << at_width(lanes) << ", math " << int(math));
                const Met met = {rows[i].o,
                                 rows[i].d,
                                 {found.at(HIT_UV_U, i), found.at(HIT_UV_V, i)},
                                 found.vec3(HIT_DPDU_X, i) * (1 / scene.scale),
                                 found.vec3(HIT_DPDV_X, i) * (1 / scene.scale)};
                check(met, rows[i], math == MathMode::double_precision);
            }
        }
}

void check_rows(const Shape &shape, const std::vector<Met> &rows) {
    for_each_kernel(shape, rows, [](const Met &met, const Met &row, bool in_double) {
        constexpr double ulp = 1.2e-7;               // of a float, relative
        const double most = in_double ? 2e-6 : 1e-5; // the figures have seven digits
        for (int i = 0; i < 2; i++)
            CHECK(std::abs(met.uv[i] - row.uv[i]) < most + ulp * row.uv[i]);
        CHECK(length(met.dpdu - row.dpdu) < most * std::max(1.0, length(row.dpdu)));
        CHECK(length(met.dpdv - row.dpdv) < most * std::max(1.0, length(row.dpdv)));
    });
}

const Transform turned = Transform::rotate({1, 2, 2}, 50);

} // namespace

TEST_CASE("Texture coordinates of spheres", "[uv]") {
    check_rows(Sphere{}, on_sphere);
    check_rows(Sphere{{}, 1, true}, on_sphere);
    for (const Transform &by : {Transform::scale({-1, 1, 1}), Transform::scale({-1, -1, -1}),
                                Transform::translate({40, 2, -9}) * turned * Transform::scale({3, 3, 3})})
        check_rows(Sphere{}.moved(by), moved(on_sphere, by));
}

TEST_CASE("Texture coordinates of rectangles and cubes", "[uv]") {
    for (const Transform &by : {Transform(), Transform::scale({1, 2, 3}), Transform::scale({-1, 1, 1}),
                                Transform::scale({-1, -1, -1}), turned})
        for (const bool flipped : {false, true}) {
            check_rows(mitsuba::rectangle(by, flipped), moved(on_rectangle, by));
            check_rows(mitsuba::cube(by, flipped), moved(on_cube, by));
        }
}

TEST_CASE("Texture coordinates of triangles", "[uv]") {
    const Vec3 down{0, 0, -1}, above{0.5, 0.25, 5};
    const auto triangle = [](std::vector<std::array<float, 2>> uvs) {
        TriangleMesh mesh = mesh_of({{0, 0, 0}, {2, 0, 0.5}, {0, 1, 0.2}}, {{0, 1, 2}});
        mesh.uvs.assign(uvs.begin(), uvs.end());
        if (!uvs.empty())
            mesh.uv_corners = {{0, 1, 2}};
        return mesh;
    };
    const Vec3 across_s{0.970964, -0.0232288, 0.238095}, across_t{-0.0232288, 0.981417, 0.190476};
    check_rows(triangle({}), {{above, down, {0.25, 0.25}, {2, 0, 0.5}, {0, 1, 0.2}}}); // the weights of corners 1 and 2
    check_rows(triangle({{0, 0}, {0, 1}, {1, 0}}), {{above, down, {0.25, 0.25}, {0, 1, 0.2}, {2, 0, 0.5}}});
    check_rows(triangle({{0, 0}, {1, 1}, {0.5, 0.5}}), {{above, down, {0.375, 0.375}, across_s, across_t}});
    check_rows(triangle({{0, 0}, {1e-25f, 0}, {0, 1e-25f}}), {{above, down, {0, 0}, across_s, across_t}});
    check_rows(triangle({{1e6f, 0}, {1e6f, 1}, {1e6f + 1, 0}}),
               {{above, down, {1e6 + 0.25, 0.25}, {0, 1, 0.2}, {2, 0, 0.5}}});
}

TEST_CASE("Near its seam and its poles a sphere keeps its texture coordinates in their range", "[uv]") {
    std::vector<Met> rows;
    for (const double x : {-1.0, 1.0})
        for (const double y : {1e-9, -1e-9, 1e-6, -1e-6, 1e-4, -1e-4})
            for (const double z : {0.0, -3e-4})
                for (const bool polar : {false, true}) {
                    const Vec3 p = normalize(polar ? Vec3{y, z, x} : Vec3{x, y, z});
                    const double u = std::atan2(p.y, p.x) / (2 * 3.14159265358979),
                                 v = std::acos(p.z) / 3.14159265358979;
                    rows.push_back({p * 3, p * -1, {u < 0 ? u + 1 : u, v}, {}, {}});
                }
    for_each_kernel(Sphere{}, rows, [](const Met &met, const Met &row, bool) {
        INFO("at " << row.o.x << " " << row.o.y << " " << row.o.z);
        const double apart = std::abs(met.uv[0] - row.uv[0]), sine = std::hypot(row.o.x, row.o.y) / 3;
        CHECK(std::min(apart, 1 - apart) * sine < 1e-6); // at the pole itself u is anything
        CHECK(std::abs(met.uv[1] - row.uv[1]) < 1e-6);
        CHECK((met.uv[0] >= 0 && met.uv[0] < 1));
    });
}
