// Spheres as Mitsuba 3.9.1 has them: where rays meet them, and what is sampled of one that emits. The figures were
// measured with that renderer.
#include "selftest/brute_force.h"
#include "support/plain_scenes.h"
#include "support/probe.h"

#include <catch2/catch.hpp>

using namespace opal;
using namespace opal::test;

namespace {

struct Met {
    Vec3 o, d, n; // of the ray; of the sphere. It is met at t = 2
};

void check_hits(const Sphere &sphere, const std::vector<Met> &rows) {
    std::vector<HostRay> rays;
    for (const Met &row : rows)
        rays.push_back({row.o, row.d, 0, 1e30});
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(flatten(scene_of({diffuse(sphere)}), lanes), lanes, Sources::embedded());
        REQUIRE(probe.scene().scale == 1);
        const Planes found = probe.trace(planes_of_rays(rays));
        for (size_t i = 0; i < rows.size(); i++) {
            INFO("ray " << i << at_width(lanes));
            CHECK(found.at(HIT_T, i) == Approx(2));
            CHECK(length(found.vec3(HIT_NORMAL_X, i) - rows[i].n) < 1e-6);
            CHECK(length(found.vec3(HIT_P_X, i) - (rows[i].o + rows[i].d * 2)) < 1e-6);
        }
    }
}

Sphere unit() { return {{0, 0, 0}, 1}; }

} // namespace

TEST_CASE("Spheres: Mitsuba's rays, with flip_normals and mirrored too", "[spheres]") {
    const std::vector<Met> outward = {{{3, 0, 0}, {-1, 0, 0}, {1, 0, 0}},
                                      {{0, 3, 0}, {0, -1, 0}, {0, 1, 0}},
                                      {{-3, 0, 0}, {1, 0, 0}, {-1, 0, 0}},
                                      {{0, -3, 0}, {0, 1, 0}, {0, -1, 0}},
                                      {{0, 0, 3}, {0, 0, -1}, {0, 0, 1}},
                                      {{0, 0, -3}, {0, 0, 1}, {0, 0, -1}},
                                      {{1.8, 1.44, 1.92}, {-0.6, -0.48, -0.64}, {0.6, 0.48, 0.64}},
                                      {{-1.8, 1.92, -1.44}, {0.6, -0.64, 0.48}, {-0.6, 0.64, -0.48}}};
    check_hits(unit(), outward);
    std::vector<Met> inward = outward, mirrored = outward, negative = outward;
    for (Met &row : inward)
        row.n = row.n * -1;
    for (Met &row : mirrored)
        row = {{-row.o.x, row.o.y, row.o.z}, {-row.d.x, row.d.y, row.d.z}, {row.n.x, -row.n.y, -row.n.z}};
    for (Met &row : negative)
        row = {row.o * -1, row.d * -1, row.n};
    check_hits({{0, 0, 0}, 1, true}, inward);
    check_hits(unit().moved(Transform::scale({-1, 1, 1})), mirrored);
    check_hits(unit().moved(Transform::scale({-1, -1, -1})), negative);
}

TEST_CASE("Sphere lights: Mitsuba's directions, distances and densities from outside", "[spheres]") {
    struct Drawn {
        double from; // on the z axis
        Vec3 d;
        double distance, pdf;
        Vec3 n;
    };
    const std::vector<Drawn> rows = {
        {2, {-0.3598433, 0, -0.9330128}, 1.171726, 1.187948, {-0.421638, 0, 0.9067643}},
        {2, {0.3851256, 0.2798101, -0.8794228}, 1.453006, 1.187948, {0.5595897, 0.4065657, 0.7221937}},
        {5, {-0.1417816, 0, -0.989898}, 4.244189, 7.877348, {-0.6017478, 0, 0.7986861}},
        {5, {0.1535786, 0.1115814, -0.9818164}, 4.59431, 7.877348, {0.7055876, 0.5126394, 0.4892311}},
        {1.01, {-0.8215474, 0, -0.5701401}, 0.01772552, 0.1851437, {-0.01456235, 0, 0.999894}},
        {1.01, {0.7880229, 0.5725321, -0.2263338}, 0.04927434, 0.1851437, {0.0388293, 0.02821114, 0.9988475}}};
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(flatten(scene_of({light(unit(), {1, 1, 1})}), lanes), lanes, Sources::embedded());
        std::vector<HostRay> rays;
        std::vector<Vec3> from;
        for (const Drawn &row : rows) {
            from.push_back({0, 0, row.from});
            rays.push_back({from.back(), row.d, 0, 1e30});
        }
        const Planes met = probe.trace(planes_of_rays(rays));
        const Planes drawn = probe.light_sample(from, probe.numbers(rows.size(), {}));
        for (size_t i = 0; i < rows.size(); i++) {
            INFO("row " << i << at_width(lanes));
            CHECK(met.at(HIT_T, i) == Approx(rows[i].distance).epsilon(2e-5)); // d is given in 7 digits
            CHECK(met.at(HIT_LIGHT_DENSITY, i) == Approx(rows[i].pdf).epsilon(1e-5));
            CHECK(length(met.vec3(HIT_NORMAL_X, i) - rows[i].n) < 1e-5);
            CHECK(drawn.at(LIGHT_DENSITY, i) == Approx(rows[i].pdf).epsilon(1e-5));
            CHECK(drawn.at(LIGHT_ACTIVE, i) == 1);
        }
    }
}

TEST_CASE("Sphere lights: dark on the side that their normals do not point to", "[spheres]") {
    for (const bool inward : {false, true})
        for (const bool two_sided : {false, true}) {
            Mesh mesh = light(Sphere{{0, 0, 0}, 1, inward}, {1, 1, 1});
            mesh.emits_on_both_sides = two_sided;
            KernelProbe probe = probe_of(flatten(scene_of({mesh}), 1), 1, Sources::embedded());
            for (const double z : {0.0, 0.3, 0.999, 1.001, 2.0}) {
                INFO("inward " << inward << ", two-sided " << two_sided << ", from " << z);
                const Planes drawn = probe.light_sample(Vec3{0, 0, z}, probe.numbers(100, {}));
                std::vector<HostRay> rays;
                for (size_t i = 0; i < drawn.count; i++)
                    rays.push_back({{0, 0, z}, drawn.vec3(LIGHT_D_X, i), 0, 1e30});
                const Planes met = probe.trace(planes_of_rays(rays));
                const bool lit = two_sided || inward == (z < 1);
                for (size_t i = 0; i < drawn.count; i++) {
                    CHECK(drawn.at(LIGHT_ACTIVE, i) == lit);
                    CHECK((met.bits(HIT_EMITTER, i) != OPAL_NONE) == lit);
                    if (lit)
                        CHECK(drawn.at(LIGHT_DENSITY, i) == Approx(met.at(HIT_LIGHT_DENSITY, i)));
                }
            }
        }
}
