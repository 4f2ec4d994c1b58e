#include "flatten/scene_warnings.h"

#include "flatten/geometry.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

namespace opal {

namespace {

std::string plural(size_t count, const char *one, const char *many) {
    return fmt::format("{} {}", count, count == 1 ? one : many);
}

// The name of a property in the scene's file.
const char *name_in(const SceneDescription &scene, const char *nori, const char *mitsuba) {
    return scene.dialect == Dialect::mitsuba ? mitsuba : nori;
}

// --- the camera ---

struct Depths {
    double least = INFINITY, most = -INFINITY;
};

// Depths of a box in camera space, along the axis that nearClip and farClip measure.
Depths depths_of(const Extent &extent, const Camera &camera) {
    const auto &rows = camera.to_world.rows;
    const auto column = [&rows](int i) { return Vec3{rows[0][i], rows[1][i], rows[2][i]}; };
    const Vec3 across = cross(column(0), column(1)), origin = camera.to_world.point({});
    Depths depths;
    for (unsigned i = 0; i < 8; ++i) {
        const double depth = dot(extent.corner(i) - origin, across) / dot(column(2), across);
        depths.least = std::min(depths.least, depth);
        depths.most = std::max(depths.most, depth);
    }
    return depths;
}

// Meshes beyond farClip are told: behind the camera, or close to it, many scenes have some.
void check_clip(const SceneDescription &scene, const std::vector<Extent> &extents, std::vector<std::string> &lines) {
    const Camera &camera = scene.camera;
    Depths all;
    size_t count = 0, unseen = 0, beyond = 0;
    const Mesh *first = nullptr;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh &mesh = scene.meshes[i];
        if (extents[i].empty())
            continue;
        const Depths depths = depths_of(extents[i], camera);
        ++count;
        all = {std::min(all.least, depths.least), std::max(all.most, depths.most)};
        unseen += depths.most < camera.near_clip || depths.least > camera.far_clip;
        if (depths.least > camera.far_clip && !mesh.radiance && ++beyond == 1)
            first = &mesh;
    }
    const std::string place = camera.place.text();
    const char *const near = name_in(scene, "nearClip", "near_clip");
    const char *const far = name_in(scene, "farClip", "far_clip");
    if (unseen == count && unseen > 0)
        lines.push_back(fmt::format(
            "{}: the camera sees no mesh: it sees depths from {} {:g} to {} {:g}, and {} at depths from "
            "{:.3g} to {:.3g}{}",
            place, near, camera.near_clip, far, camera.far_clip, unseen == 1 ? "the only mesh lies" : "all meshes lie",
            all.least, all.most, all.most < 0 ? ", behind it" : ""));
    else if (beyond > 0)
        lines.push_back(fmt::format("{}: the camera does not see {} beyond {} {:g} (the first: {} at {})", place,
                                    plural(beyond, "mesh", "meshes"), far, camera.far_clip, first->name,
                                    first->place.text()));
}

// --- lights ---

// Whether no point of the extent lies before the plane, but for rounding.
bool is_behind(const Extent &extent, Vec3 point, Vec3 normal, double rounding) {
    const Vec3 farthest = {normal.x > 0 ? extent.hi.x : extent.lo.x, normal.y > 0 ? extent.hi.y : extent.lo.y,
                           normal.z > 0 ? extent.hi.z : extent.lo.z};
    return extent.empty() || dot(farthest - point, normal) <= rounding * length(normal);
}

// Where a part of a light is, and its normals: the three corners, or of a parallelogram the origin. Light leaves a
// point in between towards x where an interpolated normal and x - point make an acute angle.
struct LightPart {
    std::array<Vec3, 3> points, normals;
};

LightPart part_of(const TriangleMesh &mesh, size_t i) {
    LightPart part;
    for (size_t k = 0; k < 3; ++k)
        part.points[k] = mesh.positions[mesh.triangles[i][k].position];
    const Vec3 geometric = cross(part.points[1] - part.points[0], part.points[2] - part.points[0]);
    for (size_t k = 0; k < 3; ++k) {
        const unsigned normal = mesh.triangles[i][k].normal;
        part.normals[k] = normal == OPAL_NONE ? geometric : mesh.normals[normal];
    }
    return part;
}

class LightCheck {
public:
    // extents: of the meshes.
    LightCheck(const SceneDescription &scene, const std::vector<Extent> &extents) : scene_(scene), extents_(extents) {
        Extent all;
        for (const Extent &extent : extents)
            all.add(extent);
        rounding_ = 1e-9 * all.longest_side();
        const Vec3 camera = scene.camera.to_world.point({});
        extents_.push_back({camera, camera});
    }

    // Whether it takes too long to ask: each part of a light is compared with each mesh.
    bool is_too_large() const {
        constexpr double most_pairs = 1e7; // a second at the most
        double parts = 0;
        for (const Mesh &mesh : scene_.meshes) {
            const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape);
            if (mesh.radiance)
                parts += triangles ? double(std::min(triangles->triangles.size(), most_triangles)) : 1;
        }
        return parts * double(extents_.size()) > most_pairs;
    }

    // Whether mesh `i`, which emits, lights neither another mesh nor itself, and is dark from the camera.
    bool faces_away(size_t i) const {
        return !scene_.meshes[i].emits_on_both_sides &&
               std::visit([&](const auto &shape) { return faces_away(shape, i); }, scene_.meshes[i].shape);
    }

private:
    static bool faces_away(const Sphere &, size_t) { return false; } // its normals point everywhere

    static constexpr size_t most_triangles = 256; // a mesh light is compared with itself, in quadratic time
    const SceneDescription &scene_;
    double rounding_ = 0;
    std::vector<Extent> extents_; // of the meshes and of the camera

    bool faces_away(const LightPart &part, size_t own) const {
        for (size_t i = 0; i < extents_.size(); ++i)
            for (Vec3 point : part.points)
                for (Vec3 normal : part.normals)
                    if (i != own && !is_behind(extents_[i], point, normal, rounding_))
                        return false;
        return true;
    }

    bool faces_away(const Parallelogram &shape, size_t own) const {
        const Vec3 p = shape.origin, n = cross(shape.u, shape.v);
        return faces_away(LightPart{{p, p, p}, {n, n, n}}, own);
    }

    bool faces_away(const TriangleMesh &mesh, size_t own) const {
        if (mesh.triangles.size() > most_triangles)
            return false;
        for (size_t i = 0; i < mesh.triangles.size(); ++i) {
            const LightPart part = part_of(mesh, i);
            const auto lights = [&](Vec3 other) {
                for (Vec3 point : part.points)
                    for (Vec3 normal : part.normals)
                        if (!is_behind({other, other}, point, normal, rounding_))
                            return true;
                return false;
            };
            if (!faces_away(part, own) || std::any_of(mesh.positions.begin(), mesh.positions.end(), lights))
                return false;
        }
        return true;
    }
};

void check_lights(const SceneDescription &scene, const std::vector<Extent> &extents, std::vector<std::string> &lines) {
    if (!scene.lights.empty() || !integrator_of(scene.strategy).has(OPAL_ASKS_LIGHTS))
        return;
    const LightCheck check(scene, extents);
    if (check.is_too_large())
        return;
    size_t count = 0;
    const Mesh *first = nullptr;
    for (size_t i = 0; i < scene.meshes.size(); ++i)
        if (scene.meshes[i].radiance) {
            if (!check.faces_away(i))
                return;
            if (++count == 1)
                first = &scene.meshes[i];
        }
    if (count > 0)
        lines.push_back(
            fmt::format("{}: {}: an area light shines on one side, that of its normals, and the camera and "
                        "all else lie on the other; the image is black. {}",
                        first->place.text(),
                        count == 1 ? "the only light faces away" : fmt::format("all {} lights face away", count),
                        std::holds_alternative<Parallelogram>(first->shape)
                            ? "Swapping u and v turns it round"
                            : "Faces with their corners in the opposite order turn it round"));
}

// Whether the ball around a box lies outside the spot's cone.
bool misses(const emitter_spot &spot, const Extent &extent) {
    const Vec3 to_middle = extent.middle() - spot.position;
    const double distance = length(to_middle), radius = extent.radius();
    if (extent.empty() || distance <= radius)
        return extent.empty();
    const double cosine = dot(to_middle, spot.direction) / (distance * length(spot.direction));
    const double angle = std::acos(std::clamp(cosine, -1.0, 1.0)) - std::asin(radius / distance);
    return angle * (180 / std::numbers::pi) >= spot.cutoff_angle;
}

void check_spots(const SceneDescription &scene, const std::vector<Extent> &extents, std::vector<std::string> &lines) {
    constexpr size_t most_pairs = 10'000'000; // a second at the most
    const size_t pairs = scene.lights.size() * extents.size();
    if (pairs == 0 || pairs > most_pairs || !integrator_of(scene.strategy).has(OPAL_ASKS_LIGHTS))
        return;
    size_t count = 0;
    const Light *first = nullptr;
    for (const Light &light : scene.lights)
        if (const auto *spot = std::get_if<emitter_spot>(&light.parameters))
            if (std::ranges::all_of(extents, [&](const Extent &mesh) { return misses(*spot, mesh); }) && ++count == 1)
                first = &light;
    if (count > 0)
        lines.push_back(fmt::format("{}: {}: no mesh lies within {} of the axis", first->place.text(),
                                    count == 1 ? "a spot lights nothing" : fmt::format("{} spots light nothing", count),
                                    name_in(scene, "cutoffAngle", "cutoff_angle")));
}

// --- coincident faces ---

struct Face {
    std::array<Vec3, 3> points; // from the least on, by x, then y, then z
    uint mesh;

    Vec3 area_vector() const { return cross(points[1] - points[0], points[2] - points[0]); } // doubled
};

bool before(Vec3 a, Vec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }
bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }

// The directions from a face's first point to the others, of length 1: it lies between them.
struct Wedge {
    Vec3 from, to, normal;

    explicit Wedge(const Face &face)
        : from(normalize(face.points[1] - face.points[0])), to(normalize(face.points[2] - face.points[0])),
          normal(normalize(cross(from, to))) {}

    Vec3 middle() const { return from + to; }
    // Of directions in its plane; `rounding` is an angle.
    bool holds(Vec3 d) const { return dot(cross(from, d), normal) > rounding && dot(cross(d, to), normal) > rounding; }
    static constexpr double rounding = 1e-6;
};

// Whether two faces with the same first point lie in one plane, face opposite ways and overlap.
bool hide_each_other(const Face &a, const Face &b) {
    if (dot(a.area_vector(), b.area_vector()) >= 0) // most neighbours, quickly
        return false;
    const Wedge wedge(a), other(b);
    return length(cross(wedge.normal, other.normal)) < Wedge::rounding &&
           (wedge.holds(other.middle()) || other.holds(wedge.middle()) || wedge.holds(other.from) ||
            wedge.holds(other.to));
}

// All triangles of a scene; parallelograms are two each, spheres have none.
class Faces {
public:
    explicit Faces(const SceneDescription &scene) : scene_(scene) {
        for (const Mesh &mesh : scene.meshes) {
            const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape);
            starts_.push_back(count_);
            count_ += triangles                                           ? triangles->triangles.size()
                      : std::holds_alternative<Parallelogram>(mesh.shape) ? 2
                                                                          : 0;
        }
    }

    size_t count() const { return count_; }

    Face operator[](size_t i) const {
        const auto next = std::upper_bound(starts_.begin(), starts_.end(), i);
        const uint mesh = uint(next - starts_.begin() - 1);
        return of(mesh, i - starts_[mesh]);
    }

    // Calls visit(index, face) for each.
    template <class Visit> void each(Visit visit) const {
        for (uint mesh = 0; mesh < starts_.size(); ++mesh) {
            const size_t end = mesh + 1 < starts_.size() ? starts_[mesh + 1] : count_;
            for (size_t i = starts_[mesh]; i < end; ++i)
                visit(i, of(mesh, i - starts_[mesh]));
        }
    }

private:
    const SceneDescription &scene_;
    std::vector<size_t> starts_; // the first face of each mesh
    size_t count_ = 0;

    Face of(uint mesh, size_t i) const {
        const auto [a, b, c] = points_of(scene_.meshes[mesh].shape, i);
        return before(a, b) && before(a, c) ? Face{{a, b, c}, mesh}
               : before(b, c)               ? Face{{b, c, a}, mesh}
                                            : Face{{c, a, b}, mesh};
    }

    static std::array<Vec3, 3> points_of(const Shape &shape, size_t i) {
        if (const auto *quad = std::get_if<Parallelogram>(&shape)) {
            const auto [origin, u, v, opposite] = quad->corners();
            return i == 0 ? std::array<Vec3, 3>{origin, u, opposite} : std::array<Vec3, 3>{origin, opposite, v};
        }
        const auto &mesh = std::get<TriangleMesh>(shape);
        const auto [a, b, c] = mesh.triangles[i];
        return {mesh.positions[a.position], mesh.positions[b.position], mesh.positions[c.position]};
    }
};

uint64_t hash_of(Vec3 p) {
    uint64_t hash = 0;
    for (double coordinate : {p.x, p.y, p.z}) // 0 is added so that -0 is 0
        hash = std::rotl(hash ^ std::bit_cast<uint64_t>(coordinate + 0.0), 23) * 0x9e3779b97f4a7c15u; // 2^64 / golden
    return hash;
}

// Two polygons that coincide may be cut into different triangles. But the corner of both that is least, by x, then y,
// then z, is the least corner of those triangles that meet there, and these overlap. So triangles are compared that
// have their least corner in common: they stand in lists, found by a hash of that corner.
void check_coincident_faces(const SceneDescription &scene, const Faces &faces, std::vector<std::string> &lines) {
    constexpr uint none = ~0u;
    constexpr int most_compared = 64; // of a list, so that a fan of many triangles takes linear time
    if (faces.count() == 0 || faces.count() >= none)
        return;
    const int bits = std::bit_width(faces.count());
    std::vector<uint> lists(size_t(1) << bits, none), next(faces.count(), none);
    size_t count = 0;
    std::optional<std::array<uint, 2>> first; // their meshes
    faces.each([&](size_t i, const Face &face) {
        uint &list = lists[hash_of(face.points[0]) >> (64 - bits)];
        int compared = 0;
        for (uint at = list; at != none && compared < most_compared; at = next[at], ++compared) {
            const Face other = faces[at];
            if (!same(face.points[0], other.points[0]) || !hide_each_other(face, other))
                continue;
            if (++count == 1)
                first = {other.mesh, face.mesh};
            break;
        }
        next[i] = list;
        list = uint(i);
    });
    if (!first)
        return;
    const Mesh &a = scene.meshes[(*first)[0]], &b = scene.meshes[(*first)[1]];
    lines.push_back(
        fmt::format("{}: faces coincide that are wound against each other: a ray that gets there meets one of them by "
                    "chance, its front or its back ({} in all, the first in {}{})",
                    a.place.text(), plural(count, "triangle", "triangles"), a.name,
                    &a == &b ? "" : fmt::format(", and in {} at {}", b.name, b.place.text())));
}

} // namespace

std::vector<std::string> scene_warnings(const SceneDescription &scene, size_t most_faces) {
    std::vector<std::string> lines;
    std::vector<Extent> extents;
    for (const Mesh &mesh : scene.meshes)
        extents.push_back(extent_of(mesh));
    check_clip(scene, extents, lines);
    check_lights(scene, extents, lines);
    check_spots(scene, extents, lines);
    if (const Faces faces(scene); faces.count() <= most_faces)
        check_coincident_faces(scene, faces, lines);
    return lines;
}

std::vector<std::string> scene_notes(const SceneDescription &scene, bool samples_given) {
    std::vector<std::string> lines;
    if (!samples_given && !scene.sample_count_given)
        lines.push_back(fmt::format("{}: no {}: {} a pixel", scene.sampler_place.text(),
                                    name_in(scene, "sampleCount", "sample_count"),
                                    plural(scene.spp, "sample", "samples")));
    size_t bare = 0;
    const Mesh *first = nullptr;
    for (const Mesh &mesh : scene.meshes)
        if (mesh.bsdf.place.line == 0 && ++bare == 1)
            first = &mesh;
    if (first && integrator_of(scene.strategy).has(OPAL_ASKS_BSDFS))
        lines.push_back(fmt::format("{}: {} without <bsdf>: diffuse, albedo 0.5", first->place.text(),
                                    plural(bare, "mesh", "meshes")));
    return lines;
}

} // namespace opal
