#include "flatten/face_list.h"

#include "base/math.h"
#include "bvh/box.h"
#include "bvh/collapse.h"
#include "flatten/geometry.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace opal {
namespace {

Box box_of(const TriangleSoup &soup, uint id) {
    Box box = Box::empty();
    for (uint vertex : soup.corners[id])
        box.add(soup.vertices[vertex]);
    return box;
}

std::size_t blocks_for(std::size_t primitives) { return (primitives + OPAL_WIDTH - 1) / OPAL_WIDTH; }

// As many ids from place `first` on as a block has.
BlockIds part_of(const std::vector<uint> &ids, std::size_t first) {
    BlockIds part;
    part.fill(OPAL_NONE);
    std::copy_n(&ids[first], std::min(part.size(), ids.size() - first), part.begin());
    return part;
}

// Puts primitives together as the tree's leaves ask. `single` holds each primitive of a shape, in the first place of a
// block of its own. A block's rows have OPAL_WIDTH words; unused places repeat the first primitive, but have no id.
template <class Block>
LargeVector<Block> fill_blocks(const LargeVector<Block> &single, const LargeVector<BlockIds> &leaves) {
    LargeVector<Block> filled(leaves.size());
    for (std::size_t i = 0; i < leaves.size(); i++) {
        for (int place = 0; place < OPAL_WIDTH; place++) {
            const uint id = leaves[i][leaves[i][place] == OPAL_NONE ? 0 : place];
            const auto *from = reinterpret_cast<const uint *>(&single[id & OPAL_BLOCK_BITS]);
            auto *to = reinterpret_cast<uint *>(&filled[i]);
            for (std::size_t word = 0; word < sizeof(Block) / sizeof(uint); word += OPAL_WIDTH)
                to[word + place] = from[word];
        }
        std::copy(leaves[i].begin(), leaves[i].end(), filled[i].id);
    }
    return filled;
}

Vec3 vec3(const Point3f &p) { return {p[0], p[1], p[2]}; }

// A bound of the rounding error of a coordinate of at most 1: four half-ulps of 2^-24.
constexpr double rounding = 0x1p-22;
// The limits of is_quadrilateral: the affine coordinates of d along a b and a c, which are 0 where c or b is a straight
// corner, and the least height of a triangle in units of `rounding`.
constexpr double min_affine = 0x1p-10, min_height = 1024;

// Whether a b c and d c b make a convex quadrilateral: d must be in the plane of a b c up to rounding, no corner
// straight or nearly so, and both triangles much higher than rounding.
bool is_quadrilateral(const Point3f &a, const Point3f &b, const Point3f &c, const Point3f &d) {
    const Vec3 to_b = vec3(b) - vec3(a), to_c = vec3(c) - vec3(a), to_d = vec3(d) - vec3(a), n = cross(to_b, to_c);
    double largest = 0, longest2 = 0;
    for (const Point3f *p : {&a, &b, &c, &d})
        for (float coordinate : *p)
            largest = std::max(largest, double(std::abs(coordinate)));
    for (Vec3 side : {to_b, to_c, to_d, to_c - to_b, to_d - to_b, to_d - to_c})
        longest2 = std::max(longest2, dot(side, side));
    const double n2 = dot(n, n);
    const double far_b = dot(cross(to_d, to_c), n) / n2,
                 far_c = dot(cross(to_b, to_d), n) / n2; // d = a + far_b to_b + far_c to_c
    const double ratio = far_b + far_c - 1;              // of the areas
    return std::abs(dot(to_d, n)) <= rounding * largest * std::sqrt(n2) && std::min(far_b, far_c) >= min_affine &&
           std::min(ratio, 1.0) * std::sqrt(n2 / longest2) >= min_height * rounding * largest;
}

// Makes corner `by` of a triangle the first one.
void rotate_corners(uint triangle, int by, TriangleSoup &soup, FlatScene &scene) {
    const auto rotate = [by](auto &corners) {
        std::rotate(std::begin(corners), std::begin(corners) + by, std::end(corners));
    };
    rotate(soup.corners[triangle]);
    rotate(scene.triangles[triangle].normal);
    if (!scene.triangle_uvs.empty()) {
        float(&corners)[3][2] = scene.triangle_uvs[triangle].corner;
        std::rotate(&corners[0][0], &corners[0][0] + 2 * by, &corners[0][0] + 6);
    }
    for (const AttributeRange &range : soup.attributes)
        if (!range.attribute->of_faces && triangle - range.triangle < range.triangles) {
            const auto first = scene.attributes.begin() +
                               std::ptrdiff_t(range.first + (triangle - range.triangle) * std::size_t(range.stride));
            std::rotate(first, first + by * range.attribute->channels, first + range.stride);
        }
}

// Returns the face of both triangles if they make a quadrilateral, and rotates their corners to A B C and D C B; else
// the face of the first triangle alone.
Face make_face(uint first, uint second, TriangleSoup &soup, FlatScene &scene) {
    const auto corner = [&](uint id, int i) { return soup.vertices[soup.corners[id][size_t(i % 3)]]; };
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            if (corner(first, i + 1) == corner(second, j + 2) && corner(first, i + 2) == corner(second, j + 1) &&
                is_quadrilateral(corner(first, i), corner(first, i + 1), corner(first, i + 2), corner(second, j))) {
                rotate_corners(first, i, soup, scene);
                rotate_corners(second, j, soup, scene);
                return {first, second};
            }
    return {first, OPAL_NONE};
}

// Sets the plane of the quadrilateral A B D C: its normal is that of the diagonals, and it goes through the corners'
// mean. `along` is the mean's distance along the normal as rounded to float, so that the plane goes through it exactly.
void set_plane(const Point3f (&corners)[4], FaceRecord &face) {
    const Vec3 to_d = vec3(corners[3]) - vec3(corners[0]), b_to_c = vec3(corners[2]) - vec3(corners[1]);
    Vec3 n = cross(to_d, b_to_c);
    constexpr double least_sine = 1e-6; // below, C - B may have lost what tells C from A
    if (!(length(n) > least_sine * length(to_d) * length(b_to_c)))
        n = normal_of(corners[0], corners[1], corners[2]);
    const Vec3 unit = n * (1 / length(n));
    face.normal[0] = float(unit.x), face.normal[1] = float(unit.y), face.normal[2] = float(unit.z);
    double along = 0;
    for (const Point3f &p : corners)
        along += dot(vec3(p), {face.normal[0], face.normal[1], face.normal[2]}) / 4;
    face.along = float(along);
}

// On which sides of the plane of a b c points lie: the least and the greatest of their signed distances.
class Sides {
public:
    Sides(const Point3f &a, const Point3f &b, const Point3f &c) : on_plane_(vec3(a)) {
        const Vec3 n = normal_of(a, b, c);
        normal_ = n * (1 / length(n));
    }
    void add(const Point3f &p) {
        const double distance = dot(vec3(p) - on_plane_, normal_);
        lowest_ = std::min(lowest_, distance);
        highest_ = std::max(highest_, distance);
    }
    bool all_on_one_side(double tolerance) const { return lowest_ >= -tolerance || highest_ <= tolerance; }
    bool all_in_plane(double tolerance) const { return lowest_ >= -tolerance && highest_ <= tolerance; }

private:
    Vec3 on_plane_, normal_;
    double lowest_ = 0, highest_ = 0;
};

double largest_coordinate(const Point3f &p) { return std::max({std::abs(p[0]), std::abs(p[1]), std::abs(p[2])}); }

// Whether the face provably blocks no shadow ray, a ray from a point of the scene to one of `lights`: the whole scene
// is on one side of its plane, or all lights are in its plane.
bool never_blocks(const Face &face, const TriangleSoup &soup, const std::vector<Point3f> &lights) {
    const auto &[a, b, c] = soup.corners[face.first];
    Sides sides(soup.vertices[a], soup.vertices[b], soup.vertices[c]);
    double largest = 0;
    for (const Point3f &p : lights) {
        sides.add(p);
        largest = std::max(largest, largest_coordinate(p));
    }
    if (!lights.empty() && sides.all_in_plane(rounding * largest))
        return true;
    for (size_t i = 0; i < soup.corners.size() && sides.all_on_one_side(rounding); i++)
        for (uint vertex : soup.corners[i])
            sides.add(soup.vertices[vertex]);
    for (const BoundedPrimitive &other : soup.others)
        for (const Point3f &corner : other.box.corners())
            sides.add(corner);
    return sides.all_on_one_side(rounding);
}

} // namespace

std::vector<uint> choose_face_list(const TriangleSoup &soup) {
    Box scene = Box::empty();
    for (const auto &corners : soup.corners)
        for (uint vertex : corners)
            scene.add(soup.vertices[vertex]);
    for (const BoundedPrimitive &other : soup.others)
        scene.add(other.box);
    const bool tiny = soup.corners.size() <= OPAL_FACE_LIST_TRIANGLES;
    std::vector<std::pair<float, uint>> candidates; // -area, id: the largest come first, equals in their order
    for (uint id = 0; id < soup.corners.size(); id++)
        if (const float area = box_of(soup, id).half_area(); tiny || area >= FIRST_SHARE * scene.half_area())
            candidates.push_back({-area, id});
    std::sort(candidates.begin(), candidates.end());

    std::vector<uint> chosen;
    std::set<Point3f> distinct;
    for (const auto &[minus_area, id] : candidates) {
        if (!tiny && chosen.size() >= FIRST_TRIANGLES && -minus_area < FACE_LIST_SHARE * scene.half_area())
            break;
        std::set<Point3f> extended = distinct;
        for (uint vertex : soup.corners[id])
            extended.insert(soup.vertices[vertex]);
        if (chosen.size() == OPAL_FACE_LIST_TRIANGLES || extended.size() > OPAL_FACE_LIST_VERTICES)
            break;
        distinct = std::move(extended);
        chosen.push_back(id);
    }
    std::sort(chosen.begin(), chosen.end());
    return chosen;
}

std::vector<Face> pair_up(const std::vector<uint> &ids, TriangleSoup &soup, FlatScene &scene) {
    std::vector<Face> faces;
    std::vector<uint> left = ids;
    while (!left.empty()) {
        Face face{left.front(), OPAL_NONE};
        for (size_t i = 1; i < left.size() && face.second == OPAL_NONE; i++) {
            face = make_face(left.front(), left[i], soup, scene);
            if (face.second != OPAL_NONE)
                left.erase(left.begin() + std::ptrdiff_t(i));
        }
        left.erase(left.begin());
        faces.push_back(face);
    }
    return faces;
}

void build_tree(const TriangleSoup &soup, const std::vector<Face> &faces, FlatScene &scene) {
    std::vector<uint> listed;
    for (const Face &face : faces) {
        listed.push_back(face.first);
        if (face.second != OPAL_NONE)
            listed.push_back(face.second);
    }
    std::sort(listed.begin(), listed.end());
    if (!listed.empty() && listed.size() == soup.corners.size() && soup.others.empty()) {
        scene.nodes = {empty_node()};
        return;
    }
    Bvh bvh = build_bvh(soup, listed);
    scene.sah_cost = sah_cost(bvh);
    scene.nodes = std::move(bvh.nodes);
    // With room for those of the face list.
    scene.triangle_blocks.reserve(bvh.leaves[SHAPE_triangle].size() + blocks_for(2 * faces.size()));
    for (const BlockIds &ids : bvh.leaves[SHAPE_triangle])
        scene.triangle_blocks.push_back(pack_block(soup, ids));
#define OPAL_FILL_BLOCKS(name, Block)                                                                                  \
    if (SHAPE_##name != SHAPE_triangle)                                                                                \
        scene.name##_blocks = fill_blocks(scene.name##_blocks, bvh.leaves[SHAPE_##name]);
    OPAL_SHAPES(OPAL_FILL_BLOCKS)
#undef OPAL_FILL_BLOCKS
}

void list_faces(const TriangleSoup &soup, std::vector<Face> faces, const std::optional<std::vector<Point3f>> &lights,
                FlatScene &scene) {
    const auto may_block = [&](const Face &face) { return !lights || !never_blocks(face, soup, *lights); };
    const auto idle = std::stable_partition(faces.begin(), faces.end(), may_block);
    scene.settings.face_list_slot = uint(scene.triangle_blocks.size()) * 8;
    std::map<Point3f, uint> vertices;
    std::vector<uint> shapes, ids; // by slot: a triangle of its shape, and of its id
    for (const Face &face : faces) {
        const bool pair = face.second != OPAL_NONE;
        FaceRecord record{};
        Point3f corners[4]; // A, B, C, and D or B again
        for (size_t i = 0; i < 4; i++) {
            corners[i] = soup.vertices[i < 3  ? soup.corners[face.first][i]
                                       : pair ? soup.corners[face.second][0]
                                              : soup.corners[face.first][1]];
            record.corner[i] = vertices.try_emplace(corners[i], uint(vertices.size())).first->second;
        }
        set_plane(corners, record);
        scene.faces.push_back(record);
        scene.face_list_triangles += pair ? 2 : 1;
        shapes.insert(shapes.end(), {face.first, pair ? face.second : face.first});
        ids.insert(ids.end(), {face.first, face.second});
        scene.settings.face_list = {uint(scene.faces.size()), uint(vertices.size())};
        if (scene.faces.size() == size_t(idle - faces.begin()))
            scene.settings.face_list_to_light = scene.settings.face_list;
    }
    for (std::size_t first = 0; first < ids.size(); first += OPAL_WIDTH) {
        TriangleBlock block = pack_block(soup, part_of(shapes, first));
        std::ranges::copy(part_of(ids, first), block.id);
        scene.triangle_blocks.push_back(block);
    }
    scene.face_vertices.resize(3 * vertices.size());
    for (const auto &[position, place] : vertices)
        std::copy(position.begin(), position.end(), &scene.face_vertices[3 * size_t(place)]);
}

} // namespace opal
