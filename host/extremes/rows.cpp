#include "extremes/rows.h"

#include "extremes/scenes.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace opal::extremes {

namespace {

// The powers of ten from 10^from to 10^to, `step` decades apart.
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
// Moves the scene away from the origin by so many of its sizes; a room has side 2.
std::function<SceneDescription(double)> shifted(SceneDescription (*scene)()) {
    return [scene](double sizes) { return moved(scene(), 1, normalize(Vec3{1, 0.7, -0.4}) * (2 * sizes)); };
}
// The scene as a detail of a world that is 1 / factor times as large, which two far triangles span.
std::function<SceneDescription(double)> as_detail(SceneDescription (*scene)()) {
    return [scene](double factor) {
        SceneDescription detail = moved(scene(), factor, {0.61, -0.37, 0.53});
        for (const Vec3 &corner : {Vec3{1, 1, 1}, Vec3{-1, -1, -1}})
            detail.meshes.push_back(made_of(
                mesh_of({corner, corner * 0.99, {corner.x, corner.y * 0.99, corner.z}}, {{0, 1, 2}}), diffuse(0.5)));
        return detail;
    };
}

// A floor under a light, seen from the side.
SceneDescription floor_under(Mesh lamp, const Bsdf &floor, double seen_from = 0.6) {
    return path_traced({made_of(quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), floor), std::move(lamp)},
                       camera({0.1, seen_from, -0.9}, {0.1, 0, 0.1}, 40), 3);
}
// A square light that faces down, with its middle at `at`.
Mesh lamp_over(Vec3 at, double side, double radiance) {
    return light(Parallelogram{at - Vec3{side / 2, 0, side / 2}, {side, 0, 0}, {0, 0, side}}, radiance);
}

SceneDescription masked_floor(double opacity) {
    bsdf_mask_record record;
    record.opacity = opacity;
    Bsdf mask = record;
    mask.children = {diffuse(0.5)};
    SceneDescription scene = floor_under(lamp_over({0, 1, 0}, 1, 1), mask);
    scene.meshes.push_back(light(quad({-2, -0.5, -2}, {0, 0, 4}, {4, 0, 0}), 1)); // below, facing up
    return scene;
}

SceneDescription light_of_size(double side) {
    return floor_under(lamp_over({0, 1, 0}, side, side < 1 ? 1 / (side * side) : 1), diffuse(0.5));
}
SceneDescription light_at_distance(double d) {
    return floor_under(lamp_over({0, d, 0}, 1, d > 1 ? d * d : 1), diffuse(0.5), 0.3);
}
// A light seen nearly edge-on: `degrees` between its plane and the floor's.
SceneDescription light_edge_on(double degrees) {
    const double a = degrees * (std::numbers::pi / 180), s = std::sin(a), c = std::cos(a);
    return floor_under(light(Parallelogram{{-1.2, 0.5, -0.3}, {0.6 * c, 0.6 * s, 0}, {0, 0, 0.6}}, 1 / s),
                       diffuse(0.5));
}
// A light that stands upright on the floor, or above a gap.
SceneDescription light_standing(double gap) {
    return floor_under(light(quad({-0.3, gap, 0.5}, {0, 0.5, 0}, {0.6, 0, 0}), 1), diffuse(0.5));
}
SceneDescription light_of_radiance(double radiance) {
    return floor_under(lamp_over({0, 1, 0}, 0.5, radiance), diffuse(0.5));
}

SceneDescription floor_lit_by(const Light &lamp, double fov) {
    SceneDescription scene = path_traced({made_of(quad({-1, 0, -1}, {0, 0, 2}, {2, 0, 0}), diffuse(0.5))},
                                         camera({0.1, 0.6, -0.9}, {0.1, 0, 0.1}, fov), 3);
    scene.lights = {lamp};
    return scene;
}
// A spot whose light ends at that angle from its axis; the view narrows with it.
SceneDescription spot_of_angle(double degrees) {
    const double area = std::min(1., std::pow(degrees / 45, 2)), power = 1 / area;
    const emitter_spot spot{{0.3, 1, 0}, {-0.2, -1, 0.1}, {power, power, power}, degrees, degrees * 0.75, false};
    return floor_lit_by({spot, {}}, std::min(40., 2 * degrees));
}
// Parallel light that makes this angle with the floor.
SceneDescription sun_of_height(double degrees) {
    const double a = degrees * (std::numbers::pi / 180), s = std::sin(a);
    return floor_lit_by({emitter_directional{{std::cos(a), -s, 0}, {1 / s, 1 / s, 1 / s}}, {}}, 40);
}

// A sky of 16 x 9 texels, one of which is that many times brighter than the others.
SceneDescription sky_of_contrast(double contrast) {
    constexpr int width = 16, height = 9, bright = 2 * width + 3;
    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.channels = 1;
    picture.floats.assign(width * height, float(1 / (1 + contrast / (width * height))));
    picture.floats[bright] *= float(contrast);
    emitter_envmap sky;
    sky.map = environment_of(std::move(picture), "extremes");
    return floor_lit_by({sky, {}}, 40);
}

// A floor with a texture of 4 x 4 texels that is repeated that often along each side.
SceneDescription repeated_texture(double times) {
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = 4;
    picture->channels = 1;
    picture->encoded = true;
    picture->bytes = {240, 20, 130, 60, 90, 200, 10, 170, 50, 110, 250, 30, 180, 70, 150, 220};
    Bsdf textured = diffuse(1);
    textured.textures[bsdf_parameters(textured.kind())[0].texture_word] = BitmapTexture{.picture = picture};
    SceneDescription scene = floor_under(lamp_over({0, 1, 0}, 1, 1), textured);
    const auto last = float(times);
    auto &floor = std::get<TriangleMesh>(scene.meshes[0].shape);
    for (const Vec3 &corner : floor.positions)
        floor.uvs.push_back({corner.x < 0 ? 0 : last, corner.z < 0 ? 0 : last});
    for (const auto &triangle : floor.triangles)
        floor.uv_corners.push_back({triangle[0].position, triangle[1].position, triangle[2].position});
    return scene;
}

SceneDescription rough_floor(double alpha) { return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), microfacet(alpha)); }
// A glossy floor seen from `degrees` above its plane.
SceneDescription grazed_floor(double degrees) {
    return floor_under(lamp_over({0, 0.6, 0.5}, 0.5, 4), microfacet(0.1), std::tan(degrees * (std::numbers::pi / 180)));
}
SceneDescription metal_floor(double alpha) {
    return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4),
                       bsdf_roughconductor_record{.eta = 0.2, .k = 3.9, .alpha_u = alpha, .alpha_v = alpha, .ggx = 1});
}
SceneDescription plastic_floor(double alpha) {
    return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), bsdf_roughplastic_record{.alpha = alpha, .ggx = 1});
}
SceneDescription principled_floor(double roughness) {
    return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), principled(roughness));
}
SceneDescription phong_floor(double exponent) { return floor_under(lamp_over({0, 0.6, 1}, 0.5, 4), phong(exponent)); }

// A cube in a bright room.
SceneDescription cube_of(const Bsdf &glass) {
    SceneDescription scene =
        path_traced({light(cube({}, 1, true), 1), made_of(cube({0.05, -0.1, 0.1}, 0.4, false), glass),
                     made_of(quad({-0.9, -0.8, -0.9}, {0, 0, 1.8}, {1.8, 0, 0}), diffuse(0.5))},
                    camera({0.2, 0.45, -0.95}, {0, -0.1, 0.1}, 60), 12);
    return moved(scene, 1, {});
}
SceneDescription glass_cube(double ior) { return cube_of(dielectric(ior)); }
SceneDescription rough_glass_cube(double alpha) {
    return cube_of(bsdf_roughdielectric_record{.ext_ior = 1, .alpha_u = alpha, .alpha_v = alpha});
}
SceneDescription rough_cube_of_index(double ior) {
    return cube_of(bsdf_roughdielectric_record{.int_ior = ior, .ext_ior = 1, .ggx = 1});
}

// A furnace of albedo 1 - darkness and radiance 1. Without roulette each sample is the sum of the geometric series.
SceneDescription furnace(double darkness, unsigned max_depth) {
    SceneDescription scene = path_traced({made_of(cube({}, 1, true), diffuse(1 - darkness))},
                                         camera({0.1, 0.2, -0.3}, {0.3, 0, 1}, 70), max_depth);
    scene.meshes[0].radiance = Color{1, 1, 1};
    scene.strategy[AXIS_lighting] = CHOICE_lighting_bsdf;
    scene.strategy[AXIS_rr] = CHOICE_rr_off;
    return scene;
}
// The sum of albedo^k, k < max_depth, for the albedo as the scene holds it, in single precision.
double furnace_truth(double darkness, unsigned max_depth) {
    const double albedo = float(1 - darkness);
    return albedo < 1 ? -std::expm1(max_depth * std::log(albedo)) / (1 - albedo) : max_depth;
}
constexpr unsigned round_furnace_depth = 30;

// The bounces after which less than e^-20 of the series remains, or 20000.
unsigned enough_bounces(double darkness) { return darkness < 1e-4 ? 20000 : unsigned(20 / darkness); }
SceneDescription bright_furnace(double darkness) { return furnace(darkness, enough_bounces(darkness)); }
SceneDescription deep_furnace(double depth) { return furnace(0.1, unsigned(depth)); }

// The furnace in a sphere of that radius, by all ways to find light: 1 / (1 - albedo) but for the last bounce.
SceneDescription round_furnace(double radius) {
    SceneDescription scene =
        path_traced({made_of(Sphere{{}, radius, true}, diffuse(0.5))},
                    camera(Vec3{0.1, 0.2, -0.3} * radius, Vec3{0.3, 0, 1} * radius, 70), round_furnace_depth);
    scene.meshes[0].radiance = Color{1, 1, 1};
    return scene;
}
SceneDescription ball_lamp(double radius) {
    const double away = std::max(1.0, 2 * radius);
    return floor_under(light(Sphere{{0, away, 0}, radius}, away * away / (radius * radius)), diffuse(0.5));
}

SceneDescription seen_through(double degrees) {
    SceneDescription scene = room();
    scene.camera.perspective.fov = degrees;
    return scene;
}
SceneDescription seen_by_lens(double radius) {
    SceneDescription scene = room();
    const double fov = scene.camera.perspective.fov;
    scene.camera.kind = CAMERA_thinlens;
    scene.camera.thinlens = {fov, radius, 1};
    return scene;
}
SceneDescription clipped_near(double distance) {
    SceneDescription scene = room();
    scene.camera.near_clip = distance;
    return scene;
}

// The room with `walls`, given as a cube of half side 1, in the place of its own cube.
SceneDescription room_of(TriangleMesh walls) {
    SceneDescription scene = room();
    const TriangleMesh old = std::get<TriangleMesh>(scene.meshes[0].shape); // its corners give the room's axes
    const Vec3 o = old.positions[0], x = (old.positions[1] - o) * 0.5, y = (old.positions[2] - o) * 0.5,
               z = (old.positions[4] - o) * 0.5;
    for (Vec3 &p : walls.positions)
        p = o + x * (p.x + 1) + y * (p.y + 1) + z * (p.z + 1);
    scene.meshes[0].shape = walls;
    return scene;
}
SceneDescription slivered_room(double aspect) { return room_of(slivered_cube(aspect)); }
SceneDescription slivered_walls(double aspect) { return occlusion_of(slivered_room(aspect)); }
SceneDescription speckled_room(double area) { return room_of(cube_with_specks(area)); }
SceneDescription speckled_walls(double area) { return occlusion_of(speckled_room(area)); }

// Adds copies of all reflecting opaque meshes. Every other copy has its quadrilaterals cut along the other diagonal, so
// that triangles differ but lie in one plane up to rounding.
SceneDescription with_copies(SceneDescription scene, double copies) {
    const size_t meshes = scene.meshes.size();
    for (int copy = 1; copy < int(copies); copy++)
        for (size_t m = 0; m < meshes; m++) {
            Mesh mesh = scene.meshes[m];
            if (mesh.radiance || mesh.bsdf.kind() == BSDF_dielectric)
                continue;
            auto &triangles = std::get<TriangleMesh>(mesh.shape).triangles;
            // Each pair of triangles shares its first corner and its diagonal.
            for (size_t t = 0; copy % 2 && t + 1 < triangles.size(); t += 2) {
                const auto p = triangles[t], q = triangles[t + 1];
                const bool forward = q[1].position == p[2].position;
                const std::array around =
                    forward ? std::array{p[0], p[1], p[2], q[2]} : std::array{p[0], q[1], p[1], p[2]};
                triangles[t] = {around[1], around[2], around[3]};
                triangles[t + 1] = {around[1], around[3], around[0]};
            }
            scene.meshes.push_back(std::move(mesh));
        }
    return scene;
}
SceneDescription room_of_copies(double copies) { return with_copies(room(), copies); }
SceneDescription walls_of_copies(double copies) { return with_copies(closed_walls(), copies); }
SceneDescription plane_of_copies(double copies) { return with_copies(open_plane(), copies); }

// A light of pairs of triangles side by side, whose widths grow over 12 decades. The narrow ones lie near 0, where
// floats are dense.
SceneDescription light_of_triangles(double count) {
    const unsigned n = unsigned(count);
    std::vector<Vec3> positions;
    std::vector<double> ends = {0};
    for (unsigned i = 0; i < n; i++)
        ends.push_back(ends.back() + std::pow(10.0, n > 1 ? 12.0 * i / (n - 1) - 12 : 0));
    for (double end : ends)
        for (double z : {-0.3, 0.3})
            positions.push_back({0.8 * end / ends.back(), 0.8, z});
    std::vector<std::array<unsigned, 3>> triangles;
    for (unsigned i = 0; i < n; i++)
        for (const auto &t : {std::array{2 * i, 2 * i + 2, 2 * i + 1}, std::array{2 * i + 1, 2 * i + 2, 2 * i + 3}})
            triangles.push_back(t);
    return floor_under(light(mesh_of(positions, triangles), 3), diffuse(0.5));
}

SceneDescription many_lights(double count) {
    SceneDescription scene = floor_under(lamp_over({0, 1, 0}, 0.1, 1), diffuse(0.5));
    scene.meshes.pop_back();
    const int side = int(std::ceil(std::sqrt(count)));
    for (int i = 0; i < int(count); i++)
        scene.meshes.push_back(
            lamp_over({(i % side + 0.5) / side * 2 - 1, 1, (i / side + 0.5) / side * 2 - 1}, 0.5 / side, 1 + i % 7));
    scene.strategy[AXIS_emitter_choice] = CHOICE_emitter_choice_power;
    return scene;
}

// A wall of radiance 0.1, the only thing that a pixel sees: every sample is exact, so that their mean must be, too.
SceneDescription glowing_wall(double) {
    return path_traced({light(quad({-1, -1, 0}, {0, 2, 0}, {2, 0, 0}), 0.1)}, camera({0, 0, -1}, {}, 40), 1);
}
// The same, in a picture one pixel wide and `height` pixels high.
SceneDescription glowing_column(double height) {
    SceneDescription scene = glowing_wall(0);
    scene.camera.width = 1;
    scene.camera.height = int(height);
    scene.camera.perspective.fov = 2 * std::atan(0.5 / height) * (180 / std::numbers::pi);
    return scene;
}
double glow_truth(double) { return double(0.1f); }

SceneDescription room_by_sobol(double) {
    SceneDescription scene = room();
    scene.strategy[AXIS_sampler] = CHOICE_sampler_sobol;
    return scene;
}

} // namespace

const std::vector<StressRow> &stress_rows() {
    static const std::vector<StressRow> table = {
        {.name = "scale",
         .stretched = "size of the scene",
         .values = decades(-6, 6),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1e4,
         .picture = scaled(room),
         .invariant = true,
         .closed = scaled(closed_walls),
         .open = scaled(open_plane)},
        {.name = "distance",
         .stretched = "distance from the origin, in sizes of the scene",
         .values = joined({0}, decades(0, 7)),
         .start = 0,
         .promised_from = 0,
         .promised_to = 1e4,
         .picture = shifted(room),
         .invariant = true,
         .closed = shifted(closed_walls),
         .open = shifted(open_plane)},
        {.name = "detail",
         .stretched = "size of what is looked at, the world having 1",
         .values = reversed(decades(-6, -1)),
         .start = 0.1,
         .promised_from = 1e-3,
         .promised_to = 0.1,
         .picture = as_detail(room),
         .invariant = true,
         .closed = as_detail(closed_walls)},
        {.name = "sphere-scale",
         .stretched = "size of a scene of spheres",
         .values = decades(-6, 6),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1e4,
         .picture = scaled(balls),
         .invariant = true,
         .closed = scaled(round_walls),
         .open = scaled(open_ball)},
        {.name = "sphere-distance",
         .stretched = "distance of a scene of spheres from the origin, in sizes of the scene",
         .values = joined({0}, decades(0, 7)),
         .start = 0,
         .promised_from = 0,
         .promised_to = 1e4,
         .picture = shifted(balls),
         .invariant = true,
         .closed = shifted(round_walls),
         .open = shifted(open_ball)},
        {.name = "sphere-detail",
         .stretched = "size of the spheres that are looked at, the world having 1",
         .values = reversed(decades(-6, -1)),
         .start = 0.1,
         .promised_from = 1e-3,
         .promised_to = 0.1,
         .picture = as_detail(balls),
         .invariant = true,
         .closed = as_detail(round_walls)},
        {.name = "sphere-furnace",
         .stretched = "radius of a sphere that is a furnace",
         .values = decades(-4, 4),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1e4,
         .picture = round_furnace,
         .truth = [](double) { return furnace_truth(0.5, round_furnace_depth); }},
        {.name = "sphere-light",
         .stretched = "radius of a sphere that lights a floor from distance 1, or from two radii",
         .values = decades(-6, 3),
         .start = 0.1,
         .promised_from = 1e-4,
         .promised_to = 1e2,
         .picture = ball_lamp},
        {.name = "aspect",
         .stretched = "aspect of the triangles of closed walls",
         .values = decades(0, 7),
         .start = 1,
         .promised_from = 1,
         .promised_to = 1e3,
         .picture = slivered_room,
         .invariant = true,
         .closed = slivered_walls},
        {.name = "specks",
         .stretched = "area of triangles in the middle of those of closed walls, of theirs",
         .values = reversed(decades(-12, 0)),
         .start = 1,
         .promised_from = 1e-12,
         .promised_to = 1,
         .picture = speckled_room,
         .invariant = true,
         .closed = speckled_walls},
        {.name = "copies",
         .stretched = "coplanar copies of every wall, each cut along the other diagonal",
         .values = {1, 2, 3, 10, 30},
         .start = 1,
         .promised_from = 1,
         .promised_to = 30,
         .picture = room_of_copies,
         .invariant = true,
         .closed = walls_of_copies,
         .open = plane_of_copies},
        {.name = "edges",
         .stretched = "size of closed meshes, turned and moved; rays at their edges and vertices",
         .values = decades(-6, 6, 2),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1e4,
         .numeric = measure_edges},
        {.name = "light-size",
         .stretched = "side of a light at distance 1",
         .values = decades(-6, 3),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1e2,
         .picture = light_of_size},
        {.name = "light-distance",
         .stretched = "height of a light of side 1 over a floor",
         .values = decades(-6, 3),
         .start = 1,
         .promised_from = 1e-3,
         .promised_to = 1e2,
         .picture = light_at_distance},
        {.name = "light-edge-on",
         .stretched = "angle of a light's plane to the floor's, degrees",
         .values = reversed(decades(-5, 1)),
         .start = 10,
         .picture = light_edge_on},
        {.name = "light-standing",
         .stretched = "gap between a floor and a light that stands on it",
         .values = joined(reversed(decades(-7, -1)), {0}),
         .start = 0.1,
         .promised_from = 0,
         .promised_to = 0.1,
         .picture = light_standing},
        {.name = "radiance",
         .stretched = "radiance of a light",
         .values = decades(-20, 20, 5),
         .start = 1,
         .promised_from = 1e-15,
         .promised_to = 1e15,
         .picture = light_of_radiance},
        {.name = "spot",
         .stretched = "angle at which a spot's light ends, degrees",
         .values = joined({180, 90}, reversed(decades(-3, 1))),
         .start = 90,
         .promised_from = 1e-2,
         .promised_to = 180,
         .picture = spot_of_angle},
        {.name = "sun",
         .stretched = "angle of parallel light to the floor, degrees",
         .values = joined({90}, reversed(decades(-5, 1))),
         .start = 90,
         .promised_from = 1e-2,
         .promised_to = 90,
         .picture = sun_of_height},
        {.name = "sky",
         .stretched = "radiance of one texel of a sky over that of the others",
         .values = decades(0, 8),
         .start = 1,
         .promised_from = 1,
         .promised_to = 1e6,
         .picture = sky_of_contrast},
        {.name = "uv",
         .stretched = "texture coordinates of a floor's far corner, whose texture repeats",
         .values = decades(0, 8),
         .start = 1,
         .promised_from = 1,
         .promised_to = 1e6,
         .picture = repeated_texture},
        {.name = "alpha",
         .stretched = "roughness of a microfacet floor",
         .values = reversed(decades(-6, 0)),
         .start = 1,
         .promised_from = 1e-4,
         .promised_to = 1,
         .picture = rough_floor},
        {.name = "metal-alpha",
         .stretched = "roughness of a metal floor, GGX",
         .values = reversed(decades(-6, 0)),
         .start = 1,
         .promised_from = 1e-6,
         .promised_to = 1,
         .picture = metal_floor},
        {.name = "plastic-alpha",
         .stretched = "roughness of a floor of rough plastic, GGX",
         .values = reversed(decades(-6, 0)),
         .start = 1,
         .promised_from = 1e-6,
         .promised_to = 1,
         .picture = plastic_floor},
        {.name = "glass-alpha",
         .stretched = "roughness of a cube of glass",
         .values = reversed(decades(-6, 0)),
         .start = 1,
         .promised_from = 1e-6,
         .promised_to = 1,
         .picture = rough_glass_cube},
        {.name = "rough-ior",
         .stretched = "index of a cube of rough glass",
         .values = {1 + 1e-6, 1 + 1e-3, 1.5, 2, 10, 100},
         .start = 1.5,
         .promised_from = 1 + 1e-6,
         .promised_to = 100,
         .picture = rough_cube_of_index},
        {.name = "grazing",
         .stretched = "angle of the view to a floor of roughness 0.1, degrees",
         .values = reversed(decades(-3, 1)),
         .start = 10,
         .picture = grazed_floor},
        {.name = "principled",
         .stretched = "roughness of a principled floor",
         .values = joined({0}, decades(-4, 0)),
         .start = 1,
         .promised_from = 0,
         .promised_to = 1,
         .picture = principled_floor},
        {.name = "phong",
         .stretched = "exponent",
         .values = joined({0}, decades(0, 8)),
         .start = 0,
         .promised_from = 0,
         .promised_to = 1e6,
         .picture = phong_floor},
        {.name = "opacity",
         .stretched = "opacity of a masked floor before a light",
         .values = joined({0}, decades(-8, 0)),
         .start = 1,
         .promised_from = 0,
         .promised_to = 1,
         .picture = masked_floor},
        {.name = "ior",
         .stretched = "index of a cube of glass",
         .values = {1 - 1e-6, 1, 1 + 1e-6, 1 + 1e-3, 1.5, 2, 10, 100},
         .start = 1.5,
         .promised_from = 1 - 1e-6,
         .promised_to = 100,
         .picture = glass_cube},
        {.name = "critical-angle",
         .stretched = "sine of the angle beyond total reflection, ulp",
         .values = {-1e6, -1e5, -1e4, -1e3, -100, -10, -2, -1, 0, 1, 2, 10, 100},
         .start = -1e6,
         .numeric = measure_critical_angle},
        {.name = "furnace",
         .stretched = "1 - albedo, all bounces; below 1e-4 the first 20000",
         .values = {1, 0.5, 0.1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-7, 0},
         .start = 0.5,
         .promised_from = 1e-4,
         .promised_to = 1,
         .picture = bright_furnace,
         .truth = [](double d) { return furnace_truth(d, enough_bounces(d)); },
         .tolerance = 1e-3,
         .side = 4,
         .spp = 4}, // tolerance: a float sums 1e4 terms, and there is no noise without roulette
        {.name = "depth",
         .stretched = "segments of the longest path, albedo 0.9",
         .values = {1, 2, 10, 100, 65535, 65536, 1e6, 0x1p31, 4294967295.0},
         .start = 10,
         .promised_from = 1,
         .promised_to = 4294967295.0,
         .picture = deep_furnace,
         .truth = [](double d) { return furnace_truth(0.1, unsigned(d)); },
         .side = 4,
         .spp = 4},
        {.name = "fov",
         .stretched = "field of view, degrees",
         .values = joined(decades(-6, 1), {60, 120, 170, 179, 179.9}),
         .start = 60,
         .promised_from = 1e-3,
         .promised_to = 170,
         .picture = seen_through},
        {.name = "lens",
         .stretched = "radius of the lens, of the depth that is seen sharply",
         .values = joined({0}, decades(-6, -1)),
         .start = 0,
         .promised_from = 0,
         .promised_to = 0.1,
         .picture = seen_by_lens},
        {.name = "near-clip",
         .stretched = "nearClip",
         .values = {0.01, 1e-4, 1e-10, 1e-20, 1e-30, 1e-40, 0},
         .start = 0.01,
         .promised_from = 0,
         .promised_to = 0.01,
         .picture = clipped_near,
         .invariant = true},
        {.name = "numbers",
         .stretched = "random number, through every warp, BSDF and light",
         .values = {0, 0x1p-32, 0x1p-24, 0.25, 0.5, 0.75, 1 - 0x1p-24},
         .start = 0.25,
         .promised_from = 0,
         .promised_to = 1,
         .numeric = measure_numbers},
        {.name = "samplers",
         .stretched = "samples of a pixel, all samplers, their numbers from the first to the last",
         .values = {1, 2, 3, 1 << 16, 1 << 24, 0x1p31 - 1, 0x1p32 - 1},
         .start = 2,
         .promised_from = 1,
         .promised_to = 0x1p32 - 1,
         .numeric = measure_samplers},
        {.name = "late-samples",
         .stretched = "first of a pixel's samples, Sobol",
         .values = {0, 1 << 16, 1 << 24, 0x1p31, 0x1p32 - 65536},
         .start = 0,
         .promised_from = 0,
         .promised_to = 0x1p32 - 65536,
         .picture = room_by_sobol,
         .invariant = true,
         .value_means = ValueMeaning::first_sample},
        {.name = "light-triangles",
         .stretched = "triangle pairs of a light, areas over 12 decades",
         .values = joined(decades(0, 5), {5e5}),
         .start = 1,
         .promised_from = 1,
         .promised_to = 5e5,
         .picture = light_of_triangles,
         .invariant = true},
        {.name = "emitters",
         .stretched = "number of lights",
         .values = decades(0, 4),
         .start = 1,
         .promised_from = 1,
         .promised_to = 1e4,
         .picture = many_lights},
        {.name = "height",
         .stretched = "height of a picture one pixel wide",
         .values = {1, 2, 255, 65535, 65536, 1e6},
         .start = 1,
         .promised_from = 1,
         .promised_to = 1e6,
         .picture = glowing_column,
         .truth = glow_truth,
         .spp = 4,
         .value_means = ValueMeaning::height},
        {.name = "samples",
         .stretched = "samples of one pixel, all of 0.1",
         .values = {1, 1 << 10, 1 << 20, 1 << 24, 1 << 26},
         .start = 1,
         .promised_from = 1,
         .promised_to = 1 << 26,
         .picture = glowing_wall,
         .truth = glow_truth,
         .value_means = ValueMeaning::spp},
    };
    return table;
}

} // namespace opal::extremes
