#include "flatten/emitters.h"

#include "base/error.h"
#include "bvh/binary_tree.h"
#include "flatten/distribution.h"
#include "flatten/emitter_kinds.h"
#include "flatten/store.h"
#include "flatten/texture_mean.h"
#include "flatten/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>
#include <span>

namespace opal {
namespace {

constexpr double pi = std::numbers::pi;

// Powers count as equal within this share. The rounding of corners makes the powers of equal lamps differ by up to
// about 2^-23 over the lamp's size in flattened units, and choosing equal lamps alike costs no variance.
constexpr double equal_power_tolerance = 1e-3;

bool are_equal(const std::vector<double> &powers) {
    const auto [least, largest] = std::ranges::minmax(powers);
    return least >= (1 - equal_power_tolerance) * largest;
}

bool is_black(const Color &c) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }

// The slot of each triangle's vertices, by triangle id (EmittingMesh::slots).
std::vector<uint> triangle_slots(const FlatScene &scene) {
    std::vector<uint> slots(scene.triangles.size());
    for (uint slot = 0; slot < scene.triangle_blocks.size() * block_size; slot++) {
        const uint id = scene.triangle_blocks[slot / block_size].id[slot % block_size];
        if (id != OPAL_NONE)
            slots[id] = slot;
    }
    return slots;
}

// What emits where a mesh does.
uint kind_of(const Shape &shape) {
    return std::holds_alternative<Sphere>(shape)          ? EMITTER_sphere
           : std::holds_alternative<Parallelogram>(shape) ? EMITTER_parallelogram
                                                          : EMITTER_mesh;
}

class EmitterGatherer {
public:
    EmitterGatherer(const SceneDescription &description, const Flattening &flattening, double radius,
                    const TriangleSoup &soup, TextureGatherer &textures, FlatScene &scene)
        : description_(description), flattening_(flattening), radius_(radius), soup_(soup), textures_(textures),
          scene_(scene) {}

    void gather() {
        textured_ = std::size_t(
            std::ranges::count_if(description_.meshes, [](const Mesh &mesh) { return mesh.texture.has_value(); }));
        uint end = 0; // triangles are in the order of their meshes
        for (uint mesh = 0; mesh < description_.meshes.size(); mesh++) {
            const uint begin = end;
            while (end < scene_.triangles.size() && scene_.triangles[end].mesh == mesh)
                end++;
            const auto &radiance = description_.meshes[mesh].radiance;
            const auto *sphere = std::get_if<Sphere>(&description_.meshes[mesh].shape);
            const bool is_there = sphere ? has_area(flattening_.distance(sphere->radius)) : begin != end;
            if (radiance && !is_black(*radiance) && is_there)
                scene_.meshes[mesh].emitter = add_mesh(mesh, begin, end);
        }
        for (const Light &light : description_.lights)
            if (!is_black(light))
                add_light(light);
        fill_emitter_choice();
    }

private:
    const SceneDescription &description_;
    const Flattening &flattening_;
    const double radius_;
    const TriangleSoup &soup_;
    TextureGatherer &textures_;
    FlatScene &scene_;
    std::vector<uint> slots_;
    std::size_t textured_ = 0; // meshes that emit by a texture
    SourcePlace environment_place_;
    std::vector<double> powers_; // of each emitter, W, times the square of the flattening's scale

    uint add(const EmitterRecord &record, double power) {
        scene_.emitters.push_back(record);
        powers_.push_back(power);
        return uint(scene_.emitters.size() - 1);
    }

    uint add_mesh(uint index, uint begin, uint end) {
        const Mesh &mesh = description_.meshes[index];
        if (slots_.empty())
            slots_ = triangle_slots(scene_);
        const bool uniform = description_.strategy[AXIS_triangle_choice] == CHOICE_triangle_choice_uniform;
        const EmittingMesh from{mesh, index, flattening_, begin, end, soup_, slots_, uniform};
        EmitterRecord record{};
        record.texture = OPAL_UNTEXTURED;
        record.kind = kind_of(mesh.shape);
        record.two_sided = mesh.emits_on_both_sides;
        double area = 0;
#define OPAL_FLATTEN_MESH(name, traits)                                                                                \
    if (record.kind == EMITTER_##name)                                                                                 \
        area = flatten_##name(from, record, scene_);
        OPAL_MESH_EMITTERS(OPAL_FLATTEN_MESH)
        Color radiance = *mesh.radiance;
        if (mesh.texture) {
            record.texture = textures_.add(*mesh.texture);
            const Color mean = mean_over(from);
            for (std::size_t i = 0; i < radiance.size(); i++)
                radiance[i] *= mean[i];
        }
        return add(record, pi * luminance(radiance) * area * (mesh.emits_on_both_sides ? 2 : 1));
    }

    // The mean of a light's texture over its surface. Where all values that are looked up are 0, others may not be, and
    // the light must be found: the texture's own mean stands in.
    Color mean_over(const EmittingMesh &from) const {
        constexpr std::size_t all_lookups = 1 << 18, least_lookups = 1 << 8; // 20 ms, and 20 us a light
        const std::size_t lookups = std::max(least_lookups, all_lookups / textured_);
        const Texture &texture = *from.mesh.texture;
        Color mean{};
        if (std::holds_alternative<MeshAttributeTexture>(texture)) {
            mean.fill(mean_luminance(texture)); // of its values alike
        } else if (std::holds_alternative<Sphere>(from.mesh.shape)) {
            mean = mean_over_sphere(texture, lookups);
        } else {
            std::vector<double> areas;
            for (uint id = from.begin; id < from.end; id++)
                areas.push_back(triangle_area(soup_, id));
            mean = mean_over_triangles(texture, std::span(scene_.triangle_uvs).subspan(from.begin, areas.size()), areas,
                                       lookups);
        }
        if (is_black(mean))
            mean.fill(mean_luminance(texture));
        return mean;
    }

    void add_light(const Light &light) {
        if (is_environment(light.kind())) {
            if (scene_.settings.environment != OPAL_NONE)
                throw Error(fmt::format("{}: a second environment: rays that leave the scene meet one only; the first "
                                        "is at {}",
                                        light.place.text(), environment_place_.text()));
            scene_.settings.environment = uint(scene_.emitters.size());
            environment_place_ = light.place;
        }
        EmitterRecord record{};
        record.texture = OPAL_UNTEXTURED;
        record.kind = light.kind();
#define OPAL_STORE_EMITTER(name, traits)                                                                               \
    if (const auto *own = std::get_if<emitter_##name>(&light.parameters))                                              \
        record.u.of_##name = flattened(*own, flattening_);
        OPAL_SCENE_EMITTERS(OPAL_STORE_EMITTER)
        if (const auto *map = std::get_if<emitter_envmap>(&light.parameters))
            flatten_map(*map, description_.strategy[AXIS_lighting] == CHOICE_lighting_mis, record.u.of_envmap,
                        scene_.environment_texels);
        double power = power_of(light, radius_);
        if (light.texture) {
            std::visit([&](const auto &own) { add_texture(*light.texture, own, record); }, light.parameters);
            power *= mean_luminance(light.texture->texture);
        }
        add(record, power * flattening_.scale * flattening_.scale);
    }

    template <class Other> void add_texture(const LightTexture &, const Other &, EmitterRecord &) {} // has none

    void add_texture(const LightTexture &own, const emitter_projector &light, EmitterRecord &record) {
        record.texture = textures_.add(own.texture);
        store_image_axes(light, own.x, own.y, record.u.of_projector);
    }

    void add_texture(const LightTexture &own, const emitter_spot &light, EmitterRecord &record) {
        const double factor = 1 / (2 * std::tan(light.cutoff_angle * (pi / 180)));
        record.texture = textures_.add(own.texture);
        store(own.x * factor, record.u.of_spot.across[0]);
        store(own.y * factor, record.u.of_spot.across[1]);
    }

    void fill_emitter_choice() {
        if (powers_.empty())
            return;
        if (description_.strategy[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform || are_equal(powers_))
            powers_.assign(powers_.size(), 1);
        const AliasTable table = build_alias_table(powers_);
        for (std::size_t i = 0; i < scene_.emitters.size(); i++) {
            scene_.emitters[i].probability = float(table.probability[i]);
            scene_.emitters[i].accept = float(table.accept[i]);
            scene_.emitters[i].other = table.other[i];
        }
    }
};

} // namespace

void gather_emitters(const SceneDescription &description, const Flattening &flattening, double radius,
                     const TriangleSoup &soup, TextureGatherer &textures, FlatScene &scene) {
    scene.settings.environment = OPAL_NONE;
    EmitterGatherer(description, flattening, radius, soup, textures, scene).gather();
    scene.settings.emitter_count = uint(scene.emitters.size());
}

} // namespace opal
