#include "extremes/rows.h"

#include "extremes/scenes.h"

#include <cmath>

namespace opal::extremes {

namespace {

// 10^from ... 10^to, a value every `step` decades.
std::vector<double> decades(int from, int to, int step = 1) {
    std::vector<double> values;
    for (int i = from; i <= to; i += step)
        values.push_back(std::pow(10.0, i));
    return values;
}

std::vector<double> joined(std::vector<double> a, const std::vector<double> &b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

std::vector<double> reversed(std::vector<double> a) { return {a.rbegin(), a.rend()}; }

std::function<SceneDescription(double)> scaled(SceneDescription (*scene)()) {
    return [scene](double factor) { return moved(scene(), factor, {}); };
}
std::function<SceneDescription(double)> shifted(SceneDescription (*scene)()) { // in sizes: a room has side 2
    return [scene](double sizes) { return moved(scene(), 1, normalize(Vec3{1, 0.7, -0.4}) * (2 * sizes)); };
}
// In a corner of a world that is 1 / factor times as large, which two far triangles span.
std::function<SceneDescription(double)> as_detail(SceneDescription (*scene)()) {
    return [scene](double factor) {
        SceneDescription detail = moved(scene(), factor, {0.61, -0.37, 0.53});
        for (const Vec3 &corner : {Vec3{1, 1, 1}, Vec3{-1, -1, -1}})
            detail.meshes.push_back(made_of(mesh_of({corner, corner * 0.99, {corner.x, corner.y * 0.99, corner.z}}, {{0, 1, 2}}), diffuse(0.5)));
        return detail;
    };
}

// A floor under a light, seen from the side.
SceneDescription floor_under(Mesh lamp, const BsdfRecord &floor, double seen_from = 0.6) {
    return path_traced({made_of(quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), floor), std::move(lamp)},
                       camera({0.1, seen_from, -0.9}, {0.1, 0, 0.1}, 40), 3);
}
Mesh lamp_over(Vec3 at, double side, double radiance) { // faces down
    return light(Parallelogram{at - Vec3{side / 2, 0, side / 2}, {side, 0, 0}, {0, 0, side}}, radiance);
}

SceneDescription light_of_size(double side) { return floor_under(lamp_over({0, 1, 0}, side, side < 1 ? 1 / (side * side) : 1), diffuse(0.5)); }
SceneDescription light_at_distance(double d) { return floor_under(lamp_over({0, d, 0}, 1, d > 1 ? d * d : 1), diffuse(0.5), 0.3); }
SceneDescription light_edge_on(double degrees) { // between its plane and the middle of the floor
    const double a = degrees * (3.14159265358979323846 / 180), s = std::sin(a), c = std::cos(a);
    return floor_under(light(Parallelogram{{-1.2, 0.5, -0.3}, {0.6 * c, 0.6 * s, 0}, {0, 0, 0.6}}, 1 / s), diffuse(0.5));
}
SceneDescription light_of_radiance(double radiance) { return floor_under(lamp_over({0, 1, 0}, 0.5, radiance), diffuse(0.5)); }

SceneDescription rough_floor(double alpha) { return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), microfacet(alpha)); }
SceneDescription grazed_floor(double degrees) { // above the floor's plane
    return floor_under(lamp_over({0, 0.6, 0.5}, 0.5, 4), microfacet(0.1), std::tan(degrees * (3.14159265358979323846 / 180)));
}
SceneDescription phong_floor(double exponent) { return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), phong(exponent)); }

SceneDescription glass_cube(double ior) {
    SceneDescription scene = path_traced({light(cube({}, 1, true), 1), made_of(cube({0.05, -0.1, 0.1}, 0.4, false), dielectric(ior)),
                                          made_of(quad({-0.9, -0.8, -0.9}, {0, 0, 1.8}, {1.8, 0, 0}), diffuse(0.5))},
                                         camera({0.2, 0.45, -0.95}, {0, -0.1, 0.1}, 60), 12);
    return moved(scene, 1, {});
}

// Paths are not cut short by chance, so that each sample is the sum of the series itself.
SceneDescription furnace(double darkness) { // 1 - albedo
    SceneDescription scene = path_traced({made_of(cube({}, 1, true), diffuse(1 - darkness))}, camera({0.1, 0.2, -0.3}, {0.3, 0, 1}, 70),
                                         unsigned(std::min(1e6, 20 / darkness)));
    scene.meshes[0].radiance = Color{1, 1, 1};
    scene.strategy[AXIS_lighting] = CHOICE_lighting_bsdf;
    scene.strategy[AXIS_rr] = CHOICE_rr_off;
    return scene;
}
double furnace_truth(double darkness) { // of the albedo in single precision, which is what the scene holds
    const double albedo = float(1 - darkness), depth = double(furnace(darkness).strategy.max_depth);
    return albedo < 1 ? -std::expm1(depth * std::log(albedo)) / (1 - albedo) : depth;
}

SceneDescription seen_through(double degrees) {
    SceneDescription scene = room();
    scene.camera.fov = degrees;
    return scene;
}
SceneDescription clipped_near(double distance) {
    SceneDescription scene = room();
    scene.camera.near_clip = distance;
    return scene;
}

// Each wall of a closed cube is cut into a strip 1 / aspect wide and the rest.
TriangleMesh slivered_cube(double aspect) {
    TriangleMesh cut;
    const TriangleMesh whole = cube({}, 1, true);
    cut.positions = whole.positions;
    for (const auto &t : whole.triangles) { // across the side opposite to its first corner
        const unsigned a = t[0].position, b = t[1].position, c = t[2].position, d = unsigned(cut.positions.size());
        cut.positions.push_back(cut.positions[b] + (cut.positions[c] - cut.positions[b]) * (1 / aspect));
        for (const auto &[x, y, z] : {std::array{a, b, d}, std::array{a, d, c}})
            cut.triangles.push_back({{{x, OPAL_NONE}, {y, OPAL_NONE}, {z, OPAL_NONE}}});
    }
    return cut;
}
SceneDescription slivered_room(double aspect) {
    SceneDescription scene = room();
    const TriangleMesh old = std::get<TriangleMesh>(scene.meshes[0].shape); // its corners say how the room is turned
    TriangleMesh walls = slivered_cube(aspect);
    const Vec3 o = old.positions[0], x = (old.positions[1] - o) * 0.5, y = (old.positions[2] - o) * 0.5, z = (old.positions[4] - o) * 0.5;
    for (Vec3 &p : walls.positions)
        p = o + x * (p.x + 1) + y * (p.y + 1) + z * (p.z + 1);
    scene.meshes[0].shape = walls;
    return scene;
}
SceneDescription slivered_walls(double aspect) { return occlusion_of(slivered_room(aspect)); }

// A light of triangles side by side whose widths grow from one to the next, over 12 decades of area.
SceneDescription light_of_triangles(double count) {
    const unsigned n = unsigned(count);
    TriangleMesh strip;
    std::vector<double> ends = {0};
    for (unsigned i = 0; i < n; i++)
        ends.push_back(ends.back() + std::pow(10.0, n > 1 ? 12.0 * i / (n - 1) - 12 : 0));
    for (double end : ends)
        for (double z : {-0.3, 0.3})
            strip.positions.push_back({-0.4 + 0.8 * end / ends.back(), 0.8, z});
    std::vector<std::array<unsigned, 3>> triangles;
    for (unsigned i = 0; i < n; i++)
        for (const auto &t : {std::array{2 * i, 2 * i + 2, 2 * i + 1}, std::array{2 * i + 1, 2 * i + 2, 2 * i + 3}})
            triangles.push_back(t);
    return floor_under(light(mesh_of(std::move(strip.positions), std::move(triangles)), 3), diffuse(0.5));
}

SceneDescription many_lights(double count) {
    SceneDescription scene = floor_under(lamp_over({0, 1, 0}, 0.1, 1), diffuse(0.5));
    scene.meshes.pop_back();
    const int side = int(std::ceil(std::sqrt(count)));
    for (int i = 0; i < int(count); i++)
        scene.meshes.push_back(lamp_over({(i % side + 0.5) / side * 2 - 1, 1, (i / side + 0.5) / side * 2 - 1}, 0.5 / side, 1 + i % 7));
    scene.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    return scene;
}

SceneDescription glowing_wall(double) { // what every sample returns is exact: the sum must be, too
    return path_traced({light(quad({-1, -1, 0}, {0, 2, 0}, {2, 0, 0}), 0.1)}, camera({0, 0, -1}, {}, 40), 1);
}

} // namespace

const std::vector<Row> &rows() {
    static const std::vector<Row> table = {
        {.name = "scale", .stretched = "size of the scene", .values = decades(-6, 6), .start = 1, .promised_from = 1e-4, .promised_to = 1e4,
         .picture = scaled(room), .invariant = true, .closed = scaled(closed_walls), .open = scaled(open_plane)},
        {.name = "distance", .stretched = "distance from the origin, in sizes of the scene", .values = joined({0}, decades(0, 7)), .start = 0,
         .promised_from = 0, .promised_to = 1e4, .picture = shifted(room), .invariant = true, .closed = shifted(closed_walls), .open = shifted(open_plane)},
        {.name = "detail", .stretched = "size of what is looked at, the world having 1", .values = reversed(decades(-6, -1)), .start = 0.1,
         .picture = as_detail(room), .invariant = true, .closed = as_detail(closed_walls)},
        {.name = "aspect", .stretched = "aspect of the triangles of closed walls", .values = decades(0, 7), .start = 1, .promised_from = 1,
         .promised_to = 1e4, .picture = slivered_room, .invariant = true, .closed = slivered_walls},
        {.name = "light-size", .stretched = "side of a light at distance 1", .values = decades(-6, 3), .start = 1, .promised_from = 1e-4,
         .promised_to = 1e2, .picture = light_of_size},
        {.name = "light-distance", .stretched = "height of a light of side 1 over a floor", .values = decades(-6, 3), .start = 1, .promised_from = 1e-3,
         .promised_to = 1e2, .picture = light_at_distance},
        {.name = "light-edge-on", .stretched = "angle of a light's plane to the floor's, degrees", .values = reversed(decades(-5, 1)), .start = 10,
         .picture = light_edge_on},
        {.name = "radiance", .stretched = "radiance of a light", .values = decades(-20, 20, 5), .start = 1, .promised_from = 1e-15, .promised_to = 1e15,
         .picture = light_of_radiance},
        {.name = "alpha", .stretched = "roughness of a microfacet floor", .values = reversed(decades(-6, 0)), .start = 1, .promised_from = 1e-4,
         .promised_to = 1, .picture = rough_floor},
        {.name = "grazing", .stretched = "angle of the view to a floor of roughness 0.1, degrees", .values = reversed(decades(-3, 1)), .start = 10,
         .picture = grazed_floor},
        {.name = "phong", .stretched = "exponent", .values = joined({0}, decades(0, 8)), .start = 0, .promised_from = 0, .promised_to = 1e6,
         .picture = phong_floor},
        {.name = "ior", .stretched = "index of a cube of glass", .values = {1 - 1e-6, 1, 1 + 1e-6, 1 + 1e-3, 1.5, 2, 10, 100}, .start = 1.5,
         .promised_from = 1 - 1e-6, .promised_to = 10, .picture = glass_cube},
        {.name = "furnace", .stretched = "1 - albedo, all bounces", .values = {1, 0.5, 0.1, 1e-2, 1e-3, 1e-4}, .start = 0.5, .promised_from = 1e-4,
         .promised_to = 1, .picture = furnace, .truth = furnace_truth, .side = 4, .spp = 4},
        {.name = "fov", .stretched = "field of view, degrees", .values = joined(decades(-6, 1), {60, 120, 170, 179, 179.9}), .start = 60,
         .promised_from = 1e-3, .promised_to = 170, .picture = seen_through},
        {.name = "near-clip", .stretched = "nearClip", .values = {0.01, 1e-4, 1e-10, 1e-20, 1e-30, 1e-40, 0}, .start = 0.01, .promised_from = 0,
         .promised_to = 0.01, .picture = clipped_near, .invariant = true},
        {.name = "light-triangles", .stretched = "triangle pairs of a light, areas over 12 decades", .values = decades(0, 4), .start = 1,
         .promised_from = 1, .promised_to = 1e4, .picture = light_of_triangles},
        {.name = "emitters", .stretched = "number of lights", .values = decades(0, 4), .start = 1, .promised_from = 1, .promised_to = 1e4,
         .picture = many_lights},
        {.name = "samples", .stretched = "samples of one pixel, all of 0.1", .values = {1, 1 << 10, 1 << 20, 1 << 24, 1 << 26}, .start = 1,
         .promised_from = 1, .promised_to = 1 << 26, .picture = glowing_wall, .truth = [](double) { return double(0.1f); }, .value_is_spp = true},
    };
    return table;
}

} // namespace opal::extremes
