// Reading takes time in proportion to the file: what a file repeats a hundred thousand times is not looked for anew
// each time. Readers that were quadratic took minutes to hours for these files.
#include "base/log.h"
#include "base/printable.h"
#include "read/nori/load.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <ctime>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

constexpr int many = 100'000;
constexpr double most_seconds = 30; // of CPU time: some 30 times what a slow machine takes under a sanitizer

template <class Part> std::string repeated(Part part) {
    std::string text;
    for (int i = 0; i < many; i++)
        text += part(i);
    return text;
}

std::string scene_of(const std::string &rest) { return "<scene><camera type='perspective'/>\n" + rest + "</scene>"; }

std::string parallelogram(int i, const std::string &rest) {
    return fmt::format(
        "<mesh type='parallelogram'><point name='origin' value='{} {} 0'/><vector name='u' value='1 0 0'/>"
        "<vector name='v' value='0 1 0'/>{}</mesh>\n",
        i % 300, i / 300, rest);
}

// Loads the scene. Returns its number of meshes and lights, or the words of its error that are asked for.
void load_in_time(const ScratchFolder &folder, const std::string &text, size_t objects, const std::string &error = "") {
    const std::clock_t start = std::clock();
    try {
        const SceneDescription scene = load_scene(folder.write("scene.xml", text));
        CHECK(error.empty());
        CHECK(scene.meshes.size() + scene.lights.size() == objects);
    } catch (const Error &told) {
        CHECK_THAT(told.what(), Catch::Contains(error.empty() ? "no error" : error));
    }
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < most_seconds);
    forget_warnings();
}

} // namespace

TEST_CASE("XML of a hundred thousand objects, properties, attributes or names takes linear time",
          "[linear_readers][alone]") {
    const ScratchFolder folder;
    SECTION("meshes") {
        load_in_time(folder, scene_of(repeated([](int i) { return parallelogram(i, ""); })), many);
    }
    SECTION("BSDFs") {
        load_in_time(folder, scene_of(repeated([](int i) { return parallelogram(i, "<bsdf type='mirror'/>"); })), many);
    }
    SECTION("lights") {
        load_in_time(folder, scene_of(repeated([](int) {
                         return "<emitter type='point'><point name='position' value='1 2 3'/><color name='power' "
                                "value='1 1 1'/></emitter>\n";
                     })),
                     many);
    }
    SECTION("properties of one object") {
        load_in_time(folder,
                     scene_of("<mesh type='parallelogram'>" +
                              repeated([](int i) { return fmt::format("<float name='p{}' value='1'/>\n", i); }) +
                              "</mesh>"),
                     0, "... and 99980 more mistakes");
    }
    SECTION("attributes of one tag") {
        load_in_time(folder, scene_of("<mesh " + repeated([](int i) { return fmt::format("a{}='1' ", i); }) + "/>"), 0,
                     "<mesh> has more than 1000 attributes");
    }
    SECTION("transforms") {
        load_in_time(folder,
                     scene_of("<mesh type='obj'><transform name='toWorld'>" +
                              repeated([](int) { return "<translate value='1 0 0'/>\n"; }) + "</transform></mesh>"),
                     0, "<mesh> lacks its property 'filename'");
    }
    SECTION("mistakes") {
        load_in_time(folder, scene_of(repeated([](int) { return "<mesh type='opj'/>\n"; })), 0,
                     "... and 99980 more mistakes");
    }
    SECTION("defaults and names without a value") {
        load_in_time(folder, scene_of(repeated([](int i) {
                         return fmt::format("<default name='d{}' value='1'/><mesh type='$e{}'/>\n", i, i);
                     })),
                     0, " more mistakes");
    }
}

TEST_CASE("OBJ and MTL of a hundred thousand materials, libraries or names take linear time",
          "[linear_readers][alone]") {
    const ScratchFolder folder;
    const std::string scene = scene_of("<mesh type='obj'><string name='filename' value='a.obj'/>"
                                       "<boolean name='materials' value='true'/></mesh>");
    const auto faces = [](const std::string &suffix) {
        return "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\n" +
               repeated([&](int i) { return fmt::format("usemtl m{}{}\nf 1 2 3\n", i, suffix); });
    };
    folder.write("a.mtl", repeated([](int i) { return fmt::format("newmtl m{}\nKd 0.5 0.5 0.5\n", i); }));
    size_t meshes = many;
    SECTION("materials") { folder.write("a.obj", faces("")); }
    SECTION("names that no library has") { folder.write("a.obj", faces("x")); }
    SECTION("libraries that are missing") {
        meshes = 1;
        folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\n" +
                                  repeated([](int i) { return fmt::format("mtllib none{}.mtl\n", i); }) + "f 1 2 3\n");
    }
    SECTION("statements of one material that stand twice") {
        folder.write("a.mtl", repeated([](int) { return "newmtl m0\n"; }));
        folder.write("a.obj", faces(""));
    }
    load_in_time(folder, scene, meshes);
}

TEST_CASE("A message of many quoted words without an end takes linear time", "[linear_readers][alone]") {
    const std::clock_t start = std::clock();
    CHECK(shortened_message(repeated([](int) { return "'a "; })).size() < 3000);
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 5); // a quadratic reader takes a minute
}

TEST_CASE("A million warnings are told as a thousand", "[linear_readers][alone]") {
    forget_warnings();
    for (int i = 0; i < 5000; i++)
        warn(fmt::format("the warning {}", i));
    REQUIRE(warnings().size() == 1001);
    CHECK(warnings().back() == "more warnings follow, which are not told");
    forget_warnings();
}

TEST_CASE("PLY of a hundred thousand properties, elements, names or corners takes linear time",
          "[linear_readers][alone]") {
    const ScratchFolder folder;
    const std::string start = "ply\nformat ascii 1.0\n", vertex = "element vertex 3\n",
                      xyz = "property float x\nproperty float y\nproperty float z\n",
                      face = "element face 1\nproperty list int int vertex_index\nend_header\n",
                      body = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    const auto properties = [](const char *name) {
        return repeated([&](int i) { return fmt::format("property char {}{}\n", name, i); });
    };
    const std::string zeros = repeated([](int) { return " 0"; });
    std::string error;
    SECTION("properties of a vertex") {
        folder.write("a.ply", start + vertex + xyz + properties("p") + face + "0 0 0" + zeros + "\n1 0 0" + zeros +
                                  "\n0 1 0" + zeros + "\n3 0 1 2\n");
    }
    SECTION("elements that are skipped") {
        folder.write("a.ply", start + vertex + xyz +
                                  repeated([](int i) { return fmt::format("element e{} 1\nproperty int a\n", i); }) +
                                  face + "0 0 0\n1 0 0\n0 1 0\n" + repeated([](int) { return "7\n"; }) + "3 0 1 2\n");
    }
    SECTION("comments and blank lines") {
        folder.write("a.ply", start + repeated([](int) { return "comment\n\n"; }) + vertex + xyz + face +
                                  repeated([](int) { return "\n"; }) + body);
    }
    SECTION("a header without an end") {
        folder.write("a.ply", start + vertex + properties("p"));
        error = "the file ends before 'end_header'";
    }
    SECTION("corners of one face") {
        folder.write("a.ply", start + vertex + xyz + face + "0 0 0\n1 0 0\n0 1 0\n" + std::to_string(many + 3) +
                                  " 0 1 2" + zeros + "\n");
    }
    load_in_time(folder, scene_of("<mesh type='ply'><string name='filename' value='a.ply'/></mesh>"),
                 error.empty() ? 1 : 0, error);
}
