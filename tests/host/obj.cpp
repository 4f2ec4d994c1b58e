#include "read/obj.h"
#include "base/log.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <tiny_obj_loader.h>

#include <cmath>
#include <set>

using namespace opal;
using opal::test::error_of;

namespace {

struct ObjFixture {
    test::ScratchFolder scratch;
    std::string file() const { return (scratch / "a.obj").string(); }
    TriangleMesh read(const std::string &text, const Transform &to_world = {}) const {
        return read_obj(scratch.write("a.obj", text), to_world).mesh;
    }
    // The error without the file's name, which leads.
    std::string error_in(const std::string &text) const {
        std::string error = error_of([&] { read(text); });
        return error.starts_with(file()) ? error.substr(file().size()) : error;
    }
};

const std::string square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double area(const TriangleMesh &mesh) {
    double sum = 0;
    for (const auto &t : mesh.triangles) {
        Vec3 a = mesh.positions[t[0].position], b = mesh.positions[t[1].position], c = mesh.positions[t[2].position];
        sum += length(cross(b - a, c - a)) / 2;
    }
    return sum;
}

// The sum of the triangles' area vectors: equal to area() only where all face the same way.
Vec3 area_vector(const TriangleMesh &mesh) {
    Vec3 sum;
    for (const auto &t : mesh.triangles) {
        Vec3 a = mesh.positions[t[0].position], b = mesh.positions[t[1].position], c = mesh.positions[t[2].position];
        sum = sum + cross(b - a, c - a) * 0.5;
    }
    return sum;
}

using CornerValues = std::array<float, 6>; // position and normal of a corner, the normal zero where the face gives none

std::vector<std::array<CornerValues, 3>> by_tinyobjloader(const std::filesystem::path &file) {
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    tinyobj::ObjReader reader;
    REQUIRE(reader.ParseFromFile(file.string(), config));
    const tinyobj::attrib_t &all = reader.GetAttrib();
    std::vector<std::array<CornerValues, 3>> triangles;
    for (const tinyobj::shape_t &shape : reader.GetShapes()) {
        auto corner = shape.mesh.indices.begin();
        for (size_t count : shape.mesh.num_face_vertices) {
            std::vector<Vec3> outline;
            std::vector<CornerValues> points;
            for (size_t i = 0; i < count; ++i, ++corner) {
                const float *p = &all.vertices[size_t(corner->vertex_index) * 3];
                const float *n = corner->normal_index < 0 ? nullptr : &all.normals[size_t(corner->normal_index) * 3];
                points.push_back({p[0], p[1], p[2], n ? n[0] : 0, n ? n[1] : 0, n ? n[2] : 0});
                outline.push_back({p[0], p[1], p[2]});
            }
            for (auto [a, b, c] : triangulate(outline))
                triangles.push_back({points[a], points[b], points[c]});
        }
    }
    return triangles;
}

// Positions to an ulp or so of tinyobjloader's own parser, normals as unit vectors.
bool same_corner(const TriangleMesh &mesh, TriangleMesh::Corner corner, const CornerValues &point) {
    const Vec3 p = mesh.positions[corner.position], wanted{point[0], point[1], point[2]};
    Vec3 n{point[3], point[4], point[5]};
    const double size = length(n);
    const Vec3 given = corner.normal == OPAL_NONE ? Vec3{} : mesh.normals[corner.normal];
    return length(p - wanted) <= 1e-6 * length(wanted) &&
           (size > 0 ? length(given - n * (1 / size)) <= 1e-6 : corner.normal == OPAL_NONE);
}

} // namespace

TEST_CASE("well-formed files mean what tinyobjloader reads in them", "[obj]") {
    std::vector<std::filesystem::path> files;
    for (const char *folder : {"scenes", "../shared/scenes"}) {
        std::error_code missing; // a clone has no ../shared
        for (const auto &entry :
             std::filesystem::recursive_directory_iterator(std::filesystem::path(OPAL_SOURCE_DIR) / folder, missing))
            if (entry.path().extension() == ".obj")
                files.push_back(entry.path());
    }
    REQUIRE(files.size() > 20);
    for (const std::filesystem::path &file : files) {
        INFO(file.string());
        const TriangleMesh mesh = read_obj(file, {}).mesh;
        const auto expected = by_tinyobjloader(file);
        size_t next = 0, found = 0; // those without area are left out of the mesh
        for (const auto &triangle : mesh.triangles) {
            const auto matches = [&](const std::array<CornerValues, 3> &other) {
                return same_corner(mesh, triangle[0], other[0]) && same_corner(mesh, triangle[1], other[1]) &&
                       same_corner(mesh, triangle[2], other[2]);
            };
            while (next < expected.size() && !matches(expected[next]))
                ++next;
            found += next++ < expected.size();
        }
        CHECK(found == mesh.triangles.size());
        CHECK(expected.size() - found < 1 + expected.size() / 100);
    }
}

TEST_CASE_METHOD(ObjFixture, "coordinates are read in double", "[obj]") {
    TriangleMesh mesh = read("v 0.1 1e-9 -3.25E2\nv +1 .5 2.\nv 0 1 123456.789012345\nf 1 2 3\n");
    CHECK(mesh.positions[0].x == 0.1);
    CHECK(mesh.positions[0].y == 1e-9);
    CHECK(mesh.positions[0].z == -325);
    CHECK(mesh.positions[1].y == 0.5);
    CHECK(mesh.positions[2].z == 123456.789012345);
}

TEST_CASE_METHOD(ObjFixture, "corners of all four spellings, some without normals", "[obj]") {
    TriangleMesh mesh = read(square + "vt 0 0\nvn 0 0 2\nf 1 2/1 3//1\nf 1/1/1 3/1/ 4//-1\n");
    REQUIRE(mesh.triangles.size() == 2);
    REQUIRE(mesh.normals.size() == 1);
    CHECK(mesh.normals[0].z == 1);
    CHECK(mesh.triangles[0][0].normal == OPAL_NONE);
    CHECK(mesh.triangles[0][1].normal == OPAL_NONE);
    CHECK(mesh.triangles[0][2].normal == 0);
    CHECK(mesh.triangles[1][0].normal == 0);
    CHECK(mesh.triangles[1][1].normal == OPAL_NONE);
    CHECK(mesh.triangles[1][2].normal == 0);
}

TEST_CASE_METHOD(ObjFixture, "negative indices count from the end so far", "[obj]") {
    TriangleMesh mesh = read(square + "f -4 -3 -2\nv 5 5 5\nf -1 -5 -4\n");
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.positions[mesh.triangles[0][0].position].x == 0);
    CHECK(mesh.positions[mesh.triangles[1][0].position].x == 5);
    CHECK(length(mesh.positions[mesh.triangles[1][1].position]) == 0);
}

TEST_CASE_METHOD(ObjFixture, "a vertex may come after the face that names it", "[obj]") {
    CHECK(read("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").triangles.size() == 1);
}

TEST_CASE_METHOD(ObjFixture, "all else is ignored: materials, groups, lines, comments, colours, CRLF, continued lines",
                 "[obj]") {
    TriangleMesh mesh =
        read("# comment\r\nmtllib a.mtl\r\no thing\r\n  v 0 0 0 1 0 0 # red\r\n\tv 1 0 0 1.0\r\nv\\\n 0 1 \\\r\n 0\r\n"
             "g group\r\nusemtl b\r\ns off\r\nl 1 2\r\np 1\r\nvp 1 2\r\n\r\nf 1 2 \\\n 3");
    REQUIRE(mesh.triangles.size() == 1);
    CHECK(area(mesh) == 0.5);
}

TEST_CASE_METHOD(ObjFixture, "materials are named by the rest of the line, and kept as runs of triangles", "[obj]") {
    const ObjFile obj = read_obj(scratch.write("a.obj", "mtllib my lib.mtl \n" + square +
                                                            "f 1 2 3 4\nusemtl my red\nf 1 2 3\nusemtl none\nusemtl "
                                                            "blue\t\nf 1 1 2\nf 1 2 3\n usemtl my red\nf 1 2 3\n"),
                                 {});
    REQUIRE(obj.libraries.size() == 1);
    CHECK(obj.libraries[0].names == "my lib.mtl");
    CHECK(obj.libraries[0].place.text() == file() + ":1:1");
    REQUIRE(obj.materials.size() == 3);
    CHECK(obj.materials[0].name == "my red");
    CHECK(obj.materials[0].place.text() == file() + ":7:1");
    CHECK(obj.materials[1].name == "none");
    CHECK(obj.materials[2].name == "blue");
    const std::vector<std::pair<size_t, unsigned>> expected = {{0, OPAL_NONE}, {2, 0}, {3, 2}, {4, 0}};
    REQUIRE(obj.material_runs.size() == expected.size());
    for (size_t i = 0; i < expected.size(); ++i) {
        CHECK(obj.material_runs[i].first == expected[i].first);
        CHECK(obj.material_runs[i].material == expected[i].second);
    }
    CHECK(read_obj(scratch.write("a.obj", square + "f 1 2 3\n"), {}).material_runs.empty());
}

TEST_CASE_METHOD(ObjFixture, "only what triangles use is kept", "[obj]") {
    TriangleMesh mesh = read("v 9 9 9\nvn 1 0 0\n" + square + "vn 0 1 0\nvn 0 0 1\nf 2//3 3//3 4//3\n");
    CHECK(mesh.positions.size() == 3);
    REQUIRE(mesh.normals.size() == 1);
    CHECK(mesh.normals[0].z == 1);
}

TEST_CASE_METHOD(ObjFixture, "a quad is split from its first corner, as Nori splits it", "[obj]") {
    TriangleMesh mesh = read(square + "f 1 2 3 4\n");
    REQUIRE(mesh.triangles.size() == 2);
    for (const auto &t : mesh.triangles)
        CHECK(length(mesh.positions[t[0].position]) == 0);
    CHECK(area_vector(mesh).z == 1);
}

TEST_CASE_METHOD(ObjFixture, "a large polygon is covered once, whatever its plane", "[obj]") {
    const int n = 100;
    std::string vertices, face = "f";
    for (int i = 0; i < n; ++i) {
        double angle = 2 * M_PI * i / n, radius = i % 2 ? 1 : 0.4; // a star, concave at every second corner
        double x = radius * std::cos(angle), y = radius * std::sin(angle);
        vertices += fmt::format("v {} {} {}\n", x + 7, 0.6 * y, 0.8 * y);
        face += " " + std::to_string(i + 1);
    }
    TriangleMesh mesh = read(vertices + face + "\n");
    CHECK(mesh.triangles.size() == n - 2);
    double wanted = n * 0.5 * 0.4 * std::sin(2 * M_PI / n);
    CHECK(area(mesh) == Approx(wanted).epsilon(1e-4));
    CHECK(length(area_vector(mesh)) == Approx(area(mesh)).epsilon(1e-12));
    CHECK(area_vector(mesh).z > 0);
    CHECK(area_vector(mesh).y < 0);
}

TEST_CASE("concave quads are split at their reflex corner, from any first corner", "[obj]") {
    std::vector<Vec3> dart = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}}; // reflex at the third
    for (int first = 0; first < 4; ++first)
        for (bool flipped : {false, true}) {
            std::vector<Vec3> corners;
            for (int i = 0; i < 4; ++i)
                corners.push_back(dart[(flipped ? 4 + first - i : first + i) % 4]);
            auto triangles = triangulate(corners);
            REQUIRE(triangles.size() == 2);
            double sum = 0;
            for (auto [a, b, c] : triangles)
                sum += length(cross(corners[b] - corners[a], corners[c] - corners[a])) / 2;
            CHECK(sum == Approx(4));
        }
}

TEST_CASE("outlines that no triangulation is right for still give corners - 2 triangles", "[obj]") {
    CHECK(triangulate({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}).size() == 2);            // crosses itself
    CHECK(triangulate({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}).size() == 3); // a line
    CHECK(triangulate({{1, 1, 1}, {1, 1, 1}, {1, 1, 1}, {1, 1, 1}}).size() == 2);            // a point
    CHECK(triangulate({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 0, 0}, {0, 2, 0}}).size() == 3); // touches itself
    CHECK(triangulate({{0, 0, 0}, {1, 0, 0}}).empty());
}

TEST_CASE_METHOD(ObjFixture, "a face that is too large to be cut is refused at its place", "[obj]") {
    std::string vertices, face = "f";
    for (int i = 0; i < 10002; ++i) { // a star
        const double radius = i % 2 ? 1 : 0.5, angle = 2 * M_PI * i / 10002;
        vertices += fmt::format("v {} {} 0\n", radius * std::cos(angle), radius * std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    CHECK_THAT(error_in(vertices + "\n  " + face + "\n"),
               Catch::StartsWith(":10004:3: a face of 10002 corners that is not convex: at most 10000"));
}

TEST_CASE_METHOD(ObjFixture, "triangles without area are dropped and counted", "[obj]") {
    size_t before = warnings().size();
    TriangleMesh mesh = read(square + "v 2 0 0\nv 0.1 0.3 0.7\nv 0.2 0.6 1.4\nv 0.3 0.9 2.1\n"
                                      "f 1 2 3\nf 1 1 2\nf 1 2 5\nf 6 7 8\nf 1 2\nf 2 3 4\n");
    CHECK(mesh.triangles.size() == 2);
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() == file() + ": dropped 4 triangles without area, kept 2");
}

TEST_CASE_METHOD(ObjFixture, "small and thin triangles are kept", "[obj]") {
    size_t before = warnings().size();
    CHECK(read("v 1000 0 0\nv 1000.000001 0 0\nv 1000 0.000001 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(read("v 0 0 0\nv 1 0 0\nv 0.5 1e-9 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(read("v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(warnings().size() == before);
}

TEST_CASE_METHOD(ObjFixture, "no triangles at all is an error", "[obj]") {
    for (const char *text : {"", "v 0 0 0\n", "# only words\n"})
        CHECK(error_in(text) == ": holds no triangles");
    CHECK(error_in(square + "f 1 1 2\nf 3 3 3\n") == ": holds no triangles: dropped 2 triangles without area");
}

TEST_CASE_METHOD(ObjFixture, "indices out of range fail at their place", "[obj]") {
    CHECK(error_in(square + "f 1 2 3\nf 1 2 5\n") == ":6:7: vertex index 5 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 \\\n 5\n") == ":6:2: vertex index 5 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 0\n") == ":5:7: vertex index 0 is out of range: 4 so far");
    CHECK(error_in(square + "f 1 2 -5\n") == ":5:7: vertex index -5 is out of range: 4 so far");
    CHECK(error_in(square + "f -2147483648 2 3\n") == ":5:3: vertex index -2147483648 is out of range: 4 so far");
    CHECK(error_in(square + "vn 0 0 1\nf 1//1 2//2 3//1\n") == ":6:8: normal index 2 is out of range: the file has 1");
    CHECK(error_in(square + "vt 0 0\nf 1/-2 2/1 3/1\n") == ":6:3: texture index -2 is out of range: 1 so far");
    CHECK(error_in(square + "vt 0 0\nf 1/2 2/1 3/1\n") == ":6:3: texture index 2 is out of range: the file has 1");
    CHECK(error_in(square + "f 1 2 99999999999\n") == ":5:7: '99999999999' is too large for an integer");
}

TEST_CASE_METHOD(ObjFixture, "malformed numbers fail at their place", "[obj]") {
    CHECK(error_in("v 0 0 0\nv nan 0 0\n") == ":2:3: 'nan' is not a finite number in single precision");
    CHECK(error_in("v 0 0 0\n\nv 0 inf 0\n") == ":3:5: 'inf' is not a finite number in single precision");
    CHECK(error_in("v 1e39 0 0\n") == ":1:3: '1e39' is not a finite number in single precision");
    CHECK(error_in("  v 0 0\n") == ":1:3: 'v' needs three numbers");
    CHECK(error_in("v 0 0 1,5\n") == ":1:7: '1,5' is not a number");
    CHECK(error_in("vn 0 NaN 1\n") == ":1:6: 'NaN' is not a finite number in single precision");
    CHECK(error_in(square + "f 1 2 x\n") == ":5:7: 'x' is not an integer");
    CHECK(error_in(square + "f 1 2 \\\n /1\n") == ":6:2: '' is not an integer");
    CHECK(error_in(square + "f 1 2 1/1/1/1\n") == ":5:7: '1/1/1/1' has more than vertex/texture/normal");
}

TEST_CASE_METHOD(ObjFixture, "a missing file is named", "[obj]") {
    CHECK_THAT(error_of([&] { read_obj(scratch / "none.obj", {}); }),
               Catch::StartsWith((scratch / "none.obj").string() + ": cannot read: "));
}

TEST_CASE_METHOD(ObjFixture, "vertices and normals go to world space, normals by the inverse transpose", "[obj]") {
    Transform t = Transform::translate({1, 2, 3}) * Transform::scale({2, 1, 1});
    TriangleMesh mesh = read("v 0 0 0\nv 1 -1 0\nv 0 0 1\nvn 1 1 0\nf 1//1 2//1 3//1\n", t);
    CHECK(mesh.positions[1].x == 3);
    CHECK(mesh.positions[1].y == 1);
    CHECK(mesh.positions[2].z == 4);
    CHECK(mesh.normals[0].x == Approx(1 / std::sqrt(5)));
    CHECK(mesh.normals[0].y == Approx(2 / std::sqrt(5)));
}

TEST_CASE_METHOD(ObjFixture, "a mirror turns the geometric normal and not the given one", "[obj]") {
    TriangleMesh mesh = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n", Transform::scale({-1, 1, 1}));
    CHECK(area_vector(mesh).z == -0.5);
    CHECK(mesh.normals[0].z == 1);
}

TEST_CASE_METHOD(ObjFixture, "normals of no length are missing ones", "[obj]") {
    TriangleMesh mesh = read(square + "vn 0 0 0\nvn 0 0 1e-30\nf 1//1 2//2 3//1\n");
    CHECK(mesh.triangles[0][0].normal == OPAL_NONE);
    REQUIRE(mesh.triangles[0][1].normal == 0);
    CHECK(mesh.normals.size() == 1);
    CHECK(mesh.normals[0].z == 1);
}

TEST_CASE_METHOD(ObjFixture, "a vertex that a transform sends out of range is an error", "[obj]") {
    scratch.write("a.obj", "v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK_THAT(error_of([&] {
                   read_obj(file(), Transform::scale({1e30, 1, 1}));
               }),
               Catch::StartsWith(file() + ": vertex 2 is not finite"));
}
