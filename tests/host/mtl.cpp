#include "read/mtl.h"
#include "base/log.h"
#include "base/table.h"
#include "image/image.h"
#include "read/obj_materials.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <random>

using namespace opal;
using opal::test::error_of;

namespace {

struct MtlFixture {
    test::ScratchFolder scratch;
    std::string file() const { return (scratch / "a.mtl").string(); }
    std::vector<MtlMaterial> read(const std::string &text) const { return read_mtl(scratch.write("a.mtl", text)); }
    MtlMaterial one(const std::string &statements) const { return read("newmtl a\n" + statements).at(0); }
    // As a file of Blender's exporter.
    PrincipledMaterial blender(const std::string &statements) const {
        return principled_of(read("# Blender 5.0.1 MTL File: 'None'\nnewmtl a\n" + statements).at(0));
    }
    SurfaceOfMaterial blender_surface(const std::string &statements) const {
        return surface_of(read("# Blender 5.0.1 MTL File: 'None'\nnewmtl a\n" + statements).at(0));
    }
    std::string error_in(const std::string &text) const {
        const std::string error = error_of([&] { read(text); });
        return error.starts_with(file()) ? error.substr(file().size()) : error;
    }
};

// The warnings of a call.
template <class Call> std::vector<std::string> warnings_of(Call call) {
    const size_t before = warnings().size();
    call();
    return {warnings().begin() + std::ptrdiff_t(before), warnings().end()};
}

bool is_near(const Color &a, const Color &b, double tolerance = 1e-6) {
    return std::abs(a[0] - b[0]) <= tolerance && std::abs(a[1] - b[1]) <= tolerance &&
           std::abs(a[2] - b[2]) <= tolerance;
}

const std::string triangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n";

} // namespace

TEST_CASE_METHOD(MtlFixture, "numbers that are left out are the first; names of statements have any case", "[mtl]") {
    CHECK(is_near(one("Kd 0.5\n").colors.at("kd"), {0.5, 0.5, 0.5}));
    CHECK(is_near(one("\tkD 0.5 0.6 0.7 # warm\r\n").colors.at("kd"), {0.5, 0.6, 0.7}));
    CHECK(is_near(one("KS 1 0\n").colors.at("ks"), {1, 0, 1}));
    CHECK(one("Ns 250").numbers.at("ns") == 250);
    CHECK(one("").colors.empty());
}

TEST_CASE_METHOD(MtlFixture, "colours of CIE XYZ become RGB, those of spectral files are told and absent", "[mtl]") {
    CHECK(is_near(one("Kd xyz 0.4124564 0.2126729 0.0193339\n").colors.at("kd"), {1, 0, 0}, 1e-5));
    const auto told = warnings_of([&] { CHECK_FALSE(one("Kd spectral a.rfl 1\n").colors.contains("kd")); });
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::StartsWith(file() + ":2:1: 'Kd spectral' is ignored"));
}

TEST_CASE_METHOD(MtlFixture, "d, Tr and a halo are one number; d counts", "[mtl]") {
    CHECK(one("Tr 0.3\n").numbers.at("d") == Approx(0.7));
    CHECK(one("d -halo 0.3\n").numbers.at("d") == 0.3);
    CHECK(warnings_of([&] { CHECK(one("Tr 0.7\nd 0.3\n").numbers.at("d") == 0.3); }).empty());
    const auto told = warnings_of([&] { CHECK(one("d 0.3\nTr 0.3\n").numbers.at("d") == 0.3); });
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::Contains("contradict each other"));
}

TEST_CASE_METHOD(MtlFixture, "names of materials are the rest of the line", "[mtl]") {
    const auto materials = read("newmtl wall red  \nKd 1 0 0\nnewmtl stra\xc3\x9f"
                                "e.001\r\nnewmtl paint #2\n");
    REQUIRE(materials.size() == 3);
    CHECK(materials[0].name == "wall red");
    CHECK(materials[1].name == "stra\xc3\x9f"
                               "e.001");
    CHECK(materials[2].name == "paint #2");
    CHECK(materials[2].place.line == 4);
}

TEST_CASE_METHOD(MtlFixture, "of two materials with one name the first counts", "[mtl]") {
    const auto told = warnings_of([&] {
        const auto materials = read("newmtl a\nKd 1\nnewmtl a\nKd 0\n");
        REQUIRE(materials.size() == 1);
        CHECK(materials[0].colors.at("kd")[0] == 1);
    });
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::StartsWith(file() + ":3:1: a second material 'a'"));
}

TEST_CASE_METHOD(MtlFixture, "textures: options before and behind a name, which may hold blanks", "[mtl]") {
    const auto texture = [&](const std::string &rest) { return one("map_Kd " + rest).textures.at("map_kd"); };
    CHECK(texture("t.png").file == "t.png");
    CHECK(texture("my wood.png").file == "my wood.png");
    CHECK(texture("\"my wood.png\"").file == "my wood.png");
    CHECK(texture(".\\maps\\t.png").file == "maps/t.png");
    CHECK(texture("wood#1.png # oak").file == "wood#1.png");
    CHECK(texture("-s 2 t.png").scale == std::array<double, 2>{2, 1});
    CHECK(texture("-s 2 3 t.png").scale == std::array<double, 2>{2, 3});
    CHECK(texture("-o 0.1 0.2 0 -s 2 3 1 t.png").offset == std::array<double, 2>{0.1, 0.2});
    CHECK(texture("t.png -s 2 2 2").file == "t.png");
    CHECK(texture("t.png -s 2 2 2").scale == std::array<double, 2>{2, 2});
    CHECK(texture("-clamp on -mm 0 1 t.png").clamp);
    CHECK(texture("-bm 0.5 t.png").strength == 0.5);
    CHECK(texture("-type sphere t.png").file == "t.png");
    const auto told = warnings_of([&] { CHECK(texture("-foo 3 t.png").file == "t.png"); });
    CHECK(told.size() == 1);
    CHECK(error_in("newmtl a\nmap_Kd -clamp\n") == ":2:1: option '-clamp' of 'map_Kd' lacks its value");
}

TEST_CASE_METHOD(MtlFixture, "a texture without a file is told and absent", "[mtl]") {
    for (const char *statement : {"map_Kd\n", "map_Kd -s 2\n", "map_Kd \"\"\n"}) {
        const auto told = warnings_of([&] { CHECK(one(statement).textures.empty()); });
        REQUIRE(told.size() == 1);
        CHECK(told[0] == file() + ":2:1: 'map_Kd' names no file: it is ignored");
    }
}

TEST_CASE_METHOD(MtlFixture, "malformed statements fail at their place", "[mtl]") {
    CHECK(error_in("newmtl a\nKd 0,5 0,6 0,7\n") == ":2:4: '0,5' is not a number");
    CHECK(error_in("newmtl a\nKd\n") == ":2:1: 'Kd' needs a number");
    CHECK(error_in("newmtl a\nKd -1\n") == ":2:1: 'Kd' must not be negative");
    CHECK(error_in("newmtl a\nNs nan\n") == ":2:4: 'nan' is not a finite number in single precision");
    CHECK(error_in("newmtl a\nd 1.5\n") == ":2:1: 'd' must be between 0 and 1");
    CHECK(error_in("Kd 1\nnewmtl a\n") == ":1:1: 'Kd' before the first newmtl");
    CHECK_THAT(error_in(triangles), Catch::StartsWith(": is a Wavefront OBJ mesh, not a material library"));
}

TEST_CASE_METHOD(MtlFixture, "what Blender's exporter writes is read back", "[mtl]") {
    for (double roughness : {0.0, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0})
        CHECK(blender(fmt::format("Ns {}\n", 1000 * (1 - roughness) * (1 - roughness))).roughness ==
              Approx(roughness).margin(1e-9));
    CHECK(blender("Ks 1\nNi 1.4\nNs 810\n").f0 == Approx(0.055556).epsilon(1e-4));
    CHECK(blender("Ks 0\nNs 250\nNi 1.5\nillum 1\n").f0 == 0);
    CHECK(blender("Ka 1\nillum 2\n").metallic == 0);
    CHECK(blender("Ka 0.5\nillum 3\n").metallic == 0.5);
    CHECK(blender("Ka 1\nillum 6\nd 0.5\n").metallic == 1);
    CHECK(blender("Ka 1\nillum 6\nd 1\n").metallic == 0);
    CHECK(blender("Ka 1\nillum 9\nd 0.5\n").transmission == 0);
    CHECK(blender("Pr 0.2\nPm 1\nillum 3\n").roughness == 0.2);
    CHECK(blender("Pr 0.2\nPm 1\nillum 3\n").metallic == 1);
    CHECK(blender("Pr 0.5\nPc 2.8\n").coat == Approx(0.7));
    CHECK(blender("Pr 0\nTf 1 1 1\nNi 1.45\n").transmission == 1);
}

TEST_CASE_METHOD(MtlFixture, "in other files Ns is an exponent, and Ka means nothing", "[mtl]") {
    const PrincipledMaterial material = principled_of(one("Kd 0.3\nKs 0.4\nNs 250\nKa 1 1 1\nillum 3\n"));
    CHECK(material.metallic == 0);
    CHECK(material.phong_exponent == 250);
    CHECK(material.roughness * material.roughness == Approx(0.0891).epsilon(1e-3)); // alpha
    CHECK(principled_of(one("Ks 1\n")).phong_exponent == 0);                        // no Ns, no lobe
    CHECK(principled_of(one("Ks 1\nNs 0\n")).phong_exponent == 0);                  // MeshLab
    CHECK(principled_of(one("Tf 1 1 1\nd 1\nillum 2\n")).transmission == 0);
    CHECK(principled_of(one("Tf 1 1 1\nillum 7\n")).transmission == 1);
}

TEST_CASE_METHOD(MtlFixture, "absent colours are what a picture should have", "[mtl]") {
    CHECK(principled_of(one("")).base[0] == 0.8);
    CHECK(principled_of(one("map_Kd t.png\n")).base[0] == 1);
    CHECK(principled_of(one("map_Kd t.png\nKd 0.2\n")).base[0] == 0.2);
    CHECK(principled_of(one("map_Ke t.png\n")).emission[0] == 1);
    CHECK(principled_of(one("")).emission[0] == 0);
}

TEST_CASE_METHOD(MtlFixture, "materials become the BSDFs that Opal has", "[mtl]") {
    const auto inner = [](const SurfaceOfMaterial &surface) {
        REQUIRE(surface.bsdf.is<bsdf_twosided_record>());
        return surface.bsdf.children.at(0);
    };
    const Bsdf matte = inner(blender_surface("Kd 0.5 0.4 0.3\nKs 0\nNs 250\n"));
    REQUIRE(matte.is<bsdf_diffuse_record>());
    CHECK(matte.as<bsdf_diffuse_record>().albedo.value[1] == 0.4f);

    const Bsdf lacquer = inner(blender_surface("Kd 0.8 0.1 0.05\nKs 1\nNs 810\nNi 1.4\n"));
    REQUIRE(lacquer.is<bsdf_microfacet_record>());
    const auto coat = lacquer.as<bsdf_microfacet_record>();
    CHECK(coat.alpha.value == Approx(0.01));
    const double eta = coat.int_ior.value / coat.ext_ior.value;
    CHECK(std::pow((eta - 1) / (eta + 1), 2) == Approx(0.055556).epsilon(1e-4));

    CHECK(inner(blender_surface("Kd 1\nNs 1000\nKa 1\nillum 3\n")).is<bsdf_mirror_record>());
    const SurfaceOfMaterial gold = blender_surface("Kd 0.9 0.6 0.1\nNs 490\nKa 1\nillum 3\n");
    REQUIRE(inner(gold).is<bsdf_principled_record>());
    const auto metal = inner(gold).as<bsdf_principled_record>();
    CHECK(metal.metallic.value == 1);
    CHECK(metal.base_color.value[1] == 0.6f);
    CHECK(metal.roughness.value == Approx(0.3));
    CHECK(metal.eta.value == 1.001f); // at 1 nothing would be reflected
    CHECK(gold.lacking.empty());

    const SurfaceOfMaterial lacquered = blender_surface("Kd 0.5\nKs 0.5\nNi 1.5\nPr 0.5\nPc 2\nPcr 0.1\n");
    const auto coated = inner(lacquered).as<bsdf_principled_record>();
    CHECK(coated.eta.value == Approx(1.5));
    CHECK(coated.clearcoat.value == 1);
    CHECK(coated.clearcoat_gloss.value == Approx((0.1 - 0.01) / 0.099));
    CHECK(lacquered.lacking == std::vector<std::string>{"coat 0.5, which becomes 0.25"});
    const auto cloth = inner(blender_surface("Kd 0.5\nPr 0.5\nPs 0.7\n")).as<bsdf_principled_record>();
    CHECK(cloth.sheen.value == 0.7f);
    const Bsdf frosted = blender_surface("Kd 0.9\nPr 0.4\nTf 0.8\nNi 1.4\n").bsdf;
    REQUIRE(frosted.is<bsdf_principled_record>()); // light passes: it is not twosided
    CHECK(frosted.as<bsdf_principled_record>().spec_trans.value == 0.8f);
    CHECK(frosted.as<bsdf_principled_record>().eta.value == 1.4f);

    const SurfaceOfMaterial glass = blender_surface("Kd 1\nPr 0\nTf 1 1 1\nNi 1.45\n");
    REQUIRE(glass.bsdf.is<bsdf_dielectric_record>());
    CHECK(glass.bsdf.as<bsdf_dielectric_record>().int_ior.value == 1.45f);
    CHECK(glass.bsdf.as<bsdf_dielectric_record>().ext_ior.value == 1);

    const SurfaceOfMaterial lamp = blender_surface("Kd 0\nKe 5 2.5 1.25\n");
    REQUIRE(lamp.radiance);
    CHECK(is_near(*lamp.radiance, {5, 2.5, 1.25}));
    CHECK(blender_surface("d 0\n").is_invisible);
    const SurfaceOfMaterial half = blender_surface("Kd 0.25\nd 0.5\n");
    REQUIRE(half.bsdf.is<bsdf_mask_record>());
    CHECK(half.bsdf.as<bsdf_mask_record>().opacity.value == 0.5f);
    CHECK(half.bsdf.children.at(0).children.at(0).as<bsdf_diffuse_record>().albedo.value[0] == 0.25f);
    CHECK(half.lacking.empty());
    CHECK(blender_surface("Kd 1\nPr 0\nTf 1 1 1\nd 0.5\n").lacking.size() == 1); // glass passes light by itself
    CHECK(blender_surface("map_Kd t.png\nmap_Bump n.png\n").lacking ==
          std::vector<std::string>{"map_Bump n.png", "map_Kd t.png"});
}

TEST_CASE_METHOD(MtlFixture, "numbers beyond what a BSDF can hold become the nearest that it can", "[mtl]") {
    // A lobe whose share single precision cannot tell from 0.
    for (const char *ks : {"1e-45", "1e-9"})
        CHECK(surface_of(one(fmt::format("Kd 0.5\nKs {}\nNs 10\n", ks))).bsdf.children.at(0).is<bsdf_diffuse_record>());
    const Bsdf sharp = surface_of(one("Kd 0.5\nKs 0.3\nNs 1e30\n")).bsdf.children.at(0);
    CHECK(sharp.as<bsdf_phong_record>().n.value == 1e5f);
    CHECK(principled_of(one("Ni 0\n")).ior == 1.5);
    CHECK(principled_of(one("Pr 1e30\n")).roughness == 1);
    CHECK(blender("Pr 2\n").roughness == 1);
}

TEST_CASE_METHOD(MtlFixture, "glass is smooth unless a statement says how rough it is", "[mtl]") {
    CHECK(surface_of(one("Kd 0\nTf 1\nillum 4\n")).bsdf.is<bsdf_dielectric_record>());
    const auto rough = [&](const std::string &statements) {
        const SurfaceOfMaterial surface = surface_of(one(statements));
        CHECK(surface.lacking.empty());
        return surface.bsdf.as<bsdf_principled_record>().roughness.value;
    };
    CHECK(rough("Kd 1\nTf 1\nillum 4\nKs 1\nNs 20\n") == Approx(std::pow(2 / 22., 0.25)));
    CHECK(rough("Kd 1\nTf 1\nPr 0.5\n") == 0.5f);
}

TEST_CASE_METHOD(MtlFixture, "no material reflects more than all light", "[mtl]") {
    for (double kd : {0.0, 0.3, 0.8, 1.0})
        for (double ks : {0.1, 0.5, 1.0}) {
            const SurfaceOfMaterial surface = surface_of(one(fmt::format("Kd {}\nKs {}\nNs 10\n", kd, ks)));
            const Bsdf bsdf = surface.bsdf.children.at(0);
            const double wanted_ks = std::min(ks, 1 - kd);
            CHECK(surface.lacking.size() == (ks > 1 - kd + 1e-12 ? 1 : 0));
            if (!bsdf.is<bsdf_phong_record>()) {
                CHECK(wanted_ks == 0);
                continue;
            }
            const auto phong = bsdf.as<bsdf_phong_record>();
            CHECK(phong.pd.value * phong.kd.value[0] == Approx(kd).margin(1e-6));
            CHECK((1 - phong.pd.value) * phong.ks.value[0] == Approx(wanted_ks).margin(1e-6));
        }
}

TEST_CASE_METHOD(MtlFixture, "a mesh for each material, by names with blanks in several libraries", "[mtl]") {
    scratch.write("a.mtl", "newmtl wall red\nKd 1 0 0\n");
    scratch.write("b c.mtl", "newmtl lamp\nKe 1 2 3\n");
    scratch.write("d.mtl", "newmtl hidden\nd 0\n");
    const auto path = scratch.write("a.obj", triangles + "mtllib b c.mtl\nmtllib a.mtl d.mtl\nf 1 2 3\n"
                                                         "usemtl wall red\nf 1 2 3\nusemtl lamp\nf 1 2 4\nf 2 3 4\n"
                                                         "usemtl wall red  \nf 2 3 4\nusemtl nowhere\nf 1 3 4\n"
                                                         "usemtl hidden\nf 1 3 4\n");
    Mesh mesh;
    mesh.name = "room";
    std::vector<Mesh> meshes;
    const auto told = warnings_of([&] { meshes = meshes_by_material(read_obj(path, {}), path, mesh, {}); });
    REQUIRE(meshes.size() == 4);
    CHECK(meshes[0].name == "room");
    CHECK(meshes[0].bsdf.is<bsdf_diffuse_record>());
    CHECK(meshes[1].name == "room: wall red");
    CHECK(std::get<TriangleMesh>(meshes[1].shape).triangles.size() == 2);
    CHECK(meshes[1].bsdf.children.at(0).as<bsdf_diffuse_record>().albedo.value[0] == 1);
    CHECK(meshes[2].emits_on_both_sides);
    CHECK(std::get<TriangleMesh>(meshes[2].shape).positions.size() == 4);
    CHECK(meshes[3].name == "room: nowhere");
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::Contains("a.obj:15:") && Catch::Contains("no material 'nowhere'"));

    const auto own = meshes_by_material(read_obj(path, {}), path, mesh, {.own_bsdf = true, .own_emitter = true});
    for (const Mesh &part : own) {
        CHECK(part.bsdf.is<bsdf_diffuse_record>());
        CHECK_FALSE(part.radiance);
    }
}

TEST_CASE_METHOD(MtlFixture, "Blender's material without a name is found", "[mtl]") {
    scratch.write("a.mtl", "newmtl \nKd 0.25\n");
    const auto path = scratch.write("a.obj", triangles + "mtllib a.mtl\nusemtl \nf 1 2 3\n");
    const auto meshes = meshes_by_material(read_obj(path, {}), path, {}, {});
    CHECK(meshes.at(0).bsdf.children.at(0).as<bsdf_diffuse_record>().albedo.value[0] == 0.25f);
}

TEST_CASE_METHOD(MtlFixture, "comments behind the names of materials and libraries, and quotes, are no part of them",
                 "[mtl]") {
    scratch.write("b c.mtl", "newmtl red # warm\nKd 0.25\nnewmtl blue # 1\nKd 0\nnewmtl blue # 2\nKd 0.5\n");
    for (const char *library : {"b c.mtl # all of them", "\"b c.mtl\"", "\"b c.mtl\"\t# quoted"})
        for (const char *name : {"red", "red # warm", "red # warm # 2"}) {
            INFO(library << " " << name);
            const auto path =
                scratch.write("a.obj", triangles + "mtllib " + library + "\nusemtl " + name + "\nf 1 2 3\n");
            const auto told = warnings_of([&] {
                const auto meshes = meshes_by_material(read_obj(path, {}), path, {}, {});
                CHECK(meshes.at(0).bsdf.children.at(0).as<bsdf_diffuse_record>().albedo.value[0] == 0.25f);
            });
            CHECK(told.empty());
        }
    const auto path = scratch.write("a.obj", triangles + "mtllib b c.mtl\nusemtl blue # 2\nf 1 2 3\n");
    const auto meshes = meshes_by_material(read_obj(path, {}), path, {}, {});
    CHECK(meshes.at(0).bsdf.children.at(0).as<bsdf_diffuse_record>().albedo.value[0] == 0.5f);
    scratch.write("a.obj", triangles + "mtllib b c.mtl\nusemtl blue # 3\nf 1 2 3\n");
    CHECK(warnings_of([&] { meshes_by_material(read_obj(path, {}), path, {}, {}); }).size() == 1);
}

TEST_CASE_METHOD(MtlFixture, "a material that is missing is no matter where the mesh has a bsdf of its own", "[mtl]") {
    const auto path = scratch.write("a.obj", triangles + "usemtl a\nf 1 2 3\n");
    CHECK(warnings_of([&] { meshes_by_material(read_obj(path, {}), path, {}, {.own_bsdf = true}); }).empty());
}

TEST_CASE_METHOD(MtlFixture, "each mesh keeps the texture coordinates of its triangles", "[mtl]") {
    const auto path = scratch.write("a.obj", triangles + "vt 0 0\nvt 0.5 0\nvt 0 0.25\nusemtl a\nf 1/1 2/2 3/1\n"
                                                         "usemtl b\nf 1/3 2/2 4\n");
    const auto meshes = meshes_by_material(read_obj(path, {}), path, {}, {.own_bsdf = true, .own_emitter = true});
    REQUIRE(meshes.size() == 2);
    const auto &second = std::get<TriangleMesh>(meshes[1].shape);
    REQUIRE(second.uvs.size() == 2);
    CHECK(second.uvs[0] == std::array<float, 2>{0, 0.25});
    CHECK(second.uv_corners == LargeVector<std::array<unsigned, 3>>{{0, 1, OPAL_NONE}});
}

TEST_CASE_METHOD(MtlFixture, "a library that is missing is told, with its place", "[mtl]") {
    const auto path = scratch.write("a.obj", triangles + "mtllib no such.mtl\nusemtl a\nf 1 2 3\n");
    const auto told = warnings_of([&] { meshes_by_material(read_obj(path, {}), path, {}, {}); });
    REQUIRE(told.size() == 3); // both words, and the material
    CHECK_THAT(told[0], Catch::Contains("a.obj:5:") && Catch::Contains("no such material library"));
}

TEST_CASE_METHOD(MtlFixture, "materials that nobody asked for are counted once", "[mtl]") {
    const auto path = scratch.write("a.obj", triangles + "usemtl a\nf 1 2 3\nusemtl b\nf 1 2 4\n");
    const auto told = warnings_of([&] { warn_of_unused_materials(read_obj(path, {}), path); });
    REQUIRE(told.size() == 1);
    CHECK_THAT(told[0], Catch::Contains("2 materials are not used"));
    scratch.write("a.obj", triangles + "f 1 2 3\n");
    CHECK(warnings_of([&] { warn_of_unused_materials(read_obj(path, {}), path); }).empty());
}

TEST_CASE_METHOD(MtlFixture, "mutated libraries are read or refused", "[mtl]") {
    const std::string text = "# Blender 5.0.1 MTL File: 'None'\nnewmtl wall red\nNs 250\nKa 1 1 1\nKd 0.8 0.1 0.2\nKs "
                             "0.5\nKe 0 0 0\nNi 1.5\nd 0.5\nTr 0.5\nillum 9\nmap_Kd -s 2 3 -o 0.1 0.2 my wood.png\n"
                             "newmtl b\nPr 0.5\nPm 1\nTf 1 1 1\nmap_Bump -bm 0.5 n.png # c\n";
    std::mt19937 random(1);
    const auto below = [&](size_t n) { return size_t(random() % n); };
    for (int i = 0; i < 500; i++) {
        std::string mutated = text;
        for (size_t edits = 1 + below(4); edits > 0; edits--) {
            const size_t at = below(mutated.size());
            switch (below(4)) {
            case 0:
                mutated[at] = char(random());
                break;
            case 1:
                mutated.erase(at, 1 + below(8));
                break;
            case 2:
                mutated.insert(at, mutated.substr(below(mutated.size()), 1 + below(20)));
                break;
            default:
                mutated.insert(at, std::vector<std::string>{"nan", "-", "1e999", "#", "\n", "\"", "-s", " "}[below(8)]);
            }
            mutated += ' ';
        }
        INFO(mutated);
        error_of([&] {
            for (const MtlMaterial &material : read(mutated))
                surface_of(material);
        });
    }
}

TEST_CASE_METHOD(MtlFixture, "pictures of colours and of opacity are rendered", "[mtl]") {
    Image image;
    image.width = 2;
    image.height = 1;
    image.layers = {{"R", {0.5f, 1}}, {"G", {0.25f, 1}}, {"B", {0, 1}}};
    std::filesystem::create_directories(scratch / "maps");
    write_exr(image, scratch / "maps/my wood.exr");
    // The first mesh of an OBJ file with a material of these statements.
    const auto mesh_of = [&](const std::string &statements) {
        scratch.write("a.mtl", "newmtl a\n" + statements);
        const auto path = scratch.write("a.obj", triangles + "mtllib a.mtl\nusemtl a\nf 1 2 3\n");
        return meshes_by_material(read_obj(path, {}), path, {}, {}).at(0);
    };
    const auto texture_of = [](const Bsdf &bsdf, const char *name) {
        return std::get<BitmapTexture>(
            bsdf.textures.at(find_row(bsdf_parameters(bsdf.kind()), "parameter", name).texture_word));
    };
    const Bsdf plain = mesh_of("map_Kd maps\\my wood.exr\n").bsdf.children.at(0);
    CHECK(plain.as<bsdf_diffuse_record>().albedo.value[1] == 1);
    CHECK(texture_of(plain, "albedo").picture->width == 2);
    CHECK(texture_of(plain, "albedo").to_uv == UvTransform{{{1, 0, 0}, {0, -1, 1}}}); // v = 0 is the bottom row
    CHECK(texture_of(plain, "albedo").wrap == WRAP_repeat);
    CHECK_FALSE(texture_of(plain, "albedo").raw);
    const Bsdf tiled =
        mesh_of("Kd 0.25 0.5 1\nmap_Kd -s 2 4 1 -o 0.5 0.125 0 -clamp on maps/my wood.exr\n").bsdf.children.at(0);
    CHECK(tiled.as<bsdf_diffuse_record>().albedo.value[0] == 0.25f); // which the picture multiplies
    CHECK(texture_of(tiled, "albedo").to_uv == UvTransform{{{2, 0, 0.5}, {0, -4, 0.875}}});
    CHECK(texture_of(tiled, "albedo").wrap == WRAP_clamp);
    const Bsdf coated = mesh_of("map_Kd maps/my wood.exr\nPr 0.5\n").bsdf.children.at(0);
    CHECK(texture_of(coated, "kd").picture->width == 2);
    const Bsdf metal = mesh_of("map_Kd maps/my wood.exr\nPr 0.5\nPm 1\n").bsdf.children.at(0);
    CHECK(texture_of(metal, "base_color").picture->width == 2);
    const Bsdf fence = mesh_of("map_d maps/my wood.exr\n").bsdf;
    REQUIRE(fence.is<bsdf_mask_record>());
    CHECK(fence.as<bsdf_mask_record>().opacity.value == 1);
    CHECK(texture_of(fence, "opacity").raw); // numbers
    CHECK(texture_of(fence, "opacity").to_uv[1][1] == -1);

    const auto told_of = [&](const std::string &statements) { return warnings_of([&] { mesh_of(statements); }); };
    CHECK(told_of("map_Kd maps/my wood.exr\nmap_d -t 0 0 0 -mm 0 1 maps/my wood.exr\n") == // its alpha is meant
          std::vector<std::string>{file() + ":1:1: material 'a': Opal does not render map_d maps/my wood.exr"});
    CHECK(told_of("Kd 0.5\nmap_Bump maps/my wood.exr\nnorm maps/my wood.exr\n") ==
          std::vector<std::string>{
              file() + ":1:1: material 'a': Opal does not render map_Bump maps/my wood.exr, norm maps/my wood.exr"});
    CHECK(told_of("map_Kd -mm 0.5 1 maps/my wood.exr\n") ==
          std::vector<std::string>{file() + ":2:1: option '-mm' of a texture is ignored"});
}

TEST_CASE_METHOD(MtlFixture, "a picture that is missing is told, with what stands in for it", "[mtl]") {
    const auto path = scratch.write("a.obj", triangles + "mtllib a.mtl\nusemtl a\nf 1 2 3\n");
    std::vector<Mesh> meshes;
    const auto told_of = [&](const std::string &statements) {
        scratch.write("a.mtl", "newmtl a\n" + statements);
        return warnings_of([&] { meshes = meshes_by_material(read_obj(path, {}), path, {}, {}); });
    };
    const auto albedo = [&] { return meshes.at(0).bsdf.children.at(0).as<bsdf_diffuse_record>().albedo.value[0]; };
    CHECK(told_of("map_Kd b.png\n") ==
          std::vector<std::string>{file() + ":2:1: map_Kd: no such file: " + (scratch / "b.png").string() +
                                   "; Kd 0.8 0.8 0.8 stands in for it"});
    CHECK(albedo() == 0.8f);
    CHECK_THAT(told_of("Kd 0.25\nmap_Kd a.obj\n").at(0),
               Catch::StartsWith(file() + ":3:1: map_Kd: ") && Catch::EndsWith("; Kd 0.25 0.25 0.25 stands in for it"));
    CHECK(albedo() == 0.25f);
    CHECK_THAT(told_of("d 0.5\nmap_d b.png\n").at(0), Catch::EndsWith("; d 0.5 stands in for it"));
    CHECK(meshes.at(0).bsdf.as<bsdf_mask_record>().opacity.value == 0.5f);
    // a mesh with a bsdf of its own needs none
    CHECK(warnings_of([&] { meshes_by_material(read_obj(path, {}), path, {}, {.own_bsdf = true}); }).empty());
}
