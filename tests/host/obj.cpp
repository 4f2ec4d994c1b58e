#include "read/obj.h"
#include "base/log.h"
#include "read/triangulate.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#define TINYOBJLOADER_USE_DOUBLE // as read/obj.cpp compiles it
#include <tiny_obj_loader.h>

#include <cmath>
#include <random>

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

using CornerValues =
    std::array<double, 6>; // position and normal of a corner, the normal zero where the face gives none

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
                const double *p = &all.vertices[size_t(corner->vertex_index) * 3];
                const double *n = corner->normal_index < 0 ? nullptr : &all.normals[size_t(corner->normal_index) * 3];
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

namespace {

struct Habit {
    std::string text, library, opal;
};

// "2 triangles of area 1 from 0 0 0": their count, area and first corner.
std::string summary(const std::vector<std::array<Vec3, 3>> &triangles) {
    double sum = 0;
    for (const auto &[a, b, c] : triangles)
        sum += length(cross(b - a, c - a)) / 2;
    const Vec3 first = triangles.empty() ? Vec3{} : triangles[0][0];
    return fmt::format("{} of area {:.6g} from {} {} {}", triangles.size(), sum, first.x, first.y, first.z);
}

// What the library makes of a text by its usual interface, with its own triangulation.
std::string library_reads(const std::string &text) {
    tinyobj::ObjReader reader;
    if (!reader.ParseFromString(text, ""))
        return "fails";
    const std::vector<double> &numbers = reader.GetAttrib().vertices;
    std::vector<std::array<Vec3, 3>> triangles;
    for (const tinyobj::shape_t &shape : reader.GetShapes())
        for (size_t i = 0; i + 2 < shape.mesh.indices.size(); i += 3) {
            triangles.emplace_back();
            for (size_t k = 0; k < 3; ++k) {
                const int index = shape.mesh.indices[i + k].vertex_index;
                if (index < 0 || size_t(index) >= numbers.size() / 3)
                    return fmt::format("index {} of {}", index, numbers.size() / 3);
                const double *p = &numbers[size_t(index) * 3];
                triangles.back()[k] = {p[0], p[1], p[2]};
            }
        }
    return summary(triangles);
}

} // namespace

TEST_CASE_METHOD(ObjFixture, "faces of fewer than three corners are dropped, also first in the file", "[obj]") {
    for (const std::string face : {"f\n", "f 1\n", "f 1 2\n"}) {
        INFO(face);
        forget_warnings();
        CHECK(read(square + face + "f 1 2 3\n").triangles.size() == 1);
        REQUIRE(warnings().size() == 1);
        CHECK_THAT(warnings()[0], Catch::Contains(":5:1: dropped 1 triangle"));
        CHECK(read(square + face).triangles.empty());
        CHECK_THAT(error_in(face), Catch::Contains(face == "f\n" ? "" : "out of range"));
    }
    forget_warnings();
}

TEST_CASE_METHOD(ObjFixture, "which habits of tinyobjloader remain", "[obj]") {
    const std::string ring = "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 0 4 0\nv 1 1 0\nv 1 3 0\nv 3 3 0\nv 3 1 0\n";
    const std::string two = "v 1 0 0\nv 0 1 0\n"; // behind a vertex: a triangle
    const std::vector<Habit> habits = {
        // text, the library alone, Opal

        // Right, and left to the library: indices
        {square + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        {square + "f -4 -3 -2\n", "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        {"f 1 2 3\n" + square, "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        {square + "vt 0 0\nvn 0 0 1\nf 1/1/1 2//1 3/1\n", "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        {square + "\tf  1\t 2 3 \r\n", "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        // Polygons: cut by triangulate()
        {"v 0 10 0\nv -1 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3 4\n", "2 of area 11 from 0 10 0", "2 of area 9 from 0 10 0"},
        {ring + "f 1 2 3 4 1 5 6 7 8 5\n", "5 of area 7 from 0 4 0", "8 of area 12 from 0 4 0"},
        {"v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 1 2 3 4 5\n", "3 of area 0 from 0 0 0",
         "0 of area 0 from 0 0 0"},
        {square + "f 1 2\n", "0 of area 0 from 0 0 0", "0 of area 0 from 0 0 0"},
        // Statements: made clean, or kept away, by ObjStatements
        {square + "f 1 2 3 # x\n", "fails", "1 of area 0.5 from 0 0 0"},
        {square + "f 1 2 \\\n3\n", "fails", "1 of area 0.5 from 0 0 0"},
        {square + "f 1// 2// 3//\n", "fails", "1 of area 0.5 from 0 0 0"},
        {square + "f 1/ 2/ 3/\n", "fails", "1 of area 0.5 from 0 0 0"},
        {square + "f 1/0/0 2/0/0 3/0/0\n", "fails", "1 of area 0.5 from 0 0 0"},
        {square + "f 1 2 3x\n", "1 of area 0.5 from 0 0 0", ":5:7: '3x' is not an integer"},
        {square + "f 1.0 2.0 3.0\n", "1 of area 0.5 from 0 0 0", ":5:3: '1.0' is not an integer"},
        {square + "f 1 2 4294967299\n", "1 of area 0.5 from 0 0 0", ":5:7: '4294967299' is too large for an integer"},
        {square + "f 1 2 3/1/1/1\n", "fails", ":5:7: '3/1/1/1' has more than vertex/texture/normal"},
        {"\xef\xbb\xbf" + square + "f 1 2 3\n", "1 of area 0.5 from 1 0 0", "1 of area 0.5 from 0 0 0"},
        {square + "F 1 2 3\n", "0 of area 0 from 0 0 0", "0 of area 0 from 0 0 0"},
        // Indices out of range: ObjReader
        {square + "f 1 2 9\n", "index 8 of 4", ":5:7: vertex index 9 is out of range: the file has 4"},
        {square + "f 1 2 -9\n", "index -5 of 4", ":5:7: vertex index -9 is out of range: 4 so far"},
        {square + "f 1 2 0\n", "fails", ":5:7: vertex index 0 is out of range: 4 so far"},
        // Numbers: from ObjStatements
        {"v 0.7654321 0 0\n" + two + "f 1 2 3\n", "1 of area 0.117284 from 0.7654320999999998 0 0",
         "1 of area 0.117284 from 0.7654321 0 0"},
        {"v abc 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", ":1:3: 'abc' is not a number"},
        {"v nan 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0",
         ":1:3: 'nan' is not a finite number in single precision"},
        {"v -inf 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0",
         ":1:3: '-inf' is not a finite number in single precision"},
        {"v 0x10 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", ":1:3: '0x10' is not a number"},
        {"v 2e 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", ":1:3: '2e' is not a number"},
        {"v ++2 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", ":1:3: '++2' is not a number"},
        {"v 2d3 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 2 0 0", ":1:3: '2d3' is not a number"},
        {"v 2,5 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 2 0 0", ":1:3: '2,5' is not a number"},
        {"v 2_0 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 2 0 0", ":1:3: '2_0' is not a number"},
        {"v 2.5.5 0 0\n" + two + "f 1 2 3\n", "1 of area 0.75 from 2.5 0 0", ":1:3: '2.5.5' is not a number"},
        {"v 0.1f 0 0\n" + two + "f 1 2 3\n", "1 of area 0.45 from 0.1 0 0", ":1:3: '0.1f' is not a number"},
        {"v 1e400 0 0\n" + two + "f 1 2 3\n", "1 of area 0 from inf 0 0",
         ":1:3: '1e400' is not a finite number in single precision"},
        {"v 1e-400 0 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 0 0 0", "1 of area 0.5 from 0 0 0"},
        {"v 2 0\n" + two + "f 1 2 3\n", "1 of area 0.5 from 2 0 0", ":1:1: 'v' needs three numbers"},
        {"v 2 0 0 0.5\n" + two + "f 1 2 3\n", "1 of area 0.5 from 2 0 0", "1 of area 0.5 from 2 0 0"},
    };
    for (const Habit &habit : habits) {
        INFO(habit.text);
        CHECK(library_reads(habit.text) == habit.library);
        std::string opal;
        const std::string error = error_of([&] {
            const TriangleMesh mesh = read(habit.text);
            std::vector<std::array<Vec3, 3>> triangles;
            for (const auto &[a, b, c] : mesh.triangles)
                triangles.push_back(
                    {mesh.positions[a.position], mesh.positions[b.position], mesh.positions[c.position]});
            opal = summary(triangles);
        });
        CHECK((error.empty() ? opal : error.substr(file().size())) == habit.opal);
    }

    // It counts corners in eight bits where it does not triangulate; its callbacks count in 32.
    std::string circle, face = "f";
    for (int i = 0; i < 300; ++i) {
        circle += fmt::format("v {} {} 0\n", std::cos(2 * M_PI * i / 300), std::sin(2 * M_PI * i / 300));
        face += " " + std::to_string(i + 1);
    }
    tinyobj::ObjReader reader;
    tinyobj::ObjReaderConfig config;
    config.triangulate = false;
    REQUIRE(reader.ParseFromString(circle + face + "\n", "", config));
    CHECK(reader.GetShapes()[0].mesh.num_face_vertices[0] == 300 - 256);
    CHECK(read(circle + face + "\n").triangles.size() == 298);

    // It cuts the names of materials at blanks.
    const std::string red = "mtllib a.mtl\n" + square + "usemtl my red\nf 1 2 3\n";
    REQUIRE(reader.ParseFromString(red, "newmtl my red\nKd 1 0 0\n"));
    CHECK(reader.GetShapes()[0].mesh.material_ids[0] == -1);
    CHECK(read_obj(scratch.write("a.obj", red), {}).materials[0].name == "my red");
}

TEST_CASE_METHOD(ObjFixture, "a spoilt file is read, or an error, and nothing else", "[obj]") {
    const std::string whole =
        "# all statements\nmtllib a b.mtl\no thing\n" + square +
        "v 0.5 0.5 1e-3 1 0 0\nvt 0.5 0.25\nvt 1 0 0\nvn 0 0 1\nvn nan 0 -1e2\n"
        "g a b\ns 1\nusemtl my red\nf 1 2 3 4 5\nf 1/1 2/2 3/-1 # comment\nf 1//1 2//2 -3//-1\n"
        "usemtl blue\nf 1/1/1 \\\n 3/2/2 4/0/0\nf 1/ 2// 3\nl 1 2\np 1\nF 1 2 3\nf 7 8 9\nv 2 0 0\n"
        "v 2 1 0\nv 3 3 .5\nvp 0\n";
    const std::string tokens[] = {"-1",
                                  "0",
                                  "99999999999",
                                  "1e400",
                                  "1e-400",
                                  "nan",
                                  "/",
                                  "//",
                                  "\\\n",
                                  "#",
                                  "\r",
                                  "f",
                                  "v",
                                  "usemtl",
                                  std::string(1, '\0'),
                                  "\xff",
                                  "\xef\xbb\xbf",
                                  std::string(300, '1')};
    std::mt19937 random(1);
    const auto below = [&](size_t count) { return size_t(random() % count); };
    size_t read_count = 0, refused = 0;
    for (int i = 0; i < 500; ++i) {
        std::string text = whole;
        for (size_t changes = 1 + below(3); changes > 0; --changes) {
            const size_t at = below(text.size());
            const size_t line = text.rfind('\n', at) + 1; // 0 in the first
            const size_t line_end = std::min(text.find('\n', at), text.size() - 1) + 1;
            switch (below(5)) {
            case 0:
                text[at] = char(random());
                break;
            case 1:
                text.erase(line, line_end - line);
                break;
            case 2:
                text.insert(line, std::string(text, line, line_end - line));
                break;
            case 3:
                text.insert(at, tokens[below(std::size(tokens))]);
                break;
            default:
                text.resize(at + 1);
            }
            if (text.empty())
                text = "\n";
        }
        INFO(text);
        const std::string error = error_of([&] {
            const ObjFile obj = read_obj(scratch.write("a.obj", text), {});
            for (const auto &triangle : obj.mesh.triangles)
                for (const TriangleMesh::Corner &corner : triangle) {
                    REQUIRE(corner.position < obj.mesh.positions.size());
                    REQUIRE((corner.normal == OPAL_NONE || corner.normal < obj.mesh.normals.size()));
                }
            REQUIRE((obj.mesh.uv_corners.empty() || obj.mesh.uv_corners.size() == obj.mesh.triangles.size()));
            for (const ObjMaterialRun &run : obj.material_runs)
                REQUIRE(run.first < obj.mesh.triangles.size());
        });
        ++(error.empty() ? read_count : refused);
        CHECK((error.empty() || error.starts_with(file() + ":")));
    }
    CHECK(read_count > 100);
    CHECK(refused > 100);
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
    CHECK(warnings().back() ==
          file() + ":10:1: dropped 4 triangles without area, in height below 1.9e-15 of the mesh's size, kept 2");
    read(square + "g first\nf 1 2 3\no the second \nf 1 1 2\ng third\nf 1 2 2\n");
    CHECK(warnings().back() == file() + ":8:1: dropped 2 triangles without area, in height below 8.9e-16 of the mesh's "
                                        "size, the first in 'the second', kept 1");
    read(square + "f 1 2 3\nf\nf 1\n");
    CHECK(warnings().back() == file() + ":6:1: dropped 2 triangles without area, kept 1");
}

TEST_CASE_METHOD(ObjFixture, "small and thin triangles are kept", "[obj]") {
    size_t before = warnings().size();
    CHECK(read("v 1000 0 0\nv 1000.000001 0 0\nv 1000 0.000001 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(read("v 0 0 0\nv 1 0 0\nv 0.5 1e-9 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(read("v 0 0 0\nv 1e-20 0 0\nv 0 1e-20 0\nf 1 2 3\n").triangles.size() == 1);
    CHECK(warnings().size() == before);
}

TEST_CASE_METHOD(ObjFixture, "a file without triangles is an empty mesh, with a warning", "[obj]") {
    const std::string empty = ": holds no triangles, so it is neither seen nor a light";
    for (const std::string text : {"", "\n", "# only words\n", "v 0 0 0\n", "v 0 0 0\np 1\n", "s 1\n",
                                   "v 0 0 0\nv 1 0 0\nl 1 2\n", "vt 1 1\nvn 0 0 1\n"}) {
        INFO(text);
        const size_t before = warnings().size();
        const TriangleMesh mesh = read(text);
        CHECK(mesh.triangles.empty());
        CHECK(mesh.positions.empty());
        CHECK(mesh.extent().empty());
        REQUIRE(warnings().size() == before + 1);
        CHECK(warnings().back() == file() + empty);
    }
    read(square + "f 1 1 2\nf 3 3 3\n");
    CHECK(warnings().back() == file() + empty + ": dropped 2 triangles without area");
}

TEST_CASE_METHOD(ObjFixture, "text that has no statement of an OBJ is told apart", "[obj]") {
    CHECK(error_in("\nDear reader,\nv1 is not v 1\n") ==
          ":2:1: is no OBJ file: it has no statement of one, but 'Dear'");
    CHECK(error_in("Dear reader,\nf\n") == "");
}

TEST_CASE_METHOD(ObjFixture, "indices out of range fail at their place", "[obj]") {
    CHECK(error_in(square + "f 1 2 3\nf 1 2 5\n") == ":6:7: vertex index 5 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 \\\n 5\n") == ":6:2: vertex index 5 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 0\n") == ":5:7: vertex index 0 is out of range: 4 so far");
    CHECK(error_in(square + "f 1 2 -5\n") == ":5:7: vertex index -5 is out of range: 4 so far");
    CHECK(error_in(square + "f -2147483648 2 3\n") == ":5:3: vertex index -2147483648 is out of range: 4 so far");
    CHECK(error_in(square + "vn 0 0 1\nf 1//1 2//-2 3//1\n") == ":6:8: normal index -2 is out of range: 1 so far");
    CHECK(error_in(square + "vt 0 0\nf 1/-2 2/1 3/1\n") == ":6:3: texture index -2 is out of range: 1 so far");
    CHECK(error_in("f 1 2 3\n" + square + "f 1 2 -5\n") == ":6:7: vertex index -5 is out of range: 4 so far");
    CHECK(error_in("f 1 2 5\n" + square) == ":1:7: vertex index 5 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 2147483647\n") == ":5:7: vertex index 2147483647 is out of range: the file has 4");
    CHECK(error_in(square + "f 1 2 99999999999\n") == ":5:7: '99999999999' is too large for an integer");
}

TEST_CASE_METHOD(ObjFixture, "malformed numbers fail at their place", "[obj]") {
    CHECK(error_in("v 0 0 0\nv nan 0 0\n") == ":2:3: 'nan' is not a finite number in single precision");
    CHECK(error_in("v 0 0 0\n\nv 0 inf 0\n") == ":3:5: 'inf' is not a finite number in single precision");
    CHECK(error_in("v 1e39 0 0\n") == ":1:3: '1e39' is not a finite number in single precision");
    CHECK(error_in("  v 0 0\n") == ":1:3: 'v' needs three numbers");
    CHECK(error_in("v 0 0 1,5\n") == ":1:7: '1,5' is not a number");
    CHECK(error_in("v 0 1.#IND 0\n") == ":1:5: '1.#IND' is not a number");
    CHECK(error_in("vn 0 1e400 1\n") == ":1:6: '1e400' is not a finite number in single precision");
    CHECK(error_in("vn 0 1\n") == ":1:1: 'vn' needs three numbers");
    CHECK(error_in("vn 0 nan1 1\n") == ":1:6: 'nan1' is not a number");
    CHECK(error_in("vt\n") == ":1:1: 'vt' needs a number");
    CHECK(error_in("vt 0 O\n") == ":1:6: 'O' is not a number");
    CHECK(error_in(square + "f 1 2 x\n") == ":5:7: 'x' is not an integer");
    CHECK(error_in(square + "f 1 2 \\\n /1\n") == ":6:2: '' is not an integer");
    CHECK(error_in(square + "f 1 2 1/1/1/1\n") == ":5:7: '1/1/1/1' has more than vertex/texture/normal");
}

TEST_CASE_METHOD(ObjFixture, "numbers too small for a double are 0", "[obj]") {
    const size_t before = warnings().size();
    const TriangleMesh mesh = read("v 1e-400 -1e-400 1e-310\nv 1 0 +1e-999999999999\nv 0 1 0\nf 1 2 3\n");
    CHECK(mesh.positions[0].x == 0);
    CHECK(mesh.positions[0].y == 0);
    CHECK(mesh.positions[0].z == 1e-310);
    CHECK(mesh.positions[1].z == 0);
    CHECK(warnings().size() == before);
    CHECK(error_in("v 1e400 0 0\n") == ":1:3: '1e400' is not a finite number in single precision");
    CHECK(error_in("v -1e999999999999 0 0\n") == ":1:3: '-1e999999999999' is not a finite number in single precision");
}

TEST_CASE_METHOD(ObjFixture, "indices of normals and texture coordinates that mean none are warned of once", "[obj]") {
    const std::string elements = square + "vt 0 0\nvn 0 0 1\n";
    const auto check = [&](const std::string &text, const std::string &warning) {
        INFO(text);
        const size_t before = warnings().size();
        const TriangleMesh mesh = read(text);
        REQUIRE(mesh.triangles.size() == 2);
        for (const auto &triangle : mesh.triangles)
            CHECK(triangle[0].normal == OPAL_NONE);
        REQUIRE(warnings().size() == before + 1);
        CHECK(warnings().back() == file() + warning);
        return mesh;
    };
    const std::string none = ": no normal or texture coordinate has this index: the corner has none";
    check(square + "f 1 2 3\nf 1//1 2//2 3//3\n", ":6:3" + none + " (3 in the file)"); // no vn at all
    check(square + "f 1/1/1 2/2/1 3/3/1 4/4/1\n", ":5:3" + none + " (8 in the file)"); // neither vt nor vn
    check(square + "f 1/0/0 2/0 3//0 4\n", ":5:3" + none + " (4 in the file)");
    const TriangleMesh past = check(elements + "f 1//2 2//1 3//1\nf 1 3/1/1 4//1\n", ":7:3" + none);
    CHECK(past.triangles[0][1].normal == 0);
    CHECK(past.uv_corners[0][0] == OPAL_NONE);
    CHECK(past.uv_corners[1][1] == 0);
    check(elements + "f 1/2/-0 2 3 4\n", ":7:3" + none + " (2 in the file)");
    const size_t before = warnings().size();
    read(elements + "f 1/ 2// 3/1/\n");    // left out: nothing to warn of
    read("f 1//1 2//1 3//1\n" + elements); // later in the file
    CHECK(warnings().size() == before);
}

TEST_CASE_METHOD(ObjFixture, "normals and texture coordinates that are not finite are missing", "[obj]") {
    const size_t before = warnings().size();
    const TriangleMesh mesh =
        read(square + "vn 0 0 1\nvn nan -NaN nan(ind)\nvn 0 -inf 1\nvn -1.#IND 1.#QNAN0 1.#INF # comment\nvt 0.5 nan\n"
                      "vt 0.5 0.25 nan\nf 1/1/1 2//2 3//3\nf 1/1/1 3/2/4 4//1\n");
    REQUIRE(mesh.triangles.size() == 2);
    REQUIRE(mesh.normals.size() == 1);
    CHECK(mesh.triangles[0][0].normal == 0);
    CHECK(mesh.triangles[0][1].normal == OPAL_NONE);
    CHECK(mesh.triangles[0][2].normal == OPAL_NONE);
    CHECK(mesh.triangles[1][1].normal == OPAL_NONE);
    CHECK(mesh.triangles[1][2].normal == 0);
    REQUIRE(mesh.uvs.size() == 1);
    CHECK(mesh.uvs[0] == std::array<float, 2>{0.5f, 0.25f});
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() == file() + ":6:1: a normal or texture coordinate is not finite: corners that name it have "
                                        "none (4 in the file)");
}

TEST_CASE_METHOD(ObjFixture, "texture coordinates are kept where triangles have them", "[obj]") {
    const TriangleMesh mesh = read(square + "vt 9 9\nvt 0.1 0.2 0.3\nvt 0.7\nf 1 2 3\nf 1/2 3/-1 4\n");
    REQUIRE(mesh.uvs.size() == 2);
    CHECK(mesh.uvs[0] == std::array<float, 2>{0.1f, 0.2f});
    CHECK(mesh.uvs[1] == std::array<float, 2>{0.7f, 0});
    REQUIRE(mesh.uv_corners.size() == 2);
    CHECK(mesh.uv_corners[0] == std::array<unsigned, 3>{OPAL_NONE, OPAL_NONE, OPAL_NONE});
    CHECK(mesh.uv_corners[1] == std::array<unsigned, 3>{0, 1, OPAL_NONE});
    CHECK(mesh.text() == "2 triangles with uv");
    const TriangleMesh moved = mesh.moved(Transform::scale({2, 2, 2}));
    CHECK(moved.uvs == mesh.uvs);
    CHECK(moved.uv_corners == mesh.uv_corners);
    CHECK(mesh.parts({{1}}).at(0).uvs == mesh.uvs);
    CHECK(mesh.parts({{1}}).at(0).uv_corners == decltype(mesh.uv_corners){{0, 1, OPAL_NONE}});
    CHECK(mesh.parts({{0}}).at(0).uv_corners.empty());
    const TriangleMesh unused = read(square + "vt 0 0\nf 1 2 3\n");
    CHECK(unused.uvs.empty());
    CHECK(unused.uv_corners.empty());
    CHECK(unused.text() == "1 triangles");
}

TEST_CASE_METHOD(ObjFixture, "a face before its elements means what it means behind them", "[obj]") {
    const std::string elements = square + "vt 0 0\nvt 1 0\nvn 0 0 1\nusemtl a\n";
    const ObjFile first = read_obj(scratch.write("b.obj", "f 1 2/2 3//1\nf 1/1/1 3 4\n" + elements), {});
    const ObjFile last = read_obj(scratch.write("c.obj", elements + "f 1 2/2 3//1\nf 1/1/1 3 4\n"), {});
    REQUIRE(first.mesh.triangles.size() == 2);
    for (size_t i = 0; i < 2; ++i)
        for (size_t k = 0; k < 3; ++k) {
            CHECK(first.mesh.triangles[i][k].position == last.mesh.triangles[i][k].position);
            CHECK(first.mesh.triangles[i][k].normal == last.mesh.triangles[i][k].normal);
        }
    CHECK(first.mesh.uvs == last.mesh.uvs);
    CHECK(first.mesh.uv_corners == last.mesh.uv_corners);
    REQUIRE(first.material_runs.size() == 1);
    CHECK(first.material_runs[0].material == OPAL_NONE);
    REQUIRE(last.material_runs.size() == 1);
    CHECK(last.material_runs[0].material == 0);
}

TEST_CASE_METHOD(ObjFixture, "a file of megabytes is read again for a face before its elements", "[obj]") {
    std::string padding; // its pages leave memory while it is read
    for (int i = 0; i < 100000; ++i)
        padding += "o a part with a number of its own\n";
    const TriangleMesh mesh = read("f 4 3 2\n" + padding + square + padding + "f 1 2 3\n");
    REQUIRE(mesh.triangles.size() == 2);
    CHECK(mesh.positions.size() == 4);
    CHECK_THAT(error_of([&] { read(padding + square + padding + "f 1 2 9\n"); }),
               Catch::StartsWith(file() + ":200005:7: vertex index 9 is out of range: the file has 4"));
}

TEST_CASE_METHOD(ObjFixture, "what is left out of a file is noted once, unless --quiet", "[obj]") {
    scratch.write("a.obj",
                  "# v\nv 0 0 0 1\nv 1 0 0 0.5 0.5 0.5\nv 0 1 0 1 1 1 1\ng a\ns 1\nvp 1\nmg 1\nl 1 2\ncurv 0 1 1 2\n"
                  "f 1 2 3\nF 1 2 3\nV 1 1 1\n fo 1 2 3\n");
    const auto scene = scratch.write(
        "a.xml", "<scene><camera type='perspective'/><mesh type='obj'><string name='filename' "
                 "value='a.obj'/><emitter type='area'><color name='radiance' value='1 1 1'/></emitter></mesh></scene>");
    const std::string command = std::string(OPAL_BINARY) + " inspect " + scene.string();
    const std::string notes = test::run_shell(command).err;
    CHECK_THAT(notes, Catch::Contains(
                          "note: " + file() +
                          ":2:9: further numbers of a vertex, a weight or a colour, are ignored (3 in the file)\n"));
    CHECK_THAT(notes,
               Catch::Contains("note: " + file() +
                               ":9:1: statement 'l' is ignored: only faces are read as surfaces (2 in the file)\n"));
    CHECK_THAT(notes, Catch::Contains("note: " + file() + ":12:1: unknown statement 'F' is ignored (3 in the file)\n"));
    CHECK_THAT(test::run_shell(command + " --quiet").err, !Catch::Contains("note"));
}

TEST_CASE_METHOD(ObjFixture, "names in OBJ files are the rest of the line", "[obj]") {
    const ObjFile obj =
        read_obj(scratch.write("a.obj", square + "mtllib  ./a b.mtl\\\r\n c.mtl\r\nusemtl\tMaterial #25 \r\n"
                                                 "f 1 2 3\nusemtl stra\303\237e.001"),
                 {});
    REQUIRE(obj.libraries.size() == 1);
    CHECK(obj.libraries[0].names == "./a b.mtl  c.mtl");
    REQUIRE(obj.materials.size() == 2);
    CHECK(obj.materials[0].name == "Material #25");
    CHECK(obj.materials[1].name == "stra\303\237e.001");
    CHECK(obj.materials[1].place.text() == file() + ":9:1");
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
    // 1 / 5e-324 is infinite
    TriangleMesh mesh = read(square + "vn 0 0 0\nvn 0 0 1e-30\nvn 0 0 5e-324\nf 1//1 2//2 3//3\n");
    CHECK(mesh.triangles[0][0].normal == OPAL_NONE);
    CHECK(mesh.triangles[0][2].normal == OPAL_NONE);
    REQUIRE(mesh.triangles[0][1].normal == 0);
    CHECK(mesh.normals.size() == 1);
    CHECK(mesh.normals[0].z == 1);
}

TEST_CASE_METHOD(ObjFixture, "a vertex that a transform sends out of range is an error", "[obj]") {
    scratch.write("a.obj", "v 0 0 0\nv 1e20 0 0\nv 0 1 0\nf 1 2 3\n");
    CHECK_THAT(error_of([&] {
                   read_obj(file(), Transform::scale({1e30, 1, 1}));
               }),
               Catch::StartsWith(file() + ":2:1: vertex 2 is not finite"));
}
