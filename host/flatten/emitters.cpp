#include "flatten/emitters.h"

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

// Where each triangle's vertices are, as Hit has it.
std::vector<uint> slots_of(const FlatScene &scene) {
    std::vector<uint> slots(scene.triangles.size());
    for (uint slot = 0; slot < scene.blocks.size() * 8; slot++) {
        const uint id = scene.blocks[slot / 8].id[slot % 8];
        if (id != OPAL_NONE)
            slots[id] = slot;
    }
    return slots;
}

class EmitterGatherer {
public:
    EmitterGatherer(const SceneDescription &from, const Frame &to_flat, const TriangleSoup &triangles, FlatScene &goal)
        : description(from), frame(to_flat), soup(triangles), scene(goal) {}

    void gather() {
        uint end = 0; // triangles lie mesh by mesh
        for (uint mesh = 0; mesh < description.meshes.size(); mesh++) {
            const uint begin = end;
            while (end < scene.triangles.size() && scene.triangles[end].mesh == mesh)
                end++;
            const auto &radiance = description.meshes[mesh].radiance;
            if (!radiance || is_black(*radiance) || begin == end)
                continue;
            EmitterRecord record{};
            store(*radiance, 1, record.radiance);
            const double area = std::holds_alternative<Parallelogram>(description.meshes[mesh].shape)
                                    ? add_parallelogram(begin, record)
                                    : add_mesh(begin, end, record);
            scene.meshes[mesh].emitter = add(record, pi * luminance(*radiance) * area);
        }
        for (const PointLight &light : description.point_lights)
            if (!is_black(light.power))
                add_point(light);
        fill_choice();
    }

private:
    const SceneDescription &description;
    const Frame &frame;
    const TriangleSoup &soup;
    FlatScene &scene;
    std::vector<uint> slots;
    std::vector<double> powers; // W, times frame.scale^2

    uint add(const EmitterRecord &record, double power) {
        scene.emitters.push_back(record);
        powers.push_back(power);
        return uint(scene.emitters.size() - 1);
    }

    // The first triangle of a parallelogram is o, o + u, o + v.
    double add_parallelogram(uint triangle, EmitterRecord &record) {
        const auto &[o, u, v] = soup.corners[triangle];
        record.kind = EMITTER_parallelogram;
        for (int axis = 0; axis < 3; axis++) {
            record.origin[axis] = soup.vertices[o][axis];
            record.u[axis] = soup.vertices[u][axis] - soup.vertices[o][axis];
            record.v[axis] = soup.vertices[v][axis] - soup.vertices[o][axis];
        }
        const Vec3 normal = normal_of(soup.vertices[o], soup.vertices[u], soup.vertices[v]);
        const double area = length(normal);
        store(normal * (1 / area), record.normal);
        record.area = float(area);
        record.inverse_area = float(1 / area);
        return area;
    }

    double add_mesh(uint begin, uint end, EmitterRecord &record) {
        if (slots.empty())
            slots = slots_of(scene);
        std::vector<double> areas;
        double area = 0;
        for (uint id = begin; id < end; id++) {
            const auto &[a, b, c] = soup.corners[id];
            areas.push_back(0.5 * length(normal_of(soup.vertices[a], soup.vertices[b], soup.vertices[c])));
            area += areas.back();
        }
        record.kind = EMITTER_mesh;
        record.area = float(area);
        record.inverse_area = float(1 / area);
        record.first = uint(scene.light_triangles.size());
        record.count = end - begin;
        record.first_triangle = begin;
        const bool uniform = description.strategy[AXIS_triangle_choice] == CHOICE_triangle_choice_uniform;
        const AliasTable table = build_alias_table(uniform ? std::vector<double>(areas.size(), 1.0) : areas);
        for (uint i = 0; i < record.count; i++)
            scene.light_triangles.push_back(
                {slots[begin + i], float(table.accept[i]), table.other[i], float(areas[i] / table.probability[i])});
        return area;
    }

    void add_point(const PointLight &light) {
        EmitterRecord record{};
        record.kind = EMITTER_point;
        const double scale2 = frame.scale * frame.scale;
        store(light.power, scale2 / (4 * pi), record.radiance);
        store((light.position - frame.center) * frame.scale, record.origin);
        add(record, luminance(light.power) * scale2);
    }

    void fill_choice() {
        if (description.strategy[AXIS_emitter_choice] == CHOICE_emitter_choice_uniform)
            powers.assign(powers.size(), 1);
        const AliasTable table = build_alias_table(powers);
        for (std::size_t i = 0; i < scene.emitters.size(); i++) {
            scene.emitters[i].probability = float(table.probability[i]);
            scene.emitters[i].accept = float(table.accept[i]);
            scene.emitters[i].other = table.other[i];
        }
    }
};

} // namespace

void gather_emitters(const SceneDescription &description, const Frame &frame, const TriangleSoup &soup,
                     FlatScene &scene) {
    EmitterGatherer(description, frame, soup, scene).gather();
}

} // namespace opal
