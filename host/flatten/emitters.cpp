#include "flatten/emitters.h"

#include "bvh/binary_tree.h"
#include "flatten/distribution.h"

#include <numbers>

namespace opal {
namespace {

constexpr double pi = std::numbers::pi;

bool is_black(const Color &c) { return c[0] == 0 && c[1] == 0 && c[2] == 0; }
void store(const Color &from, double factor, float (&to)[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = float(from[i] * factor);
}
void store(Vec3 from, float (&to)[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = float(from[i]);
}

// The slot of each triangle's vertices, by triangle id: block * block_size + place in the block, as in a Hit.
std::vector<uint> triangle_slots(const FlatScene &scene) {
    std::vector<uint> slots(scene.triangles.size());
    for (uint slot = 0; slot < scene.triangle_blocks.size() * block_size; slot++) {
        const uint id = scene.triangle_blocks[slot / block_size].id[slot % block_size];
        if (id != OPAL_NONE)
            slots[id] = slot;
    }
    return slots;
}

class EmitterGatherer {
public:
    EmitterGatherer(const SceneDescription &description, const Flattening &flattening, const TriangleSoup &soup,
                    FlatScene &scene)
        : description_(description), flattening_(flattening), soup_(soup), scene_(scene) {}

    void gather() {
        uint end = 0; // triangles are in the order of their meshes
        for (uint mesh = 0; mesh < description_.meshes.size(); mesh++) {
            const uint begin = end;
            while (end < scene_.triangles.size() && scene_.triangles[end].mesh == mesh)
                end++;
            const auto &radiance = description_.meshes[mesh].radiance;
            if (!radiance || is_black(*radiance) || begin == end)
                continue;
            EmitterRecord record{};
            store(*radiance, 1, record.radiance);
            const double area = std::holds_alternative<Parallelogram>(description_.meshes[mesh].shape)
                                    ? add_parallelogram(begin, record)
                                    : add_mesh(begin, end, record);
            scene_.meshes[mesh].emitter = add(record, pi * luminance(*radiance) * area);
        }
        for (const PointLight &light : description_.point_lights)
            if (!is_black(light.power))
                add_point(light);
        fill_emitter_choice();
    }

private:
    const SceneDescription &description_;
    const Flattening &flattening_;
    const TriangleSoup &soup_;
    FlatScene &scene_;
    std::vector<uint> slots_;
    std::vector<double> powers_; // of each emitter, W, times the square of the flattening's scale

    uint add(const EmitterRecord &record, double power) {
        scene_.emitters.push_back(record);
        powers_.push_back(power);
        return uint(scene_.emitters.size() - 1);
    }

    // Adds a parallelogram by its first triangle, whose corners are o, o + u and o + v. Returns the area.
    double add_parallelogram(uint triangle, EmitterRecord &record) {
        const auto &[o, u, v] = soup_.corners[triangle];
        record.kind = EMITTER_parallelogram;
        for (int axis = 0; axis < 3; axis++) {
            record.origin[axis] = soup_.vertices[o][axis];
            record.u[axis] = soup_.vertices[u][axis] - soup_.vertices[o][axis];
            record.v[axis] = soup_.vertices[v][axis] - soup_.vertices[o][axis];
        }
        const Vec3 normal = normal_of(soup_.vertices[o], soup_.vertices[u], soup_.vertices[v]);
        const double area = length(normal);
        store(normal * (1 / area), record.normal);
        record.area = float(area);
        record.inverse_area = float(1 / area);
        return area;
    }

    // Adds a mesh of triangles [begin, end). Returns the area.
    double add_mesh(uint begin, uint end, EmitterRecord &record) {
        if (slots_.empty())
            slots_ = triangle_slots(scene_);
        std::vector<double> areas;
        double area = 0;
        for (uint id = begin; id < end; id++) {
            const auto &[a, b, c] = soup_.corners[id];
            areas.push_back(0.5 * length(normal_of(soup_.vertices[a], soup_.vertices[b], soup_.vertices[c])));
            area += areas.back();
        }
        record.kind = EMITTER_mesh;
        record.area = float(area);
        record.inverse_area = float(1 / area);
        record.first = uint(scene_.light_triangles.size());
        record.count = end - begin;
        record.first_triangle = begin;
        const bool uniform = description_.strategy[AXIS_triangle_choice] == CHOICE_triangle_choice_uniform;
        const AliasTable table = build_alias_table(uniform ? std::vector<double>(areas.size(), 1.0) : areas);
        for (uint i = 0; i < record.count; i++)
            scene_.light_triangles.push_back(
                {slots_[begin + i], float(table.accept[i]), table.other[i], float(areas[i] / table.probability[i])});
        return area;
    }

    void add_point(const PointLight &light) {
        EmitterRecord record{};
        record.kind = EMITTER_point;
        const double scale2 = flattening_.scale * flattening_.scale;
        store(light.power, scale2 / (4 * pi), record.radiance);
        store((light.position - flattening_.center) * flattening_.scale, record.origin);
        add(record, luminance(light.power) * scale2);
    }

    void fill_emitter_choice() {
        if (description_.strategy[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform)
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

void gather_emitters(const SceneDescription &description, const Flattening &flattening, const TriangleSoup &soup,
                     FlatScene &scene) {
    EmitterGatherer(description, flattening, soup, scene).gather();
}

} // namespace opal
