// From a scene as written to the tables of the device: positions, triangles, settings.
#include "base/log.h"
#include "flatten/geometry.h"
#include "read/nori/load.h"
#include "support/error_of.h"
#include "support/plain_scenes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>

using namespace opal;

TEST_CASE("the scene is moved and scaled into [-1, 1], by a power of two", "[flatten]") {
    for (double size : {1e-9, 0.3, 1.0, 2.0, 550.0, 1e12}) {
        const Vec3 corner{1e3 * size, -7 * size, 0};
        const Flattening flattening =
            find_flattening(extent_of(scene_of({diffuse(Parallelogram{corner, {size, 0, 0}, {0, size / 3, 0}})})));
        int exponent;
        CHECK(std::frexp(flattening.scale, &exponent) == 0.5);
        const double half = 0.5 * size * flattening.scale;
        CHECK(half > 0.5 - 1e-9);
        CHECK(half <= 1);
        CHECK(flattening.center.x == Approx(corner.x + size / 2).epsilon(1e-14));
    }
    // Half of the box is 1: the scale stays 1, and a position that is a float stays itself.
    const Flattening unit =
        find_flattening(extent_of(scene_of({diffuse(mesh_of({{-1, 0, 0}, {1, 0, 0}, {0, 1, 0.25}}, {{0, 1, 2}}))})));
    CHECK(unit.scale == 1);
    CHECK(unit({0.75, 0.5, 0.125}) == std::array<float, 3>{0.75f, 0, 0});
}

TEST_CASE("positions far from the world's origin keep their digits", "[flatten]") {
    const double far = 1e6, step = 1e-3; // in float, 1e6 + 1e-3 is 1e6
    const FlatScene scene =
        flatten(scene_of({diffuse(mesh_of({{far, 0, 0}, {far + step, 0, 0}, {far, step, 0}}, {{0, 1, 2}}))}), 8);
    REQUIRE(scene.triangles.size() == 1);
    const auto a = vertex(scene, 0, 0), b = vertex(scene, 0, 1);
    CHECK((double(b[0]) - a[0]) / scene.scale == Approx(step).epsilon(1e-6));
}

TEST_CASE("what no triangle uses does not stretch the scene; point lights do", "[flatten]") {
    TriangleMesh mesh = one_triangle;
    mesh.positions.push_back({1e9, 0, 0});
    SceneDescription scene = scene_of({diffuse(mesh)});
    CHECK(find_flattening(extent_of(scene)).scale == 2);
    scene.lights.push_back({emitter_constant{}, {}});
    CHECK(find_flattening(extent_of(scene)).scale == 2);
    scene.lights.push_back({emitter_point{{0, 0, 7}, {1, 1, 1}}, {}});
    CHECK(find_flattening(extent_of(scene)).scale == 0.25);
}

TEST_CASE("a scene of nothing", "[flatten]") {
    for (int lanes : {1, 8}) {
        const FlatScene scene = flatten(scene_of({}), lanes);
        CHECK(scene.scale == 1);
        CHECK(scene.triangles.empty());
        CHECK(scene.triangle_blocks.size() == 1);
        CHECK(scene.triangle_blocks[0].id[0] == OPAL_NONE);
        CHECK(scene.settings.emitter_count == 0);
        CHECK(scene.features[FEATURE_tree] == (lanes == 1));
    }
}

TEST_CASE("the camera's columns, film and clips", "[flatten]") {
    SceneDescription scene = scene_of({diffuse(Parallelogram{{-4, -4, 0}, {8, 0, 0}, {0, 8, 0}})}); // scale 1/4
    Camera &camera = scene.camera;
    camera.to_world.rows = {{{-2, 0, 0, 1}, {0, 4, 0, 2}, {0, 0, 2, 3}, {0, 0, 0, 1}}}; // mirrored, stretched, moved
    camera.width = 400;
    camera.height = 100;
    camera.perspective.fov = 90;
    camera.near_clip = 0.5;
    camera.far_clip = 1e300;
    const FlatScene flat = flatten(scene, 8);
    REQUIRE(flat.cameras.size() == 1);
    const CameraRecord &record = flat.cameras[0];
    CHECK((record.origin[0] == 0.25f && record.origin[1] == 0.5f && record.origin[2] == 0.75f));
    CHECK((record.left[0] == -1 && record.up[1] == 2 && record.forward[2] == 1));
    CHECK(record.own.perspective.tan_half_x == Approx(1));
    CHECK(record.own.perspective.tan_half_y == Approx(0.25));
    CHECK(record.near_clip == 0.5f * 2 / 4);
    CHECK(std::isfinite(record.far_clip));
    CHECK((flat.settings.width == 400 && flat.settings.height == 100));

    // The point at camera depth near_clip along a film direction, by both ways.
    const double sx = 0.1, sy = 0.7, x = (1 - 2 * sx) * 1, y = (1 - 2 * sy) * 0.25;
    const Vec3 world = Vec3{-2 * x, 4 * y, 2} * 0.5;
    for (int i = 0; i < 3; i++) {
        const double d = record.left[i] * x + record.up[i] * y + record.forward[i];
        CHECK(record.near_clip * d == Approx(world[i] / 4));
    }
}

TEST_CASE("the film is all of the largest image", "[flatten]") {
    SceneDescription scene;
    const int most = std::numeric_limits<int>::max();
    scene.camera.width = scene.camera.height = most;
    scene.camera.filter = {FILTER_gaussian, 2, 0.5, 0, 0, true};
    const PixelWindow film = flatten(scene, 1).settings.film;
    CHECK((film.left == 0 && film.top == 0 && film.width == uint(most) && film.height == uint(most)));
}

TEST_CASE("a listed triangle has a plane where two corners are much nearer than the third", "[flatten]") {
    // The second triangle, which has no area, puts the origin into the scene's middle.
    const TriangleMesh mesh = mesh_of({{0, 0, 0}, {1, 1, 1}, {4e-19, 0, 0}, {-1, -1, -1}}, {{0, 1, 2}, {3, 1, 2}});
    const FlatScene flat = flatten(scene_of({diffuse(mesh)}), 16);
    REQUIRE(flat.faces.size() == 1);
    const FaceRecord &face = flat.faces[0];
    CHECK(std::abs(face.normal[0]) < 1e-6); // the plane holds the x axis and 1 1 1
    CHECK(std::abs(face.normal[1]) == Approx(std::sqrt(0.5)));
    CHECK(face.normal[1] == -face.normal[2]);
}

TEST_CASE("every number of the scene reaches the settings", "[flatten]") {
    SceneDescription scene = scene_of({diffuse(Parallelogram{{-4, -4, 0}, {8, 0, 0}, {0, 8, 0}})}); // scale 1/4
    scene.camera.filter = {FILTER_mitchell, 3, 0.75, 0.25, 0.125, true};
    scene.spp = 77;
    scene.normals_signed = true;
    scene.simple_light = {{4, 8, 0}, {16, 32, 64}};
    scene.strategy.max_depth = 9;
    scene.strategy.rr_depth = 5;
    scene.strategy.rr_prob = 0.25;
    scene.strategy[AXIS_sampler] = CHOICE_sampler_sobol;
    const Settings s = flatten(scene, 8).settings;
    CHECK((s.filter == FILTER_mitchell && s.filter_radius == 3 && s.filter_stddev == 0.75f && s.filter_b == 0.25f &&
           s.filter_c == 0.125f));
    CHECK((s.spp == 77 && s.normals_signed == 1 && s.max_depth == 9 && s.rr_depth == 5 && s.rr_prob == 0.25f));
    CHECK((s.light_position[0] == 1 && s.light_position[1] == 2 && s.light_energy[0] == 1 && s.light_energy[2] == 4));
    CHECK(s.choices[AXIS_sampler] == CHOICE_sampler_sobol);
    CHECK(s.choices[AXIS_integrator] == CHOICE_integrator_path);
}

TEST_CASE("A filter reaches no farther than its weights and the image, and gathers no more than can be waited for",
          "[flatten]") {
    SceneDescription scene = scene_of({diffuse(one_triangle)});
    scene.camera.width = 1000;
    scene.camera.height = 500;
    scene.camera.crop = {400, 200, 10, 10, 1000, 500};
    const auto film = [&](const Filter &filter) {
        scene.camera.filter = filter;
        return flatten(scene, 8).settings.film;
    };
    CHECK(film({FILTER_gaussian, 2, 0.5}).width == 14);
    CHECK(film({FILTER_gaussian, 1e38, 0.5}).width == film({FILTER_gaussian, 20, 0.5}).width);
    CHECK(film({FILTER_gaussian, 1e38, 0.5}).width == 10 + 2 * 7); // exp(-7.5^2 / 0.5) is 0 in single precision
    CHECK(film({FILTER_mitchell, 15.5}).width == 10 + 2 * 15);
    for (const Filter &wide :
         {Filter{FILTER_mitchell, 32}, Filter{FILTER_mitchell, 1e38}, Filter{FILTER_gaussian, 1e9, 1e8}}) {
        scene.camera.filter = wide;
        scene.camera.filter.place = {"a.xml", 3, 1};
        CHECK_THAT(test::error_of([&] { flatten(scene, 8); }),
                   Catch::StartsWith("a.xml:3:1: ") && Catch::EndsWith("possible: a radius up to 15.5"));
    }
    scene.camera.width = scene.camera.height = 32; // so few pixels are soon gathered
    scene.camera.crop = {};
    CHECK(film({FILTER_mitchell, 1e38}).width == 32);
}

// The triangles that listed face i stands for: in the slots that the device finds them in, with the corners that it
// tests.
std::vector<std::array<std::array<float, 3>, 3>> triangles_of_face(const FlatScene &scene, uint i) {
    const FaceRecord &face = scene.faces[i];
    const auto at = [&](int corner) {
        const float *p = &scene.face_vertices[3 * face.corner[corner]];
        return std::array<float, 3>{p[0], p[1], p[2]};
    };
    std::vector<std::array<std::array<float, 3>, 3>> expected{{at(0), at(1), at(2)}};
    if (face.corner[3] != face.corner[1])
        expected.push_back({at(3), at(2), at(1)});
    const uint slot = scene.settings.face_list_slot + 2 * i;
    for (uint which = 0; which < 2; which++) {
        const bool there = scene.triangle_blocks[(slot + which) / 8].id[(slot + which) % 8] != OPAL_NONE;
        CHECK(there == (which < expected.size()));
        for (int corner = 0; corner < 3 && there; corner++)
            CHECK(vertex(scene, slot + which, corner) == expected[which][size_t(corner)]);
    }
    return expected;
}

TEST_CASE("tiny scenes share corners and need no tree", "[flatten]") {
    // A cube of 12 triangles, each face a parallelogram: 24 corners, 8 distinct ones.
    std::vector<Mesh> faces;
    for (Vec3 o : {Vec3{0, 0, 0}, Vec3{1, 1, 1}}) {
        const double s = o.x > 0 ? -1 : 1;
        faces.push_back(diffuse(Parallelogram{o, {s, 0, 0}, {0, s, 0}}));
        faces.push_back(diffuse(Parallelogram{o, {0, s, 0}, {0, 0, s}}));
        faces.push_back(diffuse(Parallelogram{o, {0, 0, s}, {s, 0, 0}}));
    }
    const FlatScene scene = flatten(scene_of(faces), 8);
    CHECK(scene.nodes.empty());
    CHECK_FALSE(scene.features[FEATURE_tree]);
    CHECK(scene.face_list_triangles == 12);
    CHECK(scene.settings.face_list.vertices == 8);
    CHECK(scene.settings.face_list.faces == 6);
    CHECK(scene.settings.face_list_to_light.faces == 0); // nothing is outside of a cube
    REQUIRE(scene.faces.size() == 6);
    for (uint i = 0; i < 6; i++)
        CHECK(triangles_of_face(scene, i).size() == 2);

    SECTION("in the general kernel, too, which finds an empty tree") {
        SceneDescription general = scene_of(faces);
        general.strategy.specialise = Specialise::off;
        const FlatScene flat = flatten(general, 8);
        CHECK(flat.faces.size() == 6);
        REQUIRE(flat.nodes.size() == 1);
        CHECK(std::ranges::all_of(flat.nodes[0].child, [](uint child) { return child == OPAL_NONE; }));
        CHECK(flat.triangle_blocks.size() == scene.triangle_blocks.size());
    }
    SECTION("but for few lanes, many triangles or many vertices") {
        CHECK(flatten(scene_of(faces), 1).features[FEATURE_tree]);
        CHECK(flatten(scene_of(faces), 1).faces.empty());
        CHECK(flatten(scene_of(faces), 8, false).faces.empty());
        std::vector<Mesh> many, scattered;
        for (int i = 0; i < 25; i++)
            many.push_back(diffuse(Parallelogram{{0, 0, 0.1 * i}, {1, 0, 0}, {0, 1, 0}}));
        for (int i = 0; i < 33; i++)
            scattered.push_back(diffuse(mesh_of({{0, 0, 0.1 * i}, {1, 0, 0.1 * i}, {0, 1, 0.1 * i}}, {{0, 1, 2}})));
        CHECK(flatten(scene_of(many), 8).features[FEATURE_tree]);
        CHECK(flatten(scene_of(scattered), 8).features[FEATURE_tree]);
        many.pop_back();
        scattered.pop_back();
        CHECK_FALSE(flatten(scene_of(many), 8).features[FEATURE_tree]);
        CHECK_FALSE(flatten(scene_of(scattered), 8).features[FEATURE_tree]);
    }
}

TEST_CASE("a parallelogram is two triangles that face u x v", "[flatten]") {
    const FlatScene scene =
        flatten(scene_of({diffuse(Parallelogram{{0, 0, 0}, {1, 0, 0}, {0, 0, 1}})}), 8); // u x v = -y
    REQUIRE(scene.triangles.size() == 2);
    double area = 0;
    for (uint slot : {0u, 1u}) {
        const Vec3 normal = normal_of(vertex(scene, slot, 0), vertex(scene, slot, 1), vertex(scene, slot, 2));
        CHECK(normal.y < 0);
        CHECK((normal.x == 0 && normal.z == 0));
        area += length(normal) / 2;
    }
    CHECK(area / (scene.scale * scene.scale) == Approx(1));
}

TEST_CASE("vertex normals are numbered across meshes; a triangle that lacks one is flat", "[flatten]") {
    TriangleMesh smooth = mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {{0, 1, 2}, {1, 3, 2}});
    smooth.normals = {{0, 0, 1}, {0.6, 0, 0.8}};
    for (auto &corner : smooth.triangles[0])
        corner.normal = 1;
    smooth.triangles[1][0].normal = 0; // and no other
    const FlatScene scene = flatten(scene_of({diffuse(smooth), diffuse(smooth), diffuse(one_triangle)}), 8);
    CHECK(scene.normals == LargeVector<float>{0, 0, 1, 0.6f, 0, 0.8f, 0, 0, 1, 0.6f, 0, 0.8f});
    REQUIRE(scene.triangles.size() == 5);
    for (int corner = 0; corner < 3; corner++) {
        CHECK(scene.triangles[0].normal[corner] == 1);
        CHECK(scene.triangles[1].normal[corner] == OPAL_NONE);
        CHECK(scene.triangles[2].normal[corner] == 3);
        CHECK(scene.triangles[4].normal[corner] == OPAL_NONE);
    }
    CHECK((scene.triangles[1].mesh == 0 && scene.triangles[3].mesh == 1 && scene.triangles[4].mesh == 2));
    CHECK(scene.features[FEATURE_shading_normals]);
    CHECK(scene.features.list[FEATURE_shading_normals].reason == "2 of 5 triangles");
    CHECK_FALSE(flatten(scene_of({diffuse(one_triangle)}), 8).features[FEATURE_shading_normals]);
}

TEST_CASE("a scene that is freed as it is flattened gives the same tables", "[flatten]") {
    TriangleMesh smooth = one_triangle;
    smooth.normals = {{0, 0.6, 0.8}};
    for (auto &corner : smooth.triangles[0])
        corner.normal = 0;
    SceneDescription description = scene_of(
        {diffuse(smooth), light(one_triangle, {1, 2, 3}), light(Parallelogram{{}, {1, 0, 0}, {0, 1, 1}}, {1, 1, 1})});
    description.lights = {{emitter_constant{{1, 2, 3}}, {}}}; // its power is that of the scene's extent
    description.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    const FlatScene kept = flatten(description, 1), freed = flatten_and_free(description, 1);
#define OPAL_COMPARE_TABLE(record, name, shown)                                                                        \
    REQUIRE(kept.name.size() == freed.name.size());                                                                    \
    CHECK(std::memcmp(kept.name.data(), freed.name.data(), kept.name.size() * sizeof(record)) == 0);
    OPAL_TABLES(OPAL_COMPARE_TABLE)
#undef OPAL_COMPARE_TABLE
    CHECK(freed.emitters.size() == 3);
    CHECK(std::get<TriangleMesh>(description.meshes[0].shape).positions.empty());
    CHECK(std::get<TriangleMesh>(description.meshes[1].shape).triangles.empty());
}

TEST_CASE("triangles that float makes degenerate are dropped everywhere and counted", "[flatten]") {
    TriangleMesh mesh =
        mesh_of({{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}, {0.3, 0, 0.5}, {0.3 + 1e-12, 0, 0.5}, {0.3, 1e-12, 0.5}},
                {{3, 4, 5}, {0, 1, 2}, {0, 1, 4}});
    const std::size_t before = warnings().size();
    SceneDescription description = scene_of({light(mesh, {1, 1, 1})});
    description.meshes[0].name = "a.obj";
    description.meshes[0].place = {"a.xml", 2, 1};
    const FlatScene scene = flatten(description, 1);
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() == "a.xml:2:1: 1 of 3 triangles dropped: no area is left of them in single precision, "
                               "which rounds coordinates to 6e-08 of the scene's size; the first is one of a.obj");
    CHECK(scene.triangles.size() == 2);
    CHECK(scene.light_triangles.size() == 2);
    uint kept = 0;
    for (const TriangleBlock &block : scene.triangle_blocks)
        kept += uint(std::count_if(block.id, block.id + 8, [](uint id) { return id != OPAL_NONE; }));
    CHECK(kept == 2);

    // A light of which nothing is left is none.
    const FlatScene gone =
        flatten(scene_of({light(mesh_of({{0.3, 0, 0}, {0.3 + 1e-12, 0, 0}, {0.3, 1e-12, 0}}, {{0, 1, 2}}), {1, 1, 1}),
                          diffuse(Parallelogram{{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}})}),
                8);
    CHECK(gone.emitters.empty());
    CHECK(gone.meshes[0].emitter == OPAL_NONE);
}

TEST_CASE("the scenes that people have", "[flatten]") {
    const std::filesystem::path folder = std::filesystem::path(OPAL_SOURCE_DIR) / "../shared/scenes";
    if (!std::filesystem::exists(folder)) {
        WARN("no ../shared/scenes here");
        return;
    }
    int scenes = 0;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(folder)) {
        if (entry.path().extension() != ".xml")
            continue;
        INFO(entry.path());
        scenes++;
        const SceneDescription description = load_scene(entry.path());
        std::size_t triangles = 0, lights = 0;
        for (const Mesh &mesh : description.meshes) {
            const auto *shape = std::get_if<TriangleMesh>(&mesh.shape);
            triangles += shape ? shape->triangles.size() : 2;
            lights += mesh.radiance.has_value();
        }
        for (int lanes : {1, 16}) {
            const FlatScene scene = flatten(description, lanes);
            CHECK(scene.triangles.size() == triangles);
            CHECK(scene.emitters.size() == lights);
            CHECK(scene.features[FEATURE_tree] == (lanes == 1 || triangles > OPAL_FACE_LIST_TRIANGLES));
            if (triangles > 1000)
                CHECK(scene.sah_cost < 6);
        }
    }
    CHECK(scenes > 0);
}

TEST_CASE("the largest triangles are listed beside the tree, each triangle is in one of both", "[flatten]") {
    // A floor of two triangles under a grid of small ones.
    TriangleMesh grid;
    for (int i = 0; i < 400; i++) {
        const double x = i % 20, y = double(i / 20), z = 1 + (i % 7) * 0.1;
        const unsigned first = unsigned(grid.positions.size());
        grid.positions.insert(grid.positions.end(), {{x, y, z}, {x + 0.5, y, z}, {x, y + 0.5, z}});
        grid.triangles.push_back({{{first, OPAL_NONE}, {first + 1, OPAL_NONE}, {first + 2, OPAL_NONE}}});
    }
    const SceneDescription description =
        scene_of({diffuse(grid), diffuse(Parallelogram{{-5, -5, 0}, {40, 0, 0}, {0, 40, 0}})});
    const FlatScene scene = flatten(description, 8);
    CHECK(scene.features[FEATURE_face_list]);
    CHECK(scene.features[FEATURE_tree]);
    REQUIRE(scene.faces.size() == 1);
    CHECK(scene.face_list_triangles == 2);
    CHECK(scene.settings.face_list_to_light.faces == 0); // the grid is on one side of the floor
    CHECK(scene.face_vertices.size() == 3 * 4);
    REQUIRE(triangles_of_face(scene, 0).size() == 2);
    for (uint place = 0; place < 2; place++)
        CHECK(scene.triangles[scene.triangle_blocks[scene.settings.face_list_slot / 8].id[place]].mesh == 1);
    std::vector<int> seen(scene.triangles.size());
    for (const TriangleBlock &block : scene.triangle_blocks)
        for (uint id : block.id)
            if (id != OPAL_NONE)
                seen[id]++;
    CHECK(std::all_of(seen.begin(), seen.end(), [](int times) { return times == 1; }));
    // The tree's box is that of the grid.
    const auto &lows = scene.nodes[0].lo[2];
    CHECK(*std::min_element(std::begin(lows), std::end(lows)) == float((1 - scene.center.z) * scene.scale));
    CHECK(flatten(description, 1).faces.empty());

    // A smaller one is listed beside a single large one, as two cost what one does; a third would cost more.
    const auto with_lamps = [&](std::vector<double> sides) {
        std::vector<Mesh> meshes{diffuse(grid), diffuse(Parallelogram{{-5, -5, 0}, {40, 0, 0}, {0, 40, 0}})};
        for (double side : sides)
            meshes.push_back(diffuse(Parallelogram{{side, side, 3}, {0, side, 0}, {side, 0, 0}}));
        return flatten(scene_of(std::move(meshes)), 8).face_list_triangles;
    };
    CHECK(with_lamps({8}) == 4);
    CHECK(with_lamps({8, 7}) == 4);
    CHECK(with_lamps({1}) == 2);

    // Light below the floor makes it one that may block.
    SceneDescription lit = description;
    lit.lights.push_back({emitter_point{{0, 0, -1}, {1, 1, 1}}, {}});
    CHECK(flatten(lit, 8).settings.face_list_to_light.faces == 1);
    // Light from all around makes all faces such, unless it is black.
    SceneDescription sky = description;
    sky.lights.push_back({emitter_constant{{0, 0, 0}}, {}});
    CHECK(flatten(sky, 8).settings.face_list_to_light.faces == 0);
    sky.lights.push_back({emitter_constant{}, {}});
    CHECK(flatten(sky, 8).settings.face_list_to_light.faces == flatten(sky, 8).faces.size());

    // A lamp in the middle of the scene does not block its own light, nor do two in one plane; one above the other may,
    // and so may a mirror there.
    const auto blocking = [&](std::vector<double> lamps, double mirror) {
        std::vector<Mesh> meshes{diffuse(grid)};
        const auto add = [&](double x, double z, bool shines) {
            meshes.push_back(diffuse(Parallelogram{{x, 0, z}, {0, 20, 0}, {9, 0, 0}}));
            if (shines)
                meshes.back().radiance = Color{1, 1, 1};
        };
        for (size_t i = 0; i < lamps.size(); i++)
            add(10 * double(i), lamps[i], true);
        add(0, mirror, false);
        const FlatScene lit_scene = flatten(scene_of(std::move(meshes)), 8);
        CHECK(lit_scene.faces.size() == lamps.size() + 1);
        return lit_scene.settings.face_list_to_light.faces;
    };
    CHECK(blocking({1.3}, 9) == 0);
    CHECK(blocking({1.3, 1.3}, 9) == 0);
    CHECK(blocking({1.3, 1.2}, 9) == 2);
    CHECK(blocking({1.3}, 1.4) == 1);
    CHECK(blocking({1.3}, 1.3) == 0); // in the lamp's plane
}

TEST_CASE("two triangles are one face only where they make a convex quadrilateral", "[flatten]") {
    const std::array<unsigned, 3> front{0, 1, 2};
    const auto faces = [&](Vec3 far, std::array<unsigned, 3> second) {
        // A larger triangle below everything keeps the flattening the same.
        const FlatScene scene =
            flatten(scene_of({diffuse(mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, far}, {front, second})),
                              diffuse(mesh_of({{-4, -4, -1}, {4, -4, -1}, {0, 4, -1}}, {{0, 1, 2}}))}),
                    8);
        size_t triangles = 0;
        for (uint i = 0; i < scene.faces.size(); i++)
            triangles += triangles_of_face(scene, i).size();
        CHECK(triangles == 3);
        CHECK(scene.face_list_triangles == 3);
        return scene.faces.size();
    };
    CHECK(faces({1, 1, 0}, {1, 3, 2}) == 2);
    CHECK(faces({1, 1, 0}, {3, 2, 1}) == 2);
    CHECK(faces({1, 1, 0}, {2, 1, 3}) == 2);
    CHECK(faces({0.6, 0.7, 0}, {1, 3, 2}) == 2);    // no parallelogram
    CHECK(faces({3, 2, 0}, {1, 3, 2}) == 2);        // the second one is the larger
    CHECK(faces({1, 1, 0}, {1, 2, 3}) == 3);        // they face opposite ways
    CHECK(faces({1, 1, 1e-5}, {1, 3, 2}) == 3);     // not plane
    CHECK(faces({0.5, 0.5001, 0}, {1, 3, 2}) == 3); // the second one is a sliver
    CHECK(faces({1, -0.5, 0}, {1, 3, 2}) == 3);     // reflex at B
    CHECK(faces({2, 0, 0}, {1, 3, 2}) == 3);        // straight at B
    CHECK(faces({0.2, 0.2, 0}, {1, 3, 2}) == 3);    // one covers the other
    CHECK(faces({1, 1, 0}, {0, 1, 3}) == 3);        // likewise
}
