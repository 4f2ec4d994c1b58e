// Pictures of Mitsuba's files, against what Mitsuba 3.9.1 does with them.
#include "base/log.h"
#include "read/load.h"
#include "support/pictures.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using namespace opal::test;

namespace {

SceneDescription scene_of_file(const std::string &body) {
    const ScratchFolder scratch;
    return load_scene(scratch.write("a.xml", "<scene version='3.0.0'>" + body + "</scene>"));
}

const std::string small_film = "<film type='hdrfilm'><integer name='width' value='4'/><integer name='height' "
                               "value='4'/><rfilter type='box'/></film>";

} // namespace

TEST_CASE("The aperture changes no brightness", "[mitsuba]") {
    for (double radius : {0.001, 0.1, 1.0}) {
        INFO("aperture_radius " << radius);
        const SceneDescription scene = scene_of_file(
            fmt::format("<emitter type='constant'><rgb name='radiance' value='0.25 0.5 2'/></emitter><sensor "
                        "type='thinlens'><float name='aperture_radius' value='{}'/><float name='focus_distance' "
                        "value='2'/>{}</sensor>",
                        radius, small_film));
        REQUIRE(scene.camera.kind == CAMERA_thinlens);
        for (int channel = 0; channel < 3; channel++)
            CHECK(sample_of(render(scene, 16, 1), channel).mean == Approx(std::array{0.25, 0.5, 2.0}[size_t(channel)]));
    }
}

TEST_CASE("Roulette lets as many paths survive as Mitsuba's path", "[mitsuba]") {
    // A patch before a sky: a path that survives the patch with probability q sheds albedo / q, so that q is the
    // squared mean over the mean square. Mitsuba: 0.497, 0.900, 0.951 of few samples.
    struct Row {
        double albedo, survival;
    };
    for (const Row &row : {Row{0.5, 0.5}, Row{0.9, 0.9}, Row{0.99, 0.95}}) {
        INFO("albedo " << row.albedo);
        SceneDescription scene = scene_of_file(
            fmt::format("<integrator type='path'><integer name='rr_depth' value='1'/></integrator>"
                        "<emitter type='constant'/><shape type='rectangle'><bsdf type='diffuse'><rgb "
                        "name='reflectance' value='{}'/></bsdf></shape><sensor type='perspective'><float name='fov' "
                        "value='10'/><transform name='to_world'><lookat origin='0 0 2' target='0 0 0' up='0 1 "
                        "0'/></transform>{}</sensor>",
                        row.albedo, small_film));
        const stats::Sample of = sample_of(render(with_strategy(scene, {{"lighting", "bsdf"}}), 1 << 14, 1), 0);
        const double mean_square = of.variance + of.mean * of.mean;
        const double share = of.mean * of.mean / mean_square; // of 2^18 paths, with a standard error below 0.001
        CHECK(share == Approx(row.survival).margin(0.004));
    }
}

namespace {

// A PLY file of these vertices, each with its place and further numbers, and of these triangles likewise.
std::string ply_text(const std::string &vertex_properties, const std::vector<std::string> &vertices,
                     const std::string &face_properties, const std::vector<std::string> &faces) {
    std::string text = fmt::format("ply\nformat ascii 1.0\nelement vertex {}\nproperty float x\nproperty float "
                                   "y\nproperty float z\n{}element face {}\nproperty list uchar int vertex_indices\n{}"
                                   "end_header\n",
                                   vertices.size(), vertex_properties, faces.size(), face_properties);
    for (const auto *lines : {&vertices, &faces})
        for (const std::string &line : *lines)
            text += line + '\n';
    return text;
}

// The reflectance that a diffuse mesh shows at (x, y, 0): a sky of radiance 1 is seen by its reflection alone.
Color reflectance_at(const std::string &ply, const std::string &texture, double x, double y, const RenderSetup &setup) {
    const ScratchFolder scratch;
    scratch.write("a.ply", ply);
    SceneDescription scene = load_scene(scratch.write(
        "a.xml",
        fmt::format("<scene version='3.0.0'><emitter type='constant'/><shape type='ply'><string name='filename' "
                    "value='a.ply'/><bsdf type='diffuse'><texture name='reflectance' type='mesh_attribute'>{}"
                    "</texture></bsdf></shape><sensor type='perspective'><float name='fov' value='1e-4'/>"
                    "<transform name='to_world'><lookat origin='{} {} 5' target='{} {} 0' up='0 1 0'/>"
                    "</transform>{}</sensor></scene>",
                    texture, x, y, x, y, small_film)));
    const Film film = render(with_strategy(scene, {{"lighting", "bsdf"}, {"rr", "off"}}), 1, 1, setup);
    return {sample_of(film, 0).mean, sample_of(film, 1).mean, sample_of(film, 2).mean};
}

std::string named(const std::string &attribute, const std::string &more = "") {
    return "<string name='name' value='" + attribute + "'/>" + more;
}

} // namespace

TEST_CASE("Attributes of meshes are interpolated as Mitsuba does it", "[mitsuba]") {
    // Mitsuba 3.9.1's reflectances at two points, one on each triangle.
    const std::string rgb = "property float red\nproperty float green\nproperty float blue\n";
    const std::vector<std::string> triangles = {"3 0 1 2", "3 0 2 3"};
    const std::string colored =
        ply_text(rgb, {"-1 -1 0 1 0 0", "1 -1 0 0 1 0", "1 1 0 0 0 1", "-1 1 0 2 -0.5 0.25"}, "", triangles);
    const std::string faces =
        ply_text("", {"-1 -1 0", "1 -1 0", "1 1 0", "-1 1 0"}, rgb, {"3 0 1 2 0.1 0.2 0.3", "3 0 2 3 0.7 0.6 0.5"});
    const std::string grey =
        ply_text("property float w_0\n", {"-1 -1 0 0", "1 -1 0 0.25", "1 1 0 0.5", "-1 1 0 0.75"}, "", triangles);
    struct Row {
        std::string ply, texture;
        double x, y;
        Color wanted;
    };
    const std::vector<Row> rows = {
        {colored, named("vertex_color"), 0.5, -0.25, {0.25, 0.375, 0.375}},
        {colored, named("vertex_color"), -0.5, 0.25, {1.125, -0.1875, 0.34375}},
        {colored, named("vertex_color", "<float name='scale' value='0.5'/>"), 0.5, -0.25, {0.125, 0.1875, 0.1875}},
        {faces, named("face_color"), 0.5, -0.25, {0.1, 0.2, 0.3}},
        {faces, named("face_color"), -0.5, 0.25, {0.7, 0.6, 0.5}},
        {grey, named("vertex_w"), 0.5, -0.25, {0.28125, 0.28125, 0.28125}},
    };
    for (int lanes : {1, 8})
        for (const Row &row : rows) {
            INFO(row.texture << " at " << row.x << " " << row.y << ", " << lanes << " lanes");
            const Color got = reflectance_at(row.ply, row.texture, row.x, row.y, {.lanes = lanes});
            for (size_t c = 0; c < 3; c++)
                CHECK(got[c] == Approx(row.wanted[c]).margin(1e-5));
        }
    forget_warnings();
}

TEST_CASE("Triangles that the tree cuts keep their attributes", "[mitsuba]") {
    // Many small triangles above one that is far larger, which the tree cuts into several boxes; the attribute is the
    // place.
    std::vector<std::string> vertices, faces;
    const auto add = [&](double x, double y, double z) {
        vertices.push_back(fmt::format("{} {} {} {} {} {}", x, y, z, (x + 8) / 16, (y + 8) / 16, z == 0 ? 0 : 1));
    };
    add(-8, -8, 0), add(8, -8, 0), add(8, 8, 0), add(-8, 8, 0);
    faces = {"3 0 1 2", "3 0 2 3"};
    for (int i = 0; i < 200; i++) {
        const double x = -7.5 + 15 * (i % 20) / 20.0, y = -7.5 + 15 * int(i / 20) / 10.0;
        const size_t first = vertices.size();
        add(x, y, -0.01), add(x + 0.1, y, -0.01), add(x, y + 0.1, -0.01);
        faces.push_back(fmt::format("3 {} {} {}", first, first + 1, first + 2));
    }
    const std::string ply =
        ply_text("property float red\nproperty float green\nproperty float blue\n", vertices, "", faces);
    for (int lanes : {1, 8})
        for (const auto &[x, y] : {std::pair{-6.0, 3.0}, {5.5, -7.0}, {0.3, 0.2}, {7.5, 7.0}}) {
            const Color got = reflectance_at(ply, named("vertex_color"), x, y, {.lanes = lanes});
            INFO(x << " " << y << ", " << lanes << " lanes");
            CHECK(got[0] == Approx((x + 8) / 16).margin(1e-5));
            CHECK(got[1] == Approx((y + 8) / 16).margin(1e-5));
            CHECK(got[2] == Approx(0).margin(1e-5));
        }
}
