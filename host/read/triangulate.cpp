#include "read/triangulate.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace opal {

namespace {

struct Point2 {
    double x, y;
};

// Twice the signed area of abc, positive counter-clockwise.
double turn(Point2 a, Point2 b, Point2 c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

// Newell's method (Sutherland, Sproull and Schumacher 1974): the area vector of any polygon, doubled.
Vec3 area_vector(const std::vector<Vec3> &corners) {
    Vec3 sum;
    for (size_t i = 1; i + 1 < corners.size(); ++i)
        sum = sum + cross(corners[i] - corners[0], corners[i + 1] - corners[0]);
    return sum;
}

// Projects along the axis in which the polygon is flattest, and keeps it counter-clockwise.
std::vector<Point2> projected(const std::vector<Vec3> &corners) {
    Vec3 n = area_vector(corners);
    double x = std::abs(n.x), y = std::abs(n.y), z = std::abs(n.z);
    int drop = x > y && x > z ? 0 : y > z ? 1 : 2;
    int first = (drop + 1) % 3, second = (drop + 2) % 3;
    if (n[drop] < 0)
        std::swap(first, second);
    std::vector<Point2> points;
    for (Vec3 corner : corners)
        points.push_back({corner[first] - corners[0][first], corner[second] - corners[0][second]});
    return points;
}

bool same(Point2 a, Point2 b) { return a.x == b.x && a.y == b.y; }

struct Triangle2 {
    Point2 a, b, c;
    bool has_corner(Point2 p) const { return same(p, a) || same(p, b) || same(p, c); }
};

struct Box2 {
    Point2 lo{INFINITY, INFINITY}, hi{-INFINITY, -INFINITY}; // empty

    bool empty() const { return lo.x > hi.x; }
    Box2 with(const Box2 &other) const {
        return {{std::min(lo.x, other.lo.x), std::min(lo.y, other.lo.y)},
                {std::max(hi.x, other.hi.x), std::max(hi.y, other.hi.y)}};
    }
    // Whether all of the box lies right of the line ab. Of a single point this is turn(a, b, point) < 0, and no point
    // in the box disagrees, because turn() as it is rounded is monotone in both coordinates.
    bool is_right_of(Point2 a, Point2 b) const {
        return turn(a, b, {b.y < a.y ? hi.x : lo.x, b.x < a.x ? lo.y : hi.y}) < 0;
    }
    bool misses(const Triangle2 &t) const {
        return empty() || is_right_of(t.a, t.b) || is_right_of(t.b, t.c) || is_right_of(t.c, t.a);
    }
};

// A tree of boxes over points, from which points can be removed: a heap whose leaves are the points in the order of a
// k-d tree.
class PointTree {
public:
    explicit PointTree(const std::vector<Point2> &points)
        : order_(points.size()), leaf_(points.size()), boxes_(2 * points.size()) {
        std::iota(order_.begin(), order_.end(), 0u);
        sort(points, 0, points.size());
        for (size_t i = 0; i < points.size(); ++i) {
            leaf_[order_[i]] = points.size() + i;
            boxes_[points.size() + i] = {points[order_[i]], points[order_[i]]};
        }
        for (size_t node = points.size() - 1; node > 0; --node)
            boxes_[node] = boxes_[2 * node].with(boxes_[2 * node + 1]);
    }

    void remove(unsigned point) {
        size_t node = leaf_[point];
        boxes_[node] = {};
        while ((node /= 2) > 0)
            boxes_[node] = boxes_[2 * node].with(boxes_[2 * node + 1]);
    }

    // A point in the triangle or on its outline that is none of its corners, or `none`. Which one is random: corners
    // are cut off in an order of their own, so that a random one lasts long.
    unsigned any_in(const Triangle2 &triangle, unsigned none) {
        stack_ = {1};
        while (!stack_.empty()) {
            const size_t node = stack_.back();
            stack_.pop_back();
            const Box2 &box = boxes_[node];
            if (box.misses(triangle) || (same(box.lo, box.hi) && triangle.has_corner(box.lo)))
                continue;
            if (node >= order_.size())
                return order_[node - order_.size()];
            random_ = random_ * 1664525u + 1013904223u; // Numerical Recipes' generator
            const unsigned last = random_ >> 31;
            stack_.push_back(2 * node + 1 - last);
            stack_.push_back(2 * node + last);
        }
        return none;
    }

private:
    std::vector<unsigned> order_;
    std::vector<size_t> leaf_; // of each point
    std::vector<Box2> boxes_;  // the root is 1, the children of i are 2 i and 2 i + 1
    std::vector<size_t> stack_;
    unsigned random_ = 1;

    // Splits a range by halves across the longer side of its box.
    void sort(const std::vector<Point2> &points, size_t first, size_t last) {
        if (last - first < 2)
            return;
        Box2 box;
        for (size_t i = first; i < last; ++i)
            box = box.with({points[order_[i]], points[order_[i]]});
        const bool by_x = box.hi.x - box.lo.x > box.hi.y - box.lo.y;
        const size_t middle = first + (last - first) / 2;
        std::nth_element(order_.begin() + std::ptrdiff_t(first), order_.begin() + std::ptrdiff_t(middle),
                         order_.begin() + std::ptrdiff_t(last), [&](unsigned a, unsigned b) {
                             return by_x ? points[a].x < points[b].x : points[a].y < points[b].y;
                         });
        sort(points, first, middle);
        sort(points, middle, last);
    }
};

// Ear clipping. A corner is an ear if it is convex and no other corner lies in the triangle that it makes with its
// neighbours. The first ear after the first corner is cut off, again and again. Whether a corner is an ear changes only
// where a neighbour is cut off, or the corner that was found in its triangle: these alone are asked again.
class Clipper {
public:
    explicit Clipper(const std::vector<Point2> &points)
        : points_(points), tree_(points), previous_(points.size()), next_(points.size()), is_cut_(points.size()),
          blocked_by_(points.size()) {
        const unsigned count = unsigned(points.size());
        for (unsigned i = 0; i < count; ++i) {
            previous_[i] = (i + count - 1) % count;
            next_[i] = (i + 1) % count;
            unknown_.insert(unknown_.end(), i);
        }
    }

    std::array<unsigned, 3> clip() {
        const unsigned ear = find_ear(), before = previous_[ear], after = next_[ear];
        is_cut_[ear] = true;
        unknown_.erase(ear);
        tree_.remove(ear);
        next_[before] = after;
        previous_[after] = before;
        if (ear == first_)
            first_ = after;
        unknown_.insert({before, after});
        for (unsigned corner : blocked_by_[ear])
            if (!is_cut_[corner])
                unknown_.insert(corner);
        return {before, ear, after};
    }

    std::array<unsigned, 3> rest() const { return {first_, next_[first_], previous_[first_]}; } // when three are left

private:
    const std::vector<Point2> &points_;
    PointTree tree_; // of the corners that are left
    std::vector<unsigned> previous_, next_;
    std::vector<bool> is_cut_;
    std::vector<std::vector<unsigned>> blocked_by_; // the corners in whose triangles a corner was found
    std::set<unsigned> unknown_;                    // all others are no ears
    unsigned first_ = 0;

    bool is_ear(unsigned corner) {
        const Triangle2 triangle = {points_[previous_[corner]], points_[corner], points_[next_[corner]]};
        if (!(turn(triangle.a, triangle.b, triangle.c) > 0))
            return false;
        const unsigned blocker = tree_.any_in(triangle, corner);
        if (blocker == corner)
            return true;
        blocked_by_[blocker].push_back(corner);
        return false;
    }

    // Without an ear (collinear corners, an outline that crosses itself) the second corner is cut off.
    unsigned find_ear() {
        for (auto it = unknown_.upper_bound(first_); it != unknown_.end(); it = unknown_.erase(it))
            if (is_ear(*it))
                return *it;
        if (unknown_.erase(first_) && is_ear(first_))
            return first_;
        return next_[first_];
    }
};

bool is_convex(const std::vector<Point2> &points) {
    size_t n = points.size();
    for (size_t i = 0; i < n; ++i)
        if (turn(points[i], points[(i + 1) % n], points[(i + 2) % n]) < 0)
            return false;
    return true;
}

} // namespace

std::vector<std::array<unsigned, 3>> triangulate(const std::vector<Vec3> &corners) {
    std::vector<std::array<unsigned, 3>> triangles;
    unsigned count = static_cast<unsigned>(corners.size());
    std::vector<Point2> points;
    if (count > 3)
        points = projected(corners);
    if (is_convex(points)) {
        for (unsigned i = 2; i < count; ++i)
            triangles.push_back({0, i - 1, i});
        return triangles;
    }
    if (count > max_concave_corners)
        throw Error(fmt::format("a face of {} corners that is not convex: at most {} are cut into triangles; "
                                "triangulate it in the program that wrote the file",
                                count, max_concave_corners));
    Clipper clipper(points);
    for (unsigned i = 3; i < count; ++i)
        triangles.push_back(clipper.clip());
    triangles.push_back(clipper.rest());
    return triangles;
}

} // namespace opal
