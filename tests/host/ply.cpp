#include "read/ply.h"
#include "base/log.h"
#include "read/mitsuba/meshes.h"
#include "read/nori/load.h"
#include "read/obj.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <random>

using namespace opal;
using opal::test::error_of;

namespace {

enum class Format { ascii, little, big };

// Writes PLY files of any types and orders.
struct Writer {
    Format format;
    std::string header, body;

    explicit Writer(Format of) : format(of) {
        const char *names[] = {"ascii", "binary_little_endian", "binary_big_endian"};
        header = fmt::format("ply\nformat {} 1.0\n", names[int(of)]);
    }
    template <class T> void binary(T value) {
        std::array<char, sizeof value> bytes;
        std::memcpy(bytes.data(), &value, sizeof value);
        if ((format == Format::little) != (std::endian::native == std::endian::little))
            std::reverse(bytes.begin(), bytes.end());
        body.append(bytes.data(), bytes.size());
    }
    void number(const std::string &type, double value) {
        if (format == Format::ascii)
            body += fmt::format("{} ", value);
        else if (type == "char" || type == "int8")
            binary(int8_t(value));
        else if (type == "uchar" || type == "uint8")
            binary(uint8_t(value));
        else if (type == "short" || type == "int16")
            binary(int16_t(value));
        else if (type == "ushort" || type == "uint16")
            binary(uint16_t(value));
        else if (type == "int" || type == "int32")
            binary(int32_t(value));
        else if (type == "uint" || type == "uint32")
            binary(uint32_t(value));
        else if (type == "int64")
            binary(int64_t(value));
        else if (type == "uint64")
            binary(uint64_t(value));
        else if (type == "float" || type == "float32")
            binary(float(value));
        else
            binary(value);
    }
    void end_element() {
        if (format == Format::ascii)
            body += "\n";
    }
    std::string text() const { return header + "end_header\n" + body; }
};

struct PlyFixture {
    test::ScratchFolder scratch;
    PlyFixture() { set_quiet(true); } // notes of hundreds of files
    ~PlyFixture() { set_quiet(false); }
    std::string file() const { return (scratch / "a.ply").string(); }
    TriangleMesh read(const std::string &text, const Transform &to_world = {}) const {
        return read_ply(scratch.write("a.ply", text), to_world);
    }
    // The error without the file's name, which leads.
    std::string error_in(const std::string &text) const {
        const std::string error = error_of([&] { read(text); });
        return error.starts_with(file()) ? error.substr(file().size()) : error;
    }
    // The warnings, likewise.
    std::vector<std::string> told(const std::string &text, const Transform &to_world = {}) const {
        forget_warnings();
        read(text, to_world);
        std::vector<std::string> lines = warnings();
        forget_warnings();
        for (std::string &line : lines)
            if (line.starts_with(file()))
                line.erase(0, file().size());
        return lines;
    }
};

Vec3 at(const TriangleMesh &mesh, size_t triangle, int corner) {
    return mesh.positions[mesh.triangles[triangle][size_t(corner)].position];
}

// The sum of the triangles' area vectors, and of the areas.
std::pair<Vec3, double> areas(const TriangleMesh &mesh) {
    Vec3 vector;
    double sum = 0;
    for (size_t i = 0; i < mesh.triangles.size(); ++i) {
        const Vec3 doubled = cross(at(mesh, i, 1) - at(mesh, i, 0), at(mesh, i, 2) - at(mesh, i, 0));
        vector = vector + doubled * 0.5;
        sum += length(doubled) / 2;
    }
    return {vector, sum};
}

// Every index in range, all normals unit.
void require_sound(const TriangleMesh &mesh) {
    for (const auto &triangle : mesh.triangles)
        for (const TriangleMesh::Corner &corner : triangle) {
            REQUIRE(corner.position < mesh.positions.size());
            REQUIRE((corner.normal == OPAL_NONE || corner.normal < mesh.normals.size()));
        }
    for (const Vec3 &normal : mesh.normals)
        REQUIRE(std::abs(length(normal) - 1) < 1e-12);
    REQUIRE((mesh.uv_corners.empty() || mesh.uv_corners.size() == mesh.triangles.size()));
    for (const auto &corners : mesh.uv_corners)
        for (unsigned corner : corners)
            REQUIRE((corner == OPAL_NONE || corner < mesh.uvs.size()));
}

// A pyramid without a bottom but for one triangle of it: a quad as its base is cut, and mixed with triangles.
constexpr double corners[5][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 1, 1.5}};
const std::vector<std::vector<int>> pyramid = {{3, 2, 1, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
const double pyramid_area = 4 + 4 * std::sqrt(1 + 1.5 * 1.5);

const std::string head = "ply\nformat ascii 1.0\n";
const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string normal_properties = "property float nx\nproperty float ny\nproperty float nz\n";
std::string vertices(int count, const std::string &more = "") {
    return fmt::format("element vertex {}\n", count) + xyz + more;
}
std::string faces(int count, const std::string &more = "") {
    return fmt::format("element face {}\nproperty list uchar int vertex_indices\n", count) + more;
}
const std::string end = "end_header\n";
const std::string three = "0 0 0\n1 0 0\n0 1 0\n", four = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";

} // namespace

TEST_CASE_METHOD(PlyFixture, "all formats, types and orders of a PLY file give one mesh", "[ply]") {
    std::mt19937 random(3);
    const auto one_of = [&](const std::vector<std::string> &all) { return all[random() % all.size()]; };
    const std::vector<std::string> whole = {"char",  "uchar", "short",  "ushort", "int",    "uint",  "int8",
                                            "uint8", "int16", "uint16", "int32",  "uint32", "int64", "uint64"};
    const std::vector<std::string> real = {"float", "double", "float32", "float64"};
    for (int i = 0; i < 300; ++i) {
        Writer writer(Format(i % 3));
        // Fields of a vertex in any order, some numbers and lists that are not used between them.
        std::vector<std::string> fields = {"x", "y", "z", "red", "a list"};
        const bool has_normals = random() % 2, has_uvs = random() % 2;
        if (has_normals)
            fields.insert(fields.end(), {"nx", "ny", "nz"});
        const std::vector<std::string> uv =
            std::vector<std::vector<std::string>>{{"u", "v"}, {"s", "t"}, {"texture_u", "texture_v"}}[random() % 3];
        if (has_uvs)
            fields.insert(fields.end(), uv.begin(), uv.end());
        std::shuffle(fields.begin(), fields.end(), random);
        std::vector<std::string> types;
        for (const std::string &field : fields)
            types.push_back(field == "red" ? one_of(whole) : one_of(real));
        const std::string length_type = one_of(whole), index_type = one_of(whole),
                          name = one_of({"vertex_indices", "vertex_index"});

        const auto write_vertices = [&] {
            writer.header += fmt::format("element vertex {}\n", std::size(corners));
            for (size_t f = 0; f < fields.size(); ++f)
                writer.header += fields[f] == "a list"
                                     ? fmt::format("property list {} {} more\n", length_type, types[f])
                                     : fmt::format("property {} {}\n", types[f], fields[f]);
            for (const auto &corner : corners) {
                for (size_t f = 0; f < fields.size(); ++f) {
                    if (fields[f] == "a list") {
                        const unsigned count = random() % 4;
                        writer.number(length_type, count);
                        for (unsigned k = 0; k < count; ++k)
                            writer.number(types[f], 7);
                    } else if (fields[f] == "red") {
                        writer.number(types[f], 100);
                    } else if (fields[f].size() == 1 && fields[f][0] >= 'x') {
                        writer.number(types[f], corner[fields[f][0] - 'x']);
                    } else if (fields[f][0] == 'n') {
                        writer.number(types[f], fields[f] == "nz" ? 4 : 0);
                    } else {
                        writer.number(types[f], fields[f] == uv[0] ? 0.25 : 0.75);
                    }
                }
                writer.end_element();
            }
        };
        const auto write_faces = [&] {
            writer.header += fmt::format("element face {}\nproperty {} flags\nproperty list {} {} {}\n", pyramid.size(),
                                         types[0], length_type, index_type, name);
            for (const auto &face : pyramid) {
                writer.number(types[0], 5);
                writer.number(length_type, double(face.size()));
                for (int index : face)
                    writer.number(index_type, index);
                writer.end_element();
            }
        };
        const auto write_others = [&] {
            writer.header += "comment x\nobj_info y z\nelement edge 2\nproperty int vertex1\nproperty double w\n";
            for (int e = 0; e < 2; ++e) {
                writer.number("int", -1);
                writer.number("double", 1e300);
                writer.end_element();
            }
        };
        std::vector<std::function<void()>> parts = {write_vertices, write_faces, write_others};
        std::shuffle(parts.begin(), parts.end(), random);
        for (const auto &part : parts)
            part();

        INFO(writer.text());
        const TriangleMesh mesh = read(writer.text());
        require_sound(mesh);
        REQUIRE(mesh.triangles.size() == 6);
        CHECK(mesh.positions.size() == 5);
        const auto [vector, sum] = areas(mesh);
        CHECK(std::abs(sum - pyramid_area) < 1e-12);
        CHECK(length(vector) < 1e-12);
        CHECK(mesh.normals.size() == (has_normals ? 5 : 0));
        if (has_normals)
            CHECK(mesh.normals[0].z == 1);
        CHECK(mesh.uvs.size() == (has_uvs ? 5 : 0));
        if (has_uvs)
            CHECK(mesh.uvs[0] == std::array<float, 2>{0.25f, 0.75f});
    }
}

TEST_CASE_METHOD(PlyFixture, "coordinates are read in double, and moved by the transform", "[ply]") {
    const std::string text = head + vertices(3, normal_properties) + faces(1) + end +
                             "0.1 1e-9 -3.25E2 0 0 1\n+1 .5 2. 0 0 1\n0 1 123456.789012345 0 0 1\n3 0 1 2\n";
    const TriangleMesh mesh = read(text);
    CHECK(mesh.positions[0].x == 0.1);
    CHECK(mesh.positions[0].y == 1e-9);
    CHECK(mesh.positions[0].z == -325);
    CHECK(mesh.positions[1].x == 1);
    CHECK(mesh.positions[2].z == 123456.789012345);
    // Normals follow the inverse transpose; their side stays where a transform mirrors.
    const TriangleMesh moved = read(head + vertices(3, normal_properties) + faces(1) + end +
                                        "0 0 0 1 0 1\n1 0 0 1 0 1\n0 1 0 1 0 1\n3 0 1 2\n",
                                    Transform::translate({5, 0, 0}) * Transform::scale({-2, 1, 1}));
    CHECK(moved.positions[1].x == 3);
    CHECK(std::abs(moved.normals[0].x + 0.5 / std::sqrt(1.25)) < 1e-15);
    CHECK(std::abs(moved.normals[0].z - 1 / std::sqrt(1.25)) < 1e-15);
}

TEST_CASE_METHOD(PlyFixture, "PLY files as programs write them", "[ply]") {
    // Blank lines, ends of Windows, blanks behind, no line end in the last line, a byte order mark.
    CHECK(read("\xef\xbb\xbfply  \r\nformat ascii 1.0\t\r\n\r\ncomment\r\nobj_info  by hand \xff\r\n"
               "element vertex 3  \r\nproperty float32 x\r\nproperty float32 y \r\nproperty float32 z\r\n"
               "element face 1\r\nproperty list uint8 int32 vertex_index\r\nend_header \r\n"
               "\r\n0 0 0 \r\n\t1 0 0\r\n  0\t1 0\r\n\r\n3 0 1 2")
              .triangles.size() == 1);
    // MeshLab: two kinds of uv, of which those of the vertices are read, and colours of faces.
    const TriangleMesh meshlab = read(head + vertices(3, "property float texture_u\nproperty float texture_v\n") +
                                      faces(1, "property list uchar float texcoord\nproperty uchar red\n") + end +
                                      "0 0 0 .5 1\n1 0 0 1 1\n0 1 0 .5 0\n3 0 1 2 6 0 0 1 0 0 1 255\n");
    CHECK(meshlab.uvs[0] == std::array<float, 2>{0.5f, 1});
    CHECK(meshlab.uv_corners[0] == std::array<unsigned, 3>{0, 1, 2});
    // Half of a pair is none; of two pairs the first is read.
    CHECK(read(head + vertices(3, "property float u\nproperty float t\nproperty float nx\n") + faces(1) + end +
               "0 0 0 1 1 1\n1 0 0 1 1 1\n0 1 0 1 1 1\n3 0 1 2\n")
              .uvs.empty());
    CHECK(read(head + vertices(3, "property float s\nproperty float t\nproperty float v\nproperty float u\n") +
               faces(1) + end + "0 0 0 1 2 3 4\n1 0 0 1 2 3 4\n0 1 0 1 2 3 4\n3 0 1 2\n")
              .uvs[0] == std::array<float, 2>{4, 3});
    // A concave quad is cut at its reflex corner, and a vertex that no face has is left out.
    const TriangleMesh concave =
        read(head + vertices(5) + faces(1) + end + "-1 0 0\n0 1 0\n1 0 0\n9 9 9\n0 10 0\n4 0 1 2 4\n");
    CHECK(areas(concave).second == 9);
    CHECK(areas(concave).first.z == 9);
    CHECK(concave.positions.size() == 4);
}

TEST_CASE_METHOD(PlyFixture, "degenerate triangles and points alone are told", "[ply]") {
    using Lines = std::vector<std::string>;
    CHECK(told(head + vertices(4) + faces(4) + end + four + "3 0 1 2\n3 0 1 1\n2 0 1\n0\n") ==
          Lines{":15:1: dropped 3 triangles without area, in height below 8.9e-16 of the mesh's size, kept 1"});
    CHECK(told(head + vertices(3) + end + three) == Lines{": holds no triangles, so it is neither seen nor a light"});
    CHECK(told("ply\nformat ascii 1.0\nelement vertex 0\nend_header\n").size() == 1);
    CHECK(told(head + vertices(3) + faces(1) + end + three + "3 0 0 1\n") ==
          Lines{": holds no triangles, so it is neither seen nor a light: dropped 1 triangles without area"});
    CHECK(told(head + vertices(3) + faces(1) + end + three + "3 0 1 2\n").empty());
}

TEST_CASE_METHOD(PlyFixture, "normals on the back of every face are told, as in Blender's mirrored objects", "[ply]") {
    const auto file_of = [](const std::string &first, const std::string &second) {
        return head + vertices(4, normal_properties) + faces(2) + end + "0 0 0 " + first + "\n1 0 0 " + first +
               "\n1 1 0 " + first + "\n0 0 1 " + second + "\n3 0 1 2\n3 3 3 0\n";
    };
    const auto count = [&](const std::string &text, const Transform &to_world = {}) {
        const auto lines = told(text, to_world);
        return std::count_if(lines.begin(), lines.end(), [](const std::string &line) {
            return line.starts_with(":10:9: the normals are on the back of every face");
        });
    };
    CHECK(count(file_of("0 0 -1", "0 0 -1")) == 1);
    CHECK(count(file_of("0 0 1", "0 0 1")) == 0);
    const Transform mirror = Transform::scale({-1, 1, 1}); // the file is told of, not the place
    CHECK(count(file_of("0 0 -1", "0 0 -1"), mirror) == 1);
    CHECK(count(file_of("0 0 1", "0 0 1"), mirror) == 0);
    const std::string two = head + vertices(3, normal_properties) + faces(2) + end;
    CHECK(count(two + "0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2\n3 2 1 0\n") == 0); // on one face
}

TEST_CASE_METHOD(PlyFixture, "normals and uv that are not finite are none", "[ply]") {
    const std::string text = head + vertices(3, normal_properties + "property double s\nproperty double t\n") +
                             faces(1) + end +
                             "0 0 0 nan 0 1 0 0\n1 0 0 0 0 0 1e300 0\n0 1 0 0 0 2 -inf 1.#QNAN\n3 0 1 2\n";
    const std::vector<std::string> lines = told(text);
    REQUIRE(lines.size() == 1);
    CHECK(lines[0] == ":15:1: a normal or texture coordinate is not finite: corners there have none (3 in the file)");
    const TriangleMesh mesh = read(text);
    require_sound(mesh);
    CHECK(mesh.normals.size() == 1);
    CHECK(mesh.triangles[0][0].normal == OPAL_NONE);
    CHECK(mesh.triangles[0][1].normal == OPAL_NONE); // zero
    CHECK(mesh.uvs.size() == 1);
    CHECK(mesh.uv_corners[0] == std::array<unsigned, 3>{0, OPAL_NONE, OPAL_NONE});
    forget_warnings();
}

TEST_CASE_METHOD(PlyFixture, "a mistake in a PLY file of text is one error at its place", "[ply]") {
    const std::string good = head + vertices(3) + faces(1) + end;
    const std::vector<std::pair<std::string, std::string>> rows = {
        // The header
        {"", ":1:1: is no PLY file: it does not begin with a line 'ply'"},
        {"plyx\n", ":1:1: is no PLY file: it does not begin with a line 'ply'"},
        {"ply\n", ":2:1: the file ends before 'end_header'"},
        {"ply\nformat ascii 1.0\nelement vertex 3", ":3:1: the file ends before 'end_header'"},
        {"ply\rformat ascii 1.0\rend_header\r\n",
         ":1:4: lines of the header end with a carriage return alone, as on old Macintoshes"},
        {"ply\nelement vertex 0\nend_header\n", ":3:1: the header has no line 'format'"},
        {"ply\nformat ascii\n", ":2:1: a line 'format ascii 1.0' is expected"},
        {"ply\nformat ascii 1.0 x\n", ":2:18: a line 'format ascii 1.0' is expected"},
        {"ply\nformat ascii 1.1\n", ":2:14: the version is '1.1'; available: 1.0"},
        {"ply\nformat binary 1.0\n", ":2:8: unknown format 'binary'; available: ascii, binary_little_endian, "
                                     "binary_big_endian"},
        {head + "format ascii 1.0\n", ":3:1: a second line 'format'"},
        {head + "elment vertex 3\n", ":3:1: unknown statement of a PLY header 'elment'; did you mean 'element'? "
                                     "available: format, comment, obj_info, element, property, end_header"},
        {head + "property float x\n", ":3:1: a property before the first element"},
        {head + "element vertex -3\n", ":3:16: '-3' is no count of elements"},
        {head + "element vertex 3.0\n", ":3:16: '3.0' is no count of elements"},
        {head + "element vertex 99999999999999999999\n", ":3:16: '99999999999999999999' is no count of elements"},
        {head + "element vertex\n", ":3:1: a line 'element NAME COUNT' is expected"},
        {head + "element vertex 3\nproperty list uchar int\n",
         ":4:1: a line 'property list TYPE TYPE NAME' is expected"},
        {head + "element vertex 3\nproperty float\n", ":4:1: a line 'property TYPE NAME' is expected"},
        {head + "element vertex 3\nproperty list float int a\n", ":4:15: the count of a list is no whole number"},
        {head + "element dust 3\n" + vertices(0) + end, ":3:1: the element has no properties"},
        {head + "element vertex 3\n" + end, ":3:1: the element has no properties"},
        {head + faces(1) + end, ": has no element 'vertex'"},
        {head + vertices(0) + vertices(0) + end, ":7:9: element 'vertex' again"},
        {head + vertices(1, "property int x\n") + end + "0 0 0 0\n", ":7:14: property 'x' again"},
        {head + "element vertex 1\nproperty float x\nproperty float z\n" + end + "0 0\n",
         ":3:9: element 'vertex' needs the properties x, y and z"},
        {head + vertices(0) + "element face 1\nproperty int vertex_indices\n" + end + "0\n",
         ":8:14: 'vertex_indices' is no list of whole numbers"},
        {head + vertices(0) + "element face 1\nproperty list int float vertex_indices\n" + end + "0\n",
         ":8:25: 'vertex_indices' is no list of whole numbers"},
        {head + vertices(0) + "element face 1\nproperty int a\n" + end + "0\n",
         ":7:9: element 'face' needs the list vertex_indices or vertex_index"},
        {head + vertices(0) + faces(1, "property list uchar int vertex_index\n") + end + "0 0\n",
         ":9:25: a second list of corners, 'vertex_index'"},
        {head + vertices(0) + "element tristrips 1\nproperty list int int vertex_indices\n" + end + "0\n",
         ":7:9: triangle strips are not read; open the file in Blender and export it again"},
        // The body: its first line is 10.
        {good + "0.0 0.0 0.0\n1 0 0\n", ":12:1: the file ends before this element"},
        {good + three, ":7:9: 1 times 'face' take at least 2 bytes each, but 0 are left of the file"},
        {good + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", ":11:4: the line ends, but a number of 'z' is expected"},
        {good + "0 0 0\n1 0 0 0\n0 1 0\n3 0 1 2\n", ":11:7: '0' is more than the element has properties"},
        {good + three + "3 0 1\n", ":13:6: the line ends, but a number of 'vertex_indices' is expected"},
        {good + three + "3 0 1 2 0\n", ":13:9: '0' is more than the element has properties"},
        {good + three + "3 0 1 3\n", ":13:1: vertex index 3 is out of range: the file has 3 vertices"},
        {good + three + "3 0 1 -1\n", ":13:1: vertex index -1 is out of range: the file has 3 vertices"},
        {good + three + "3 0 1 4294967296\n", ":13:7: '4294967296' is out of the range of its type"},
        {good + three + "3 0 1 1.0\n", ":13:7: '1.0' is no whole number"},
        {good + three + "300 0 1 2\n", ":13:1: '300' is out of the range of its type"},
        {good + three + "-3 0 1 2\n", ":13:1: '-3' is out of the range of its type"},
        {good + three + "3 0 1 2\n\n 7\n", ":15:1: 2 bytes are left behind the last element"},
        {head + vertices(3) + "element face 1\nproperty list int int vertex_index\n" + end + three + "-3 0 1 2\n",
         ":13:1: 'vertex_index' has -3 numbers"},
        {head + vertices(3) + "element face 1\nproperty list uint int vertex_index\n" + end + three + "4000000000 0\n",
         ":13:13: the line ends, but a number of 'vertex_index' is expected"},
        {good + "0 0 0\n1 0 0\n0 abc 0\n3 0 1 2\n", ":12:3: 'abc' is not a number"},
        {good + "0 0 0\n1 0 0\n0 1,5 0\n3 0 1 2\n", ":12:3: '1,5' is not a number"},
        {good + "0 0 0\n1 0 0\n0 0x10 0\n3 0 1 2\n", ":12:3: '0x10' is not a number"},
        {good + "0 0 0\n1 0 0\n0 ++1 0\n3 0 1 2\n", ":12:3: '++1' is not a number"},
        {good + "0 0 0\n1 0 0\n0 1e400 0\n3 0 1 2\n", ":12:3: '1e400' is not a finite number in single precision"},
        {good + "0 0 0\n1 0 0\n0 nan 0\n3 0 1 2\n",
         ":12:1: vertex 2 is not finite in single precision once transformed"},
        {good + "0 0 0\n1 0 0\n0 1e300 0\n3 0 1 2\n",
         ":12:1: vertex 2 is not finite in single precision once transformed"},
        // Faces before the vertices are checked where they stand.
        {head + faces(2) + vertices(3) + end + "3 0 1 2\n3 0 1 3\n" + three,
         ":11:1: vertex index 3 is out of range: the file has 3 vertices"},
        {head + faces(1) + vertices(3) + end + "3 0 1 x\n" + three, ":10:7: 'x' is no whole number"},
    };
    for (const auto &[text, error] : rows) {
        INFO(text);
        CHECK(error_in(text) == error);
    }
    CHECK(read(good + "0 0 0\n1 0 0\n0 1 1e-400\n3 0 1 2\n").positions[2].z == 0);
    CHECK(error_of([&] {
              read(good + three + "3 0 1 2\n", Transform::scale({1e39, 1, 1}));
          }) == file() + ":11:1: vertex 1 is not finite in single precision once transformed");
    CHECK(error_of([&] { read_ply(scratch / "none.ply", {}); }) ==
          (scratch / "none.ply").string() + ": cannot read: No such file or directory");
    CHECK(error_in("v 0 0 0\nv 1 0 0\nf 1 2 3\n") ==
          ": is a Wavefront OBJ mesh, not a PLY file; its type in a scene is obj");
    forget_warnings();
}

TEST_CASE_METHOD(PlyFixture, "a mistake in a binary PLY file is one error at its byte and element", "[ply]") {
    // The file ends, or has a count or index that is wrong, each in both orders of bytes.
    struct Spoilt {
        double index = 2, length = 3, y = 1;
        size_t cut = 0;        // bytes off the end
        std::string more = ""; // behind the end
        std::string length_type = "uchar", count = "3";
    };
    for (Format format : {Format::little, Format::big}) {
        const auto error_of_file = [&](const Spoilt &spoilt) {
            Writer writer(format);
            writer.header += "element vertex " + spoilt.count + "\n" + xyz + "element face 1\nproperty list " +
                             spoilt.length_type + " int vertex_index\n";
            for (double x : {0., 1., 2.})
                for (double value : {x, x == 2 ? spoilt.y : 0., 0.})
                    writer.number("float", value);
            writer.number(spoilt.length_type, spoilt.length);
            for (double index : {0., 1., spoilt.index})
                writer.number("int", index);
            const std::string text = writer.text();
            // Offsets count from the body's first byte here.
            const size_t begin = text.size() - writer.body.size();
            std::string error = error_in(text.substr(0, text.size() - spoilt.cut) + spoilt.more);
            if (const std::string byte = ": byte "; error.starts_with(byte)) {
                size_t digits = 0;
                const size_t offset = std::stoul(error.substr(byte.size()), &digits);
                error = fmt::format("{}: {}", offset - begin, error.substr(byte.size() + digits));
            }
            return error;
        };
        CHECK(error_of_file({}).empty());
        CHECK(error_of_file({.index = 3}) == "36:  (face 0): vertex index 3 is out of range: the file has 3 vertices");
        CHECK(error_of_file({.index = -1}) ==
              "36:  (face 0): vertex index -1 is out of range: the file has 3 vertices");
        CHECK(error_of_file({.length = 255}) ==
              "37:  (face 0): 'vertex_index' has 255 numbers, but 12 bytes are left of the file");
        CHECK(error_of_file({.length = 4e9, .length_type = "uint"}) ==
              "40:  (face 0): 'vertex_index' has 4000000000 numbers, but 12 bytes are left of the file");
        CHECK(error_of_file({.length = 1e19, .length_type = "uint64"}) ==
              "44:  (face 0): 'vertex_index' has 10000000000000000000 numbers, but 12 bytes are left of the file");
        CHECK(error_of_file({.length = -3, .length_type = "int"}) == "36:  (face 0): 'vertex_index' has -3 numbers");
        CHECK(error_of_file({.y = NAN}) ==
              "24:  (vertex 2): vertex 2 is not finite in single precision once transformed");
        CHECK(error_of_file({.cut = 1}) ==
              "37:  (face 0): 'vertex_index' has 3 numbers, but 11 bytes are left of the file");
        CHECK(error_of_file({.cut = 13}) ==
              ":7:9: 1 times 'face' take at least 1 bytes each, but 0 are left of the file");
        CHECK(error_of_file({.cut = 14}) ==
              ":3:9: 3 times 'vertex' take at least 12 bytes each, but 35 are left of the file");
        CHECK(error_of_file({.more = "\n"}) == "49: : 1 bytes are left behind the last element");
        CHECK(error_of_file({.count = "4000000000"}) ==
              ":3:9: 4000000000 times 'vertex' take at least 12 bytes each, but 49 are left of the file");
        CHECK(error_of_file({.count = "4294967295"}) == ":3:9: 4294967295 vertices are too many: at most 4294967294");
        CHECK(error_of_file({.count = "18446744073709551615"}) ==
              ":3:9: 18446744073709551615 vertices are too many: at most 4294967294");
    }
}

TEST_CASE_METHOD(PlyFixture, "a spoilt PLY file is read, or an error, and nothing else", "[ply]") {
    std::mt19937 random(1);
    const auto below = [&](size_t count) { return size_t(random() % count); };
    const std::string tokens[] = {"-1",
                                  "99999999999",
                                  "nan",
                                  "\n",
                                  "\r",
                                  "list ",
                                  "uchar ",
                                  " ",
                                  "element a 1000000000\n",
                                  "property list uchar int vertex_indices\n",
                                  std::string(1, '\0'),
                                  "\xff"};
    size_t read_count = 0, refused = 0;
    for (int i = 0; i < 1500; ++i) {
        Writer writer(Format(i % 3));
        writer.header += "comment c\n" + vertices(5, "property uchar red\n") +
                         "element face 5\nproperty list uchar int vertex_indices\nproperty float f\n";
        for (const auto &corner : corners) {
            for (double x : corner)
                writer.number("float", x);
            writer.number("uchar", 3);
            writer.end_element();
        }
        for (const auto &face : pyramid) {
            writer.number("uchar", double(face.size()));
            for (int index : face)
                writer.number("int", index);
            writer.number("float", 0.5);
            writer.end_element();
        }
        std::string text = writer.text();
        const size_t change = below(4), spot = below(text.size());
        if (change == 0)
            text[spot] = char(random());
        else if (change == 1)
            text.resize(spot);
        else if (change == 2)
            text.insert(spot, tokens[below(std::size(tokens))]);
        else
            text.erase(spot, 1 + below(8));
        INFO(text);
        const std::string error = error_of([&] { require_sound(read(text)); });
        ++(error.empty() ? read_count : refused);
        CHECK((error.empty() || error.starts_with(file() + ":")));
    }
    forget_warnings();
    CHECK(read_count > 100);
    CHECK(refused > 500);
}

TEST_CASE_METHOD(PlyFixture, "Nori's scenes may have meshes of PLY files", "[ply]") {
    scratch.write("a.ply", head + vertices(4) + faces(1) + end + four + "4 0 1 2 3\n");
    scratch.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n");
    const auto load = [&](const std::string &type, const std::string &name) {
        return load_scene(scratch.write("a.xml", "<scene><camera type='perspective'/><mesh type='" + type +
                                                     "'><string name='filename' value='" + name +
                                                     "'/><transform name='toWorld'><scale value='2 2 "
                                                     "2'/></transform></mesh></scene>"));
    };
    const SceneDescription scene = load("ply", "a.ply");
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].name == "a.ply");
    CHECK(areas(std::get<TriangleMesh>(scene.meshes[0].shape)).second == 4);
    CHECK_THAT(error_of([&] { load("obj", "a.ply"); }),
               Catch::Contains("a.ply: is a PLY mesh, not an OBJ file; its type in a scene is ply (the mesh at "));
    CHECK_THAT(error_of([&] { load("ply", "a.obj"); }),
               Catch::Contains("a.obj: is a Wavefront OBJ mesh, not a PLY file; its type in a scene is obj"));
    forget_warnings();
}

// Names and values as Mitsuba 3.9.1 has them: those of three vertices, or of the face.
TEST_CASE_METHOD(PlyFixture, "attributes have the names that Mitsuba gives them", "[ply]") {
    struct Row {
        std::vector<std::string> properties; // of a vertex i the numbers 10 i + 0, 1, 2 ...
        std::string name;
        std::vector<float> values;
    };
    const std::vector<float> three = {0, 1, 2, 10, 11, 12, 20, 21, 22}, one = {0, 10, 20};
    const std::vector<Row> rows = {
        {{"red", "green", "blue"}, "vertex_color", three},
        {{"r", "g", "b", "a"}, "vertex_color", three},
        {{"blue", "green", "red"}, "vertex_color", {2, 1, 0, 12, 11, 10, 22, 21, 20}},
        {{"red", "green", "blue", "foo_x", "foo_y", "foo_z"}, "vertex_foo", {3, 4, 5, 13, 14, 15, 23, 24, 25}},
        {{"foo_x", "foo_y", "foo_z"}, "vertex_foo", three},
        {{"foo_0", "foo_1", "foo_2"}, "vertex_foo", three},
        {{"foo_1", "foo_2", "foo_3"}, "vertex_foo", three},
        {{"color_0", "color_1", "color_2"}, "vertex_color", three},
        {{"red"}, "vertex_color", {}},
        {{"foo_bar_x", "foo_bar_y", "foo_bar_z"}, "vertex_foo_bar", three},
        {{"foo_r", "foo_g", "foo_b"}, "vertex_foo_color", three},
        {{"vertex_color_r", "vertex_color_g", "vertex_color_b"}, "vertex_vertex_color_color", three},
        {{"foo_x"}, "vertex_foo", one},
        {{"foo_r"}, "vertex_foo_color", one},
        {{"foo_x", "bar_x"}, "vertex_bar", {1, 11, 21}},
        {{"foo_x", "foo_y"}, "vertex_foo", {}},
        {{"red", "green"}, "vertex_color", {}},
        {{"quality"}, "vertex_quality", {}},
        {{"foo_red", "foo_green", "foo_blue"}, "vertex_foo", {}},
        {{"foo_r", "foo_g", "foo_b"}, "vertex_foo", {}},
        {{"red", "green", "blue"}, "face_color", {}},
    };
    for (const Row &row : rows) {
        INFO(row.name << " of " << fmt::format("{}", fmt::join(row.properties, " ")));
        std::string declared, body;
        for (const std::string &property : row.properties)
            declared += "property float " + property + "\n";
        const std::array<const char *, 3> places = {"0 0 0", "1 0 0", "0 1 0"};
        for (size_t i = 0; i < 3; ++i) {
            body += places[i];
            for (size_t k = 0; k < row.properties.size(); ++k)
                body += fmt::format(" {}", 10 * i + k);
            body += "\n";
        }
        const auto file = scratch.write("a.ply", head + vertices(3, declared) + faces(1) + end + body + "3 0 1 2\n");
        const TriangleMesh mesh = read_ply(file, {}, nullptr, std::vector<std::string>{row.name});
        REQUIRE(mesh.attributes.size() == (row.values.empty() ? 0 : 1));
        if (row.values.empty())
            continue;
        CHECK(mesh.attributes[0]->name == row.name);
        CHECK_FALSE(mesh.attributes[0]->of_faces);
        CHECK(std::ranges::equal(mesh.attributes[0]->values, row.values));
    }
    forget_warnings();
}

TEST_CASE_METHOD(PlyFixture, "attributes follow vertices and triangles that are renumbered, cut and dropped", "[ply]") {
    // Vertex 0 is unused; the first face has no area, the last one has four corners.
    const std::string text = head + vertices(6, "property double w_0\n") +
                             "element face 3\nproperty float red\nproperty list uchar int vertex_indices\nproperty "
                             "float green\nproperty float blue\n" +
                             end + "9 9 9 0\n0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0 4\n5 5 5 5\n" +
                             "1 3 1 2 2 2 3\n4 3 4 2 1 5 6\n7 4 1 2 3 4 8 9\n";
    const TriangleMesh mesh =
        read_ply(scratch.write("a.ply", text), {}, nullptr, std::vector<std::string>{"face_color", "vertex_w"});
    REQUIRE(mesh.attributes.size() == 2);
    const MeshAttribute &w = *mesh.attributes[0], &color = *mesh.attributes[1];
    REQUIRE(w.name == "vertex_w");
    REQUIRE(mesh.positions.size() == 4);
    REQUIRE(w.values.size() == 4);
    for (size_t i = 0; i < 4; ++i) // w is 1 + x + 3 y - 2 x y there
        CHECK(double(w.values[i]) ==
              1 + mesh.positions[i].x + 3 * mesh.positions[i].y - 2 * mesh.positions[i].x * mesh.positions[i].y);
    CHECK(color.of_faces);
    CHECK(std::ranges::equal(color.values, std::vector<float>{4, 5, 6, 7, 8, 9, 7, 8, 9}));
    forget_warnings();
}

TEST_CASE_METHOD(PlyFixture, "attributes of whole numbers stay, and what is not finite is 0; both are told", "[ply]") {
    const auto read = [&](const std::string &type, const std::string &first) {
        const std::string declared =
            "property " + type + " red\nproperty " + type + " green\nproperty " + type + " blue\n";
        return read_ply(scratch.write("a.ply", head + vertices(3, declared) + faces(1) + end + "0 0 0 " + first +
                                                   " 128 0\n1 0 0 1 2 3\n0 1 0 4 5 6\n3 0 1 2\n"),
                        {}, nullptr, std::vector<std::string>{"vertex_color"});
    };
    size_t before = warnings().size();
    CHECK(read("uchar", "255").attributes.at(0)->values[0] == 255);
    REQUIRE(warnings().size() == before + 1);
    CHECK_THAT(warnings()[before], Catch::Contains("a.ply:7:") && Catch::Contains("vertex_color has whole numbers"));
    before = warnings().size();
    CHECK(read("float", "nan").attributes.at(0)->values[0] == 0);
    REQUIRE(warnings().size() == before + 1);
    CHECK_THAT(warnings()[before], Catch::Contains("1 numbers of the attribute vertex_color are NaN or infinite"));
    forget_warnings();
}

// What Mitsuba 3.9.1 made of small files (corners of triangles in order; measured by loading them).
TEST_CASE_METHOD(PlyFixture, "meshes get the normals and uv that Mitsuba gives them", "[ply]") {
    // What a mesh that is turned round keeps of the barycentric coordinates, where the file has none of its own.
    const std::vector<double> barycentric = {0, 0, 1, 0, 0, 1};
    struct Row {
        std::string name, text;
        mitsuba::MeshOptions options; // for obj, flip_tex_coords as the scene has it or by default
        bool mirrored;
        std::vector<double> normals; // of each triangle's corners; empty: none
        std::vector<double> uvs;
    };
    constexpr double r = 0.70710678, a = 0.84655, b = 0.5323093;
    const std::string uv = "v 0 0 0\nv 1 0 0\nv 1 1 0\nvt 0 0.2\nvt 1 0.2\nvt 0 0.9\nf 1/1 2/2 3/3\n";
    const std::string edge = "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 0 0 3\n", two = "f 1 3 2\nf 1 2 4\n";
    const std::string one = "v 0 0 0\nv 1 0 0\nv 1 1 0\n";
    const std::vector<double> up = {0, 0, 1, 0, 0, 1, 0, 0, 1}, down = {0, 0, -1, 0, 0, -1, 0, 0, -1};
    const std::string ply_uv = "0 0 0 0.1 0.2\n1 0 0 0.1 0.2\n1 1 0 0.1 0.2\n3 0 1 2\n";
    const auto ply = [&](const std::string &u, const std::string &v, const std::string &body) {
        return head + vertices(3, "property float " + u + "\nproperty float " + v + "\n") + faces(1) + end + body;
    };
    const std::vector<Row> rows = {
        {"obj", uv, {.flip_tex_coords = true}, false, up, {0, 0.8, 1, 0.8, 0, 0.1}},
        {"obj", uv, {}, false, up, {0, 0.2, 1, 0.2, 0, 0.9}},
        {"obj", edge + two, {}, false, {r, 0, r, 0, 0, 1, a, 0, b, r, 0, r, a, 0, b, 1, 0, 0}, {}},
        {"obj",
         edge + "vt 0 0\nvt 1 0\nvt 0 1\nvt .5 0\nvt .5 1\nf 1/1 3/2 2/3\nf 1/4 2/5 4/1\n",
         {.flip_tex_coords = true},
         false,
         {0, 0, 1, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 0},
         {0, 1, 1, 1, 0, 0, 0.5, 1, 0.5, 0, 0, 1}},
        {"obj", edge + two, {.face_normals = true}, false, {}, {}},
        {"obj", edge + "vn 1 1 1\nf 1//1 3//1 2//1\nf 1 2 4\n", {.face_normals = true}, false, {}, {}},
        {"obj", one + "vn 0 0 2\nf 1//1 2//1 3//1\n", {}, false, up, {}},
        {"obj", one + "f 1 2 3\n", {}, true, down, {}},
        {"obj", one + "vn 0 0 1\nf 1//1 2//1 3//1\n", {}, true, up, {}},
        {"obj", one + "vn 0 0 1\nf 1//1 2//1 3//1\n", {.flip_normals = true}, false, down, barycentric},
        {"obj", one + "f 1 2 3\n", {.flip_normals = true}, false, down, barycentric},
        {"obj", one + "f 1 2 3\n", {.face_normals = true, .flip_normals = true}, false, {}, barycentric},
        {"ply", ply("u", "v", ply_uv), {}, false, up, {0.1, 0.2, 0.1, 0.2, 0.1, 0.2}},
        {"ply", ply("s", "t", ply_uv), {}, false, up, {0.1, 0.2, 0.1, 0.2, 0.1, 0.2}},
        {"ply", ply("texture_u", "texture_v", ply_uv), {}, false, up, {0.1, 0.2, 0.1, 0.2, 0.1, 0.2}},
        {"ply", ply("u", "v", ply_uv), {.flip_tex_coords = true}, false, up, {0.1, 0.8, 0.1, 0.8, 0.1, 0.8}},
        {"ply",
         head + vertices(4) + faces(2) + end + "0 0 0\n1 0 0\n0 1 0\n0 0 3\n3 0 1 2\n3 0 2 3\n",
         {},
         false,
         {r, 0, r, 0, 0, 1, a, 0, b, r, 0, r, a, 0, b, 1, 0, 0},
         {}},
        // Faces back to back: what is left of the sum is noise there, and here the corner has its face's normal.
        {"obj", one + "f 1 2 3\nf 3 2 1\n", {}, false, {}, {}},
    };
    for (const Row &row : rows) {
        INFO(row.text);
        const Transform to_world = Transform::scale({row.mirrored ? -1. : 1., 1, 1});
        const auto file = scratch.write("a." + row.name, row.text);
        const TriangleMesh mesh = mitsuba::finished_mesh(
            row.name == "obj" ? read_obj(file, to_world).mesh : read_ply(file, to_world), row.options);
        require_sound(mesh);
        // flip_normals turns corners round; the second and third then change places.
        const std::array<size_t, 3> order =
            row.options.flip_normals ? std::array<size_t, 3>{0, 2, 1} : std::array<size_t, 3>{0, 1, 2};
        std::vector<double> normals, uvs;
        for (size_t t = 0; t < mesh.triangles.size(); ++t)
            for (size_t i : order) {
                if (const unsigned n = mesh.triangles[t][i].normal; n != OPAL_NONE)
                    normals.insert(normals.end(), {mesh.normals[n].x, mesh.normals[n].y, mesh.normals[n].z});
                if (!mesh.uv_corners.empty())
                    for (float x : mesh.uvs[mesh.uv_corners[t][i]])
                        uvs.push_back(double(x));
            }
        CHECK_THAT(normals, Catch::Approx(row.normals).margin(2e-7));
        CHECK_THAT(uvs, Catch::Approx(row.uvs).margin(1e-6));
        if (row.text.ends_with("f 1 2 3\n") || row.text.ends_with("f 1//1 2//1 3//1\n"))
            CHECK(areas(mesh).first.z == (row.mirrored != row.options.flip_normals ? -0.5 : 0.5));
    }
    forget_warnings();
}

TEST_CASE("rectangles and cubes are Mitsuba's, also mirrored and flipped", "[ply]") {
    const Transform identity, scaled = Transform::scale({1, 2, 3}), mirrored = Transform::scale({-1, 1, 1}),
                              inverted = Transform::scale({-1, -1, -1});
    // The shading normal there, by which sides are told; flip_normals turns it round.
    for (bool flip : {false, true}) {
        const auto front = [&](const Transform &to_world) {
            const Parallelogram shape = mitsuba::rectangle(to_world, flip);
            CHECK(length(shape.origin - to_world.point({-1, -1, 0})) == 0);
            return normalize(cross(shape.u, shape.v)).z * (flip ? -1 : 1);
        };
        CHECK(front(identity) == 1);
        CHECK(front(scaled) == 1);
        CHECK(front(mirrored) == 1);
        CHECK(front(inverted) == -1);

        for (const Transform &to_world : {identity, scaled, mirrored, inverted}) {
            const TriangleMesh cube = mitsuba::cube(to_world, flip);
            require_sound(cube);
            REQUIRE(cube.positions.size() == 24);
            REQUIRE(cube.triangles.size() == 12);
            for (size_t t = 0; t < 12; ++t) {
                const Vec3 normal = cross(at(cube, t, 1) - at(cube, t, 0), at(cube, t, 2) - at(cube, t, 0));
                CHECK((dot(normal, at(cube, t, 0)) > 0) != flip);
            }
        }
    }
    // Points of the sides and their uv, as rays at the cube found them.
    const double points[6][5] = {{1, 0.25, -0.75, 0.625, 0.875}, {-1, 0.25, -0.75, 0.625, 0.125},
                                 {0.5, 1, -0.75, 0.25, 0.875},   {0.5, -1, -0.75, 0.125, 0.75},
                                 {0.5, 0.25, 1, 0.625, 0.75},    {0.5, 0.25, -1, 0.375, 0.75}};
    const TriangleMesh cube = mitsuba::cube(identity, false);
    for (const auto &[x, y, z, u, v] : points) {
        const Vec3 p{x, y, z};
        int found = 0;
        for (size_t t = 0; t < 12; ++t) {
            const Vec3 a = at(cube, t, 0), b = at(cube, t, 1), c = at(cube, t, 2), n = cross(b - a, c - a);
            const double b1 = dot(cross(p - a, c - a), n) / dot(n, n), b2 = dot(cross(b - a, p - a), n) / dot(n, n);
            if (dot(n, p - a) != 0 || b1 < 0 || b2 < 0 || b1 + b2 > 1)
                continue;
            ++found;
            const auto uv = [&](int i, size_t axis) { return double(cube.uvs[cube.uv_corners[t][size_t(i)]][axis]); };
            const double w = 1 - b1 - b2;
            CHECK(w * uv(0, 0) + b1 * uv(1, 0) + b2 * uv(2, 0) == u);
            CHECK(w * uv(0, 1) + b1 * uv(1, 1) + b2 * uv(2, 1) == v);
        }
        CHECK(found == 1);
    }
    CHECK(error_of([] {
              mitsuba::rectangle(Transform::scale({0, 1, 1}), false);
          }) == "to_world leaves the rectangle no area, or makes it infinite");
    CHECK(error_of([] {
              mitsuba::rectangle(Transform::scale({1e39, 1, 1}), false);
          }) == "to_world leaves the rectangle no area, or makes it infinite");
    CHECK(error_of([] {
              mitsuba::cube(Transform::scale({1, 0, 1}), false);
          }) == "to_world leaves a side of the cube no area");
    CHECK(error_of([] { mitsuba::cube(Transform::scale({NAN, 1, 1}), false); }) == "to_world makes the cube infinite");
}
