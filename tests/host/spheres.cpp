// Spheres: how they are read, refused and flattened.
#include "flatten/geometry.h"
#include "flatten/scene_warnings.h"
#include "read/nori/load.h"
#include "support/error_of.h"
#include "support/plain_scenes.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

using namespace opal;
using namespace opal::test;

namespace {

std::string sphere_of(const std::string &body) {
    return "<scene><camera type='perspective'/>\n<mesh type='sphere'>\n" + body + "</mesh></scene>";
}

Mesh read(const std::string &body) {
    const ScratchFolder folder;
    return load_scene(folder.write("a.xml", sphere_of(body))).meshes.at(0);
}
Sphere read_sphere(const std::string &body) { return std::get<Sphere>(read(body).shape); }

std::string refused(const std::string &body) {
    return error_of([&] { read(body); });
}

std::string moved_by(const std::string &operations) {
    return "<transform name='toWorld'>" + operations + "</transform>\n";
}

} // namespace

TEST_CASE("a sphere is read with its place, size and side", "[spheres]") {
    const Sphere plain = read_sphere("");
    CHECK(length(plain.center) == 0);
    CHECK(plain.radius == 1);
    CHECK(!plain.inward);

    const std::string own = "<point name='center' value='1 2 3'/><float name='radius' value='0.5'/>";
    const Sphere moved = read_sphere(
        own + moved_by("<scale value='2 2 2'/><rotate axis='0 0 1' angle='90'/><translate value='10 0 0'/>"));
    CHECK(length(moved.center - Vec3{6, 2, 6}) < 1e-12); // toWorld comes after centre and radius
    CHECK(moved.radius == Approx(1));
    CHECK(!moved.inward);

    CHECK(read_sphere(moved_by("<scale value='-1 1 1'/>")).inward);
    CHECK(read_sphere(moved_by("<scale value='-1 -1 -1'/>")).inward);
    CHECK(!read_sphere(moved_by("<scale value='-1 -1 1'/>")).inward);
    CHECK(read_sphere(moved_by("<scale value='3 3 -3'/>")).radius == Approx(3));
    // A matrix in few digits.
    CHECK(!read_sphere(moved_by("<matrix value='0.70711 -0.70711 0 0 0.70711 0.70711 0 0 0 0 1 0 0 0 0 1'/>")).inward);
}

TEST_CASE("what makes no sphere is refused with its place", "[spheres]") {
    for (const char *radius : {"0", "-1", "1e-60"})
        CHECK_THAT(refused(fmt::format("<float name='radius' value='{}'/>\n", radius)),
                   Catch::Contains("a.xml:3:1: 'radius'"));
    CHECK_THAT(refused("<float name='radius' value='nan'/>\n"), Catch::Contains("a.xml:3:"));
    CHECK_THAT(refused(moved_by("<scale value='1 2 3'/>")),
               Catch::Contains("a.xml:3:1: 'toWorld' scales a sphere by 1, 2 and 3"));
    CHECK_THAT(refused(moved_by("<matrix value='1 0.5 0 0 0 1 0 0 0 0 1 0 0 0 0 1'/>")), Catch::Contains("'toWorld'"));
    CHECK_THAT(refused(moved_by("<matrix value='0.8 0.6 0 0 0.6 0.8 0 0 0 0 1 0 0 0 0 1'/>")),
               Catch::Contains("shears a sphere"));
    CHECK_THAT(refused(moved_by("<scale value='1 1 0'/>")), Catch::Contains("'toWorld' is singular"));
    CHECK_THAT(refused(moved_by("<scale value='0 0 0'/>")), Catch::Contains("'toWorld' is singular"));
    CHECK_THAT(refused(moved_by("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 0.5 1'/>")), Catch::Contains("'toWorld'"));
    CHECK_THAT(refused("<float name='raduis' value='1'/>\n"), Catch::Contains("did you mean 'radius'"));
}

TEST_CASE("the tree's boxes hold the spheres of the blocks", "[spheres]") {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    SceneDescription description;
    for (int i = 0; i < 500; i++)
        description.meshes.push_back(diffuse(Sphere{
            {uniform(random), uniform(random), uniform(random)}, std::pow(10, 4 * uniform(random) - 4), i % 2 == 0}));
    const FlatScene scene = flatten(description, 8);
    size_t found = 0;
    for (const BvhNode &node : scene.nodes)
        for (int child = 0; child < OPAL_WIDTH; child++) {
            const uint leaf = node.child[child];
            if (leaf == OPAL_NONE || !(leaf & OPAL_LEAF))
                continue;
            REQUIRE((leaf >> OPAL_SHAPE_SHIFT & OPAL_SHAPE_BITS) == SHAPE_sphere);
            const SphereBlock &block = scene.sphere_blocks.at(leaf & OPAL_BLOCK_BITS);
            for (int place = 0; place < OPAL_WIDTH && block.id[place] != OPAL_NONE; place++) {
                found++;
                CHECK(block.inward[place] == (block.mesh[place] % 2 == 0));
                for (int axis = 0; axis < 3; axis++) {
                    CHECK(double(block.center[axis][place]) - block.radius[place] >= node.lo[axis][child]);
                    CHECK(double(block.center[axis][place]) + block.radius[place] <= node.hi[axis][child]);
                }
            }
        }
    CHECK(found == 500);
}

TEST_CASE("a sphere that emits: the sphere of its block, and its power", "[spheres]") {
    Mesh lamp = light(Sphere{{1.1, 2.3, 3.7}, 0.3, true}, {3, 2, 1});
    lamp.emits_on_both_sides = true;
    SceneDescription description = scene_of({diffuse(Sphere{{0, 0, 0}, 8}), lamp, light(one_triangle, {1, 1, 1}),
                                             light(Sphere{{0, 5, 0}, 0.1}, {0, 0, 0})});
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    const FlatScene scene = flatten(description, 8);
    REQUIRE(scene.emitters.size() == 2); // none is black
    CHECK(scene.meshes[1].emitter == 0);
    CHECK(scene.meshes[3].emitter == OPAL_NONE);
    const EmitterRecord &emitter = scene.emitters[0];
    CHECK(emitter.kind == EMITTER_sphere);
    CHECK(emitter.two_sided == 1);
    const emitter_sphere_record &own = emitter.u.of_sphere;
    size_t found = 0;
    for (const SphereBlock &block : scene.sphere_blocks)
        for (int place = 0; place < OPAL_WIDTH; place++)
            if (block.id[place] != OPAL_NONE && block.mesh[place] == 1) {
                found++;
                for (int axis = 0; axis < 3; axis++)
                    CHECK(own.center[axis] == block.center[axis][place]);
                CHECK(own.radius == block.radius[place]);
                CHECK(own.inward == block.inward[place]);
            }
    CHECK(found == 1);
    const double lit = luminance(Color{3, 2, 1}) * 2 * 4 * std::numbers::pi * 0.09, other = 0.5;
    CHECK(emitter.probability == Approx(lit / (lit + other)).epsilon(1e-5));
}

TEST_CASE("spheres that single precision loses are dropped, lamps too", "[spheres]") {
    SceneDescription description =
        scene_of({diffuse(Sphere{{0, 0, 0}, 1}), light(Sphere{{1, 0, 0}, 1e-21}, {1, 1, 1})});
    const FlatScene scene = flatten(description, 8);
    CHECK(scene.sphere_blocks.size() == 1);
    CHECK(scene.emitters.empty());
}

TEST_CASE("spheres beside coinciding faces and in scenes of one light", "[spheres]") {
    const SceneDescription description =
        scene_of({diffuse(Sphere{{0, 0, 0}, 1}), diffuse(one_triangle), light(Sphere{{3, 0, 0}, 1, true}, {1, 1, 1}),
                  diffuse(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 2, 1}}))});
    const std::vector<std::string> lines = scene_warnings(description);
    CHECK(std::count_if(lines.begin(), lines.end(),
                        [](const std::string &line) { return line.find("faces coincide") != std::string::npos; }) == 1);
}
