#include "flatten/features.h"

#include "flatten/distribution.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace opal {
namespace {

struct Decision {
    bool on;
    std::string reason;
};

std::string plural(std::size_t count, const char *one, const char *many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

// A tree of more bytes is large: its nodes are prefetched. Prefetching costs 2 to 5 % of a ray's time in trees of 0.1
// to 3 MiB and saves 6 % at 110 MiB.
constexpr std::size_t large_tree_bytes = 4 << 20;

// Paths up to this length are finished in the launch that starts them: roulette's own longest ones, in a scene that
// loses no light, have 1 / (1 - 0.9999) = 10 000 segments on the average by default (--rr-max).
constexpr double longest_path_of_a_launch = 2 / (1 - 0.9999);

// The segments of a path that loses no light, on the average.
double longest_path(const Strategy &strategy) {
    const double limit = strategy.max_depth == no_limit ? INFINITY : strategy.max_depth;
    if (!integrator_of(strategy).reads(AXIS_rr)) // only specular chains go on, by a roulette of their own
        return 1;
    if (strategy[AXIS_rr] == CHOICE_rr_off)
        return limit;
    const double survival =
        strategy[AXIS_rr] == CHOICE_rr_fixed ? drawn_probability(strategy.rr_prob) : strategy.rr_max;
    return std::min(limit, strategy.rr_depth + 1 / (1 - survival));
}

class Decider {
public:
    Decider(const SceneDescription &from, const FlatScene &flat, int width)
        : description(from), scene(flat), lanes(width), integrator(integrator_of(from.strategy)) {}

#define OPAL_DECIDE_BSDF(name, traits)                                                                                 \
    Decision bsdf_##name() const { return bsdf(BSDF_##name); }
    OPAL_ALL_BSDFS(OPAL_DECIDE_BSDF)
#undef OPAL_DECIDE_BSDF

#define OPAL_DECIDE_EMITTER(name, traits)                                                                              \
    Decision emitter_##name() const { return emitter(EMITTER_##name); }
    OPAL_EMITTERS(OPAL_DECIDE_EMITTER)
#undef OPAL_DECIDE_EMITTER

#define OPAL_DECIDE_SHAPE(name, Block)                                                                                 \
    Decision shape_##name() const { return shape(scene.name##_blocks.size()); }
    OPAL_SHAPES(OPAL_DECIDE_SHAPE)
#undef OPAL_DECIDE_SHAPE
#define OPAL_DECIDE_CAMERA(name, record, traits)                                                                       \
    Decision camera_##name() const { return camera(CAMERA_##name); }
    OPAL_CAMERAS(OPAL_DECIDE_CAMERA)
#undef OPAL_DECIDE_CAMERA

    Decision bsdf(uint kind) const {
        return bsdfs([&](uint at) { return scene.bsdfs[at] == kind; });
    }

    Decision mirror_coats() const {
        return bsdfs([&](uint at) {
            return scene.bsdfs[at] == BSDF_microfacet &&
                   record_of<bsdf_microfacet_record>(scene.bsdfs, at).alpha.value < MICROFACET_MIRROR_ALPHA;
        });
    }

    // A microfacet's coat is Beckmann's without asking, unless some surface of the scene is GGX.
    Decision beckmann() const {
        const bool asks = ggx().on;
        return bsdfs([&](uint at) { return (asks || scene.bsdfs[at] != BSDF_microfacet) && has_flag(at, "ggx", 0); });
    }
    Decision ggx() const { return with_flag("ggx", 1); }
    Decision all_facets() const { return with_flag("sample_visible", 0); }

    Decision tinted_glass() const {
        return bsdfs([&](uint at) {
            const uint kind = scene.bsdfs[at];
            if (!bsdf_parameter(kind, "specular_transmittance"))
                return false;
            const auto is_tinted = [&](const char *name) {
                const Parameter &parameter = *bsdf_parameter(kind, name);
                const auto is_one = [&](uint word) { return std::bit_cast<float>(word) == 1; };
                return !std::all_of(&scene.bsdfs[at + parameter.word], &scene.bsdfs[at + parameter.word] + 3, is_one) ||
                       scene.bsdfs[at + parameter.texture_word] != OPAL_UNTEXTURED;
            };
            return is_tinted("specular_reflectance") || is_tinted("specular_transmittance");
        });
    }

    // The words of the table from a record on.
    std::span<const uint> bsdf_words(uint at) const { return std::span(scene.bsdfs).subspan(at); }

    // Is the flag of that record there, and that value?
    bool has_flag(uint at, const char *name, uint value) const {
        const Parameter *parameter = bsdf_parameter(scene.bsdfs[at], name);
        return parameter && scene.bsdfs[at + parameter->word] == value;
    }

    // Meshes with a BSDF of facets whose flag is that.
    Decision with_flag(const char *name, uint value) const {
        return bsdfs([&](uint at) { return has_flag(at, name, value); });
    }

    // Meshes that have such a BSDF; is_meant: of a record, by its first word.
    template <class Is> Decision bsdfs(Is is_meant) const {
        if (!integrator.has(OPAL_ASKS_BSDFS))
            return {false, "this integrator asks no BSDF"};
        const auto has = [&](const MeshRecord &mesh) {
            bool found = false;
            visit_bsdfs(scene, mesh.bsdf, [&](uint at) { found = found || is_meant(at); });
            return found;
        };
        return counted(std::size_t(std::count_if(scene.meshes.begin(), scene.meshes.end(), has)), scene.meshes.size(),
                       "mesh", "meshes");
    }

    Decision emitter(uint kind) const {
        if (!integrator.has(OPAL_ASKS_LIGHTS))
            return {false, "this integrator asks no emitter"};
        if (!can_be_met(kind) && !samples_emitters(description.strategy))
            return {false, fmt::format("a BSDF sample never hits a {} light", emitter_name(kind))};
        const auto has = [&](const EmitterRecord &emitter) { return emitter.kind == kind; };
        return counted(std::size_t(std::count_if(scene.emitters.begin(), scene.emitters.end(), has)),
                       scene.emitters.size(), "emitter", "emitters");
    }

    static Decision shape(std::size_t blocks) { return {blocks > 0, plural(blocks, "block", "blocks")}; }
    Decision camera(uint kind) const {
        return {description.camera.kind == kind, fmt::format("the camera is {}", camera_name(description.camera.kind))};
    }

    Decision many_emitters() const {
        if (!integrator.has(OPAL_ASKS_LIGHTS))
            return {false, "this integrator asks no emitter"};
        return {scene.emitters.size() > 1, plural(scene.emitters.size(), "emitter", "emitters")};
    }

    Decision two_sided_lights() const {
        if (!integrator.has(OPAL_ASKS_LIGHTS))
            return {false, "this integrator asks no emitter"};
        const auto on_both = [](const EmitterRecord &emitter) { return emitter.two_sided != 0; };
        return counted(std::size_t(std::count_if(scene.emitters.begin(), scene.emitters.end(), on_both)),
                       scene.emitters.size(), "emitter", "emitters");
    }

    Decision shading_normals() const {
        const auto smooth = [](const Triangle &triangle) { return triangle.normal[0] != OPAL_NONE; };
        return counted(std::size_t(std::count_if(scene.triangles.begin(), scene.triangles.end(), smooth)),
                       scene.triangles.size(), "triangle", "triangles");
    }

    Decision uv() const {
        const bool needed = needs_uv(description);
        return {needed, needed ? "something on a surface has a texture" : "nothing on a surface has a texture"};
    }

    Decision tangents() const {
        return bsdfs([&](uint at) {
            return (traits_of_record(scene.bsdfs, at) & OPAL_TANGENTS) != 0 || is_anisotropic(bsdf_words(at));
        });
    }

    Decision light_textures() const {
        const auto has = [](const EmitterRecord &emitter) { return emitter.texture != OPAL_UNTEXTURED; };
        return counted(std::size_t(std::ranges::count_if(scene.emitters, has)), scene.emitters.size(), "emitter",
                       "emitters");
    }

    Decision hidden_emitters() const {
        return {description.hides_emitters && integrator.has(OPAL_ASKS_LIGHTS),
                description.hides_emitters ? "the integrator hides emitters" : "rays of the camera see emitters"};
    }

    Decision sample_counts() const {
        const Strategy &strategy = description.strategy;
        return {integrator.has(OPAL_ONE_SAMPLE_MIS) && (strategy.emitter_samples > 1 || strategy.bsdf_samples > 1),
                fmt::format("{} and {}", plural(strategy.emitter_samples, "emitter sample", "emitter samples"),
                            plural(strategy.bsdf_samples, "BSDF sample", "BSDF samples"))};
    }

    Decision face_list() const {
        if (lanes < FACE_LIST_LANES)
            return {false, fmt::format("pays from {} lanes on", FACE_LIST_LANES)};
        if (scene.faces.empty())
            return {false, "no triangle is large enough to be tested outside the tree"};
        return {true, fmt::format("{} of {}: tested against all lanes at once", scene.face_list_triangles,
                                  plural(scene.triangles.size(), "triangle", "triangles"))};
    }

    Decision tree() const {
        const std::size_t inside = scene.triangles.size() - scene.face_list_triangles;
        std::size_t others = 0; // blocks of other shapes
#define OPAL_COUNT_BLOCKS(name, Block) others += SHAPE_##name == SHAPE_triangle ? 0 : scene.name##_blocks.size();
        OPAL_SHAPES(OPAL_COUNT_BLOCKS)
#undef OPAL_COUNT_BLOCKS
        if (inside == 0 && others == 0 && lanes >= FACE_LIST_LANES)
            return {false, scene.triangles.empty() ? "there are no triangles" : "all triangles are listed"};
        return {true, plural(inside, "triangle", "triangles") + (others ? " and other shapes" : "")};
    }

    Decision large_tree() const {
        return {tree().on && scene.tree_bytes() > large_tree_bytes,
                fmt::format("{:.1f} MiB of nodes and blocks", double(scene.tree_bytes()) / (1 << 20))};
    }

    Decision last_rays() const {
        if (!integrator.reads(AXIS_lighting))
            return {false, "this integrator's last rays ask for more than lights"};
        if (integrator.reads(AXIS_rr) && description.strategy.max_depth == no_limit)
            return {false, "no ray is known to be a path's last"};
        if (!face_list().on || !tree().on)
            return {false, "there are not both listed faces and a tree"};
        if (std::ranges::none_of(scene.emitters, [](const EmitterRecord &e) { return can_be_met(e.kind); }))
            return {false, "no ray meets a light"};
        const std::size_t inside = shining_in_tree();
        return {inside == 0, inside ? fmt::format("{} of lights in the tree", plural(inside, "shape", "shapes"))
                                    : "no light is in the tree"};
    }

    Decision endless_paths() const {
        const double segments = longest_path(description.strategy);
        return {segments > longest_path_of_a_launch,
                segments == INFINITY ? "nothing ends a path" : fmt::format("up to {:.3g} segments", segments)};
    }

private:
    // Triangles and spheres that emit, but those of the face list.
    std::size_t shining_in_tree() const {
        const auto emits = [&](uint triangle) {
            return scene.meshes[scene.triangles[triangle].mesh].emitter != OPAL_NONE;
        };
        std::size_t count = std::size_t(std::ranges::count(scene.emitters, uint(EMITTER_sphere), &EmitterRecord::kind));
        for (uint i = 0; i < scene.triangles.size(); i++)
            count += emits(i);
        for (std::size_t block = scene.settings.face_list_slot / OPAL_WIDTH; block < scene.triangle_blocks.size();
             block++)
            for (uint id : scene.triangle_blocks[block].id)
                count -= id != OPAL_NONE && emits(id);
        return count;
    }

    const SceneDescription &description;
    const FlatScene &scene;
    int lanes;
    const IntegratorTraits &integrator;

    static Decision counted(std::size_t count, std::size_t all, const char *one, const char *many) {
        if (count == 0)
            return {false, fmt::format("no {} has it", one)};
        if (all == 1)
            return {true, fmt::format("the only {} has it", one)};
        return {true, fmt::format("{} of {}", count, plural(all, one, many))};
    }
};

// Chooses the axis `hemisphere`: where all diffuse materials sample it the same way, the kernel has only that way. Sets
// `reason` in that case.
int find_hemisphere(const SceneDescription &description, const FlatScene &scene, std::string &reason) {
    const int chosen = description.strategy[AXIS_hemisphere];
    if (chosen != CHOICE_hemisphere_material)
        return chosen;
    std::size_t cosine = 0, all = 0;
    for (const MeshRecord &mesh : scene.meshes)
        visit_bsdfs(scene, mesh.bsdf, [&](uint at) {
            if (scene.bsdfs[at] == BSDF_diffuse) {
                all++;
                cosine += record_of<bsdf_diffuse_record>(scene.bsdfs, at).use_cosine != 0;
            }
        });
    if (all == 0 || (cosine > 0 && cosine < all))
        return chosen;
    reason = cosine ? "all diffuse materials use_cosine" : "no diffuse material has use_cosine";
    return cosine ? CHOICE_hemisphere_cosine : CHOICE_hemisphere_uniform;
}

// Chooses the axis `emitter_choice`: emitters of one power are chosen alike. Sets `reason` in that case.
int find_emitter_choice(const SceneDescription &description, const FlatScene &scene, std::string &reason) {
    const int chosen = description.strategy[AXIS_emitter_choice];
    const auto is_alike = [](const EmitterRecord &emitter) { return emitter.accept == 1; };
    if (chosen == CHOICE_emitter_choice_uniform || !std::ranges::all_of(scene.emitters, is_alike))
        return chosen;
    reason = scene.emitters.size() < 2 ? "there is nothing to choose from" : "all emitters have the same power";
    return CHOICE_emitter_choice_uniform;
}

// The parameters of each kind of BSDF that have a texture on some mesh; all where it is decided at run time and the
// scene has textures at all.
std::array<uint, BSDF_COUNT> find_textured(const FlatScene &scene, bool specialise) {
    std::array<uint, BSDF_COUNT> textured{};
    if (!specialise && !scene.textures.empty())
        textured.fill(~0u);
    for (const MeshRecord &mesh : scene.meshes)
        visit_bsdfs(scene, mesh.bsdf, [&](uint at) {
            uint place = 1;
            for (const Parameter &parameter : bsdf_parameters(scene.bsdfs[at])) {
                if (parameter.texture_word && scene.bsdfs[at + parameter.texture_word] != OPAL_UNTEXTURED)
                    textured[scene.bsdfs[at]] |= place;
                place *= 2;
            }
        });
    return textured;
}

// The most BSDFs of a nest that change the shading normal, one within the other.
uint find_perturbations(const FlatScene &scene, uint at) {
    uint within = 0;
    for (const Parameter &parameter : bsdf_parameters(scene.bsdfs[at]))
        if (parameter.type == ParameterType::BSDF)
            within = std::max(within, find_perturbations(scene, scene.bsdfs[at + parameter.word]));
    return within + ((bsdf_traits(scene.bsdfs[at]) & OPAL_PERTURBS) != 0);
}

// The numbers of each kind of BSDF that are not 0 on some mesh, of kinds of which kernels ask that; else all.
std::array<uint, BSDF_COUNT> find_nonzero(const FlatScene &scene, bool specialise) {
    std::array<uint, BSDF_COUNT> nonzero{};
    for (uint kind = 0; kind < BSDF_COUNT; kind++)
        nonzero[kind] = specialise && bsdf_traits(kind) & OPAL_MANY_LOBES ? 0 : ~0u;
    for (const MeshRecord &mesh : scene.meshes)
        visit_bsdfs(scene, mesh.bsdf, [&](uint at) {
            uint place = 1;
            for (const Parameter &parameter : bsdf_parameters(scene.bsdfs[at])) {
                if (parameter.type == ParameterType::NUMBER &&
                    std::bit_cast<float>(scene.bsdfs[at + parameter.word]) != 0)
                    nonzero[scene.bsdfs[at]] |= place;
                place *= 2;
            }
        });
    return nonzero;
}

// Does a program for all scenes have the feature? Where no scene of that width has it, or where it costs most scenes
// more than it saves a few, it has not: prefetching a tree that fits into the caches takes 5 to 10 % of its time. Nor
// has it what is wrong where a scene does not allow it.
bool general_has(unsigned feature, int lanes) {
    if (feature == FEATURE_face_list)
        return lanes >= FACE_LIST_LANES;
    return feature != FEATURE_large_tree && feature != FEATURE_last_rays;
}

// Features whose scenes have a general kernel of their own, which does not ask at run time.
bool has_general_kernel(unsigned feature) {
    switch (feature) {
    case FEATURE_bsdf_conductor:
    case FEATURE_bsdf_roughconductor:
    case FEATURE_bsdf_thindielectric:
    case FEATURE_bsdf_roughdielectric:
    case FEATURE_bsdf_principled:
    case FEATURE_bsdf_principledthin:
    case FEATURE_bsdf_oren_nayar:
    case FEATURE_bsdf_plastic:
    case FEATURE_bsdf_roughplastic:
    case FEATURE_beckmann:
    case FEATURE_ggx:
    case FEATURE_all_facets:
    case FEATURE_tinted_glass:
    case FEATURE_bsdf_blendbsdf:
    case FEATURE_bsdf_normalmap:
    case FEATURE_bsdf_bumpmap:
    case FEATURE_endless_paths:
    case FEATURE_hidden_emitters:
    case FEATURE_uv:
    case FEATURE_tangents:
    case FEATURE_light_textures:
    case FEATURE_emitter_projector:
    case FEATURE_emitter_envmap:
        return true;
    default:
        return false;
    }
}

// Features of a second program for all scenes, which serves scenes that have one of these. Scenes of Nori's own kinds
// have none, and would be slower with the second.
bool is_second_general(unsigned feature) {
    switch (feature) {
    case FEATURE_bsdf_mask:
    case FEATURE_bsdf_null:
    case FEATURE_emitter_sphere:
    case FEATURE_emitter_spot:
    case FEATURE_emitter_directional:
    case FEATURE_shape_sphere:
    case FEATURE_camera_thinlens:
    case FEATURE_camera_orthographic:
    case FEATURE_hidden_emitters:
    case FEATURE_sample_counts:
        return true;
    default:
        return false;
    }
}

} // namespace

const char *feature_name(unsigned feature) {
    static const char *const names[] = {
#define OPAL_FEATURE_ROW(name, shown) shown,
        OPAL_FEATURES
#undef OPAL_FEATURE_ROW
    };
    return names[feature];
}

Features find_features(const SceneDescription &description, const FlatScene &scene, int lanes) {
    const Decider decider(description, scene, lanes);
    const Decision decisions[] = {
#define OPAL_FEATURE_ROW(name, shown) decider.name(),
        OPAL_FEATURES
#undef OPAL_FEATURE_ROW
    };

    Features features;
    const bool specialise = !description.strategy.is_general();
    bool second_general = false;
    for (unsigned i = 0; i < FEATURE_COUNT; i++)
        second_general = second_general || (is_second_general(i) && decisions[i].on);
    for (unsigned i = 0; i < FEATURE_COUNT; i++)
        features.list[i] =
            specialise || has_general_kernel(i)
                ? Feature{decisions[i].on, decisions[i].reason}
                : Feature{general_has(i, lanes) && (second_general || !is_second_general(i)), "the general kernel"};
    for (int axis = 0; axis < AXIS_COUNT; axis++) {
        features.axes[axis] = specialise ? description.strategy[axis] : -1;
        features.axis_reasons[axis] = specialise ? "chosen" : "the general kernel: decided at run time";
    }
    if (specialise) {
        features.axes[AXIS_hemisphere] = find_hemisphere(description, scene, features.axis_reasons[AXIS_hemisphere]);
        features.axes[AXIS_emitter_choice] =
            find_emitter_choice(description, scene, features.axis_reasons[AXIS_emitter_choice]);
    }
    features.loop = integrator_of(description.strategy).loop;
    features.textured = find_textured(scene, specialise);
    features.nonzero = find_nonzero(scene, specialise);
    const bool any_texture = !specialise && !scene.textures.empty(); // then all is decided at run time
    features.texture_kinds = any_texture ? (1u << TEXTURE_COUNT) - 1 : scene.texture_kinds;
    features.bitmap_forms = any_texture ? uint(BITMAP_FORMS) : scene.bitmap_forms;
    if (integrator_of(description.strategy).has(OPAL_ASKS_BSDFS))
        for (const MeshRecord &mesh : scene.meshes)
            features.perturbations = std::max(features.perturbations, find_perturbations(scene, mesh.bsdf));
    return features;
}

bool shares_general_kernel(const SceneDescription &scene) {
    const auto is_own = [](const Bsdf &bsdf) {
#define OPAL_OWN_BSDF(name, traits) (has_general_kernel(FEATURE_bsdf_##name) && bsdf.leads_to(BSDF_##name)) ||
        return OPAL_ALL_BSDFS(OPAL_OWN_BSDF) false;
#undef OPAL_OWN_BSDF
    };
    const auto is_own_light = [](const Light &light) {
#define OPAL_OWN_EMITTER(name, traits) (has_general_kernel(FEATURE_emitter_##name) && light.kind() == EMITTER_##name) ||
        return OPAL_EMITTERS(OPAL_OWN_EMITTER) false;
#undef OPAL_OWN_EMITTER
    };
    return !needs_uv(scene) && !scene.hides_emitters &&
           std::ranges::none_of(scene.meshes, [&](const Mesh &mesh) { return mesh.texture || is_own(mesh.bsdf); }) &&
           std::ranges::none_of(scene.lights, is_own_light);
}

Features shared_features(const std::vector<FlatScene> &scenes) {
    Features shared = scenes.at(0).features;
    for (const FlatScene &scene : scenes) {
        for (std::size_t i = 0; i < shared.list.size(); i++)
            if (scene.features.list[i].on && !shared.list[i].on)
                shared.list[i] = scene.features.list[i];
        for (std::size_t kind = 0; kind < shared.textured.size(); kind++) {
            shared.textured[kind] |= scene.features.textured[kind];
            shared.nonzero[kind] |= scene.features.nonzero[kind];
        }
        shared.texture_kinds |= scene.features.texture_kinds;
        shared.bitmap_forms |= scene.features.bitmap_forms;
        shared.perturbations = std::max(shared.perturbations, scene.features.perturbations);
        for (int axis = 0; axis < AXIS_COUNT; axis++)
            if (scene.features.axes[axis] != shared.axes[axis]) {
                shared.axes[axis] = -1;
                shared.axis_reasons[axis] = "the strategies differ: decided at run time";
            }
    }
    return shared;
}

} // namespace opal
