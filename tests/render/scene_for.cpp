// opal scene-for: the scene that it prints loads, shows the whole model, and is lit alike whatever the model's size.
#include "read/nori/load.h"
#include "support/pictures.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

const std::string opal_binary = OPAL_BINARY;

// A box with these corners, some faces turned inside.
std::string box(Vec3 lo, Vec3 hi) {
    std::string text;
    for (unsigned i = 0; i < 8; ++i)
        text += fmt::format("v {} {} {}\n", i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z);
    return text + "f 1 2 4 3\nf 5 6 8 7\nf 1 2 6 5\nf 3 4 8 7\nf 1 3 7 5\nf 2 4 8 6\n";
}

// What `opal scene-for` prints for a file of the folder, as scene.xml there.
std::filesystem::path scene_for(const ScratchFolder &folder, const std::string &quoted_names) {
    const Outcome outcome = run_shell(
        fmt::format("cd {} && {} scene-for {} > scene.xml", folder.path().string(), opal_binary, quoted_names));
    INFO(outcome.err);
    REQUIRE(outcome.exit_code == 0);
    return folder / "scene.xml";
}

// The part of the image's half width or height that the scene's OBJ meshes reach to; infinite behind the camera.
double reach(const SceneDescription &scene) {
    const Camera &camera = scene.camera;
    const double tangent = std::tan(camera.perspective.fov * M_PI / 360);
    double most = 0;
    for (const Mesh &mesh : scene.meshes)
        if (const auto *shape = std::get_if<TriangleMesh>(&mesh.shape))
            for (Vec3 p : shape->positions) {
                const Vec3 d = p - camera.to_world.point({});
                const double depth = dot(d, camera.to_world.vector({0, 0, 1}));
                const double x = dot(d, camera.to_world.vector({1, 0, 0})) / (depth * tangent),
                             y = dot(d, camera.to_world.vector({0, 1, 0})) / (depth * tangent) * camera.width /
                                 camera.height;
                most = std::max({most, depth > camera.near_clip && depth < camera.far_clip ? 0. : INFINITY, std::abs(x),
                                 std::abs(y)});
            }
    return most;
}

double mean_of(SceneDescription scene) {
    scene.camera.width = 80;
    scene.camera.height = 60;
    const Film film = render(scene, 16, test_seed(400));
    CHECK(film.invalid == 0);
    return sample_of(film).mean;
}

} // namespace

TEST_CASE("The printed scene shows the whole model, lit alike at every size", "[scene_for]") {
    const ScratchFolder folder;
    const std::vector<std::pair<std::string, std::string>> models = {
        {"cube", box({-1, -1, -1}, {1, 1, 1})},
        {"tiny", box({-1e-6, -1e-6, -1e-6}, {1e-6, 1e-6, 1e-6})},
        {"huge", box({-1e6, -1e6, -1e6}, {1e6, 1e6, 1e6})},
        {"far from the origin", box({999, 4999, -1001}, {1001, 5001, -999})},
        {"lying", "v -1 0 -1\nv 1 0 -1\nv 1 0 1\nv -1 0 1\nf 1 2 3 4\n"},
        {"upright", "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"},
        {"needle", box({-1e-3, -1, -1e-3}, {1e-3, 1, 1e-3})},
        {"long", box({-10, -0.1, -0.1}, {10, 0.1, 0.1})}};
    double cube = 0;
    for (const auto &[name, text] : models) {
        INFO(name);
        folder.write("model.obj", text);
        const SceneDescription scene = load_scene(scene_for(folder, "model.obj"));
        CHECK(reach(scene) > 0.2);
        CHECK(reach(scene) < 0.99);
        const double mean = mean_of(scene);
        CHECK(mean > 0.2);
        CHECK(mean < 0.8);
        if (name == "cube")
            cube = mean;
        else if (text.size() > 100 && name != "needle" && name != "long")
            CHECK(mean == Approx(cube).epsilon(1e-2));
    }
}

TEST_CASE("Any file name, several models, and materials of the OBJ file", "[scene_for]") {
    const ScratchFolder folder;
    for (const char *name : {"two words & <\"quotes\"> 'x'.obj", "\xff\xfe.obj", " blank.obj", "tab\tnew\nline.obj"}) {
        INFO(name);
        folder.write(name, box({0, 0, 0}, {1, 1, 1}));
        std::string quoted = name;
        for (size_t at = 0; (at = quoted.find('\'', at)) != std::string::npos; at += 4)
            quoted.replace(at, 1, "'\\''");
        const SceneDescription scene = load_scene(scene_for(folder, "'" + quoted + "'"));
        CHECK(scene.meshes.at(0).name == name);
    }
    folder.write("a.obj", box({0, 0, 0}, {1, 1, 1}));
    folder.write("b.obj", "mtllib b.mtl\nusemtl red\n" + box({5, 0, 0}, {6, 1, 1}));
    folder.write("b.mtl", "newmtl red\nKd 1 0 0\n");
    const SceneDescription scene = load_scene(scene_for(folder, "a.obj b.obj"));
    REQUIRE(scene.meshes.size() == 4); // with floor and lamp
    CHECK(reach(scene) < 0.99);
    CHECK(scene.meshes[0].bsdf.is<bsdf_twosided_record>());
    CHECK(scene.meshes[1].bsdf.leads_to(BSDF_diffuse));
    CHECK(read_text(folder / "scene.xml").find("materials") != std::string::npos);
}

TEST_CASE("A PLY file is shown, too", "[scene_for]") {
    const ScratchFolder folder;
    folder.write("a.PLY", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
                          "z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n"
                          "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    const SceneDescription scene = load_scene(scene_for(folder, "a.PLY"));
    REQUIRE(scene.meshes.size() == 3); // with floor and lamp
    CHECK(scene.meshes[0].name == "a.PLY");
    CHECK(reach(scene) < 0.99);
}

TEST_CASE("What cannot be shown is refused, and a model in place of a scene is told what to do", "[scene_for]") {
    const ScratchFolder folder;
    folder.write("model.obj", box({0, 0, 0}, {1, 1, 1}));
    folder.write("model.ply", "ply\nformat ascii 1.0\nend_header\n");
    const auto error = [&](const std::string &arguments, int code = 1) {
        const Outcome outcome =
            run_shell(fmt::format("cd {} && {} {}", folder.path().string(), opal_binary, arguments));
        CHECK(outcome.exit_code == code);
        CHECK(outcome.out.empty());
        return outcome.err;
    };
    CHECK_THAT(error("model.obj"), Catch::Contains("model.obj: is a Wavefront OBJ mesh, not a scene; opal scene-for"));
    CHECK_THAT(error("model.ply"), Catch::Contains("model.ply: is a PLY mesh, not a scene"));
    CHECK_THAT(error("scene-for model.ply"), Catch::Contains("model.ply: has no element 'vertex'"));
    CHECK_THAT(error("scene-for nothing.obj"), Catch::Contains("nothing.obj"));
    CHECK_THAT(error("scene-for 'a\\b.obj'"), Catch::Contains("backslash"));
    CHECK_THAT(error("scene-for", 2), Catch::Contains("MODEL.obj"));
}
