#include "bvh/early_split.h"

#include "base/math.h"

#include <cmath>

namespace opal {
namespace {

// Triangles are split in scenes whose boxes waste more than this share of their area. Scenes of balls, furniture and
// terrain waste 4 to 36 % and are slower when split; veach_room wastes 78 %, and 96 % when turned out of the axes.
constexpr double min_wasted_share = 0.5;
// Parts are split until each wastes at most this share of the average waste of a whole triangle.
constexpr double max_part_waste = 0.5;

// The wasted part of a box's half surface area, which a ray can hit in vain: half_area minus twice the polygon's
// projections onto the sides. The factor is 2 because even the best-filled box of a triangle is half empty. twice_area:
// the polygon's normal, whose length is twice its area.
double wasted_area(const Box &box, Vec3 twice_area) {
    return std::max(0.0,
                    double(box.half_area()) - std::abs(twice_area.x) - std::abs(twice_area.y) - std::abs(twice_area.z));
}

using Polygon = std::vector<Vec3>; // convex: a part of a triangle

Vec3 twice_area(const Polygon &polygon) {
    Vec3 sum;
    for (std::size_t i = 2; i < polygon.size(); i++)
        sum = sum + cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return sum;
}

// The polygon's box, rounded outwards but clipped to the box of the whole triangle or part.
Box box_of(const Polygon &polygon, const Box &whole) {
    Box box = Box::empty();
    for (Vec3 p : polygon)
        for (int axis = 0; axis < 3; axis++) {
            const float x = float(p[axis]);
            box.lo[axis] = std::min(box.lo[axis], x > p[axis] ? std::nextafter(x, -Box::infinity) : x);
            box.hi[axis] = std::max(box.hi[axis], x < p[axis] ? std::nextafter(x, Box::infinity) : x);
        }
    for (int axis = 0; axis < 3; axis++) {
        box.lo[axis] = std::max(box.lo[axis], whole.lo[axis]);
        box.hi[axis] = std::min(box.hi[axis], whole.hi[axis]);
    }
    return box;
}

// Clips the polygon to the half-space sign * p[axis] <= sign * plane (Sutherland and Hodgman 1974).
Polygon clip(const Polygon &polygon, int axis, double plane, double sign) {
    Polygon part;
    for (std::size_t i = 0; i < polygon.size(); i++) {
        const Vec3 p = polygon[i], q = polygon[(i + 1) % polygon.size()];
        const double beyond_p = sign * (p[axis] - plane), beyond_q = sign * (q[axis] - plane);
        if (beyond_p <= 0)
            part.push_back(p);
        if ((beyond_p < 0 && beyond_q > 0) || (beyond_p > 0 && beyond_q < 0))
            part.push_back(p + (q - p) * (beyond_p / (beyond_p - beyond_q)));
    }
    return part;
}

// Splits at the middle of the longest axis until no box wastes more than max_waste, in squared units of area.
void add_parts(const Polygon &polygon, const BuildPrimitive &primitive, double max_waste,
               LargeVector<BuildPrimitive> &parts) {
    const Box &box = primitive.box;
    int axis = 0;
    for (int other = 1; other < 3; other++)
        if (box.hi[other] - box.lo[other] > box.hi[axis] - box.lo[axis])
            axis = other;
    const float plane = box.lo[axis] / 2 + box.hi[axis] / 2;
    if (wasted_area(box, twice_area(polygon)) <= max_waste || plane <= box.lo[axis] || plane >= box.hi[axis]) {
        parts.push_back(primitive);
        return;
    }
    for (double sign : {1.0, -1.0}) {
        const Polygon part = clip(polygon, axis, plane, sign);
        if (part.size() >= 3)
            add_parts(part, {box_of(part, box), primitive.id}, max_waste, parts);
    }
}

} // namespace

LargeVector<BuildPrimitive> whole_primitives(const TriangleSoup &soup, std::span<const uint> left_out) {
    LargeVector<BuildPrimitive> whole;
    whole.reserve(soup.corners.size() - left_out.size() + soup.others.size());
    auto next_left_out = left_out.begin();
    for (uint id = 0; id < soup.corners.size(); id++) {
        if (next_left_out != left_out.end() && *next_left_out == id) {
            ++next_left_out;
            continue;
        }
        Box &box = whole.emplace_back(BuildPrimitive{Box::empty(), id}).box;
        for (uint vertex : soup.corners[id])
            box.add(soup.vertices[vertex]);
    }
    for (const BoundedPrimitive &other : soup.others)
        whole.push_back({other.box, other.id});
    return whole;
}

LargeVector<BuildPrimitive> split_primitives(const TriangleSoup &soup, std::span<const uint> left_out) {
    LargeVector<BuildPrimitive> whole = whole_primitives(soup, left_out);
    const auto wasted_area_of = [&](const BuildPrimitive &primitive) {
        if (shape_of(primitive.id) != SHAPE_triangle)
            return 0.0;
        const auto &[a, b, c] = soup.corners[primitive.id];
        return wasted_area(primitive.box, normal_of(soup.vertices[a], soup.vertices[b], soup.vertices[c]));
    };
    double area = 0, waste = 0;
    for (const BuildPrimitive &primitive : whole) {
        area += double(primitive.box.half_area());
        waste += wasted_area_of(primitive);
    }
    if (waste <= min_wasted_share * area)
        return whole;
    const double max_waste = max_part_waste * waste / double(whole.size());
    LargeVector<BuildPrimitive> parts;
    for (const BuildPrimitive &primitive : whole) {
        if (wasted_area_of(primitive) <= max_waste) {
            parts.push_back(primitive);
            continue;
        }
        Polygon triangle;
        for (uint vertex : soup.corners[primitive.id]) {
            const auto &[x, y, z] = soup.vertices[vertex];
            triangle.push_back({x, y, z});
        }
        add_parts(triangle, primitive, max_waste, parts);
    }
    return parts;
}

} // namespace opal
