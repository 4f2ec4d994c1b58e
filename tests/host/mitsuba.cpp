// Scenes of Mitsuba: what each object becomes, and the errors. The figures are those that Mitsuba 3.9.1 has.
#include "base/log.h"
#include "base/table.h"
#include "commands/options.h"
#include "flatten/scene_warnings.h"
#include "image/image.h"
#include "read/load.h"
#include "scene/metals.h"
#include "scene/options.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

using namespace opal;
using opal::test::error_of;

namespace {

const std::string obj_text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const std::string ply_text =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
    "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

std::string transform(const std::string &operations) {
    return "<transform name='to_world'>" + operations + "</transform>";
}

struct MitsubaFixture {
    test::ScratchFolder scratch;
    MitsubaFixture() {
        scratch.write("a.obj", obj_text);
        scratch.write("a.ply", ply_text);
    }
    // Loads a scene with `body` from line 2 on.
    SceneDescription load(const std::string &body, const LoadOptions &options = {}) const {
        return load_scene(scratch.write("a.xml", "<scene version='3.0.0'>\n" + body + "\n</scene>"), options);
    }
    // The errors, without the file's name before the place.
    std::string error_in(const std::string &body, const LoadOptions &options = {}) const {
        std::string error = error_of([&] { load(body, options); });
        const std::string file = (scratch / "a.xml").string();
        for (size_t at = error.find(file); at != error.npos; at = error.find(file))
            error.erase(at, file.size());
        return error;
    }
    Mesh shape(const std::string &type, const std::string &body = "") const {
        const SceneDescription scene = load(fmt::format("<shape type='{}'>{}</shape>", type, body));
        REQUIRE(scene.meshes.size() == 1);
        return scene.meshes.front();
    }
    Bsdf bsdf(const std::string &type, const std::string &body = "") const {
        return shape("sphere", fmt::format("<bsdf type='{}'>{}</bsdf>", type, body)).bsdf;
    }
    template <class Kind> Kind light(const std::string &type, const std::string &body = "") const {
        const SceneDescription scene = load(fmt::format("<emitter type='{}'>{}</emitter>", type, body));
        REQUIRE(scene.lights.size() == 1);
        return std::get<Kind>(scene.lights.front().parameters);
    }
    SceneDescription sensor(const std::string &type, const std::string &body = "") const {
        return load(fmt::format("<sensor type='{}'>{}</sensor>", type, body));
    }
    Camera film(const std::string &body) const {
        return sensor("perspective", "<film type='hdrfilm'>" + body + "</film>").camera;
    }
    Strategy integrator(const std::string &type, const std::string &body = "") const {
        return load(fmt::format("<integrator type='{}'>{}</integrator>", type, body)).strategy;
    }
    // The warnings of a load, without the file's name.
    std::vector<std::string> warnings_of(const std::string &body, const LoadOptions &options = {}) const {
        const size_t before = warnings().size();
        load(body, options);
        std::vector<std::string> told;
        for (size_t i = before; i < warnings().size(); i++) {
            const std::string &line = warnings()[i];
            const std::string file = (scratch / "a.xml").string();
            told.push_back(line.starts_with(file) ? line.substr(file.size()) : line);
        }
        return told;
    }
};

bool near(Vec3 a, Vec3 b) { return length(a - b) < 1e-12; }

const std::string lit = "<emitter type='constant'/>";
const std::string mirrored = transform("<scale x='-1'/>");

} // namespace

TEST_CASE_METHOD(MitsubaFixture, "spheres: place, size and side", "[mitsuba]") {
    struct Row {
        std::string body;
        Sphere sphere;
    };
    const std::string flipped = "<boolean name='flip_normals' value='true'/>";
    const std::vector<Row> rows = {
        {"", {{0, 0, 0}, 1, false}},
        {"<point name='center' x='1' y='2' z='3'/><float name='radius' value='0.5'/>", {{1, 2, 3}, 0.5, false}},
        {"<point name='center' value='1, 2, 3'/><integer name='radius' value='2'/>" +
             transform("<scale value='3'/><translate x='1'/>"), // to_world acts after both
         {{4, 6, 9}, 6, false}},
        {mirrored, {{0, 0, 0}, 1, true}},
        {transform("<scale value='-1'/>"), {{0, 0, 0}, 1, true}},
        {flipped, {{0, 0, 0}, 1, true}},
        {flipped + mirrored, {{0, 0, 0}, 1, false}},
        {transform("<rotate y='1' angle='30'/><scale value='0.25'/><rotate x='1' angle='7'/>"),
         {{0, 0, 0}, 0.25, false}},
    };
    for (const Row &row : rows) {
        INFO(row.body);
        const Sphere sphere = std::get<Sphere>(shape("sphere", row.body).shape);
        CHECK(near(sphere.center, row.sphere.center));
        CHECK(sphere.radius == Approx(row.sphere.radius));
        CHECK(sphere.inward == row.sphere.inward);
    }
}

TEST_CASE_METHOD(MitsubaFixture, "rectangles keep the side of their shading normal where they are mirrored",
                 "[mitsuba]") {
    struct Row {
        std::string body;
        Vec3 normal;
    };
    const std::vector<Row> rows = {{"", {0, 0, 1}},
                                   {"<boolean name='flip_normals' value='true'/>", {0, 0, -1}},
                                   {mirrored, {0, 0, 1}},
                                   {transform("<scale value='-1'/>"), {0, 0, -1}},
                                   {transform("<rotate x='1' angle='-90'/>"), {0, 1, 0}}};
    for (const Row &row : rows) {
        INFO(row.body);
        const Parallelogram side = std::get<Parallelogram>(shape("rectangle", row.body).shape);
        CHECK(near(normalize(cross(side.u, side.v)), row.normal));
        CHECK(length(cross(side.u, side.v)) == Approx(4));
    }
}

TEST_CASE_METHOD(MitsubaFixture, "cubes and files of meshes become triangles", "[mitsuba]") {
    CHECK(std::get<TriangleMesh>(shape("cube").shape).triangles.size() == 12);
    const std::string obj = "<string name='filename' value='a.obj'/>",
                      flat = "<boolean name='face_normals' value='true'/>";
    for (const char *type : {"obj", "ply"}) {
        const std::string file = fmt::format("<string name='filename' value='a.{}'/>", type);
        INFO(type);
        const Mesh mesh = shape(type, file);
        CHECK(std::get<TriangleMesh>(mesh.shape).triangles.size() == 1);
        CHECK(std::get<TriangleMesh>(mesh.shape).normals.size() > 0); // Mitsuba makes them
        CHECK(std::get<TriangleMesh>(shape(type, file + flat).shape).normals.empty());
        CHECK(mesh.name == fmt::format("a.{}", type));
    }
    CHECK(load("<shape type='obj' id='wall'>" + obj + "</shape>").meshes.front().name == "wall");
    // flip_normals turns the corners' normals and the winding
    const TriangleMesh turned =
        std::get<TriangleMesh>(shape("obj", obj + "<boolean name='flip_normals' value='true'/>").shape);
    CHECK(near(turned.normals[turned.triangles[0][0].normal], {0, 0, -1}));
    const std::array<Vec3, 3> p = {turned.positions[turned.triangles[0][0].position],
                                   turned.positions[turned.triangles[0][1].position],
                                   turned.positions[turned.triangles[0][2].position]};
    CHECK(cross(p[1] - p[0], p[2] - p[0]).z < 0);
}

TEST_CASE_METHOD(MitsubaFixture, "lights: units, places and directions", "[mitsuba]") {
    constexpr double full = 4 * std::numbers::pi;
    const auto point = light<emitter_point>("point");
    CHECK(point.power == Color{full, full, full}); // of an intensity of 1
    CHECK(near(point.position, {0, 0, 0}));
    CHECK(near(light<emitter_point>("point", "<point name='position' value='1 2 3'/>").position, {1, 2, 3}));
    const auto moved =
        light<emitter_point>("point", transform("<translate y='4'/>") + "<rgb name='intensity' value='300'/>");
    CHECK(near(moved.position, {0, 4, 0}));
    CHECK(moved.power[2] == Approx(300 * full));

    const auto spot = light<emitter_spot>("spot");
    CHECK(near(spot.direction, {0, 0, 1}));
    CHECK(spot.intensity == Color{1, 1, 1});
    CHECK(spot.cutoff_angle == 20);
    CHECK(spot.beam_width == 15);
    CHECK_FALSE(spot.smooth);
    const auto aimed = light<emitter_spot>("spot", transform("<lookat origin='0 3 0' target='0 0 0' up='0 0 1'/>") +
                                                       "<float name='cutoff_angle' value='40'/>");
    CHECK(near(aimed.position, {0, 3, 0}));
    CHECK(near(normalize(aimed.direction), {0, -1, 0}));
    CHECK(aimed.beam_width == 30);

    const auto projector = light<emitter_projector>("projector");
    CHECK(near(projector.direction, {0, 0, 1}));
    CHECK(near(projector.up, {0, 1, 0}));
    CHECK(projector.irradiance == Color{1, 1, 1});
    CHECK(projector.fov == Approx(34.02).margin(0.01)); // that of a lens of 50 mm, across a square
    CHECK(light<emitter_projector>("projector", "<float name='fov' value='40'/>").fov == Approx(40));
    const auto large = light<emitter_projector>("projector", transform("<scale value='2'/>") + // as Mitsuba has it
                                                                 "<float name='scale' value='3'/>");
    CHECK(large.irradiance == Color{6, 6, 6});

    CHECK(near(light<emitter_directional>("directional").direction, {0, 0, 1}));
    CHECK(light<emitter_directional>("directional").irradiance == Color{1, 1, 1});
    const auto sun = light<emitter_directional>("directional", "<vector name='direction' value='0 0 -2'/>"
                                                               "<rgb name='irradiance' value='1 2 3'/>");
    CHECK(near(normalize(sun.direction), {0, 0, -1}));
    CHECK(sun.irradiance == Color{1, 2, 3});
    CHECK(near(normalize(light<emitter_directional>("directional", transform("<rotate y='1' angle='90'/>")).direction),
               {1, 0, 0}));
    CHECK(light<emitter_constant>("constant").radiance == Color{1, 1, 1});

    const Mesh lamp = shape("rectangle", "<emitter type='area'/>");
    CHECK(lamp.radiance == Color{1, 1, 1});
    CHECK_FALSE(lamp.emits_on_both_sides);
    CHECK(shape("sphere", "<emitter type='area'><float name='radiance' value='7'/></emitter>").radiance ==
          Color{7, 7, 7});
}

TEST_CASE_METHOD(MitsubaFixture, "a scaled directional light keeps its irradiance, and says so", "[mitsuba]") {
    const std::string sun = "<emitter type='directional'>" + transform("<scale value='2'/>") + "</emitter>";
    const std::vector<std::string> told = warnings_of(sun + "<shape type='sphere'/>");
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::StartsWith(":2:29: to_world scales this light; Mitsuba lights surfaces that many"));
    CHECK(
        warnings_of("<emitter type='directional'>" + transform("<scale x='-1'/>") + "</emitter><shape type='sphere'/>")
            .empty());
}

TEST_CASE_METHOD(MitsubaFixture, "the angle across the image of perspective cameras is Mitsuba's", "[mitsuba]") {
    struct Row {
        std::string body;
        int width, height;
        double fov;
    };
    const std::string fov = "<float name='fov' value='40'/>";
    const auto along = [&](const std::string &axis) { return fov + "<string name='fov_axis' value='" + axis + "'/>"; };
    const std::vector<Row> rows = {{fov, 200, 100, 40},
                                   {"", 200, 100, 42.31171},
                                   {"", 768, 576, 38.18},
                                   {"", 100, 100, 34.02},
                                   {along("x"), 200, 100, 40},
                                   {along("y"), 200, 100, 72.10477},
                                   {along("diagonal"), 200, 100, 36.06479},
                                   {along("smaller"), 200, 100, 72.10477},
                                   {along("larger"), 200, 100, 40},
                                   {along("smaller"), 100, 200, 40},
                                   {"<string name='focal_length' value='35mm'/>", 200, 100, 57.87119},
                                   {"<string name='focal_length' value='35'/>", 200, 100, 57.87119},
                                   {fov, 100, 200, 40}};
    for (const Row &row : rows) {
        INFO(row.body << " " << row.width << " x " << row.height);
        const std::string film = fmt::format("<film type='hdrfilm'><integer name='width' value='{}'/>"
                                             "<integer name='height' value='{}'/></film>",
                                             row.width, row.height);
        const double tolerance = row.width == 200 ? 1e-5 : 5e-3; // as many digits as are known
        CHECK(sensor("perspective", row.body + film).camera.perspective.fov == Approx(row.fov).margin(tolerance));
        const Camera lens = sensor("thinlens", "<float name='aperture_radius' value='0.1'/>" + row.body + film).camera;
        CHECK(lens.thinlens.fov == Approx(row.fov).margin(tolerance));
    }
}

TEST_CASE_METHOD(MitsubaFixture, "cameras", "[mitsuba]") {
    const Camera plain = sensor("perspective").camera;
    CHECK(plain.kind == CAMERA_perspective);
    CHECK(plain.near_clip == 0.01);
    CHECK(plain.far_clip == 1e4);
    CHECK(plain.perspective.principal_point_x == 0);
    // The middle of the film looks towards -x, the image's right: the axis is left of it.
    const Camera shifted =
        sensor("perspective", "<float name='principal_point_offset_x' value='0.1'/>"
                              "<float name='principal_point_offset_y' value='0.2'/>"
                              "<float name='near_clip' value='1'/><float name='far_clip' value='9'/>")
            .camera;
    CHECK(shifted.perspective.principal_point_x == -0.1);
    CHECK(shifted.perspective.principal_point_y == -0.2);
    CHECK(shifted.near_clip == 1);
    CHECK(shifted.far_clip == 9);

    const Camera lens = sensor("thinlens", "<float name='aperture_radius' value='0.5'/>").camera;
    CHECK(lens.kind == CAMERA_thinlens);
    CHECK(lens.thinlens.aperture_radius == 0.5);
    CHECK(lens.thinlens.focus_distance == 1e4); // far_clip
    CHECK(sensor("thinlens", "<float name='aperture_radius' value='0.5'/><float name='focus_distance' value='4'/>")
              .camera.thinlens.focus_distance == 4);

    const Camera parallel = sensor("orthographic", transform("<scale x='3' y='3'/>")).camera;
    CHECK(parallel.kind == CAMERA_orthographic);
    const Camera deep = sensor("orthographic", transform("<scale z='2'/>") + "<float name='near_clip' value='2'/>"
                                                                             "<float name='far_clip' value='3.2'/>")
                            .camera; // as Mitsuba: from depth 4 to 5.2 in the scene
    CHECK(deep.near_clip == 2);
    CHECK(deep.far_clip == Approx(2.6));
    CHECK(near(parallel.to_world.vector({1, 0, 0}), {3, 0, 0}));
    CHECK(error_in("<sensor type='perspective'>" + transform("<scale value='1.0001'/>") + "</sensor>").empty());
    CHECK(error_in("<sensor type='perspective'>" + mirrored + "</sensor>").empty());
}

TEST_CASE_METHOD(MitsubaFixture, "of several sensors one is taken", "[mitsuba]") {
    const auto one = [](const std::string &id, int width) {
        return fmt::format("<sensor type='perspective'{}><film type='hdrfilm'><integer name='width' value='{}'/>"
                           "</film></sensor>",
                           id.empty() ? "" : " id='" + id + "'", width);
    };
    const std::string three = one("left", 10) + one("", 20) + one("right", 30);
    CHECK(load(three).camera.width == 10);
    CHECK(load(three, {.sensor = "0"}).camera.width == 10);
    CHECK(load(three, {.sensor = "1"}).camera.width == 20);
    CHECK(load(three, {.sensor = "right"}).camera.width == 30);
    CHECK(load(three, {.sensor = "left"}).hash == load(three).hash);
    CHECK(load(three, {.sensor = "1"}).hash != load(three).hash); // another image
    for (const char *wrong : {"3", "-1", "middle"})
        CHECK(error_in(three, {.sensor = wrong}) ==
              fmt::format("--sensor {}: there is no such <sensor>; available: 0 (left), 1, 2 (right)", wrong));
    CHECK(error_in("", {.sensor = "0"}) == "--sensor 0: there is no such <sensor>; available: none");
    CHECK_THROWS_AS(load(three, {.sensor = "3"}), UsageError);
    // a mistake in one that is not taken is told all the same
    CHECK_THAT(error_in(one("", 10) + "\n<sensor type='perspective'><float name='fvo' value='3'/></sensor>"),
               Catch::StartsWith(":3:28: unknown property 'fvo'"));
}

TEST_CASE_METHOD(MitsubaFixture, "films: size, crop and filters", "[mitsuba]") {
    const Camera plain = sensor("perspective").camera;
    CHECK(plain.width == 768);
    CHECK(plain.height == 576);
    CHECK(plain.filter.kind == FILTER_gaussian);
    CHECK(plain.filter.stddev == 0.5);
    CHECK(plain.filter.radius == 2);
    CHECK(plain.crop == Crop{});
    CHECK(plain.window() == Crop{0, 0, 768, 576, 768, 576});
    const Camera cropped = film("<integer name='width' value='200'/><integer name='height' value='100'/>"
                                "<integer name='crop_offset_x' value='50'/><integer name='crop_offset_y' value='20'/>"
                                "<integer name='crop_width' value='100'/><integer name='crop_height' value='50'/>");
    CHECK(cropped.window() == Crop{50, 20, 100, 50, 200, 100});

    Camera halved = cropped; // by --width: the crop shows the same part
    set_size(halved, 100, 0);
    CHECK(halved.window() == Crop{25, 10, 50, 25, 100, 50});
    Camera tiny = cropped;
    set_size(tiny, 1, 0);
    CHECK(tiny.window() == Crop{0, 0, 1, 1, 1, 1});

    struct Row {
        std::string type, body;
        int kind;
        double radius, stddev, b, c;
    };
    const std::vector<Row> rows = {
        {"box", "", FILTER_box, 0.5, 0, 0, 0},
        {"tent", "", FILTER_tent, 1, 0, 0, 0},
        {"tent", "<float name='radius' value='2'/>", FILTER_tent, 2, 0, 0, 0},
        {"gaussian", "", FILTER_gaussian, 2, 0.5, 0, 0},
        {"gaussian", "<float name='stddev' value='1'/>", FILTER_gaussian, 4, 1, 0, 0},
        {"mitchell", "", FILTER_mitchell, 2, 0, 1.0 / 3, 1.0 / 3},
        {"mitchell", "<float name='B' value='0'/><float name='C' value='0.5'/>", FILTER_mitchell, 2, 0, 0, 0.5},
        {"catmullrom", "", FILTER_mitchell, 2, 0, 0, 0.5},
        {"lanczos", "", FILTER_lanczos, 3, 0, 0, 0},
        {"lanczos", "<integer name='lobes' value='2'/>", FILTER_lanczos, 2, 0, 0, 0},
    };
    for (const Row &row : rows) {
        INFO(row.type << " " << row.body);
        const Filter filter = film(fmt::format("<rfilter type='{}'>{}</rfilter>", row.type, row.body)).filter;
        CHECK(filter.kind == row.kind);
        CHECK(filter.radius == row.radius);
        CHECK(filter.given);
        if (row.kind == FILTER_gaussian)
            CHECK(filter.stddev == row.stddev);
        if (row.kind == FILTER_mitchell) {
            CHECK(filter.b == Approx(row.b));
            CHECK(filter.c == Approx(row.c));
        }
    }
    // what says how Mitsuba writes the file is accepted
    CHECK(film("<string name='file_format' value='pfm'/><string name='pixel_format' value='rgba'/>"
               "<string name='component_format' value='float16'/><boolean name='banner' value='false'/>"
               "<boolean name='sample_border' value='true'/><boolean name='compensate' value='true'/>")
              .width == 768);
}

TEST_CASE_METHOD(MitsubaFixture, "samplers become the nearest of Opal's", "[mitsuba]") {
    struct Row {
        std::string type;
        int sampler;
    };
    for (const Row &row : std::vector<Row>{{"independent", CHOICE_sampler_independent},
                                           {"stratified", CHOICE_sampler_stratified},
                                           {"multijitter", CHOICE_sampler_sobol},
                                           {"orthogonal", CHOICE_sampler_sobol},
                                           {"ldsampler", CHOICE_sampler_sobol}}) {
        INFO(row.type);
        const auto with = [&](const std::string &body) {
            return sensor("perspective", fmt::format("<sampler type='{}'>{}</sampler>", row.type, body));
        };
        CHECK(with("").strategy[AXIS_sampler] == row.sampler);
        CHECK(with("").spp == 4);
        const SceneDescription ten = with("<integer name='sample_count' value='10'/><integer name='seed' value='3'/>");
        CHECK(ten.spp == 10); // as asked: Opal's samplers need no rounding
        CHECK(ten.sample_count_given);
    }
    CHECK(sensor("perspective").spp == 4);
    CHECK(sensor("perspective").strategy[AXIS_sampler] == CHOICE_sampler_independent);
}

TEST_CASE_METHOD(MitsubaFixture, "integrators: the strategy of path, and what files change of it", "[mitsuba]") {
    for (const std::string &body :
         {std::string(), std::string("<integrator type='path'/>"), std::string("<integrator type='volpath'/>"),
          std::string("<integrator type='moment'><integrator type='path'/></integrator>")}) {
        INFO(body);
        const SceneDescription scene = load(body);
        const Strategy &s = scene.strategy;
        CHECK(s[AXIS_integrator] == CHOICE_integrator_path);
        CHECK(s[AXIS_lighting] == CHOICE_lighting_mis);
        CHECK(s[AXIS_mis] == CHOICE_mis_power);
        CHECK(s[AXIS_hemisphere] == CHOICE_hemisphere_cosine);
        CHECK(s[AXIS_emitter_choice] == CHOICE_emitter_choice_power);
        CHECK(s[AXIS_rr] == CHOICE_rr_throughput_eta);
        CHECK(s.rr_max == 0.95);
        CHECK(s.rr_depth == 5);
        CHECK(s.max_depth == no_limit);
        CHECK_FALSE(scene.hides_emitters);
        CHECK(scene.lights_reflect);
        CHECK(scene.wants_variance == (body.find("moment") != body.npos));
        CHECK(integrator_name(scene) == "path");
    }
    for (const char *light : {"constant", "directional"})
        CHECK(load(fmt::format("<emitter type='{}'/><emitter type='point'/>", light)).strategy[AXIS_emitter_choice] ==
              CHOICE_emitter_choice_uniform);
    CHECK(load("<emitter type='spot'/><emitter type='point'/>").strategy[AXIS_emitter_choice] ==
          CHOICE_emitter_choice_power);
    const auto depths = [](int most, int roulette) {
        return fmt::format("<integer name='max_depth' value='{}'/><integer name='rr_depth' value='{}'/>", most,
                           roulette);
    };
    CHECK(integrator("path", depths(1, 1)).max_depth == 1);
    CHECK(integrator("path", depths(8, 3)).max_depth == 8);
    CHECK(integrator("path", depths(8, 3)).rr_depth == 3);
    CHECK(integrator("path", depths(-1, 3)).max_depth == no_limit);
    CHECK(load("<integrator type='path'><boolean name='hide_emitters' value='true'/></integrator>").hides_emitters);
    CHECK_FALSE(load("<integrator type='moment'><boolean name='hide_emitters' value='true'/>"
                     "<integrator type='path'/></integrator>")
                    .hides_emitters);
    CHECK(load("<integrator type='moment'><integrator type='direct'><boolean name='hide_emitters' value='true'/>"
               "</integrator></integrator>")
              .hides_emitters);
}

TEST_CASE_METHOD(MitsubaFixture, "volpath would find a point light through a mask: a warning says so", "[mitsuba]") {
    const std::string point = "<emitter type='point'/>", plain = "<shape type='cube'/>",
                      mask = "<shape type='cube'><bsdf type='mask'><bsdf type='diffuse'/></bsdf></shape>",
                      volpath = "<integrator type='volpath'/>";
    const std::vector<std::string> told = warnings_of(point + mask + volpath);
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::StartsWith(":2:1: Mitsuba's volpath finds this light through mask and null"));
    CHECK(warnings_of(point + plain + volpath).empty());
    CHECK(warnings_of(lit + mask + volpath).empty());
    CHECK(warnings_of(point + mask + "<integrator type='path'/>").empty());

    const auto limited = [](const std::string &type) {
        return "\n<integrator type='" + type + "'>\n<integer name='max_depth' value='6'/></integrator>";
    };
    const std::vector<std::string> depth = warnings_of(lit + mask + limited("volpath"));
    REQUIRE(depth.size() == 1);
    CHECK_THAT(depth[0], Catch::StartsWith(":4:1: Mitsuba's volpath does not count mask and null as segments"));
    CHECK(warnings_of(lit + plain + limited("volpath")).empty());
    CHECK(warnings_of(lit + mask + limited("path")).empty());
}

TEST_CASE_METHOD(MitsubaFixture, "direct has samples of both kinds, or of one", "[mitsuba]") {
    const auto samples = [](const std::string &name, int count) {
        return fmt::format("<integer name='{}' value='{}'/>", name, count);
    };
    struct Row {
        std::string body;
        int lighting;
        unsigned emitter, bsdf;
    };
    for (const Row &row :
         std::vector<Row>{{"", CHOICE_lighting_mis, 1, 1},
                          {samples("shading_samples", 4), CHOICE_lighting_mis, 4, 4},
                          {samples("emitter_samples", 3) + samples("bsdf_samples", 2), CHOICE_lighting_mis, 3, 2},
                          {samples("emitter_samples", 3), CHOICE_lighting_mis, 3, 1},
                          {samples("bsdf_samples", 0), CHOICE_lighting_emitter, 1, 1},
                          {samples("emitter_samples", 0), CHOICE_lighting_bsdf, 1, 1}}) {
        INFO(row.body);
        const Strategy s = integrator("direct", row.body);
        CHECK(s[AXIS_integrator] == CHOICE_integrator_direct_lighting);
        CHECK(s[AXIS_lighting] == row.lighting);
        CHECK(s[AXIS_mis] == CHOICE_mis_power);
        CHECK(s.emitter_samples == row.emitter);
        CHECK(s.bsdf_samples == row.bsdf);
    }
    CHECK(load("<integrator type='direct'/>").lights_reflect); // beside what they emit
}

TEST_CASE_METHOD(MitsubaFixture, "aov: its inner integrator renders, and its channels are named", "[mitsuba]") {
    const std::string aov = "<integrator type='aov'><string name='aovs' value='dd.y:depth,nn:sh_normal'/>"
                            "<integrator type='direct'/></integrator>";
    CHECK(load(aov).strategy[AXIS_integrator] == CHOICE_integrator_direct_lighting);
    const std::vector<std::string> told = warnings_of(lit + "<shape type='sphere'/>" + aov);
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::EndsWith("Opal writes none of these channels: dd.y:depth,nn:sh_normal"));
}

TEST_CASE_METHOD(MitsubaFixture, "materials", "[mitsuba]") {
    const auto albedo = [](const Bsdf &made) { return made.as<bsdf_diffuse_record>().albedo; };
    CHECK(albedo(shape("sphere").bsdf).value[0] == 0.5f);
    CHECK(albedo(bsdf("diffuse")).value[0] == 0.5f);
    const std::string lamp = "<emitter type='area'/>"; // which is black in Mitsuba if no material is given
    CHECK(albedo(shape("sphere", lamp).bsdf).value[0] == 0);
    CHECK(albedo(shape("sphere", lamp + "<bsdf type='diffuse'/>").bsdf).value[0] == 0.5f);
    CHECK(scene_notes(load("<shape type='sphere'>" + lamp + "</shape>"), true).empty());
    CHECK(albedo(bsdf("diffuse", "<rgb name='reflectance' value='0.1, 0.2, 0.3'/>")).value[2] == 0.3f);
    CHECK(albedo(bsdf("diffuse", "<spectrum name='reflectance' value='1'/>")).value[1] == 1.f);

    const auto glass = [&](const std::string &body) { return bsdf("dielectric", body).as<bsdf_dielectric_record>(); };
    CHECK(glass("").int_ior.value == 1.5046f); // bk7 in air
    CHECK(glass("").ext_ior.value == 1.000277f);
    CHECK(glass("<float name='int_ior' value='1.9'/>").int_ior.value == 1.9f);
    CHECK(glass("<string name='int_ior' value='Diamond'/>").int_ior.value == 2.419f);
    CHECK(glass("<string name='ext_ior' value='water'/>").ext_ior.value == 1.333f);

    CHECK(bsdf("conductor").is<bsdf_mirror_record>());
    CHECK(bsdf("conductor", "<string name='material' value='none'/>").is<bsdf_mirror_record>());
    CHECK(bsdf("null").is<bsdf_null_record>());

    const auto gold = bsdf("conductor", "<string name='material' value='Au'/>").as<bsdf_conductor_record>();
    CHECK(gold.eta.value[0] == Approx(0.143).epsilon(1e-3));
    CHECK(gold.k.value[2] == Approx(1.603).epsilon(1e-3));
    CHECK(bsdf("conductor", "<float name='eta' value='1.5'/>").as<bsdf_conductor_record>().k.value[1] == 1);
    const std::string squares = "<texture name='alpha' type='checkerboard'/>";
    const auto facets = [&](const std::string &body) { return bsdf("roughconductor", body); };
    CHECK(facets("").as<bsdf_roughconductor_record>().alpha_u.value == 0.1f);
    CHECK(facets("").as<bsdf_roughconductor_record>().ggx == 0);
    CHECK(facets("").as<bsdf_roughconductor_record>().sample_visible == 1);
    CHECK(facets("<string name='distribution' value='GGX'/>").as<bsdf_roughconductor_record>().ggx == 1);
    CHECK(facets("<float name='alpha' value='0.3'/>").as<bsdf_roughconductor_record>().alpha_v.value == 0.3f);
    CHECK(facets(squares).textures.size() == 2);
    CHECK_FALSE(facets(squares).traits() & OPAL_TANGENTS);
    CHECK(facets("<float name='alpha_u' value='0'/><float name='alpha_v' value='0.3'/>").traits() & OPAL_TANGENTS);
    // Without roughness they are smooth.
    CHECK(facets("<float name='alpha' value='0'/>").is<bsdf_mirror_record>());
    const Bsdf smooth = facets("<float name='alpha' value='0'/><string name='material' value='Cu'/>"
                               "<texture name='specular_reflectance' type='checkerboard'/>");
    CHECK(smooth.is<bsdf_conductor_record>());
    CHECK(smooth.as<bsdf_conductor_record>().k.value[0] == Approx(find_metal("Cu")->k[0]));
    CHECK(smooth.textures.size() == 1);
    const Bsdf pane = bsdf("roughdielectric", "<float name='alpha' value='0'/><string name='int_ior' value='diamond'/>"
                                              "<rgb name='specular_transmittance' value='0.1 0.2 0.3'/>");
    CHECK(pane.as<bsdf_dielectric_record>().int_ior.value == 2.419f);
    CHECK(pane.as<bsdf_dielectric_record>().specular_transmittance.value[2] == 0.3f);
    CHECK(bsdf("thindielectric").as<bsdf_thindielectric_record>().int_ior.value == 1.5046f);

    const std::string inner = "<bsdf type='diffuse'><float name='reflectance' value='0.25'/></bsdf>";
    const Bsdf two = bsdf("twosided", inner);
    CHECK(two.is<bsdf_twosided_record>());
    REQUIRE(two.children.size() == 1); // of both sides
    CHECK(albedo(two.children[0]).value[0] == 0.25f);
    const Bsdf pair = bsdf("twosided", inner + "<bsdf type='diffuse'/>");
    CHECK(albedo(pair.children[0]).value[0] == 0.25f);
    CHECK(albedo(pair.children[1]).value[0] == 0.5f);
    CHECK(bsdf("twosided", "<bsdf type='twosided'>" + inner + "</bsdf>").children[0].is<bsdf_twosided_record>());

    const Bsdf mask = bsdf("mask", inner);
    REQUIRE(mask.is<bsdf_mask_record>());
    CHECK(mask.as<bsdf_mask_record>().opacity.value == 0.5f);
    CHECK(bsdf("mask", inner + "<rgb name='opacity' value='0.9, 0.3, 0'/>").as<bsdf_mask_record>().opacity.value ==
          Approx(0.4)); // the mean, as Mitsuba has it: its luminance would be 0.41
    CHECK(albedo(mask.children.at(0)).value[0] == 0.25f);
    CHECK(bsdf("mask", inner + "<float name='opacity' value='0.2'/>").as<bsdf_mask_record>().opacity.value == 0.2f);
}

TEST_CASE_METHOD(MitsubaFixture, "Disney's materials have Mitsuba's names", "[mitsuba]") {
    const Bsdf plain = bsdf("principled");
    CHECK(plain.words == words_of(bsdf_principled_record{}));
    CHECK(bsdf("principledthin").words == words_of(bsdf_principledthin_record{}));
    const Bsdf metal = bsdf("principled", "<rgb name='base_color' value='0.1, 0.2, 0.3'/>"
                                          "<texture type='checkerboard' name='roughness'/>"
                                          "<float name='metallic' value='0.5'/><float name='specular' value='0.8'/>"
                                          "<float name='clearcoat_sampling_rate' value='2'/>");
    const auto record = metal.as<bsdf_principled_record>();
    CHECK(record.base_color.value[2] == 0.3f);
    CHECK(record.roughness.value == 1);
    CHECK(metal.textures.size() == 1);
    CHECK(record.metallic.value == 0.5f);
    CHECK(record.eta.value == Approx(1.677315));
    const Bsdf thin = bsdf("principledthin", "<float name='diff_trans' value='1.5'/><float name='eta' value='1.3'/>");
    CHECK(thin.as<bsdf_principledthin_record>().diff_trans.value == 1.5f);
    CHECK(thin.as<bsdf_principledthin_record>().eta.value == 1.3f);
    CHECK(bsdf("twosided", "<bsdf type='principled'/>").is<bsdf_twosided_record>());
}

TEST_CASE_METHOD(MitsubaFixture, "plastics have Mitsuba's names and defaults", "[mitsuba]") {
    const Bsdf plain = bsdf("plastic");
    CHECK(plain.words == words_of(bsdf_plastic_record{}));
    CHECK(bsdf("roughplastic").words == words_of(bsdf_roughplastic_record{}));
    const Bsdf rough = bsdf("roughplastic", "<rgb name='diffuse_reflectance' value='0.1, 0.2, 0.3'/>"
                                            "<texture type='checkerboard' name='specular_reflectance'/>"
                                            "<boolean name='nonlinear' value='true'/><string name='int_ior' "
                                            "value='Water'/><float name='ext_ior' value='1'/><float name='alpha' "
                                            "value='0.3'/><string name='distribution' value='GGX'/><boolean "
                                            "name='sample_visible' value='false'/>");
    const auto record = rough.as<bsdf_roughplastic_record>();
    CHECK(record.diffuse_reflectance.value[2] == 0.3f);
    CHECK(record.specular_reflectance.value[0] == 1);
    CHECK(rough.textures.size() == 1);
    CHECK(record.nonlinear == 1);
    CHECK(record.int_ior.value == 1.333f);
    CHECK(record.ext_ior.value == 1);
    CHECK(record.alpha.value == 0.3f);
    CHECK(record.ggx == 1);
    CHECK(record.sample_visible == 0);
    CHECK(bsdf("roughplastic", "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.3'/>").words ==
          words_of(bsdf_roughplastic_record{.alpha = 0.3f}));
    // Without roughness it is the smooth one, with its textures.
    const Bsdf smooth = bsdf("roughplastic", "<float name='alpha' value='0'/><boolean name='nonlinear' value='true'/>"
                                             "<texture type='checkerboard' name='diffuse_reflectance'/>");
    CHECK(smooth.words == words_of(bsdf_plastic_record{.diffuse_reflectance = 1, .nonlinear = 1}));
    CHECK(smooth.textures.size() == 1);
    CHECK(bsdf("twosided", "<bsdf type='plastic'/>").is<bsdf_twosided_record>());
    CHECK((plain.traits() & (OPAL_SMOOTH | OPAL_DISCRETE)) == (OPAL_SMOOTH | OPAL_DISCRETE));
}

TEST_CASE_METHOD(MitsubaFixture, "one material serves all that refer to it", "[mitsuba]") {
    const SceneDescription scene = load("<shape type='sphere'><ref id='red'/></shape>"
                                        "<bsdf type='diffuse' id='red'><rgb name='reflectance' value='0.5 0 0'/></bsdf>"
                                        "<shape type='cube'><ref id='red'/></shape><shape type='cube'/>");
    REQUIRE(scene.meshes.size() == 3);
    CHECK(scene.meshes[0].bsdf.words == scene.meshes[1].bsdf.words);
    CHECK(scene.meshes[2].bsdf.place.line == 0);
    REQUIRE(scene.plugins.size() == 3);
    CHECK(scene.plugins[0].type == "diffuse");
    CHECK(scene.plugins[0].count == 1);
    CHECK(scene.plugins[2].type == "cube");
    CHECK(scene.plugins[2].becomes == "triangles");
    CHECK(scene.plugins[2].count == 2);
}

TEST_CASE_METHOD(MitsubaFixture, "what Opal cannot render is an error with its place", "[mitsuba]") {
    struct Row {
        std::string body, error;
    };
    const auto in_shape = [](const std::string &body) { return "<shape type='sphere'>\n" + body + "</shape>"; };
    const auto in_bsdf = [&](const std::string &type, const std::string &body) {
        return "<shape type='sphere'><bsdf type='" + type + "'>\n" + body + "</bsdf></shape>";
    };
    const auto in_light = [](const std::string &type, const std::string &body) {
        return "<emitter type='" + type + "'>\n" + body + "</emitter>";
    };
    const auto in_sensor = [](const std::string &type, const std::string &body) {
        return "<sensor type='" + type + "'>\n" + body + "</sensor>";
    };
    const auto in_film = [&](const std::string &body) {
        return in_sensor("perspective", "<film type='hdrfilm'>" + body + "</film>");
    };
    const auto in_integrator = [](const std::string &type, const std::string &body) {
        return "<integrator type='" + type + "'>\n" + body + "</integrator>";
    };
    const std::vector<Row> rows = {
        {in_shape(transform("<scale x='2'/>")),
         ":3:1: property 'to_world': it scales a sphere by 2, 1 and 1 along its axes"},
        {in_shape(transform("<matrix value='1 0.5 0 0 1 0 0 0 1'/>")), ":3:1: property 'to_world': it scales a sphere"},
        {in_shape("<float name='radius' value='-1'/>"), ":3:1: property 'radius': must be above 0"},
        {in_shape("<float name='raduis' value='1'/>"),
         ":3:1: unknown property 'raduis' of shape 'sphere'; did you mean 'radius'?"},
        {in_shape("<string name='filename' value='a.obj'/>"), ":3:1: unknown property 'filename' of shape 'sphere'"},
        {in_shape("<bsdf type='diffuse'/><bsdf type='diffuse'/>"), ":3:23: a second <bsdf> in the <shape>"},
        {in_shape("<emitter type='area'/><emitter type='area'/>"), ":3:23: a second <emitter> in the <shape>"},
        {in_shape("<emitter type='point'/>"), ":3:1: emitter 'point' must stand in a <scene>, not in a <shape>"},
        {in_light("area", ""), ":2:1: emitter 'area' must stand in a <shape>, not in a <scene>"},
        {"<shape type='obj'/>", ":2:1: the shape lacks its filename"},
        {"<shape type='obj'>\n<string name='filename' value='b.obj'/></shape>", ":3:1: property 'filename': "},
        {in_bsdf("diffuse", "<rgb name='reflectance' value='1.5'/>"),
         ":3:1: property 'reflectance': 1.5, 1.5, 1.5 is no"},
        {in_bsdf("dielectric", "<string name='int_ior' value='bk8'/>"),
         ":3:1: property 'int_ior': unknown medium 'bk8'; did you mean 'bk7'?"},
        {in_bsdf("dielectric", "<float name='int_ior' value='-1'/>"), ":3:1: property 'int_ior': must be above 0"},
        {in_bsdf("dielectric", "<rgb name='int_ior' value='1'/>"),
         ":3:1: property 'int_ior' is a <rgb> here, but must"},
        {in_bsdf("dielectric", "<float name='specular_reflectance' value='1.5'/>"),
         ":3:1: property 'specular_reflectance': must be 0 to 1"},
        {in_bsdf("conductor", "<string name='material' value='au'/>"),
         ":3:1: property 'material': unknown material 'au'; did you mean 'Au'?"},
        {in_bsdf("conductor", "<rgb name='k' value='-1 2 3'/>"), ":3:1: property 'k': must be 0 or more"},
        {in_bsdf("conductor", "<string name='material' value='Au'/>\n<float name='eta' value='1'/>"),
         ":4:1: property 'eta': a metal has either a material, or eta and k"},
        {in_bsdf("roughconductor", "<float name='alpha' value='1.5'/>"), ":3:1: property 'alpha': must be 0 to 1"},
        {in_bsdf("roughconductor", "<float name='alpha' value='0.5'/>\n<float name='alpha_v' value='0.5'/>"),
         ":4:1: property 'alpha_v': there is either alpha, or alpha_u and alpha_v"},
        {in_bsdf("roughconductor", "<float name='alpha_u' value='0.5'/>"),
         ":2:22: alpha_u and alpha_v must be given together"},
        {in_bsdf("roughconductor", "<string name='distribution' value='phong'/>"),
         ":3:1: property 'distribution': unknown distribution 'phong'; available: beckmann, ggx"},
        {in_bsdf("roughdielectric", "<float name='int_ior' value='1.5'/><float name='ext_ior' value='1.5'/>"),
         ":3:1: property 'int_ior': must differ from ext_ior"},
        {in_bsdf("roughplastic", "<float name='int_ior' value='1.5'/><float name='ext_ior' value='1.5'/>"),
         ":3:1: property 'int_ior': must differ from ext_ior"},
        {in_bsdf("roughplastic", "<float name='alpha' value='-0.1'/>"), ":3:1: property 'alpha': must be 0 to 1"},
        {in_bsdf("roughplastic", "<float name='alpha' value='1.5'/>"), ":3:1: property 'alpha': must be 0 to 1"},
        {in_bsdf("roughplastic", "<float name='alpha_u' value='0.2'/>\n<float name='alpha_v' value='0.3'/>"),
         ":4:1: property 'alpha_v': must be alpha_u: roughplastic has one roughness in all directions"},
        {in_bsdf("roughplastic", "<float name='alpha_v' value='0.3'/>"),
         ":2:22: alpha_u and alpha_v must be given together"},
        {in_bsdf("roughplastic", "<texture name='alpha' type='checkerboard'/>"),
         ":3:1: property 'alpha' is a <texture> here, but must"},
        {in_bsdf("roughplastic", "<float name='alpha' value='0'/>\n<float name='int_ior' value='4'/>"),
         ":4:1: property 'int_ior': must be at most 3.8 times ext_ior"},
        {in_bsdf("plastic", "<float name='int_ior' value='4'/>"),
         ":3:1: property 'int_ior': must be at most 3.8 times ext_ior"},
        {in_bsdf("plastic", "<rgb name='diffuse_reflectance' value='-1 0 0'/>"),
         ":3:1: property 'diffuse_reflectance': -1, 0, 0 is no reflectance, which is 0 to 1"},
        {in_bsdf("plastic", "<rgb name='specular_reflectance' value='2'/>"),
         ":3:1: property 'specular_reflectance': 2, 2, 2 is no reflectance, which is 0 to 1"},
        {in_bsdf("plastic", "<float name='alpha' value='0.1'/>"), ":3:1: unknown property 'alpha' of bsdf 'plastic'"},
        {in_bsdf("twosided", "<bsdf type='dielectric'/>"), ":3:1: a twosided cannot hold a BSDF that light passes"},
        {in_bsdf("twosided", "<bsdf type='null'/>"), ":3:1: a twosided cannot hold a BSDF that light passes"},
        {in_bsdf("twosided", "<bsdf type='mask'><bsdf type='diffuse'/></bsdf>"), ":3:1: a twosided cannot hold a BSDF"},
        {in_bsdf("twosided", ""), ":2:22: a twosided has 1 or 2 <bsdf> within it, not 0"},
        {in_bsdf("principled", "<float name='eta' value='1.4'/><float name='specular' value='0.5'/>"),
         ":3:32: property 'specular': stands for eta, which is given too"},
        {in_bsdf("twosided", "<bsdf type='principled'><float name='spec_trans' value='0.5'/></bsdf>"),
         ":3:1: a twosided cannot hold a BSDF"},
        {in_bsdf("twosided", "<bsdf type='principledthin'/>"), ":3:1: a twosided cannot hold a BSDF"},
        {in_bsdf("mask", ""), ":2:22: a mask has 1 <bsdf> within it, not 0"},
        {in_bsdf("mask", "<bsdf type='diffuse'/><bsdf type='diffuse'/>"),
         ":2:22: a mask has 1 <bsdf> within it, not 2"},
        {in_bsdf("null", "<float name='reflectance' value='1'/>"),
         ":3:1: unknown property 'reflectance' of bsdf 'null'"},
        {in_light("point", "<point name='position' value='1 2 3'/>" + transform("")),
         ":3:1: property 'position': stands beside to_world"},
        {in_light("directional", "<vector name='direction' value='1 2 3'/>" + transform("")),
         ":3:1: property 'direction': stands beside to_world"},
        {in_light("directional", "<vector name='direction' value='0 0 0'/>"),
         ":3:1: property 'direction': must not be"},
        {in_light("spot", "<point name='position' value='1 2 3'/>"),
         ":3:1: unknown property 'position' of emitter 'spot'"},
        {in_light("spot", transform("<scale z='2'/>")), ":3:1: property 'to_world': a spot light must be scaled alike"},
        {in_light("spot", "<texture name='texture' type='wood'/>"), ":3:1: unknown texture type 'wood'"},
        {in_light("point", "<texture name='texture' type='checkerboard'/>"), ":3:1: "},
        {in_light("spot", "<float name='cutoff_angle' value='90'/><texture name='texture' type='checkerboard'/>"),
         ":3:1: property 'cutoff_angle': must be below 90 degrees"},
        {in_light("spot", "<float name='cutoff_angle' value='0'/>"), ":3:1: property 'cutoff_angle': must be above 0"},
        {in_light("constant", "<rgb name='radiance' value='-1 0 0'/>"),
         ":3:1: property 'radiance': must not be negative"},
        {in_sensor("perspective", transform("<scale value='1.01'/>")),
         ":3:1: property 'to_world': must not scale a perspective camera"},
        {in_sensor("thinlens", transform("<scale value='1.01'/>") + "<float name='aperture_radius' value='1'/>"),
         ":3:1: property 'to_world': must not scale a thinlens camera"},
        {in_sensor("thinlens", ""), ":2:1: the camera lacks its aperture_radius"},
        {in_sensor("perspective", "<float name='fov' value='180'/>"),
         ":3:1: property 'fov': must be above 0 and below 180"},
        {in_sensor("perspective", "<float name='fov' value='40'/><string name='focal_length' value='50mm'/>"),
         ":3:31: property 'focal_length': stands beside fov"},
        {in_sensor("perspective", "<string name='focal_length' value='50cm'/>"),
         ":3:1: property 'focal_length': must be a length in millimetres"},
        {in_sensor("perspective", "<float name='fov' value='40'/><string name='fov_axis' value='z'/>"),
         ":3:31: property 'fov_axis': unknown axis 'z'; available: x, y, diagonal, smaller, larger"},
        {in_sensor("perspective", "<string name='fov_axis' value='x'/>"), ":3:1: property 'fov_axis': means nothing"},
        {in_sensor("perspective", "<float name='near_clip' value='0'/>"),
         ":3:1: property 'near_clip': must be above 0"},
        {in_sensor("perspective", "<float name='far_clip' value='0.001'/>"),
         ":3:1: property 'far_clip': must be larger"},
        {in_sensor("orthographic", "<float name='fov' value='40'/>"), ":3:1: unknown property 'fov'"},
        {in_sensor("perspective", "<film type='hdrfilm'/><film type='hdrfilm'/>"), ":3:23: a second <film>"},
        {in_film("<integer name='crop_offset_x' value='9'/>"), ":3:1: a crop of 768 x 576 pixels at 9, 0 is no part"},
        {in_film("<integer name='width' value='0'/>"), ":3:22: property 'width': must be at least 1 pixel"},
        {in_film("<string name='pixel_format' value='rbg'/>"), ":3:22: property 'pixel_format': unknown format 'rbg'"},
        {in_film("<rfilter type='gaussian'><float name='stddev' value='0'/></rfilter>"), ":3:22: gaussian, radius 0"},
        {in_film("<rfilter type='box'/><rfilter type='box'/>"), ":3:43: a second <rfilter>"},
        {in_sensor("perspective", "<sampler type='stratified'><boolean name='jitter' value='false'/></sampler>"),
         ":3:28: property 'jitter': Opal jitters"},
        {in_sensor("perspective", "<sampler type='independent'><integer name='sample_count' value='0'/></sampler>"),
         ":3:29: property 'sample_count': must be at least 1"},
        {in_integrator("path", "<integer name='max_depth' value='0'/>"),
         ":3:1: property 'max_depth': 0 would be a black"},
        {in_integrator("path", "<integer name='max_depth' value='-2'/>"),
         ":3:1: property 'max_depth': must be at least 1"},
        {in_integrator("path", "<integer name='rr_depth' value='0'/>"),
         ":3:1: property 'rr_depth': must be at least 1"},
        {in_integrator("direct", "<integer name='shading_samples' value='2'/><integer name='bsdf_samples' value='1'/>"),
         ":3:1: property 'shading_samples': stands beside"},
        {in_integrator("direct", "<integer name='shading_samples' value='0'/>"),
         ":2:1: emitter_samples and bsdf_samples are both 0"},
        {in_integrator("moment", ""), ":2:1: moment holds no <integrator> that renders"},
        {in_integrator("aov", "<integrator type='path'/>"), ":2:1: aov lacks its property 'aovs'"},
        {in_integrator("moment", "<integrator type='path'/><integrator type='path'/>"), ":3:26: a second <integrator>"},
        {"<integrator type='path'/><integrator type='path'/>", ":2:26: a second <integrator> in the <scene>"},
    };
    for (const Row &row : rows) {
        INFO(row.body);
        const std::string error = error_in(row.body);
        CHECK_THAT(error, Catch::StartsWith(row.error));
        CHECK(error.find('\n') == error.npos);
    }
}

TEST_CASE_METHOD(MitsubaFixture, "plug-ins that Opal does not have are all named in one run", "[mitsuba]") {
    const std::string body = "<shape type='cylinder'/>\n<shape type='cylinder'><bsdf type='hair'/></shape>\n"
                             "<bsdf type='hair' id='b'/>\n<emitter type='sunsky'><string name='filename' value='x'/>"
                             "</emitter>\n<medium type='homogeneous' id='m'/>\n"
                             "<shape type='sphere'><bsdf type='diffuse'><texture name='reflectance' type='volume'>"
                             "<string name='filename' value='x.png'/></texture></bsdf></shape>\n"
                             "<integrator type='ptracer'/><sensor type='batch'/>\n"
                             "<sensor type='perspective'><film type='specfilm'/><sampler type='halton'/></sensor>";
    CHECK(
        error_in(body) ==
        ":2:1: unknown shape type 'cylinder' (2 in the scene); available: obj, ply, sphere, rectangle, cube\n"
        ":3:24: unknown bsdf type 'hair' (2 in the scene); available: diffuse, dielectric, thindielectric, "
        "roughdielectric, conductor, roughconductor, plastic, roughplastic, twosided, "
        "mask, blendbsdf, normalmap, bumpmap, null, principled, principledthin\n"
        ":5:1: unknown emitter type 'sunsky'; available: area, point, spot, directional, projector, constant, envmap\n"
        ":6:1: unknown medium type 'homogeneous'; available: none\n"
        ":7:43: unknown texture type 'volume'; available: checkerboard, bitmap, mesh_attribute\n"
        ":8:1: unknown integrator type 'ptracer'; available: path, volpath, volpathmis, direct, moment, aov\n"
        ":8:29: unknown sensor type 'batch'; available: perspective, thinlens, orthographic\n"
        ":9:28: unknown film type 'specfilm'; available: hdrfilm\n"
        ":9:51: unknown sampler type 'halton'; available: independent, stratified, multijitter, orthogonal, ldsampler");
    // Those within others, too.
    CHECK_THAT(error_in("<bsdf type='hair'>\n<texture name='diffuse_reflectance' type='wood'/></bsdf>\n"
                        "<sensor type='batch'>\n<film type='specfilm'/>\n<sampler type='halton'/></sensor>"),
               Catch::Contains("\n:3:1: unknown texture type 'wood'") &&
                   Catch::Contains("\n:5:1: unknown film type 'specfilm'") &&
                   Catch::Contains("\n:6:1: unknown sampler type 'halton'"));
}

TEST_CASE_METHOD(MitsubaFixture, "lenient: what stands in for a plug-in is said", "[mitsuba]") {
    const LoadOptions lenient{.lenient = true};
    const std::string body =
        "<shape type='disk'/><shape type='sphere'><bsdf type='hair'><bsdf type='x'/></bsdf></shape>\n"
        "<emitter type='constant'><texture name='radiance' type='checkerboard'><float name='color0' "
        "value='0.6'/></texture>"
        "</emitter>\n"
        "<shape type='cube'><bsdf type='diffuse'><texture name='reflectance' type='volume'/></bsdf></shape>";
    const SceneDescription scene = load(body, lenient);
    REQUIRE(scene.meshes.size() == 2);
    CHECK(scene.meshes[0].bsdf.as<bsdf_diffuse_record>().albedo.value[0] == 0.5f);
    CHECK(scene.meshes[1].bsdf.as<bsdf_diffuse_record>().albedo.value[0] == 0.5f);
    REQUIRE(scene.lights.size() == 1);
    CHECK(std::get<emitter_constant>(scene.lights[0].parameters).radiance[1] == Approx(0.4));
    std::vector<std::string> told = warnings_of(body, lenient);
    std::ranges::sort(told);
    REQUIRE(told.size() == 4);
    CHECK_THAT(told[0],
               Catch::StartsWith(":2:1: unknown shape type 'disk'") && Catch::EndsWith("; the shape is left out"));
    CHECK_THAT(told[1], Catch::StartsWith(":2:42: unknown bsdf type 'hair'") &&
                            Catch::EndsWith("; a diffuse one of reflectance 0.5 stands in for it"));
    CHECK(told[2] == ":3:26: property 'radiance': Opal has no texture here yet; 0.4 0.4 0.4 stands in for it");
    CHECK_THAT(told[3],
               Catch::StartsWith(":4:41: unknown texture type 'volume'") && Catch::EndsWith("; 0.5 stands in for it"));
    CHECK(error_in("<emitter type='constant'><texture name='radiance' type='checkerboard'/></emitter>") ==
          ":2:26: property 'radiance': Opal has no texture here yet");
}

TEST_CASE_METHOD(MitsubaFixture, "objects that nothing uses are looked at, too", "[mitsuba]") {
    CHECK(error_in(lit + "\n<film type='specfilm' id='f'/>\n<sampler type='halton' id='s'/>\n<rfilter type='sinc' "
                         "id='r'/>") ==
          ":3:1: unknown film type 'specfilm'; available: hdrfilm\n"
          ":4:1: unknown sampler type 'halton'; available: independent, stratified, multijitter, orthogonal, "
          "ldsampler\n"
          ":5:1: unknown rfilter type 'sinc'; available: box, tent, gaussian, mitchell, catmullrom, lanczos");
    CHECK_THAT(error_in(lit + "<film type='hdrfilm' id='f'><integer name='widht' value='3'/></film>"),
               Catch::StartsWith(":2:55: unknown property 'widht' of film 'hdrfilm'; available: width"));
    // One that a sensor refers to is looked at once.
    CHECK(error_in(lit + "<sampler type='independent' id='s'>\n<integer name='sample_count' value='0'/></sampler>"
                         "<sensor type='perspective'><ref id='s'/></sensor>") ==
          ":3:1: property 'sample_count': must be at least 1 sample per pixel");
}

TEST_CASE_METHOD(MitsubaFixture, "an area light may stand in the scene if a shape refers to it", "[mitsuba]") {
    const std::string lamp = "<emitter type='area' id='lamp'><rgb name='radiance' value='1 2 3'/></emitter>\n";
    const std::string ball = "<shape type='sphere'><ref id='lamp'/></shape>\n";
    for (const std::string &body : {lamp + ball, ball + lamp}) {
        const SceneDescription scene = load(body);
        CHECK(scene.lights.empty());
        REQUIRE(scene.meshes.size() == 1);
        CHECK(scene.meshes[0].radiance == Color{1, 2, 3});
    }
    CHECK(load(lamp + ball + ball).meshes.at(1).radiance == Color{1, 2, 3});
    CHECK_THAT(error_in(lamp), Catch::StartsWith(":2:1: emitter 'area' must stand in a <shape>"));
}

TEST_CASE_METHOD(MitsubaFixture, "lenient: files that are missing are named, with what stands in for them",
                 "[mitsuba]") {
    const std::string body =
        lit + "<shape type='ply'>\n<string name='filename' value='b.ply'/></shape><shape type='cube'><bsdf "
              "type='diffuse'><texture name='reflectance' type='bitmap'>\n<string name='filename' "
              "value='b.png'/></texture></bsdf></shape>";
    CHECK_THAT(error_in(body),
               Catch::StartsWith(":3:1: property 'filename': ") && Catch::Contains("\n:4:1: property 'filename': "));
    const SceneDescription scene = load(body, {.lenient = true});
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].bsdf.textures.empty());
    CHECK(scene.meshes[0].bsdf.as<bsdf_diffuse_record>().albedo.value[0] == 0.5f);
    const std::vector<std::string> told = warnings_of(body, {.lenient = true});
    REQUIRE(told.size() == 2);
    std::vector<std::string> sorted = told;
    std::ranges::sort(sorted);
    CHECK_THAT(sorted[0],
               Catch::StartsWith(":3:1: property 'filename': ") && Catch::EndsWith("; the shape is left out"));
    CHECK_THAT(sorted[1],
               Catch::StartsWith(":4:1: property 'filename': ") && Catch::EndsWith("; 0.5 stands in for the texture"));
}

TEST_CASE_METHOD(MitsubaFixture, "textures of mesh attributes have the attribute of the shape", "[mitsuba]") {
    const std::string head =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    const std::string tail = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
    scratch.write("b.ply", head + "property float red\nproperty float green\nproperty float blue\n" + tail +
                               "0 0 0 0.25 0.5 1\n1 0 0 0 0 0\n0 1 0 1 1 1\n3 0 1 2\n");
    const auto material = [](const std::string &name, const std::string &more = "") {
        return "<bsdf type='diffuse' id='b'><texture name='reflectance' type='mesh_attribute'><string name='name' "
               "value='" +
               name + "'/>" + more + "</texture></bsdf>\n";
    };
    const std::string ply = "<shape type='ply'><string name='filename' value='b.ply'/><ref id='b'/></shape>\n";
    const SceneDescription scene = load(material("vertex_color", "<float name='scale' value='0.5'/>") + ply + ply);
    REQUIRE(scene.meshes.size() == 2);
    std::vector<std::shared_ptr<const MeshAttribute>> found;
    for (const Mesh &mesh : scene.meshes) {
        const auto texture =
            std::get<MeshAttributeTexture>(mesh.bsdf.textures.at(bsdf_parameters(BSDF_diffuse)[0].texture_word));
        CHECK(texture.scale == 0.5);
        REQUIRE(texture.attribute);
        CHECK(texture.attribute->channels == 3);
        CHECK(texture.attribute->values[2] == 1);
        CHECK(std::get<TriangleMesh>(mesh.shape).attributes.at(0) == texture.attribute);
        found.push_back(texture.attribute);
    }
    CHECK(found[0] != found[1]); // each of its own mesh
    // Nobody reads what no texture names.
    CHECK(std::get<TriangleMesh>(shape("ply", "<string name='filename' value='b.ply'/>").shape).attributes.empty());

    const std::string lacking =
        ": the shape has no attribute 'vertex_color', which a texture of its material or light names";
    const std::string cube = "<shape type='cube'><ref id='b'/></shape>",
                      ball = "<shape type='sphere'><ref id='b'/></shape>";
    CHECK_THAT(error_in(material("vertex_color") + cube), Catch::StartsWith(":3:1" + lacking));
    CHECK_THAT(error_in(material("vertex_color") + ply + ball), Catch::StartsWith(":4:1" + lacking));
    CHECK_THAT(error_in(material("vertex_foo") + ply),
               Catch::StartsWith(":3:1: the shape has no attribute 'vertex_foo'"));
    CHECK_THAT(error_in(material("color") + ply),
               Catch::Contains("property 'name': the texture needs the name of an attribute"));
    CHECK_THAT(error_in(material("vertex_color", "<transform name='to_uv'/>") + ply),
               Catch::Contains("unknown property 'to_uv' of texture 'mesh_attribute'"));
    CHECK_THAT(error_in("<emitter type='spot'>\n<texture name='texture' type='mesh_attribute'><string name='name' "
                        "value='vertex_color'/></texture></emitter>"),
               Catch::StartsWith(":3:1: property 'texture': a spot is no mesh"));
    const std::vector<std::string> told = warnings_of(lit + material("vertex_color") + cube, {.lenient = true});
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::EndsWith("; 0.5 stands in for it"));
    // Values beyond what reflects are told.
    const std::vector<std::string> bright =
        warnings_of(lit + material("vertex_color", "<float name='scale' value='-2'/>") + ply);
    REQUIRE(bright.size() == 1);
    CHECK_THAT(bright[0], Catch::StartsWith(":3:1: the texture has values from -2 to -0"));
}

TEST_CASE_METHOD(MitsubaFixture, "textures of reflectance and opacity", "[mitsuba]") {
    const auto texture_of = [&](const Bsdf &made) {
        REQUIRE(made.textures.size() == 1);
        return made.textures.begin()->second;
    };
    const auto textured_cube = [&](const std::string &type, const std::string &body) {
        return shape("cube", fmt::format("<bsdf type='{}'>{}</bsdf>", type, body)).bsdf;
    };
    const auto textured = [&](const std::string &type, const std::string &body) {
        return textured_cube("diffuse", fmt::format("<texture name='reflectance' type='{}'>{}</texture>", type, body));
    };
    const Bsdf plain = textured("checkerboard", "");
    CHECK(plain.as<bsdf_diffuse_record>().albedo.value[1] == 1.f);
    const auto squares = std::get<CheckerboardTexture>(texture_of(plain));
    CHECK(squares.color0 == Color{0.4, 0.4, 0.4});
    CHECK(squares.color1 == Color{0.2, 0.2, 0.2});
    CHECK(squares.to_uv == identity_uv);
    const auto moved = std::get<CheckerboardTexture>(texture_of(textured(
        "checkerboard", "<rgb name='color0' value='0.1 0.2 0.3'/><float name='color1' value='0.9'/>"
                        "<transform name='to_uv'><scale x='5' y='4'/><translate x='0.5' y='0.25'/></transform>")));
    CHECK(moved.color0 == Color{0.1, 0.2, 0.3});
    CHECK(moved.color1[2] == 0.9);
    CHECK(moved.to_uv == UvTransform{{{5, 0, 0.5}, {0, 4, 0.25}}});
    // a 3 x 3 matrix loses its translation, as in Mitsuba
    CHECK(std::get<CheckerboardTexture>(
              texture_of(
                  textured("checkerboard", "<transform name='to_uv'><matrix value='2 0 7 0 3 7 0 0 1'/></transform>")))
              .to_uv == UvTransform{{{2, 0, 0}, {0, 3, 0}}});

    Image image;
    image.width = 2;
    image.height = 1;
    image.layers = {{"R", {0.5f, 1}}, {"G", {0.25f, 1}}, {"B", {0, 1}}};
    write_exr(image, scratch / "a.exr");
    const std::string file = "<string name='filename' value='a.exr'/>";
    const auto bitmap = std::get<BitmapTexture>(texture_of(textured("bitmap", file)));
    CHECK(bitmap.picture->width == 2);
    CHECK_FALSE(bitmap.raw);
    CHECK_FALSE(bitmap.nearest);
    CHECK(bitmap.wrap == WRAP_repeat);
    const auto other = std::get<BitmapTexture>(texture_of(
        textured("bitmap", file + "<string name='filter_type' value='nearest'/><boolean name='raw' value='true'/>"
                                  "<string name='wrap_mode' value='clamp'/>")));
    CHECK(other.raw);
    CHECK(other.nearest);
    CHECK(other.wrap == WRAP_clamp);
    const Mesh lamp =
        shape("sphere", "<emitter type='area'><texture name='radiance' type='bitmap'>" + file + "</texture></emitter>");
    CHECK(lamp.radiance == Color{1, 1, 1});
    CHECK(std::get<BitmapTexture>(lamp.texture.value()).picture->width == 2);
    const auto slides = [&](const std::string &axis) { // of 2 x 2 pixels, as one row is doubled
        return light<emitter_projector>("projector", "<texture name='irradiance' type='bitmap'>" + file +
                                                         "</texture><float name='fov' value='40'/>"
                                                         "<string name='fov_axis' value='" +
                                                         axis + "'/>");
    };
    CHECK(slides("y").aspect == 1);
    CHECK(slides("y").fov == Approx(40));
    // 2 atan(tan 20 degrees / sqrt 2)
    CHECK(slides("diagonal").fov == Approx(28.8655).margin(1e-4));
    const Bsdf mask = textured_cube("mask", "<texture name='opacity' type='checkerboard'/><bsdf type='diffuse'/>");
    CHECK(mask.as<bsdf_mask_record>().opacity.value == 1.f);
    REQUIRE(mask.textures.size() == 1);
    const auto exchanged = std::get<CheckerboardTexture>(mask.textures.begin()->second); // of a number
    CHECK(exchanged.color0 == Color{0.2, 0.2, 0.2});
    CHECK(exchanged.color1 == Color{0.4, 0.4, 0.4});
    // A turned rectangle's sides are exchanged, but not its texture coordinates.
    for (const std::string &turn : {mirrored, std::string("<boolean name='flip_normals' value='true'/>")})
        CHECK(std::get<Parallelogram>(shape("rectangle", turn).shape).uv_exchanged);
    CHECK_FALSE(
        std::get<Parallelogram>(shape("rectangle", mirrored + "<boolean name='flip_normals' value='true'/>").shape)
            .uv_exchanged);
    // two materials share the picture
    const SceneDescription scene =
        load("<texture type='bitmap' id='t'>" + file +
             "</texture><shape type='cube'>"
             "<bsdf type='diffuse'><ref name='reflectance' id='t'/></bsdf></shape><shape type='cube'>"
             "<bsdf type='diffuse'><texture name='reflectance' type='bitmap'>" +
             file + "</texture></bsdf></shape>");
    CHECK(std::get<BitmapTexture>(texture_of(scene.meshes[0].bsdf)).picture ==
          std::get<BitmapTexture>(texture_of(scene.meshes[1].bsdf)).picture);

    const auto error = [&](const std::string &body) {
        return error_in("<bsdf type='diffuse'><texture name='reflectance' type='bitmap'>\n" + body +
                        "</texture></bsdf>");
    };
    CHECK(error("") == ":2:22: the texture lacks its filename: <string name=\"filename\" value=\"a.png\"/>");
    CHECK(error(file + "<string name='filter_type' value='ewa'/>") ==
          ":3:40: property 'filter_type': unknown value 'ewa'; available: bilinear, nearest");
    CHECK_THAT(error("<string name='filename' value='b.png'/>"), Catch::StartsWith(":3:1: property 'filename': "));
    const std::string no_image = "<string name='filename' value='a.obj'/>";
    CHECK_THAT(error(no_image), Catch::StartsWith(":3:1: property 'filename': ") && Catch::Contains("not an image"));
    const std::vector<std::string> told =
        warnings_of("<emitter type='constant'/><shape type='cube'><bsdf type='diffuse'><texture name='reflectance' "
                    "type='bitmap'>" +
                        no_image + "</texture></bsdf></shape>",
                    {.lenient = true});
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::EndsWith("; 0.5 stands in for the texture"));
}

TEST_CASE_METHOD(MitsubaFixture, "without a sensor or an integrator there are defaults", "[mitsuba]") {
    const SceneDescription scene = load("<shape type='sphere'><emitter type='area'/></shape>");
    CHECK(scene.camera.width == 768);
    CHECK(scene.camera.kind == CAMERA_perspective);
    CHECK(scene.camera.perspective.fov == Approx(38.18).margin(5e-3));
    CHECK(scene.spp == 4);
    CHECK(scene.dialect == Dialect::mitsuba);
    CHECK(warnings_of(lit).empty()); // the sky is seen
    CHECK(warnings_of("<shape type='sphere'/>") ==
          std::vector<std::string>{":1:1: the scene has no <emitter>; it renders black"});
}

TEST_CASE_METHOD(MitsubaFixture, "warnings about a scene have the names of its file", "[mitsuba]") {
    const std::string far = transform("<translate z='20000'/>");
    const auto warned = [&](const std::string &body) {
        const std::vector<std::string> lines = scene_warnings(load(body));
        REQUIRE(lines.size() == 1);
        return lines[0];
    };
    CHECK_THAT(warned(lit + "<shape type='sphere'>" + far + "</shape>"),
               Catch::Contains("it sees depths from near_clip 0.01 to far_clip 10000, and the only mesh lies at"));
    CHECK_THAT(warned(lit + "<shape type='cube'/><shape type='sphere'>" + far + "</shape>"),
               Catch::Contains("does not see 1 mesh beyond far_clip 10000"));
    CHECK_THAT(warned("<shape type='cube'>" + transform("<translate z='-9'/>") +
                      "</shape><emitter type='spot'/>"
                      "<sensor type='perspective'>" +
                      transform("<rotate y='1' angle='180'/>") + "</sensor>"),
               Catch::EndsWith("a spot lights nothing: no mesh lies within cutoff_angle of the axis"));
}

TEST_CASE("the format is told by the version and the tags", "[mitsuba]") {
    const test::ScratchFolder scratch;
    const auto load = [&](const std::string &text, const LoadOptions &options = {}) {
        return load_scene(scratch.write("a.xml", text), options);
    };
    const std::string nori =
        "<scene{}><camera type='perspective'/><mesh type='parallelogram'><point name='origin' "
        "value='0 0 0'/><vector name='u' value='1 0 0'/><vector name='v' value='0 1 0'/></mesh></scene>";
    CHECK(load("<scene version='3.0.0'><shape type='sphere'/></scene>").dialect == Dialect::mitsuba);
    CHECK(load("<scene version='3.0.0'><!-- no <camera> and no <mesh> --><shape type='sphere'/></scene>").dialect ==
          Dialect::mitsuba);
    CHECK(load("<scene version='0.6.0'><shape type='sphere'><transform name='toWorld'><scale value='2'/></transform>"
               "</shape></scene>")
              .meshes.size() == 1);
    CHECK(load(fmt::format(fmt::runtime(nori), "")).dialect == Dialect::upstream);
    CHECK(load(fmt::format(fmt::runtime(nori), " version='1.0'")).dialect == Dialect::upstream);
    CHECK(load(fmt::format(fmt::runtime(nori), " version='3.0.0'")).dialect == Dialect::upstream);
    CHECK(load("<scene version='3.0.0'><shape type='sphere'/></scene>", {.dialect = "mitsuba"}).meshes.size() == 1);
    CHECK_THAT(error_of([&] { load("<scene><shape type='sphere'/><sensor type='perspective'/></scene>"); }),
               Catch::EndsWith("a.xml: has tags of Mitsuba, but its <scene> lacks the version that a scene of Mitsuba "
                               "has, as in <scene version=\"3.0.0\">"));
    CHECK_THAT(error_of([&] { load("<scene><shape type='sphere'/></scene>", {.dialect = "mitsuba"}); }),
               Catch::Contains("lacks the attribute 'version'"));
    CHECK_THAT(error_of([&] { load("<scene version='3.0.0'><shape type='sphere'/></scene>", {.dialect = "eth"}); }),
               Catch::Contains("is a scene of Mitsuba, not one of Nori; render it: opal "));
    CHECK_THAT(error_of([&] { load(fmt::format(fmt::runtime(nori), ""), {.sensor = "0"}); }),
               Catch::Contains("--sensor 0: a scene of Nori has one camera"));
    CHECK_THAT(error_of([&] { load("<bsdf version='3.0.0' type='diffuse'/>"); }),
               Catch::EndsWith("a.xml:1:1: the root is a <bsdf>; a scene's is <scene version=\"3.0.0\">"));
}

TEST_CASE_METHOD(MitsubaFixture, "the scene's hash is that of all files", "[mitsuba]") {
    const std::string body =
        "<include filename='part.xml'/><shape type='obj'><string name='filename' value='a.obj'/></shape>";
    scratch.write("part.xml", "<scene version='3.0.0'><shape type='cube'/></scene>");
    const std::string first = load(body).hash;
    CHECK(load(body).hash == first);
    scratch.write("a.obj", obj_text + "# \n");
    const std::string second = load(body).hash;
    CHECK(second != first);
    scratch.write("part.xml", "<scene version='3.0.0'><shape type='cube'/> </scene>");
    CHECK(load(body).hash != second);
}
