// The scenes of scenes/: each loads without leniency, and its surfaces and lights face the way they are meant to.
#include "read/nori/load.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

using namespace opal;

namespace {

const std::filesystem::path folder = std::filesystem::path(OPAL_SOURCE_DIR) / "scenes";

std::vector<std::filesystem::path> scene_files() {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".xml" && entry.path().parent_path() != folder / "generated")
            files.push_back(entry.path());
    return files;
}

struct Facet {
    std::array<Vec3, 3> corner;
    std::array<const Vec3 *, 3> normal; // null: geometric
    Vec3 cross_product() const { return cross(corner[1] - corner[0], corner[2] - corner[0]); }
    double area() const { return length(cross_product()) / 2; }
};

std::vector<Facet> triangles_of(const TriangleMesh &mesh) {
    std::vector<Facet> list;
    for (const auto &corners : mesh.triangles) {
        Facet triangle{};
        for (int k = 0; k < 3; ++k) {
            triangle.corner[k] = mesh.positions[corners[k].position];
            triangle.normal[k] = corners[k].normal == OPAL_NONE ? nullptr : &mesh.normals[corners[k].normal];
        }
        list.push_back(triangle);
    }
    return list;
}

// Edges whose opposite is missing: 0 for a closed mesh wound in one sense.
size_t open_edges(const TriangleMesh &mesh) {
    std::map<std::array<double, 3>, int> index; // corners at one place are one, whatever their normals
    auto id = [&](unsigned i) {
        Vec3 p = mesh.positions[i];
        return index.emplace(std::array<double, 3>{p.x + 0.0, p.y + 0.0, p.z + 0.0}, int(index.size())).first->second;
    };
    std::map<std::array<int, 2>, int> balance;
    for (const auto &corners : mesh.triangles)
        for (int k = 0; k < 3; ++k) {
            int a = id(corners[k].position), b = id(corners[(k + 1) % 3].position);
            balance[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
        }
    return std::count_if(balance.begin(), balance.end(), [](const auto &edge) { return edge.second != 0; });
}

double volume(const TriangleMesh &mesh) {
    double sum = 0;
    for (const Facet &t : triangles_of(mesh))
        sum += dot(t.corner[0], t.cross_product()) / 6;
    return sum;
}

SceneDescription load(const std::string &name) { return load_scene(folder / (name + ".xml")); }

} // namespace

TEST_CASE("Every scene of ours loads, holds a light, and has vn on the side of its winding", "[scenes]") {
    REQUIRE(scene_files().size() >= 15);
    for (const auto &file : scene_files()) {
        INFO(file);
        SceneDescription scene = load_scene(file);
        CHECK(has_light(scene));
        double side = file.stem() == "furnace" ? -1 : 1; // the furnace is wound outwards and its vn point inwards
        for (const Mesh &mesh : scene.meshes) {
            const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape);
            if (!triangles)
                continue;
            INFO(mesh.name);
            size_t wrong = 0;
            for (const Facet &t : triangles_of(*triangles))
                for (const Vec3 *n : t.normal)
                    wrong += n && !(side * dot(*n, t.cross_product()) > 0);
            CHECK(wrong == 0);
        }
    }
}

TEST_CASE("Glass is closed and its normals point outwards", "[scenes]") {
    size_t found = 0;
    for (const auto &file : scene_files()) {
        SceneDescription scene = load_scene(file);
        for (const Mesh &mesh : scene.meshes) {
            if (mesh.bsdf.kind() != BSDF_dielectric)
                continue;
            INFO(file << " " << mesh.name);
            ++found;
            if (const auto *sphere = std::get_if<Sphere>(&mesh.shape)) {
                CHECK(!sphere->inward);
                continue;
            }
            const auto &triangles = std::get<TriangleMesh>(mesh.shape);
            CHECK(open_edges(triangles) == 0);
            CHECK(volume(triangles) > 0);
        }
    }
    CHECK(found >= 6);
}

TEST_CASE("Parallelogram lights face the scene", "[scenes]") {
    for (const auto &file : scene_files()) {
        SceneDescription scene = load_scene(file);
        INFO(file);
        // what the camera looks at, a scene's diameter being about its distance from the first things it shows
        Vec3 eye = scene.camera.to_world.point({0, 0, 0}), ahead = scene.camera.to_world.vector({0, 0, 1});
        for (const Mesh &mesh : scene.meshes) {
            const auto *light = std::get_if<Parallelogram>(&mesh.shape);
            if (!light || !mesh.radiance)
                continue;
            Vec3 front = cross(light->u, light->v), middle = light->origin + light->u * 0.5 + light->v * 0.5;
            Vec3 target = eye + ahead * dot(middle - eye, ahead);
            CHECK(dot(front, target - middle) > 0);
        }
    }
}

TEST_CASE("The scenes about choosing lights are as uneven as they say", "[scenes]") {
    SECTION("64 lamps, powers over four decades") {
        std::vector<double> powers;
        for (const Mesh &mesh : load("many_lights").meshes)
            if (mesh.radiance)
                powers.push_back(luminance(*mesh.radiance));
        REQUIRE(powers.size() == 64);
        auto [least, most] = std::minmax_element(powers.begin(), powers.end());
        CHECK(*most / *least == Approx(1e4).epsilon(1e-2));
    }
    SECTION("a mesh light with triangle areas over four decades") {
        for (const Mesh &mesh : load("spiral_light").meshes) {
            if (!mesh.radiance)
                continue;
            std::set<double> areas;
            for (const Facet &t : triangles_of(std::get<TriangleMesh>(mesh.shape)))
                areas.insert(t.area());
            CHECK(*areas.rbegin() / *areas.begin() > 5e3);
        }
    }
    SECTION("a room of about 50 thousand triangles") {
        size_t count = 0;
        for (const Mesh &mesh : load("mixed_room").meshes)
            if (const auto *m = std::get_if<TriangleMesh>(&mesh.shape))
                count += m->triangles.size();
        CHECK(count > 45000);
        CHECK(count < 55000);
    }
}

TEST_CASE("The scenes are what their script writes", "[scenes]") {
    if (std::system("python3 --version > /dev/null 2>&1") != 0) {
        WARN("no python3 here: skipped");
        return;
    }
    std::string script = std::string(OPAL_SOURCE_DIR) + "/scripts/make_scenes.py";
    CHECK(std::system(("python3 -B '" + script + "' --check").c_str()) == 0);
}
