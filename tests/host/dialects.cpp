// Dialects of Nori: which names tell them, what follows, and leftovers that mean nothing.
#include "base/log.h"
#include "read/nori/load.h"
#include "read/nori/names.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <fmt/format.h>

#include <catch2/catch.hpp>

#include <numbers>

using namespace opal;
using opal::test::error_of;

namespace {

const std::string camera = "<camera type='perspective'><transform name='toWorld'><lookat origin='1 2 3' target='0 0 0' "
                           "up='0 1 0'/></transform></camera>\n";
const std::string square =
    "<point name='origin' value='0 0 0'/><vector name='u' value='1 0 0'/><vector name='v' value='0 2 0'/>";
const std::string light = "<mesh type='parallelogram'>" + square +
                          "<emitter type='area'><color name='radiance' value='1 2 3'/></emitter></mesh>\n";

struct DialectFixture {
    test::ScratchFolder scratch;
    SceneDescription load(const std::string &body, const LoadOptions &options = {}) const {
        return load_scene(scratch.write("a.xml", "<scene>\n" + body + "</scene>"), options);
    }
    // The scene around a mesh that holds `bsdf`.
    SceneDescription load_bsdf(const std::string &bsdf, const LoadOptions &options = {}) const {
        return load(camera + light + "<mesh type='parallelogram'>" + square + bsdf + "</mesh>", options);
    }
};

// The x axis of the camera, in the world.
Vec3 camera_x(const SceneDescription &scene) { return scene.camera.to_world.vector({1, 0, 0}); }

std::string integrator(const std::string &type, const std::string &body = "") {
    return "<integrator type='" + type + "'>" + body + "</integrator>";
}

// An element that bears a name of a dialect, as a child of the scene.
std::string element_with(const DialectName &name) {
    if (name.tag == "integrator")
        return integrator(name.name, name.name == "av" ? "<float name='length' value='1'/>" : "");
    if (name.tag == "emitter")
        return "<emitter type='" + name.name + "'><color name='" + name.with + "' value='1 2 3'/></emitter>";
    if (name.tag == "luminaire")
        return "<mesh type='parallelogram'>" + square +
               "<luminaire type='area'><color name='radiance' value='1 1 1'/></luminaire></mesh>";
    REQUIRE(name.tag == "color");
    return "<mesh type='parallelogram'>" + square + "<bsdf type='diffuse'><color name='" + name.name +
           "' value='0.25 0.5 1'/></bsdf></mesh>";
}

} // namespace

TEST_CASE_METHOD(DialectFixture, "every name that tells a dialect loads and tells it", "[dialects]") {
    REQUIRE(dialect_names().size() >= 12);
    for (const DialectName &name : dialect_names()) {
        INFO(name.tag << " " << name.name);
        const size_t before = warnings().size();
        CHECK(load(camera + light + element_with(name)).dialect == name.dialect);
        CHECK(load(camera + light + element_with(name), {.dialect = "course"}).dialect == Dialect::course);
        CHECK(warnings().size() == before);
    }
    CHECK(load(camera + light).dialect == Dialect::upstream);
    CHECK(load(camera + light + integrator("path_mats")).dialect == Dialect::upstream);
    CHECK(error_of([&] { load(camera + light, {.dialect = "ehz"}); }) ==
          "unknown dialect 'ehz'; available: upstream, course, eth, mitsuba");
}

TEST_CASE_METHOD(DialectFixture, "another material's reflectance tells no dialect", "[dialects]") {
    const std::string other = "<bsdf type='velvet'><color name='reflectance' value='1 0 0'/></bsdf>";
    CHECK(load_bsdf(other, {.lenient = true}).dialect == Dialect::upstream);
}

TEST_CASE_METHOD(DialectFixture, "ETH's camera has its x axis to the right of the image", "[dialects]") {
    const Vec3 left = camera_x(load(camera + light)), right = camera_x(load(camera + light + integrator("direct_ems")));
    CHECK(length(left + right) < 1e-15);
    CHECK(length(camera_x(load(camera + light, {.dialect = "eth"})) - right) < 1e-15);
    CHECK(length(camera_x(load(camera + light + integrator("direct"), {.dialect = "upstream"})) - left) < 1e-15);
    CHECK(length(camera_x(load(camera + light + integrator("direct_lighting"))) - left) < 1e-15);
}

TEST_CASE_METHOD(DialectFixture, "the default filter is the dialect's", "[dialects]") {
    const auto filter = [&](const char *dialect) { return load(camera + light, {.dialect = dialect}).camera.filter; };
    CHECK(filter("course").kind == FILTER_box);
    CHECK(filter("eth").kind == FILTER_gaussian);
    CHECK(filter("upstream").kind == FILTER_gaussian);
}

TEST_CASE_METHOD(DialectFixture, "names of two dialects are warned of", "[dialects]") {
    const std::string both = camera + integrator("direct_ems") + "\n" + light +
                             "<emitter type='pointlight'><color name='radiance' value='1 1 1'/></emitter>";
    CHECK(load(both).dialect == Dialect::upstream);
    const std::string file = (scratch / "a.xml").string();
    CHECK_THAT(warnings().back(),
               Catch::StartsWith(file + ":1:1: names of several dialects: emitter 'pointlight' with a 'radiance' at " +
                                 file + ":5:1, and integrator 'direct_ems' at " + file + ":3:1; "));
    const size_t before = warnings().size();
    CHECK(load(both, {.dialect = "eth"}).dialect == Dialect::eth);
    CHECK(warnings().size() == before);
}

TEST_CASE_METHOD(DialectFixture, "integrators by the names of ETH, Zaragoza and 2012", "[dialects]") {
    struct Row {
        const char *name;
        int integrator, lighting;
    };
    const int direct = CHOICE_integrator_direct_lighting;
    for (const Row &row :
         {Row{"direct", direct, CHOICE_lighting_emitter}, Row{"direct_ems", direct, CHOICE_lighting_emitter},
          Row{"direct_whitted", direct, CHOICE_lighting_emitter}, Row{"direct_mats", direct, CHOICE_lighting_bsdf},
          Row{"direct_mis", direct, CHOICE_lighting_mis}, Row{"mipath", CHOICE_integrator_path, CHOICE_lighting_mis}}) {
        INFO(row.name);
        const Strategy s = load(camera + light + integrator(row.name)).strategy;
        CHECK(s[AXIS_integrator] == row.integrator);
        CHECK(s[AXIS_lighting] == row.lighting);
        CHECK(s[AXIS_mis] == CHOICE_mis_balance); // a sample of each, not of one
    }
    const SceneDescription av = load(camera + light + integrator("av", "<float name='length' value='2.5'/>"));
    CHECK(av.strategy[AXIS_integrator] == CHOICE_integrator_av);
    CHECK(av.visibility_length == 2.5);
    CHECK_THAT(error_of([&] { load(camera + light + integrator("av")); }),
               Catch::EndsWith("lacks its property 'length'"));
    CHECK_THAT(error_of([&] { load(camera + integrator("av", "<float name='length' value='0'/>")); }),
               Catch::Contains("property 'length': must be above 0"));
}

TEST_CASE_METHOD(DialectFixture, "a pointlight has an intensity, and defaults", "[dialects]") {
    const auto point = [&](const std::string &body) {
        return std::get<emitter_point>(
            load(camera + light + "<emitter type='pointlight'>" + body + "</emitter>").lights.at(0).parameters);
    };
    const double sphere = 4 * std::numbers::pi;
    CHECK(point("<color name='radiance' value='1 2 3'/>").power == Color{sphere, 2 * sphere, 3 * sphere});
    CHECK(point("<color name='power' value='1 2 3'/>").power == Color{1, 2, 3});
    CHECK(point("").position.y == 100);
    CHECK(point("").power == Color{sphere, sphere, sphere});
    CHECK_THAT(error_of([&] { point("<color name='radiance' value='1 -2 3'/>"); }),
               Catch::EndsWith("property 'radiance': must not be negative"));
    CHECK_THAT(error_of([&] { point("<color name='radiance' value='1 1 1'/><color name='power' value='1 1 1'/>"); }),
               Catch::EndsWith("property 'power': stands beside 'radiance', which says it already"));
}

TEST_CASE_METHOD(DialectFixture, "spots by the names of forks, as angles or as cosines", "[dialects]") {
    const auto spot = [&](const std::string &type, const std::string &body) {
        return std::get<emitter_spot>(load(camera + light + "<emitter type='" + type +
                                           "'><point name='position' value='0 1 0'/>"
                                           "<vector name='direction' value='0 -1 0'/>" +
                                           body + "</emitter>")
                                          .lights.at(0)
                                          .parameters);
    };
    const std::string power = "<color name='power' value='1 2 3'/>";
    const auto cone = [](const char *width, const char *start) {
        return fmt::format("<float name='cosTotalWidth' value='{}'/><float name='cosFalloffStart' value='{}'/>", width,
                           start);
    };
    const double intensity = 1 / (2 * std::numbers::pi * (1 - (0.5 + std::sqrt(0.5)) / 2));
    for (const auto &[width, start] : {std::pair{"60", "45"}, {"0.5", "0.70710678118654752"}})
        for (const char *type : {"spot", "spotlight"}) {
            const emitter_spot read = spot(type, power + cone(width, start));
            CHECK(read.cutoff_angle == Approx(60));
            CHECK(read.beam_width == Approx(45));
            CHECK(read.intensity[2] == Approx(3 * intensity));
            CHECK(read.smooth);
        }
    CHECK_THAT(error_of([&] { spot("spot", power + cone("60", "45") + "<float name='beamWidth' value='9'/>"); }),
               Catch::EndsWith("property 'beamWidth': stands beside 'power', which says it already"));
    CHECK_THAT(error_of([&] { spot("spot", power); }), Catch::EndsWith("lacks its property 'cosTotalWidth'"));
    CHECK_THAT(error_of([&] { spot("spot", cone("60", "45")); }), Catch::EndsWith("lacks its property 'power'"));
    CHECK_THAT(error_of([&] { spot("spot", power + cone("181", "45")); }),
               Catch::EndsWith("property 'cosTotalWidth': must be a cosine, or an angle from 1 to 180 degrees"));
    CHECK_THAT(error_of([&] { spot("spot", power + cone("1", "1")); }), Catch::Contains("the cone is empty"));
}

TEST_CASE_METHOD(DialectFixture, "directional lights and skies by the names of forks", "[dialects]") {
    const auto emitter = [&](const std::string &type, const std::string &body) {
        return load(camera + light + "<emitter type='" + type + "'>" + body + "</emitter>").lights.at(0).parameters;
    };
    const std::string down = "<vector name='direction' value='0 -1 0'/>";
    for (const char *name : {"power", "radiance", "irradiance"})
        CHECK(std::get<emitter_directional>(
                  emitter("directional", down + fmt::format("<color name='{}' value='1 2 3'/>", name)))
                  .irradiance == Color{1, 2, 3});
    const std::string radiance = "<color name='radiance' value='1 2 3'/>";
    CHECK_THAT(error_of([&] { emitter("directional", down + radiance + "<color name='power' value='1 2 3'/>"); }),
               Catch::Contains("is repeated"));
    const std::string whole = radiance + "<float name='thetaA' value='180'/><transform name='toWorld'/>";
    CHECK(std::get<emitter_constant>(emitter("distantdisk", whole)).radiance == Color{1, 2, 3});
    CHECK_THAT(error_of([&] { emitter("distantdisk", radiance + "<float name='thetaA' value='5'/>"); }),
               Catch::Contains("property 'thetaA': must be 180"));
}

TEST_CASE_METHOD(DialectFixture, "a perspective camera with a lens, by the names of forks", "[dialects]") {
    const auto with = [&](const std::string &body, const std::string &type = "perspective") {
        return load("<camera type='" + type + "'><float name='fov' value='50'/>" + body + "</camera>" + light).camera;
    };
    const auto number = [](const std::string &name, double value) {
        return fmt::format("<float name='{}' value='{}'/>", name, value);
    };
    for (const char *radius : {"lensRadius", "radius", "apertureRadius", "aperture"})
        for (const char *depth : {"focalDistance", "focusDistance", "focalLength"})
            for (const char *type : {"perspective", "thinlens", "thin_lens"}) {
                INFO(radius << " " << depth << " " << type);
                const Camera camera = with(number(radius, 0.25) + number(depth, 7), type);
                REQUIRE(camera.kind == CAMERA_thinlens);
                CHECK((camera.thinlens.fov == 50 && camera.thinlens.aperture_radius == 0.25));
                CHECK(camera.thinlens.focus_distance == 7);
            }
    CHECK(with(number("lensRadius", 0) + number("focalDistance", 0)).kind == CAMERA_perspective);
    CHECK(with(number("lensRadius", 1) + number("focalDistance", 3) + "<boolean name='DoF' value='false'/>").kind ==
          CAMERA_perspective);
    CHECK(with("").kind == CAMERA_perspective);
    CHECK_THAT(error_of([&] { with(number("lensRadius", 1)); }),
               Catch::EndsWith("<camera> lacks its property 'focalDistance'"));
    CHECK_THAT(error_of([&] { with(number("lensRadius", -1)); }), Catch::Contains("'lensRadius': must be 0 or more"));
    CHECK_THAT(error_of([&] { with(number("lensRadius", 1) + number("focalLength", 0)); }),
               Catch::Contains("'focalDistance': must be above 0"));
    CHECK_THAT(
        error_of([&] { with(number("lensRadius", 1) + number("focalLength", 2) + number("principalPointX", 0.1)); }),
        Catch::Contains("'principalPointX': is of a pinhole alone"));
    CHECK_THAT(error_of([&] { with(number("radius", 1) + number("aperture", 2)); }), Catch::Contains("is repeated"));
}

TEST_CASE_METHOD(DialectFixture, "tags and properties by other names", "[dialects]") {
    const SceneDescription scene =
        load(camera + "<shape type='parallelogram'>" + square +
             "<luminaire type='area'><color name='radiance' value='1 2 3'/></luminaire>"
             "<bsdf type='diffuse'><color name='reflectance' value='0.25 0.5 1'/></bsdf></shape>");
    REQUIRE(scene.meshes.size() == 1);
    CHECK(scene.meshes[0].radiance == Color{1, 2, 3});
    CHECK(scene.meshes[0].bsdf.as<bsdf_diffuse_record>().albedo.value[0] == 0.25f);
    CHECK_THAT(error_of([&] {
                   load_bsdf(
                       "<bsdf type='diffuse'><color name='albedo' value='1 1 1'/><color name='reflectance' value='1 1 "
                       "1'/></bsdf>");
               }),
               Catch::Contains("property 'albedo' is repeated"));
}

TEST_CASE_METHOD(DialectFixture, "every leftover loads without a warning, lenient or not", "[dialects]") {
    REQUIRE(leftovers().size() >= 25);
    for (const Leftover &row : leftovers()) {
        std::string name = row.name;
        if (name.ends_with('*'))
            name.back() = 'a';
        INFO(row.tag << " " << row.type << " " << name);
        const bool is_color = row.name == "albedo" || row.name == "kd" || row.name == "energy";
        const std::string property = row.property_tag == "boolean"
                                         ? "<boolean name='" + name + "' value='true'/>"
                                         : fmt::format("<{} name='{}' value='{}'/>", is_color ? "color" : "float", name,
                                                       is_color ? "1 1 1" : "0.5");
        const std::string type = !row.type.empty() ? row.type : row.tag == "sampler" ? "independent" : "path_mis";
        const std::string object = "<" + row.tag + " type='" + type + "'>" + property + "</" + row.tag + ">";
        for (bool lenient : {false, true}) {
            const size_t before = warnings().size();
            const LoadOptions options{.lenient = lenient};
            CHECK(error_of([&] {
                      if (row.tag == "bsdf")
                          load_bsdf(object, options);
                      else
                          load(camera + light + (row.tag == "scene" ? property : object), options);
                  }).empty());
            CHECK(warnings().size() == before);
        }
    }
}

TEST_CASE_METHOD(DialectFixture, "a mirror's tint is not lost without a word", "[dialects]") {
    const size_t before = warnings().size();
    for (const char *name : {"albedo", "reflectance"})
        load_bsdf("\n<bsdf type='mirror'>\n<color name='" + std::string(name) + "' value='0.9 1 1'/></bsdf>");
    REQUIRE(warnings().size() == before + 2);
    CHECK(warnings().back() ==
          (scratch / "a.xml").string() + ":6:1: property 'albedo' of bsdf 'mirror': 0.9 1 1 is rendered as 1");
}

TEST_CASE_METHOD(DialectFixture, "attributes that scenes carry mean nothing; others fail", "[dialects]") {
    const size_t before = warnings().size();
    const std::string text = "<scene version='1.0'>" + camera + "<mesh type='parallelogram' id='floor'>" + square +
                             "<bsdf type='diffuse' name='red'/></mesh>" + light + "</scene>";
    CHECK(load_scene(scratch.write("b.xml", text)).meshes.size() == 2);
    CHECK(warnings().size() == before);
    CHECK_THAT(error_of([&] { load("<mesh type='parallelogram' class='floor'>" + square + "</mesh>" + camera); }),
               Catch::Contains("unknown attribute 'class' of <mesh>"));
}

TEST_CASE_METHOD(DialectFixture, "opal says what it takes from names, and what means nothing", "[dialects]") {
    const std::string file =
        scratch.write("a.xml", "<scene>\n" + camera + light + integrator("direct_ems") +
                                   "\n<sampler type='independent'><integer name='seed' value='3'/></sampler></scene>");
    const std::string opal = std::string(OPAL_BINARY) + " inspect " + file;
    const test::Outcome as_it_is = test::run_shell(opal);
    CHECK(as_it_is.exit_code == 0);
    CHECK_THAT(as_it_is.err, Catch::Contains("dialect eth, by integrator 'direct_ems' at " + file + ":4:1: ") &&
                                 Catch::Contains("note: " + file +
                                                 ":5:29: property 'seed' of sampler 'independent' "
                                                 "means nothing here\n"));
    CHECK_THAT(as_it_is.out, Catch::Contains("dialect     eth\n"));
    CHECK_THAT(test::run_shell(opal + " --dialect upstream").out, Catch::Contains("dialect     upstream\n"));
    CHECK_THAT(test::run_shell(opal + " --dialect nori").err, Catch::Contains("upstream, course, eth, mitsuba, auto"));
}
