#include "flatten/distribution.h"
#include "flatten/emitters.h"
#include "flatten/face_list.h"
#include "flatten/features.h"
#include "flatten/geometry.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <map>
#include <numbers>

namespace opal {
namespace {

void store(Vec3 from, float (&to)[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = float(from[i]);
}

// Distances may go beyond float; the largest one is as far.
float to_distance(double d) { return float(std::min(d, double(std::numeric_limits<float>::max()))); }

// SCENE_FORMAT 3: direction = left (1 - 2 sx) tan_half_x + up (1 - 2 sy) tan_half_y + forward. The columns are those of
// toWorld divided by the length of the third, so that a point at camera depth z lies z |column 2| times that vector
// away.
void fill_camera(const Camera &camera, const Frame &frame, Settings &settings) {
    const auto &rows = camera.to_world.rows;
    const auto column = [&rows](int i) { return Vec3{rows[0][i], rows[1][i], rows[2][i]}; };
    const double depth = length(column(2));
    store((camera.to_world.point({}) - frame.center) * frame.scale, settings.camera_origin);
    store(column(0) * (1 / depth), settings.camera_left);
    store(column(1) * (1 / depth), settings.camera_up);
    store(column(2) * (1 / depth), settings.camera_forward);
    const double tangent = std::tan(camera.fov * (std::numbers::pi / 360));
    settings.tan_half_x = float(tangent);
    settings.tan_half_y = float(tangent * camera.height / camera.width);
    settings.near_clip = to_distance(camera.near_clip * depth * frame.scale);
    settings.far_clip = to_distance(camera.far_clip * depth * frame.scale);
    settings.width = uint(camera.width);
    settings.height = uint(camera.height);
    settings.filter = camera.filter.kind;
    settings.filter_radius = float(camera.filter.radius);
    settings.filter_stddev = float(camera.filter.stddev);
    settings.filter_b = float(camera.filter.b);
    settings.filter_c = float(camera.filter.c);
}

void fill_strategy(const SceneDescription &description, const Frame &frame, Settings &settings) {
    settings.spp = description.spp;
    settings.max_depth = description.strategy.max_depth;
    settings.rr_depth = description.strategy.rr_depth;
    settings.rr_prob = float(drawn_probability(description.strategy.rr_prob));
    settings.normals_signed = description.normals_signed;
    store((description.simple_light.position - frame.center) * frame.scale, settings.light_position);
    for (int i = 0; i < 3; i++)
        settings.light_energy[i] = float(description.simple_light.energy[i] * frame.scale * frame.scale);
    std::copy(description.strategy.choices.begin(), description.strategy.choices.end(), settings.choices);
}

// --hemisphere is decided here: what the device reads is in the materials.
BsdfRecord with_hemisphere(BsdfRecord record, int hemisphere) {
    if (record.kind == BSDF_diffuse && hemisphere != CHOICE_hemisphere_material)
        record.u.diffuse.use_cosine = hemisphere == CHOICE_hemisphere_cosine;
    return record;
}

void gather_bsdfs(const SceneDescription &description, FlatScene &scene) {
    std::map<std::string, uint> known; // by their bytes
    for (const Mesh &mesh : description.meshes) {
        const BsdfRecord record = with_hemisphere(mesh.bsdf.record, description.strategy[AXIS_hemisphere]);
        const std::string bytes(reinterpret_cast<const char *>(&record), sizeof record);
        const auto [found, is_new] = known.try_emplace(bytes, uint(scene.bsdfs.size()));
        if (is_new)
            scene.bsdfs.push_back(record);
        scene.meshes.push_back({found->second, OPAL_NONE});
    }
}

// Point lights and the corners of triangles that emit: all rays to light end in one of these points or between them.
std::vector<std::array<float, 3>> light_points(const SceneDescription &description, const Frame &frame,
                                               const TriangleSoup &soup, const std::vector<Triangle> &triangles) {
    std::vector<std::array<float, 3>> points;
    for (const PointLight &light : description.point_lights)
        points.push_back(frame(light.position));
    for (size_t id = 0; id < triangles.size(); id++)
        if (description.meshes[triangles[id].mesh].radiance)
            for (uint vertex : soup.corners[id])
                points.push_back(soup.vertices[vertex]);
    return points;
}

void build_acceleration(TriangleSoup &soup, const std::vector<std::array<float, 3>> &lights, bool with_face_list,
                        FlatScene &scene) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<uint> ids = choose_face_list(soup);
    // Paired at every width: pairing renumbers corners, and the points of lights depend on them.
    std::vector<Face> faces = pair_up(ids, soup, scene.triangles);
    if (!with_face_list)
        faces.clear();
    if (faces.empty() || ids.size() < soup.corners.size())
        plant_tree(soup, faces, scene);
    list_faces(soup, std::move(faces), lights, scene);
    scene.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

FlatScene flatten(const SceneDescription &description, int lanes) {
    FlatScene scene;
    const Frame frame = find_frame(description);
    scene.center = frame.center;
    scene.scale = frame.scale;
    fill_camera(description.camera, frame, scene.settings);
    fill_strategy(description, frame, scene.settings);
    gather_bsdfs(description, scene);
    TriangleSoup soup = gather_triangles(description, frame, scene);
    build_acceleration(soup, light_points(description, frame, soup, scene.triangles),
                       lanes >= FACE_LIST_LANES && description.strategy.specialise, scene);
    gather_emitters(description, frame, soup, scene);
    scene.settings.emitter_count = uint(scene.emitters.size());
    scene.features = find_features(description, scene, lanes);
    return scene;
}

} // namespace opal
