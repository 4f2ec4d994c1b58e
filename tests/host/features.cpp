// The features that a kernel is compiled with, and the materials that decide them.
#include "flatten/features.h"
#include "support/plain_scenes.h"

#include <catch2/catch.hpp>

#include <set>

using namespace opal;

TEST_CASE("equal materials are one record, and --hemisphere is written into them", "[features]") {
    SceneDescription description = scene_of({diffuse(one_triangle, 0.5f), diffuse(one_triangle, 0.25f),
                                             diffuse(one_triangle, 0.5f), diffuse(one_triangle, 0.5f, true)});
    FlatScene scene = flatten(description, 8);
    const auto different = [&] {
        std::set<uint> records;
        for (const MeshRecord &mesh : scene.meshes)
            records.insert(mesh.bsdf);
        return records.size();
    };
    const auto use_cosine = [&](size_t mesh) {
        return record_of<bsdf_diffuse_record>(scene.bsdfs, scene.meshes[mesh].bsdf).use_cosine;
    };
    CHECK(different() == 3);
    CHECK((scene.meshes[0].bsdf == scene.meshes[2].bsdf && scene.meshes[0].bsdf != scene.meshes[1].bsdf));
    CHECK(use_cosine(3) == 1);
    CHECK(scene.features.axes[AXIS_hemisphere] == CHOICE_hemisphere_material);

    description.strategy[AXIS_hemisphere] = CHOICE_hemisphere_cosine;
    scene = flatten(description, 8);
    CHECK(different() == 2);
    for (size_t mesh = 0; mesh < scene.meshes.size(); mesh++)
        CHECK(use_cosine(mesh) == 1);

    description.strategy[AXIS_hemisphere] = CHOICE_hemisphere_material;
    description.meshes.pop_back(); // now all agree
    CHECK(flatten(description, 8).features.axes[AXIS_hemisphere] == CHOICE_hemisphere_uniform);
}

TEST_CASE("a BSDF comes with those that it leads to, each record once", "[features]") {
    Bsdf inner = examples::diffuse(0.5, true), outer = bsdf_twosided_record{};
    outer.children = {inner};
    SceneDescription description =
        scene_of({diffuse(one_triangle, 0.5f, true), diffuse(one_triangle), diffuse(one_triangle)});
    description.meshes[1].bsdf = description.meshes[2].bsdf = outer;
    const FlatScene scene = flatten(description, 8);
    CHECK(scene.meshes[1].bsdf == scene.meshes[2].bsdf);
    CHECK(scene.bsdfs.at(scene.meshes[1].bsdf) == BSDF_twosided);
    CHECK(record_of<bsdf_twosided_record>(scene.bsdfs, scene.meshes[1].bsdf).base == scene.meshes[0].bsdf);
    CHECK(record_of<bsdf_twosided_record>(scene.bsdfs, scene.meshes[1].bsdf).back == scene.meshes[0].bsdf);
    CHECK(scene.features[FEATURE_bsdf_diffuse]);
    CHECK(scene.features.list[FEATURE_bsdf_twosided].reason == "2 of 3 meshes");
    CHECK(scene.features.axes[AXIS_hemisphere] == CHOICE_hemisphere_cosine);
    CHECK(outer.traits() == OPAL_SMOOTH);
}

TEST_CASE("last rays need not walk a tree without lights", "[features]") {
    const Parallelogram floor{{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}}, lamp{{-1, 1, -1}, {2, 0, 0}, {0, 0, 2}};
    SceneDescription scene = scene_of({diffuse(floor), light(lamp, {1, 1, 1}), diffuse(Sphere{{0, 0.5, 0}, 0.1})});
    const auto reason = [&](int lanes = 8) {
        const Feature last_rays = flatten(scene, lanes).features.list[FEATURE_last_rays];
        return std::string(last_rays.on ? "yes: " : "no: ") + last_rays.reason;
    };
    CHECK(reason() == "no: no ray is known to be a path's last");
    scene.strategy.max_depth = 3;
    CHECK(reason() == "yes: no light is in the tree");
    CHECK(reason(1) == "no: there are not both listed faces and a tree");
    scene.strategy.max_depth = no_limit;
    scene.strategy[AXIS_integrator] = CHOICE_integrator_direct_lighting;
    CHECK(reason() == "yes: no light is in the tree");
    scene.meshes.push_back(light(Sphere{{0, 0.7, 0}, 0.1}, {1, 1, 1}));
    CHECK(reason() == "no: 1 shape of lights in the tree");
    scene.meshes.erase(scene.meshes.begin() + 1);
    scene.meshes.back() = diffuse(Sphere{{0, 0.7, 0}, 0.1});
    scene.lights = {{emitter_point{{0, 1, 0}, {1, 1, 1}}, {}}};
    CHECK(reason() == "no: no ray meets a light");
    scene.strategy[AXIS_integrator] = CHOICE_integrator_whitted;
    CHECK(reason() == "no: this integrator's last rays ask for more than lights");
}

TEST_CASE("numbers that are 0 in all principled materials are 0 in the kernel", "[features]") {
    SceneDescription description = scene_of({diffuse(one_triangle), diffuse(one_triangle), diffuse(one_triangle)});
    description.meshes[0].bsdf = bsdf_principled_record{.metallic = 1};
    description.meshes[1].bsdf = bsdf_principled_record{.roughness = 0, .sheen = 0.5};
    const FlatScene scene = flatten(description, 8);
    uint expected = 0, place = 1;
    for (const Parameter &parameter : bsdf_parameters(BSDF_principled)) {
        if (std::set<std::string>{"roughness", "metallic", "sheen", "eta"}.contains(parameter.name))
            expected |= place;
        place *= 2;
    }
    CHECK(scene.features.nonzero[BSDF_principled] == expected);
    CHECK(scene.features.nonzero[BSDF_diffuse] == ~0u); // which asks no such thing
    CHECK_FALSE(scene.features[FEATURE_tangents]);
    description.meshes[1].bsdf = bsdf_principled_record{.anisotropic = 0.1};
    CHECK(flatten(description, 8).features[FEATURE_tangents]);
    description.strategy.specialise = Specialise::off;
    CHECK(flatten(description, 8).features.nonzero[BSDF_principled] == ~0u);
    CHECK(flatten(description, 8).features[FEATURE_bsdf_principled]);
    description.meshes = {description.meshes[2]};
    CHECK_FALSE(flatten(description, 8).features[FEATURE_bsdf_principled]);
}

TEST_CASE("features are what the scene and the strategy ask for, each with a reason", "[features]") {
    SceneDescription description = scene_of({diffuse(one_triangle), light(one_triangle, {1, 1, 1})});
    description.meshes[0].bsdf = bsdf_mirror_record{};
    description.lights = {{emitter_point{{1, 1, 1}, {1, 1, 1}}, {}}};
    description.strategy[AXIS_rr] = CHOICE_rr_throughput;
    const auto on = [](const SceneDescription &scene) {
        std::set<std::string> names;
        const Features features = flatten(scene, 8).features;
        for (unsigned i = 0; i < FEATURE_COUNT; i++) {
            CHECK_FALSE(features.list[i].reason.empty());
            if (features[i])
                names.insert(feature_name(i));
        }
        return names;
    };
    using Names = std::set<std::string>;
    CHECK(on(description) == Names{"bsdf_diffuse", "bsdf_mirror", "camera_perspective", "emitter_mesh", "emitter_point",
                                   "listed", "many_emitters", "shape_triangle"});
    CHECK(flatten(description, 8).features.list[FEATURE_bsdf_mirror].reason == "1 of 2 meshes");

    SECTION("nothing of BSDFs and emitters for the integrators that ask neither") {
        for (int integrator : {CHOICE_integrator_normals, CHOICE_integrator_ao, CHOICE_integrator_simple}) {
            description.strategy[AXIS_integrator] = integrator;
            CHECK(on(description) == Names{"camera_perspective", "listed", "shape_triangle"});
        }
    }
    SECTION("no points where light is found by hitting it") {
        description.strategy[AXIS_lighting] = CHOICE_lighting_bsdf;
        CHECK(on(description).count("emitter_point") == 0);
        CHECK(on(description).count("emitter_mesh") == 1);
        description.strategy[AXIS_integrator] = CHOICE_integrator_whitted; // samples lights whatever the axis says
        CHECK(on(description).count("emitter_point") == 1);
    }
    SECTION("filters beyond the pixel") {
        description.camera.filter = {FILTER_box, 0.5, 0.5, 0, 0, true};
        CHECK_FALSE(is_wide_filter(flatten(description, 8).settings));
        description.camera.filter.radius = 0.75;
        CHECK(is_wide_filter(flatten(description, 8).settings));
        description.camera.filter = {FILTER_tent, 0.5, 0.5, 0, 0, true};
        CHECK(is_wide_filter(flatten(description, 8).settings));
    }
    SECTION("paths that may be endless") {
        Strategy &strategy = description.strategy;
        const auto endless = [&] { return flatten(description, 8).features[FEATURE_endless_paths]; };
        CHECK_FALSE(endless());
        strategy.rr_depth = 1'000'000;
        CHECK(endless());
        strategy.max_depth = 100;
        CHECK_FALSE(endless());
        strategy[AXIS_rr] = CHOICE_rr_off;
        CHECK_FALSE(endless());
        strategy.max_depth = 1'000'000;
        CHECK(endless());
        strategy.specialise = Specialise::off;
        CHECK(endless());
        strategy.max_depth = no_limit;
        strategy.rr_depth = 3;
        strategy[AXIS_rr] = CHOICE_rr_fixed;
        strategy.rr_prob = 1 - 1e-5;
        CHECK(endless());
        strategy.rr_prob = 0.95;
        CHECK_FALSE(endless());
    }
    SECTION("metals and glass") {
        const auto with = [&](const Bsdf &bsdf) {
            description.meshes[0].bsdf = bsdf;
            return flatten(description, 8).features;
        };
        const Features rough = with(bsdf_roughconductor_record{.ggx = 1});
        CHECK(rough[FEATURE_ggx]);
        CHECK_FALSE(rough[FEATURE_beckmann]);
        CHECK_FALSE(rough[FEATURE_all_facets]);
        CHECK_FALSE(rough[FEATURE_tangents]);
        CHECK(with(bsdf_roughdielectric_record{.sample_visible = 0})[FEATURE_all_facets]);
        CHECK(with(bsdf_roughplastic_record{})[FEATURE_beckmann]);
        CHECK(with(bsdf_roughplastic_record{.ggx = 1})[FEATURE_ggx]);
        CHECK_FALSE(with(bsdf_plastic_record{})[FEATURE_beckmann]);
        const Features brushed = with(bsdf_roughconductor_record{.alpha_u = 0.2});
        CHECK(brushed[FEATURE_beckmann]);
        CHECK(brushed[FEATURE_tangents]);
        CHECK(brushed[FEATURE_uv]);
        CHECK_FALSE(with(bsdf_dielectric_record{})[FEATURE_tinted_glass]);
        CHECK(with(bsdf_thindielectric_record{.specular_transmittance = 0.5})[FEATURE_tinted_glass]);
        Bsdf textured = bsdf_dielectric_record{};
        textured.textures[bsdf_parameter(BSDF_dielectric, "specular_reflectance")->texture_word] =
            CheckerboardTexture{};
        CHECK(with(textured)[FEATURE_tinted_glass]);
    }
    SECTION("everything without specialisation") {
        description.strategy.specialise = Specialise::off;
        const Features features = flatten(description, 8).features;
        // What Nori has not is in a second general kernel, for scenes that have some of it.
        const std::set<unsigned> second = {FEATURE_bsdf_mask,       FEATURE_bsdf_null,           FEATURE_emitter_sphere,
                                           FEATURE_emitter_spot,    FEATURE_emitter_directional, FEATURE_shape_sphere,
                                           FEATURE_camera_thinlens, FEATURE_camera_orthographic, FEATURE_sample_counts};
        const std::set<unsigned> of_its_own = {FEATURE_endless_paths,
                                               FEATURE_hidden_emitters,
                                               FEATURE_uv,
                                               FEATURE_tangents,
                                               FEATURE_light_textures,
                                               FEATURE_emitter_projector,
                                               FEATURE_emitter_envmap,
                                               FEATURE_bsdf_principled,
                                               FEATURE_bsdf_principledthin,
                                               FEATURE_bsdf_oren_nayar,
                                               FEATURE_bsdf_plastic,
                                               FEATURE_bsdf_roughplastic,
                                               FEATURE_bsdf_conductor,
                                               FEATURE_bsdf_roughconductor,
                                               FEATURE_bsdf_thindielectric,
                                               FEATURE_bsdf_roughdielectric,
                                               FEATURE_beckmann,
                                               FEATURE_ggx,
                                               FEATURE_all_facets,
                                               FEATURE_tinted_glass,
                                               FEATURE_bsdf_blendbsdf,
                                               FEATURE_bsdf_normalmap,
                                               FEATURE_bsdf_bumpmap};
        description.meshes[0].bsdf = bsdf_null_record{};
        const Features others = flatten(description, 8).features;
        for (unsigned feature = 0; feature < FEATURE_COUNT; feature++) {
            INFO(feature_name(feature));
            const bool everywhere =
                !of_its_own.contains(feature) && feature != FEATURE_large_tree && feature != FEATURE_last_rays;
            CHECK(features[feature] == (everywhere && !second.contains(feature)));
            CHECK(others[feature] == everywhere);
        }
        description.hides_emitters = true;
        CHECK(flatten(description, 8).features[FEATURE_hidden_emitters]);
        CHECK_FALSE(flatten(description, 1).features[FEATURE_face_list]);
        for (int axis : features.axes)
            CHECK(axis == -1);
    }
    SECTION("axes are compiled in") {
        const Features features = flatten(description, 8).features;
        CHECK(features.axes[AXIS_lighting] == CHOICE_lighting_mis);
        for (const std::string &text : features.axis_reasons)
            CHECK_FALSE(text.empty());
    }
}
