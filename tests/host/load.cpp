#include "read/nori/load.h"
#include "base/hash.h"
#include "base/log.h"
#include "base/table.h"
#include "base/values.h"
#include "read/nori/tests.h"
#include "strategies/check.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>

using namespace opal;
using opal::test::error_of;

namespace {

const std::string camera = "<camera type='perspective'/>";
const std::string light =
    "<mesh type='parallelogram'><point name='origin' value='0 0 0'/><vector name='u' value='1 0 0'/>"
    "<vector name='v' value='0 2 0'/><emitter type='area'><color name='radiance' value='1 2 3'/>"
    "</emitter></mesh>";

struct LoadFixture {
    test::ScratchFolder scratch;
    std::string file() const { return (scratch / "a.xml").string(); }
    // Loads a scene with `body` from line 2 on.
    SceneDescription load(const std::string &body, const LoadOptions &options = {}) const {
        return load_scene(scratch.write("a.xml", "<scene>\n" + body + "\n</scene>"), options);
    }
    SceneDescription load_integrator(const std::string &integrator) const { return load(integrator + camera + light); }
    // The error after the file's name.
    std::string error_in(const std::string &body) const {
        return shortened(error_of([&] { load(body); }));
    }
    // Of a property (line 4) in an object `tag` of `type` (line 3), beside a camera unless it is one.
    std::string property_error(const std::string &tag, const std::string &type, const std::string &property) const {
        return error_in((tag == "camera" ? "" : camera) + "\n<" + tag + " type='" + type + "'>\n" + property + "</" +
                        tag + ">");
    }
    Bsdf bsdf(const std::string &xml) const {
        std::string mesh = light;
        return load(camera + mesh.insert(mesh.find("<emitter"), xml)).meshes.at(0).bsdf;
    }
    std::string bsdf_error(const std::string &type, const std::string &property) const {
        return error_in(camera + "\n<mesh type='parallelogram'><bsdf type='" + type + "'>\n" + property +
                        "</bsdf></mesh>");
    }
    TestDescription load_test_text(const std::string &text) const { return load_test(scratch.write("a.xml", text)); }
    std::string test_error(const std::string &text) const {
        return shortened(error_of([&] { load_test_text(text); }));
    }
    std::string shortened(const std::string &error) const {
        return error.starts_with(file()) ? error.substr(file().size()) : error;
    }
};

std::filesystem::path shared() { return std::filesystem::path(OPAL_SOURCE_DIR) / ".." / "shared"; }

} // namespace

TEST_CASE_METHOD(LoadFixture, "defaults of everything are resolved", "[load]") {
    SceneDescription scene = load(camera + light);
    CHECK(scene.file == file());
    CHECK(scene.camera.width == 1280);
    CHECK(scene.camera.height == 720);
    CHECK(scene.camera.perspective.fov == 30);
    CHECK(scene.camera.near_clip == 1e-4);
    CHECK(scene.camera.far_clip == 1e4);
    CHECK(scene.spp == 1);
    CHECK(scene.integrator_type == "path_mis");
    CHECK(scene.strategy[AXIS_integrator] == CHOICE_integrator_path);
    CHECK(scene.strategy[AXIS_lighting] == CHOICE_lighting_mis);
    CHECK(scene.strategy[AXIS_rr] == CHOICE_rr_throughput_eta);
    CHECK(scene.strategy.rr_depth == 3);
    CHECK(scene.strategy.max_depth == no_limit);
    REQUIRE(scene.meshes.size() == 1);
    const Mesh &mesh = scene.meshes[0];
    CHECK(mesh.place.text() == file() + ":2:29");
    REQUIRE(mesh.bsdf.is<bsdf_diffuse_record>());
    CHECK(mesh.bsdf.as<bsdf_diffuse_record>().albedo.value[1] == 0.5f);
    CHECK(mesh.bsdf.as<bsdf_diffuse_record>().use_cosine == 0);
    CHECK(mesh.radiance == Color{1, 2, 3});
    CHECK(std::get<Parallelogram>(mesh.shape).v.y == 2);
}

TEST_CASE_METHOD(LoadFixture, "the integrators of both dialects become choices", "[load]") {
    const int any = -1;
    auto recursive = [](const std::string &properties) {
        return "<integrator type='path_tracer_recursive'>" + properties + "</integrator>";
    };
    auto on = [](const std::string &name) { return "<boolean name='" + name + "' value='true'/>"; };
    auto direct = [](const std::string &properties) {
        return "<integrator type='direct_lighting'>" + properties + "</integrator>";
    };
    auto check = [&](const std::string &xml, int integrator, int lighting, int mis, int rr) {
        INFO(xml);
        const Strategy s = load_integrator(xml).strategy;
        CHECK(s[AXIS_integrator] == integrator);
        CHECK((lighting == any || s[AXIS_lighting] == lighting));
        CHECK((mis == any || s[AXIS_mis] == mis));
        CHECK((rr == any || s[AXIS_rr] == rr));
    };
    const int path = CHOICE_integrator_path, balance = CHOICE_mis_balance, eta = CHOICE_rr_throughput_eta;
    const int bsdf = CHOICE_lighting_bsdf, emitter = CHOICE_lighting_emitter, mis = CHOICE_lighting_mis;
    const int direct_lighting = CHOICE_integrator_direct_lighting, off = CHOICE_rr_off;
    check("<integrator type='normals'/>", CHOICE_integrator_normals, any, any, any);
    check("<integrator type='whitted'/>", CHOICE_integrator_whitted, emitter, any, any);
    check("<integrator type='path_mats'/>", path, bsdf, balance, eta);
    check("<integrator type='path_ems'/>", path, emitter, balance, eta);
    check("<integrator type='path_mis'/>", path, mis, balance, eta);
    check(direct(""), direct_lighting, bsdf, balance, any);
    check(direct(on("surface_sampling")), direct_lighting, emitter, balance, any);
    check(direct(on("mis_sampling")), direct_lighting, mis, CHOICE_mis_one_sample, any);
    check(recursive(""), path, bsdf, balance, off);
    check(recursive(on("rr")), path, bsdf, balance, eta);
    check(recursive(on("nee")), path, emitter, balance, off);
    check(recursive(on("mis")), path, mis, balance, off);
    check(recursive(on("nee") + on("mis") + on("rr")), path, mis, balance, eta);
    check(recursive(on("rr") + "<float name='rr_prob' value='0.7'/>"), path, bsdf, balance, CHOICE_rr_fixed);
    check(recursive(on("rr") + on("rr_dynamic") + "<float name='rr_prob' value='0.7'/>"), path, bsdf, balance, eta);
    check(recursive("<float name='rr_prob' value='0.7'/>"), path, bsdf, balance, off);
}

TEST_CASE_METHOD(LoadFixture, "integrators' own values", "[load]") {
    CHECK(load_integrator("<integrator type='path_tracer_recursive'><float name='rr_prob' value='0.7'/></integrator>")
              .strategy.rr_prob == 0.7);
    CHECK(load_integrator("<integrator type='normals'><boolean name='signed' value='true'/></integrator>")
              .normals_signed);
    auto ao = [&](const std::string &property) {
        return load_integrator("<integrator type='ao'>" + property + "</integrator>").strategy[AXIS_hemisphere];
    };
    CHECK(ao("") == CHOICE_hemisphere_cosine);
    CHECK(ao("<boolean name='cosine_sampling' value='false'/>") == CHOICE_hemisphere_uniform);
    SceneDescription simple = load_integrator("<integrator type='simple'><point name='position' value='1 2 3'/>"
                                              "<color name='energy' value='4 5 6'/></integrator>");
    CHECK(simple.simple_light.position.z == 3);
    CHECK(simple.simple_light.energy == Color{4, 5, 6});
    CHECK_THAT(error_in(camera + "<integrator type='simple'/>"), Catch::Contains("lacks its property 'position'"));
}

TEST_CASE_METHOD(LoadFixture, "every axis and number is a property of the integrator too", "[load]") {
    const Strategy s =
        load_integrator(
            "<integrator type='path_tracer_recursive'><string name='lighting' value='mis'/><string "
            "name='mis' value='power'/>"
            "<string name='rr' value='throughput-eta'/><string name='hemisphere' value='cosine'/>"
            "<string name='emitter_choice' value='uniform'/><string name='triangle_choice' value='uniform'/>"
            "<string name='sampler' value='sobol'/><integer name='maxDepth' value='9'/><integer "
            "name='rrDepth' value='4'/>"
            "<string name='math' value='fast'/><integer name='lanes' value='8'/><boolean name='specialise' "
            "value='False'/>"
            "</integrator>")
            .strategy;
    CHECK(s[AXIS_lighting] == CHOICE_lighting_mis);
    CHECK(s[AXIS_mis] == CHOICE_mis_power);
    CHECK(s[AXIS_rr] == CHOICE_rr_throughput_eta);
    CHECK(s[AXIS_hemisphere] == CHOICE_hemisphere_cosine);
    CHECK(s[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform);
    CHECK(s[AXIS_triangle_choice] == CHOICE_triangle_choice_uniform);
    CHECK(s[AXIS_sampler] == CHOICE_sampler_sobol);
    CHECK(s.max_depth == 9);
    CHECK(s.rr_depth == 4);
    CHECK(s.math == MathMode::fast);
    CHECK(s.lanes == 8);
    CHECK(s.specialise == Specialise::off);
    CHECK(load_integrator("<integrator type='path_mis'><integer name='maxDepth' value='-1'/></integrator>")
              .strategy.max_depth == no_limit);
    CHECK(property_error("integrator", "path_mis", "<string name='mis' value='powr'/>") ==
          ":4:1: property 'mis': unknown mis 'powr'; did you mean 'power'? available: " +
              joined(names_of(axes()[AXIS_mis].choices)));
    CHECK(property_error("integrator", "path_mis", "<integer name='maxDepth' value='0'/>") ==
          ":4:1: property 'maxDepth': max-depth ('none' for no limit) must be at least 1, not 0");
    CHECK(property_error("integrator", "path_mis", "<boolean name='mis' value='true'/>") ==
          ":4:1: property 'mis' is a <boolean> here, but must be a <string>");
    CHECK_THAT(property_error("integrator", "path_tracer_recursive", "<float name='rr_prob' value='0'/>"),
               Catch::StartsWith(":4:1: property 'rr_prob': rr-prob must be"));
}

TEST_CASE_METHOD(LoadFixture, "samplers by type", "[load]") {
    SceneDescription scene =
        load(camera + light + "<sampler type='stratified'><integer name='sampleCount' value='64'/></sampler>");
    CHECK(scene.spp == 64);
    CHECK(scene.strategy[AXIS_sampler] == CHOICE_sampler_stratified);
    CHECK(property_error("sampler", "independent", "<integer name='sampleCount' value='0'/>") ==
          ":4:1: property 'sampleCount': must be at least 1 sample per pixel");
    CHECK(property_error("sampler", "halton", "") ==
          ":3:1: unknown sampler type 'halton'; available: independent, stratified, sobol");
}

TEST_CASE_METHOD(LoadFixture, "the filter without <rfilter> is the dialect's", "[load]") {
    Filter university = load_integrator("<integrator type='direct_lighting'/>").camera.filter;
    CHECK(university.kind == FILTER_box);
    CHECK(university.radius == 0.5);
    CHECK_FALSE(university.given);
    Filter upstream = load_integrator("<integrator type='path_mis'/>").camera.filter;
    CHECK(upstream.kind == FILTER_gaussian);
    CHECK(upstream.radius == 2);
    CHECK(upstream.stddev == 0.5);
}

TEST_CASE_METHOD(LoadFixture, "a scene's hash is that of all files that were read", "[load]") {
    const std::string obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl grey\nf 1 2 3\n", mtl = "newmtl grey\n";
    scratch.write("a.obj", obj);
    scratch.write("a.mtl", mtl);
    const auto mesh = [&](bool materials) {
        return "<mesh type='obj'><string name='filename' value='a.obj'/><boolean name='materials' value='" +
               std::string(materials ? "true" : "false") + "'/></mesh>";
    };
    for (const bool materials : {false, true}) {
        const SceneDescription scene = load(camera + mesh(materials));
        std::string lines = xxh128(test::read_text(file())) + "\n" + xxh128(obj) + "\n";
        if (materials)
            lines += xxh128(mtl) + "\n";
        CHECK(scene.hash == xxh128(lines));
    }
}

TEST_CASE_METHOD(LoadFixture, "filters by type", "[load]") {
    auto filter = [&](const std::string &xml) {
        return load("<camera type='perspective'>" + xml + "</camera>" + light).camera.filter;
    };
    CHECK(filter("<rfilter type='box'/>").given);
    CHECK(filter("<rfilter type='box'/>").radius == 0.5);
    CHECK(filter("<rfilter type='tent'/>").radius == 1);
    Filter gaussian = filter("<rfilter type='gaussian'><float name='stddev' value='0.7'/></rfilter>");
    CHECK(gaussian.kind == FILTER_gaussian);
    CHECK(gaussian.radius == 2);
    CHECK(gaussian.stddev == 0.7);
    Filter mitchell = filter("<rfilter type='mitchell'><float name='B' value='0'/></rfilter>");
    CHECK(mitchell.b == 0);
    CHECK(mitchell.c == 1.0 / 3);
    CHECK_THAT(error_in("<camera type='perspective'>\n<rfilter type='sinc'/></camera>"),
               Catch::Equals(":3:1: unknown rfilter type 'sinc'; available: box, tent, gaussian, mitchell, lanczos, "
                             "catmullrom"));
    const Filter lanczos = filter("<rfilter type='lanczos'/>"), spline = filter("<rfilter type='catmullrom'/>");
    CHECK(lanczos.kind == FILTER_lanczos);
    CHECK(lanczos.radius == 3);
    CHECK((spline.kind == FILTER_mitchell && spline.radius == 2 && spline.b == 0 && spline.c == 0.5));
    CHECK_THAT(error_in("<camera type='perspective'>\n<rfilter type='lanczos'><float name='radius' "
                        "value='0.5'/></rfilter></camera>"),
               Catch::Contains("possible: a radius above 0.5"));
}

TEST_CASE_METHOD(LoadFixture, "filters whose weights vanish, cancel or overflow fail at their place", "[load]") {
    const auto filter_error = [&](const std::string &type, const std::string &numbers) {
        std::string properties;
        for (const std::string_view number : split(numbers)) {
            const size_t equals = number.find('=');
            properties +=
                fmt::format("<float name='{}' value='{}'/>", number.substr(0, equals), number.substr(equals + 1));
        }
        return error_in("<camera type='perspective'>\n<rfilter type='" + type + "'>" + properties +
                        "</rfilter></camera>" + light);
    };
    for (const char *numbers :
         {"radius=1e-30", "radius=0.001", "radius=0.5", "radius=-2", "stddev=0.001", "stddev=0.05", "stddev=-0.5",
          "stddev=0", "stddev=1e4", "stddev=1e9", "stddev=1e30", "radius=1e38 stddev=1e38", "radius=0.01 stddev=1e-3"})
        CHECK_THAT(filter_error("gaussian", numbers),
                   Catch::StartsWith(":3:1: gaussian, radius ") &&
                       Catch::EndsWith("possible: a radius above 0.5, and a stddev from 0.08 to 10 times the radius"));
    for (const char *numbers : {"radius=0.001", "radius=0.6", "radius=-1", "B=3e38", "B=-3e38", "C=3e38", "B=1e10",
                                "B=-1e10", "B=4", "C=1e30", "C=30 B=0", "C=30 B=0 radius=3", "radius=1 B=0"})
        CHECK_THAT(filter_error("mitchell", numbers),
                   Catch::StartsWith(":3:1: mitchell, radius ") &&
                       Catch::EndsWith("possible: a radius above 1, and B and C from 0 to 1"));
    // What the errors call possible is.
    for (const char *radius : {"0.51", "0.7", "1", "2", "5", "15.5"}) {
        CHECK(filter_error("gaussian", std::string("stddev=0.08 radius=") + radius).empty());
        CHECK(filter_error("gaussian", fmt::format("stddev={} radius={}", 10 * std::stod(radius), radius)).empty());
    }
    for (const char *radius : {"1.01", "1.5", "2", "4", "15.5"})
        for (const char *b : {"0", "0.5", "1"})
            for (const char *c : {"0", "0.5", "1"})
                CHECK(filter_error("mitchell", fmt::format("radius={} B={} C={}", radius, b, c)).empty());
}

TEST_CASE_METHOD(LoadFixture, "camera values that make no sense fail at their place", "[load]") {
    CHECK(property_error("camera", "perspective", "<integer name='width' value='0'/>") ==
          ":4:1: property 'width': must be at least 1 pixel");
    CHECK_THAT(property_error("camera", "perspective", "<integer name='height' value='-5'/>"),
               Catch::StartsWith(":4:1: "));
    CHECK(property_error("camera", "perspective", "<float name='fov' value='180'/>") ==
          ":4:1: property 'fov': must be above 0 and below 180: full horizontal angle, degrees");
    CHECK_THAT(property_error("camera", "perspective", "<float name='fov' value='0'/>"), Catch::StartsWith(":4:1: "));
    CHECK_THAT(property_error("camera", "perspective", "<float name='farClip' value='1e-5'/>"),
               Catch::StartsWith(":4:1: "));
    CHECK_THAT(property_error("camera", "perspective", "<float name='nearClip' value='-1'/>"),
               Catch::StartsWith(":4:1: "));
    CHECK_THAT(property_error("camera", "fisheye", ""),
               Catch::StartsWith(":3:1: unknown camera type 'fisheye'; available: perspective"));
    CHECK(property_error("camera", "perspective", "<float name='fov' value='1e-6'/>").empty());
}

TEST_CASE_METHOD(LoadFixture, "BSDFs with their parameters", "[load]") {
    CHECK(bsdf("<bsdf type='mirror'/>").kind() == BSDF_mirror);
    const auto glass = bsdf("<bsdf type='dielectric'/>").as<bsdf_dielectric_record>();
    CHECK(glass.int_ior.value == 1.5046f);
    CHECK(glass.ext_ior.value == 1.000277f);
    const auto diffuse = bsdf("<bsdf type='diffuse'><color name='albedo' value='1 0.2 0'/>"
                              "<boolean name='use_cosine' value='true'/></bsdf>")
                             .as<bsdf_diffuse_record>();
    CHECK(diffuse.albedo.value[1] == 0.2f);
    CHECK(diffuse.albedo.texture == OPAL_UNTEXTURED);
    CHECK(diffuse.use_cosine == 1);
    const Bsdf rough = bsdf("<bsdf type='microfacet'><color name='kd' value='0.1 0.2 0.15'/>"
                            "<boolean name='use_cosine' value='true'/></bsdf>");
    REQUIRE(rough.is<bsdf_microfacet_record>());
    CHECK(rough.as<bsdf_microfacet_record>().alpha.value == 0.1f);
    CHECK(rough.as<bsdf_microfacet_record>().kd.value[2] == 0.15f);
    CHECK(bsdf("<bsdf type='microfacet'><float name='alpha' value='0'/></bsdf>")
              .as<bsdf_microfacet_record>()
              .alpha.value == 0);
    const auto phong = bsdf("<bsdf type='phong'><float name='n' value='1e8'/></bsdf>").as<bsdf_phong_record>();
    CHECK(phong.n.value == 1e8f);
    CHECK(phong.pd.value == 0.5f);
    CHECK(phong.ks.value[0] == 0.5f);
}

TEST_CASE_METHOD(LoadFixture, "plastics", "[load]") {
    CHECK(bsdf("<bsdf type='plastic'/>").words == words_of(bsdf_plastic_record{}));
    const auto record = bsdf("<bsdf type='roughplastic'><color name='diffuse_reflectance' value='0.1 0.2 0.3'/>"
                             "<string name='distribution' value='ggx'/><string name='intIOR' value='pet'/></bsdf>")
                            .as<bsdf_roughplastic_record>();
    CHECK(record.diffuse_reflectance.value[1] == 0.2f);
    CHECK(record.alpha.value == 0.1f);
    CHECK(record.ggx == 1);
    CHECK(record.int_ior.value == 1.575f);
    CHECK(bsdf("<bsdf type='roughplastic'><float name='alpha' value='0'/></bsdf>").words ==
          words_of(bsdf_plastic_record{}));
    CHECK_THAT(bsdf_error("roughplastic", "<float name='intIOR' value='1'/><float name='extIOR' value='1'/>"),
               Catch::Contains("must differ from extIOR"));
    CHECK_THAT(bsdf_error("plastic", "<float name='intIOR' value='4'/>"),
               Catch::Contains("must be at most 3.8 times extIOR"));
    CHECK_THAT(bsdf_error("roughplastic", "<float name='alpha' value='2'/>"), Catch::Contains("must be 0 to 1"));
    // What the host computes numbers from is the same all over.
    CHECK_THAT(bsdf_error("roughplastic", "<texture name='alpha' type='checker'/>"),
               Catch::Contains("'alpha'") && Catch::Contains("available: diffuse_reflectance, specular_reflectance"));
    CHECK_THAT(bsdf_error("plastic", "<float name='boundary' value='1'/>"), Catch::Contains("'boundary'"));
}

TEST_CASE_METHOD(LoadFixture, "principled, and the names that forks have for it", "[load]") {
    const Bsdf plain = bsdf("<bsdf type='principled'/>");
    CHECK(plain.as<bsdf_principled_record>().eta.value == 1.5f);
    CHECK(plain.traits() == (OPAL_SMOOTH | OPAL_MANY_LOBES));
    const Bsdf disney = bsdf("<bsdf type='disney'><color name='baseColor' value='0.1 0.2 0.3'/>"
                             "<float name='subsurface' value='0.7'/><float name='specular' value='0.8'/>"
                             "<float name='specularTint' value='0.25'/><float name='anisotropic' value='0.1'/></bsdf>");
    const auto record = disney.as<bsdf_principled_record>();
    CHECK(record.base_color.value[2] == 0.3f);
    CHECK(record.flatness.value == 0.7f);
    CHECK(record.spec_tint.value == 0.25f);
    CHECK(record.eta.value == Approx(1.677315)); // Mitsuba's
    CHECK(disney.traits() == (OPAL_SMOOTH | OPAL_TANGENTS | OPAL_MANY_LOBES));
    const auto glass = [&](const std::string &more) {
        return bsdf("<bsdf type='principled'><float name='specTrans' value='0.5'/>" + more + "</bsdf>")
            .as<bsdf_principled_record>()
            .eta.value;
    };
    CHECK(glass("<float name='eta' value='1'/>") == 1.001f);
    CHECK(glass("<float name='specular' value='0'/>") == Approx(1.018050));
    CHECK(bsdf("<bsdf type='principled'><float name='specular' value='0'/></bsdf>")
              .as<bsdf_principled_record>()
              .eta.value == 1);
    CHECK_THAT(bsdf_error("principled", "<float name='eta' value='1.4'/><float name='specular' value='1'/>"),
               Catch::StartsWith(":4:32: property 'specular': stands for eta, which is given too"));
    CHECK_THAT(bsdf_error("principled", "<float name='specular' value='1.1'/>"),
               Catch::StartsWith(":4:1: property 'specular': must be 0 to 1"));
    CHECK_THAT(bsdf_error("twosided", "<bsdf type='principled'><float name='specTrans' value='0.1'/></bsdf>"),
               Catch::EndsWith("a twosided cannot hold a BSDF that light passes through"));
    CHECK(bsdf("<bsdf type='twosided'><bsdf type='principled'/></bsdf>").is<bsdf_twosided_record>());
    CHECK(bsdf("<bsdf type='orenNayar'><color name='reflectance' value='0.2 0.2 0.2'/></bsdf>")
              .as<bsdf_oren_nayar_record>()
              .albedo.value[0] == 0.2f);
}

TEST_CASE_METHOD(LoadFixture, "BSDF values that make no sense fail at their place", "[load]") {
    CHECK(bsdf_error("diffuse", "<color name='albedo' value='1 -1 1'/>") ==
          ":4:1: property 'albedo': must be 0 or more: reflectance");
    CHECK_THAT(bsdf_error("microfacet", "<color name='kd' value='1.5 0 0'/>"),
               Catch::StartsWith(":4:1: property 'kd': must be 0 to 1"));
    CHECK_THAT(bsdf_error("microfacet", "<float name='alpha' value='-1e-9'/>"), Catch::StartsWith(":4:1: "));
    CHECK_THAT(bsdf_error("dielectric", "<float name='intIOR' value='0'/>"), Catch::StartsWith(":4:1: "));
    CHECK_THAT(bsdf_error("phong", "<float name='pd' value='1.5'/>"), Catch::StartsWith(":4:1: "));
    CHECK_THAT(bsdf_error("phong", "<float name='n' value='-1'/>"), Catch::StartsWith(":4:1: "));
    CHECK_THAT(bsdf_error("twosided", "<bsdf type='dielectric'/>"),
               Catch::EndsWith("a twosided cannot hold a BSDF that light passes through"));
    CHECK_THAT(bsdf_error("twosided", ""), Catch::EndsWith("a twosided has 1 or 2 <bsdf> within it, not 0"));
    CHECK_THAT(bsdf_error("mask", ""), Catch::EndsWith("a mask has 1 <bsdf> within it, not 0"));
    CHECK_THAT(bsdf_error("mask", "<float name='opacity' value='1.1'/><bsdf type='diffuse'/>"),
               Catch::StartsWith(":4:1: property 'opacity': must be 0 to 1"));
    for (const char *passes : {"<bsdf type='null'/>", "<bsdf type='mask'><bsdf type='diffuse'/></bsdf>",
                               "<bsdf type='diffuse'/><bsdf type='dielectric'/>"})
        CHECK_THAT(bsdf_error("twosided", passes),
                   Catch::EndsWith("a twosided cannot hold a BSDF that light passes through"));
    CHECK_THAT(bsdf_error("diffuse", "<bsdf type='mirror'/>"), Catch::Contains("bsdf"));
    CHECK_THAT(
        bsdf_error("difuse", ""),
        Catch::StartsWith(":3:28: unknown bsdf type 'difuse'; did you mean 'diffuse'? available: diffuse, mirror"));
    CHECK(bsdf_error("area", "").starts_with(":3:28: unknown bsdf type 'area'; "));
    CHECK(bsdf_error("mirror", "<float name='pd' value='1'/>") ==
          ":4:1: unknown property 'pd' of bsdf 'mirror'; available: use_cosine");
}

TEST_CASE_METHOD(LoadFixture, "emitters stand where they belong", "[load]") {
    SceneDescription scene = load(
        camera + light +
        "\n<emitter type='point'><point name='position' value='1 2 3'/><color name='power' value='4 5 6'/></emitter>");
    REQUIRE(scene.lights.size() == 1);
    const auto point = std::get<emitter_point>(scene.lights[0].parameters);
    CHECK(point.position.y == 2);
    CHECK(point.power == Color{4, 5, 6});
    CHECK(scene.lights[0].place.text() == file() + ":3:1");
    const auto sky = load(camera + light + "<emitter type='constant'/>").lights.at(0);
    CHECK(std::get<emitter_constant>(sky.parameters).radiance == Color{1, 1, 1});
    const auto spot = std::get<emitter_spot>(
        load(camera + light +
             "<emitter type='spot'><point name='position' value='1 2 3'/><vector name='direction' value='0 0 2'/>"
             "<float name='cutoffAngle' value='40'/></emitter>")
            .lights.at(0)
            .parameters);
    CHECK((spot.cutoff_angle == 40 && spot.beam_width == 30 && !spot.smooth)); // 3/4 of it
    CHECK(spot.intensity == Color{1, 1, 1});
    CHECK(error_in(camera + "<emitter type='directional'>\n<vector name='direction' value='0 0 0'/></emitter>") ==
          ":3:1: property 'direction': must not be 0: where the light goes to");
    CHECK(error_in(camera + "<emitter type='spot'><point name='position' value='0 0 0'/>"
                            "<vector name='direction' value='0 0 1'/>\n<float name='cutoffAngle' value='181'/>"
                            "<float name='beamWidth' value='1'/></emitter>") ==
          ":3:1: property 'cutoffAngle': must be 0 to 180: angle from the axis at which the light ends, degrees");
    CHECK(error_in(camera + "\n<emitter type='point'><color name='power' value='1 1 1'/></emitter>") ==
          ":3:1: <emitter> lacks its property 'position'");
    CHECK(error_in(camera + "<emitter type='constant'>\n<color name='radiance' value='1 -1 1'/></emitter>") ==
          ":3:1: property 'radiance': must be 0 or more: radiance, W / (m^2 sr)");
    CHECK(error_in(camera + "\n<emitter type='area'><color name='radiance' value='1 1 1'/></emitter>") ==
          ":3:1: emitter 'area' must stand in a <mesh>, not in a <scene>");
    CHECK_THAT(error_in(camera + "<mesh type='parallelogram'>\n<emitter type='point'/></mesh>"),
               Catch::Equals(":3:1: emitter 'point' must stand in a <scene>, not in a <mesh>"));
    CHECK(error_in(camera + "<mesh type='parallelogram'>\n<emitter type='area'/></mesh>") ==
          ":3:1: <emitter> lacks its property 'radiance'");
    CHECK_THAT(error_in(camera + "<mesh type='parallelogram'>\n<emitter type='sky'/></mesh>"),
               Catch::StartsWith(":3:1: unknown emitter type 'sky'; available: area, parallelogram_emitter, point, "));
}

TEST_CASE_METHOD(LoadFixture, "parallelograms take their transform, and need an area", "[load]") {
    std::string mesh = light;
    mesh.insert(mesh.find("<emitter"),
                "<string name='name' value='lamp'/><transform name='toWorld'><scale value='-2 1 1'/>"
                "<translate value='0 0 5'/></transform>");
    SceneDescription scene = load(camera + mesh);
    const Parallelogram &shape = std::get<Parallelogram>(scene.meshes[0].shape);
    CHECK(scene.meshes[0].name == "lamp");
    CHECK(shape.origin.z == 5);
    CHECK(shape.u.x == -2);
    CHECK(shape.u.z == 0);
    CHECK_THAT(
        error_in(camera +
                 "\n<mesh type='parallelogram'><point name='origin' value='0 0 0'/><vector name='u' value='1 2 3'/>"
                 "<vector name='v' value='2 4 6'/></mesh>"),
        Catch::StartsWith(":3:1: the parallelogram has no area"));
    CHECK_THAT(error_in(camera + "\n<mesh type='parallelogram'><point name='origin' value='0 0 0'/></mesh>"),
               Catch::Equals(":3:1: <mesh> lacks its property 'u'"));
}

TEST_CASE_METHOD(LoadFixture, "OBJ files are found beside the scene, then in the current folder, with either slash",
                 "[load]") {
    scratch.write("meshes/a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    auto mesh = [](const std::string &name) {
        return camera + light + "\n<mesh type='obj'>\n<string name='filename' value='" + name + "'/></mesh>";
    };
    CHECK(std::get<TriangleMesh>(load(mesh("meshes/a.obj")).meshes[1].shape).triangles.size() == 1);
    CHECK(load(mesh("meshes\\a.obj")).meshes[1].name == "meshes\\a.obj");
    std::filesystem::path here = std::filesystem::current_path();
    scratch.write("elsewhere/b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    std::filesystem::current_path(scratch / "elsewhere");
    size_t count = load(mesh("b.obj")).meshes.size();
    std::filesystem::current_path(here);
    CHECK(count == 2);
    CHECK(error_in(mesh("none.obj")) == ":4:1: property 'filename': no such file: " + (scratch / "none.obj").string() +
                                            ", nor none.obj in the current folder");
    CHECK(error_in(camera + "\n<mesh type='obj'/>") == ":3:1: <mesh> lacks its property 'filename'");
}

TEST_CASE_METHOD(LoadFixture, "an error in an OBJ file names it and the mesh", "[load]") {
    std::string obj = scratch.write("bad.obj", "v 0 0 0\nf 1 2 3\n").string();
    CHECK(error_in(camera + "\n <mesh type='obj'><string name='filename' value='bad.obj'/></mesh>") ==
          obj + ":2:5: vertex index 2 is out of range: the file has 1 (the mesh at " + file() + ":3:2)");
}

TEST_CASE_METHOD(LoadFixture, "an unknown property fails, or warns if lenient", "[load]") {
    std::string body = "<camera type='perspective'>\n  <float name='fow' value='30'/></camera>" + light;
    CHECK_THAT(error_in(body),
               Catch::StartsWith(":3:3: unknown property 'fow' of camera 'perspective'; did you mean 'fov'? "));
    CHECK(load(body, {.lenient = true}).camera.perspective.fov == 30);
    CHECK_THAT(warnings().back(), Catch::StartsWith(file() + ":3:3: unknown property 'fow'"));
    CHECK_THAT(error_in("<float name='fov' value='30'/>" + camera),
               Catch::StartsWith(":2:1: unknown property 'fov' of <scene>"));
}

TEST_CASE_METHOD(LoadFixture, "what a scene must and may hold", "[load]") {
    CHECK(error_in(light) == ":1:1: <scene> lacks its <camera>");
    CHECK_THAT(error_in(camera + "\n" + camera), Catch::StartsWith(":3:1: a second <camera> in <scene>"));
    CHECK_THAT(error_in(camera + "\n<bsdf type='mirror'/>"),
               Catch::StartsWith(
                   ":3:1: no <bsdf> may stand in <scene>; available: camera, integrator, sampler, mesh, emitter"));
    CHECK_THAT(error_in(camera + "\n<cone type='x'/>"), Catch::StartsWith(":3:1: unknown tag 'cone'"));
    CHECK_THAT(
        error_in(camera + "\n<integrator type='photonmapper'/>"),
        Catch::StartsWith(
            ":3:1: unknown integrator type 'photonmapper'; available: normals, ao, simple, whitted, direct_lighting, "
            "path_tracer_recursive, path_mats, path_ems, path_mis"));
    CHECK_THAT(error_in(camera + "\n<mesh type='stl'/>"),
               Catch::Equals(":3:1: unknown mesh type 'stl'; available: obj, ply, parallelogram, sphere"));
    auto root_error = [&](const std::string &text) {
        return shortened(error_of([&] { load_scene(scratch.write("a.xml", text)); }));
    };
    CHECK(root_error("<scene type='x'/>") == ":1:1: unknown attribute 'type' of <scene>; available: none");
    CHECK(root_error("<mesh type='obj'/>") == ":1:1: unknown root 'mesh'; available: scene, test");
    CHECK_THAT(root_error("<test type='ttest'/>"),
               Catch::StartsWith(":1:1: this is a <test>") && Catch::Contains("opal test"));
    CHECK_THAT(error_of([&] { load_scene(scratch / "none.xml"); }),
               Catch::StartsWith((scratch / "none.xml").string() + ": cannot read"));
}

TEST_CASE_METHOD(LoadFixture, "scenes that render black are warned of", "[load]") {
    load(camera);
    CHECK(warnings().back() == file() + ":1:1: the scene has no <mesh>; it renders black");
    std::string dark = light;
    dark.replace(dark.find("<emitter"), dark.find("</mesh>") - dark.find("<emitter"), "");
    load(camera + dark);
    CHECK(warnings().back() == file() + ":1:1: the scene has no <emitter>; it renders black");
    size_t before = warnings().size();
    load(camera + dark + "<integrator type='ao'/>");
    CHECK(warnings().size() == before);
}

TEST_CASE_METHOD(LoadFixture, "tests hold scenes with a reference each", "[load]") {
    TestDescription test = load_test_text("<test type='ttest'><string name='references' value='0.5, 1.5'/>\n<scene>" +
                                          camera + light + "</scene><scene>" + camera + light + "</scene></test>");
    CHECK(test.type == "ttest");
    CHECK(test.references == std::vector<double>{0.5, 1.5});
    CHECK(test.scenes.size() == 2);
    CHECK(test.sample_count == 100000);
    CHECK(test.significance_level == 0.01);
    CHECK(test.scenes[1].meshes[0].radiance == Color{1, 2, 3});
}

TEST_CASE_METHOD(LoadFixture, "tests hold BSDFs with a reference each angle", "[load]") {
    TestDescription ttest = load_test_text("<test type='ttest'><string name='angles' value=' 0, 45'/><string "
                                           "name='references' value='1 2'/><bsdf type='mirror'/></test>");
    CHECK(ttest.angles == std::vector<double>{0, 45});
    CHECK(ttest.bsdfs.at(0).kind() == BSDF_mirror);
    TestDescription chi2 = load_test_text(
        "<test type='chi2test'><integer name='testCount' value='7'/><bsdf type='diffuse'/><bsdf type='phong'/></test>");
    CHECK(chi2.bsdfs.size() == 2);
    CHECK(chi2.test_count == 7);
    CHECK(chi2.sample_count == -1);
    CHECK(chi2.resolution == 10);
    CHECK(chi2.min_expected_frequency == 5);
}

TEST_CASE_METHOD(LoadFixture, "tests that make no sense fail at their place", "[load]") {
    CHECK(test_error("<test type='ttest'>\n<string name='references' value='1, 2'/><scene>" + camera + light +
                     "</scene></test>") == ":2:1: property 'references': 2 numbers for 1 means");
    CHECK(test_error("<test type='ttest'>\n<string name='references' value='1, x'/></test>") ==
          ":2:1: property 'references': 'x' is not a number");
    CHECK_THAT(test_error("<test type='chi2test'><scene>" + camera + light + "</scene></test>"),
               Catch::StartsWith(":1:1: a chi2test holds BSDFs"));
    CHECK(test_error("<test type='chi2test'/>") == ":1:1: the test holds nothing to test");
    CHECK(test_error("<test type='ztest'/>") ==
          ":1:1: unknown test type 'ztest'; did you mean 'ttest'? available: ttest, chi2test");
    CHECK_THAT(test_error("<scene/>"), Catch::StartsWith(":1:1: this is a <scene>"));
    CHECK_THAT(
        test_error("<test type='chi2test'>\n<float name='significanceLevel' value='1'/><bsdf type='mirror'/></test>"),
        Catch::StartsWith(":2:1: "));
}

TEST_CASE("the course's scenes load unchanged", "[load]") {
    if (!std::filesystem::exists(shared() / "scenes")) {
        WARN("no ../shared/scenes: skipped");
        return;
    }
    int count = 0;
    for (const auto &entry : std::filesystem::recursive_directory_iterator(shared() / "scenes")) {
        if (entry.path().extension() != ".xml")
            continue;
        INFO(entry.path());
        size_t before = warnings().size();
        SceneDescription scene = load_scene(entry.path());
        CHECK_NOTHROW(check_strategy(scene));
        CHECK(warnings().size() == before);
        CHECK(scene.meshes.size() >= 6);
        CHECK(scene.camera.filter.kind == FILTER_box);
        CHECK(std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh &mesh) { return mesh.radiance; }));
        ++count;
    }
    CHECK(count == 18);
}

TEST_CASE_METHOD(LoadFixture, "names in attributes take the values of -D, else of <default>", "[load]") {
    const std::string body = "<default name='w' value='40'/><default name='type' value='perspective'/>"
                             "<camera type='$type'><integer name='width' value='$w'/>"
                             "<integer name='height' value='1$h'/></camera>" +
                             light;
    const SceneDescription scene = load(body, {.definitions = {{"h", "2"}, {"w", "80"}}});
    CHECK((scene.camera.width == 80 && scene.camera.height == 12));
    CHECK(scene.definitions == std::map<std::string, std::string>{{"h", "2"}, {"type", "perspective"}, {"w", "80"}});
    CHECK(load(camera + light).definitions.empty());
    // values are not looked at again, and a '$' before no name stays
    const std::string named =
        "<camera type='perspective'/><mesh type='parallelogram'><string name='name' value='$a $5 $'/>"
        "<point name='origin' value='0 0 0'/><vector name='u' value='1 0 0'/>"
        "<vector name='v' value='0 2 0'/></mesh>";
    CHECK(load(named, {.definitions = {{"a", "$b"}}}).meshes[0].name == "$b $5 $");
}

TEST_CASE_METHOD(LoadFixture, "names without a value and values without a name are mistakes", "[load]") {
    const auto error_with = [&](const std::string &body, const std::map<std::string, std::string> &definitions) {
        return shortened(error_of([&] { load(body, {.definitions = definitions}); }));
    };
    const std::string sized = "<camera type='perspective'>\n  <integer name='width' value='$width'/></camera>" + light;
    CHECK_THAT(error_with(sized, {}),
               Catch::StartsWith(":3:3: $width has no value: -D width=VALUE gives one, or <def"));
    CHECK_THAT(error_with(sized, {{"widt", "4"}}), Catch::Contains("did you mean '$widt'?"));
    CHECK_THAT(error_with(sized, {{"width", "4"}, {"widthh", "4"}}),
               Catch::StartsWith(":1:1: unknown name of -D 'widthh'; did you mean 'width'?"));
    CHECK_THAT(error_with(sized, {{"width", "x"}}), Catch::Contains("'x' is not an integer"));
    CHECK_THAT(error_with(camera + light, {{"w", "4"}}), Catch::Contains("no attribute holds $w"));
    CHECK_THAT(error_with("<default name='a' value='1'/>\n<default name='a' value='2'/>" + camera + light, {}),
               Catch::StartsWith(":3:1: a second <default> of 'a'"));
    CHECK_THAT(error_with("<default name='a-b' value='1'/>" + camera + light, {}), Catch::Contains("'a-b' is no name"));
    CHECK_THAT(error_with("<default name='a'/>" + camera + light, {}), Catch::Contains("lacks the attribute 'value'"));
    CHECK_THAT(error_with("<camera type='perspective'><default name='a' value='1'/></camera>" + light, {}),
               Catch::Contains("default"));
}

TEST_CASE("one of the course's scenes, in detail", "[load]") {
    std::filesystem::path file = shared() / "scenes/importance_diffuse/cbox_pt_nee.xml";
    if (!std::filesystem::exists(file)) {
        WARN("no ../shared/scenes: skipped");
        return;
    }
    SceneDescription scene = load_scene(file);
    CHECK(scene.spp == 64);
    CHECK(scene.camera.width == 500);
    CHECK(scene.camera.near_clip == 0.10000000149011612);
    CHECK(scene.strategy[AXIS_lighting] == CHOICE_lighting_emitter);
    CHECK(scene.strategy[AXIS_rr] == CHOICE_rr_throughput_eta);
    size_t triangles = 0;
    for (const Mesh &mesh : scene.meshes)
        if (const auto *shape = std::get_if<TriangleMesh>(&mesh.shape))
            triangles += shape->triangles.size();
    CHECK(triangles == 34);
    // scale -1 -1 1, then a quarter turn about x, then the translation
    Vec3 ahead = scene.camera.to_world.vector({0, 0, 1}), origin = scene.camera.to_world.point({0, 0, 0});
    CHECK(ahead.y == Approx(-1));
    CHECK(origin.y == Approx(84));
}
