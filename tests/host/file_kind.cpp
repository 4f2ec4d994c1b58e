#include "read/file_kind.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cstring>

using namespace opal;
using namespace std::literals;
using opal::test::error_of;

namespace {

// A binary STL of `count` triangles.
std::string binary_stl(uint32_t count) {
    std::string bytes(84 + 50 * size_t(count), '\0');
    std::memcpy(bytes.data() + 80, &count, sizeof count);
    return bytes;
}

std::string in_utf16(const std::string &text, bool big_endian) {
    std::string bytes;
    for (char c : text)
        bytes += big_endian ? std::string{'\0', c} : std::string{c, '\0'};
    return bytes;
}

const std::string obj_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

struct KindFixture {
    test::ScratchFolder scratch;
    std::string file() const { return (scratch / "a.obj").string(); }
    std::string error_in(const std::string &bytes, FileKind wanted = FileKind::obj) const {
        scratch.write("a.obj", bytes);
        const std::string error = error_of([&] { read_text_file(file(), wanted); });
        return error.starts_with(file() + ": ") ? error.substr(file().size() + 2) : error;
    }
};

} // namespace

TEST_CASE_METHOD(KindFixture, "a byte order mark of UTF-8 is no part of the text", "[file_kind]") {
    scratch.write("a.obj", "\xef\xbb\xbf" + obj_text);
    CHECK(read_text_file(file(), FileKind::obj) == obj_text);
    scratch.write("a.obj", "\xef\xbb\xbf");
    CHECK(read_text_file(file(), FileKind::obj).empty());
}

TEST_CASE_METHOD(KindFixture, "text in UTF-16 and UTF-32 is named, with and without a mark", "[file_kind]") {
    CHECK_THAT(error_in("\xff\xfe" + in_utf16(obj_text, false)),
               Catch::StartsWith("is UTF-16 text, not an OBJ file; convert it: iconv -f UTF-16 -t UTF-8"));
    CHECK_THAT(error_in("\xfe\xff" + in_utf16(obj_text, true)), Catch::StartsWith("is UTF-16 text"));
    CHECK_THAT(error_in(in_utf16(obj_text, false)), Catch::StartsWith("is UTF-16LE text"));
    CHECK_THAT(error_in(in_utf16(obj_text, true)), Catch::StartsWith("is UTF-16BE text"));
    CHECK_THAT(error_in("\xff\xfe\0\0v\0\0\0"s), Catch::StartsWith("is UTF-32 text"));
}

TEST_CASE_METHOD(KindFixture, "a carriage return alone ends no line", "[file_kind]") {
    for (const char *text : {"v 0 0 0\rv 1 0 0\rf 1 2 3\r", "# a\rv 0 0 0\n", "v 0 0 0\r\rv 1 0 0\r\n"})
        CHECK_THAT(error_in(text), Catch::Contains("carriage return") && Catch::Contains("tr '\\r' '\\n'"));
    for (const char *text : {"v 0 0 0\r\nv 1 0 0\r\n", "v 0 0 0\r\r\n", "v 0 0 0\r", "v 0 0 0\nv 1 0 0\r\r"})
        CHECK(error_in(text).empty());
}

TEST_CASE("files are told by their bytes, whatever their names", "[file_kind]") {
    struct Row {
        std::string bytes, name;
        FileKind kind;
    };
    const std::vector<Row> rows = {
        {"ply\nformat ascii 1.0\n", "a PLY mesh", FileKind::ply},
        {"ply \t\r\nformat ascii 1.0\r\n", "a PLY mesh", FileKind::ply},
        {"ply the trade\n", "", FileKind::unknown},
        {"glTF\2\0\0\0"s, "a binary glTF scene", FileKind::other},
        {"{ \"asset\" : { \"version\" : \"2.0\" } }", "a glTF scene", FileKind::other},
        {"{ \"a\": 1 }", "JSON", FileKind::text},
        {"solid cube\n facet normal 0 0 1\n", "an STL mesh", FileKind::other},
        {"solid\nendsolid\n", "an STL mesh", FileKind::other},
        {binary_stl(2), "a binary STL mesh", FileKind::other},
        {"\x1f\x8b\x08"s, "compressed by gzip", FileKind::other},
        {"PK\3\4\x14"s, "a zip archive", FileKind::other},
        {"Kaydara FBX Binary  \0"s, "an FBX scene", FileKind::other},
        {"BLENDER-v300", "a Blender file", FileKind::other},
        {"OFF\n3 1 0\n", "an OFF mesh", FileKind::other},
        {"\x89PNG\r\n\x1a\n", "a PNG image", FileKind::png},
        {"version https://git-lfs.github.com/spec/v1\n", "a pointer that stands for the real file, by Git LFS",
         FileKind::other},
        {"<?xml version='1.0'?>\n<COLLADA version='1.4.1'>", "a COLLADA scene", FileKind::other},
        {"<!DOCTYPE html>\n<html><body/>", "a web page", FileKind::other},
        {"<!-- <shape> -->\n<scene version='3.0.0'><shape type='sphere'/></scene>", "a scene of Mitsuba",
         FileKind::mitsuba_scene},
        {"<scene version='0.6.0'><default name='spp' value='4'/></scene>", "a scene of Mitsuba",
         FileKind::mitsuba_scene},
        {"<scene version='3.5.0'><sensor type='perspective'/></scene>", "a scene of Mitsuba", FileKind::mitsuba_scene},
        {"<scene version='3.0.0'><emitter type='point'/></scene>", "a scene of Mitsuba", FileKind::mitsuba_scene},
        {"<scene version='3.0'><sensor type='perspective'/></scene>", "a scene of Mitsuba", FileKind::mitsuba_scene},
        {"<bsdf version='3.0.0' type='diffuse'/>", "a scene of Mitsuba", FileKind::mitsuba_scene},
        {"<bsdf type='diffuse'/>", "", FileKind::unknown},
        {"<scene version='3.0.0'><camera type='x'/><rgb/></scene>", "a scene", FileKind::scene},
        {"<scene version='1.0'><mesh type='obj'/></scene>", "a scene", FileKind::scene},
        {"<scene version=\"1\"><shape type='obj'/></scene>", "a scene", FileKind::scene},
        {"<scene version='3.0.0'><mesh type='obj'/></scene>", "a scene", FileKind::scene},
        {"\xef\xbb\xbf<scene><shape type='sphere'/></scene>", "a scene", FileKind::scene},
        {"<test type='ttest'/>", "a scene", FileKind::scene},
        {"# Blender MTL\n\nnewmtl red\n", "a material library (MTL)", FileKind::mtl},
        {"# a\n  # b\n\tv 0 0 0\n", "a Wavefront OBJ mesh", FileKind::obj},
        {"mtllib a.mtl\n", "a Wavefront OBJ mesh", FileKind::obj},
        {"LookAt 0 0 1  0 0 0  0 1 0\n", "a scene of PBRT", FileKind::text},
        {"\1\2\3\0\4"s, "a binary file", FileKind::other},
        {"", "", FileKind::unknown},
        {"# nothing\n", "", FileKind::unknown},
        {"<scne/>", "", FileKind::unknown},
        {"<", "", FileKind::unknown},
        {"<!--", "", FileKind::unknown},
    };
    for (const Row &row : rows) {
        INFO(row.bytes);
        const FileKindRow found = kind_of(row.bytes);
        CHECK(found.name == row.name);
        CHECK(found.kind == row.kind);
    }
}

TEST_CASE_METHOD(KindFixture, "the error says what the file is and how to convert it", "[file_kind]") {
    CHECK_THAT(error_in("OFF\n3 1 0\n"),
               Catch::StartsWith("is an OFF mesh, not an OBJ file; convert it: assimp export " + file() + " NEW.obj"));
    CHECK(error_in("ply\nformat ascii 1.0\n") == "is a PLY mesh, not an OBJ file; its type in a scene is ply");
    CHECK(error_in(obj_text, FileKind::ply) == "is a Wavefront OBJ mesh, not a PLY file; its type in a scene is obj");
    CHECK_THAT(error_in("ply\nformat ascii 1.0\n", FileKind::scene),
               Catch::StartsWith("is a PLY mesh, not a scene; opal scene-for " + file() + " > NEW.xml"));
    CHECK(error_in("\x1f\x8b\x08"s, FileKind::scene) ==
          "is compressed by gzip, not a scene; unpack it: gzip -dc " + file() + " > NEW");
    CHECK_THAT(error_in(obj_text, FileKind::scene), Catch::StartsWith("is a Wavefront OBJ mesh, not a scene; "));
    CHECK_THAT(error_in("<scene/>", FileKind::obj), Catch::StartsWith("is a scene, not an OBJ file; "));
    CHECK(error_in(obj_text, FileKind::obj).empty());
}
