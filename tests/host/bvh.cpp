// The tree against brute force in double, its invariants, and its cost.
#include "bvh/bvh.h"

#include "base/math.h"
#include "bvh/collapse.h"
#include "bvh/reinsertion.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>

using namespace opal;

namespace {

constexpr double infinity = INFINITY;

struct Random {
    std::mt19937 bits;
    explicit Random(unsigned seed) : bits(seed) {}
    float operator()() { return float(bits() >> 8) * 0x1p-24f; } // in [0, 1)
    float around() { return 2 * (*this)() - 1; }                 // in [-1, 1)
    std::array<float, 3> point(float size) { return {size * around(), size * around(), size * around()}; }
};

void add_triangle(TriangleSoup &soup, std::array<float, 3> a, std::array<float, 3> b, std::array<float, 3> c) {
    const uint first = uint(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), {a, b, c});
    soup.corners.push_back({first, first + 1, first + 2});
}

std::array<float, 3> plus(std::array<float, 3> a, std::array<float, 3> b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

TriangleSoup random_soup(unsigned count, float size, unsigned seed) {
    Random random(seed);
    TriangleSoup soup;
    for (unsigned i = 0; i < count; i++) {
        const auto middle = random.point(1);
        add_triangle(soup, plus(middle, random.point(size)), plus(middle, random.point(size)),
                     plus(middle, random.point(size)));
    }
    return soup;
}

// A plane of n x n squares, and a height field of it.
TriangleSoup grid(unsigned n, float height) {
    TriangleSoup soup;
    for (unsigned y = 0; y <= n; y++)
        for (unsigned x = 0; x <= n; x++)
            soup.vertices.push_back(
                {2.f * x / n - 1, 2.f * y / n - 1, height * std::sin(9.f * x / n) * std::cos(7.f * y / n)});
    for (unsigned y = 0; y < n; y++)
        for (unsigned x = 0; x < n; x++) {
            const uint a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            soup.corners.push_back({a, b, d});
            soup.corners.push_back({a, d, c});
        }
    return soup;
}

TriangleSoup nasty(int which) {
    TriangleSoup soup;
    Random random(3);
    for (int i = 0; i < 100; i++) {
        const float f = float(i) / 100;
        switch (which) {
        case 0:
            add_triangle(soup, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
            break; // all the same
        case 1:
            add_triangle(soup, {-f, -f, 0}, {f, -f, 0}, {0, 2 * f + .1f, 0});
            break; // one plane
        case 2:
            add_triangle(soup, {-1, f, 0}, {1, f, 0}, {1, f + 1e-6f, 1e-6f});
            break; // slivers
        case 3:
            add_triangle(soup, {-1 - f, -1, -f}, {1 + f, -1, f}, {0, 2, 0});
            break; // one middle, growing
        case 4:
            add_triangle(soup, {0, 0, std::ldexp(1.f, -i)}, {1, 0, std::ldexp(1.f, -i)}, {0, 1, std::ldexp(1.f, -i)});
            break;
        case 5:
            add_triangle(soup, random.point(1), random.point(1e-4f), random.point(1e-8f));
            break;
        default:
            add_triangle(soup, {f, 0, 0}, {f, 1, 0}, {f, 0, 1});
            break; // parallel, flat boxes
        }
    }
    return soup;
}
constexpr int nasty_count = 7;

// Long, thin and askew: boxes that are mostly empty.
TriangleSoup needles(unsigned count, unsigned seed) {
    Random random(seed);
    TriangleSoup soup;
    for (unsigned i = 0; i < count; i++) {
        const auto end = random.point(1);
        add_triangle(soup, end, plus(end, random.point(0.01f)), random.point(1));
    }
    return soup;
}

// Ever smaller copies of eight clusters around the origin: each level of the tree adds its seven siblings to the stack.
TriangleSoup nested_clusters() {
    TriangleSoup soup;
    Random random(11);
    for (int level = 0; level < 60; level++)
        for (int cluster = 1; cluster < 8; cluster++)
            for (int i = 0; i < 8; i++) {
                const float size = std::ldexp(1.f, -level);
                const std::array<float, 3> middle{cluster & 1 ? size : 0, cluster & 2 ? size : 0,
                                                  cluster & 4 ? size : 0};
                add_triangle(soup, plus(middle, random.point(size / 16)), plus(middle, random.point(size / 16)),
                             plus(middle, random.point(size / 16)));
            }
    return soup;
}

struct Ray {
    Vec3 origin, direction;
};

Vec3 to_vec(const std::array<float, 3> &p) { return {p[0], p[1], p[2]}; }

// Moeller and Trumbore 1997, in double. infinity where there is no hit.
double hit_triangle(const Ray &ray, Vec3 a, Vec3 b, Vec3 c) {
    const Vec3 ab = b - a, ac = c - a, p = cross(ray.direction, ac), s = ray.origin - a, q = cross(s, ab);
    const double determinant = dot(ab, p);
    if (determinant == 0)
        return infinity;
    const double u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant, t = dot(ac, q) / determinant;
    return u >= 0 && v >= 0 && u + v <= 1 && t > 0 ? t : infinity;
}

double hit_brute_force(const Ray &ray, const TriangleSoup &soup) {
    double nearest = infinity;
    for (const auto &[a, b, c] : soup.corners)
        nearest = std::min(
            nearest, hit_triangle(ray, to_vec(soup.vertices[a]), to_vec(soup.vertices[b]), to_vec(soup.vertices[c])));
    return nearest;
}

bool meets_box(const Ray &ray, const BvhNode &node, int child, double nearest) {
    double enter = 0, leave = nearest;
    for (int axis = 0; axis < 3; axis++) {
        const double d = ray.direction[axis], o = ray.origin[axis], lo = node.lo[axis][child],
                     hi = node.hi[axis][child];
        if (d == 0 && (o < lo || o > hi))
            return false;
        if (d == 0)
            continue;
        const double slack = 1e-12 * (std::abs(o) + 1) / std::abs(d); // rounding of this test's own hits
        enter = std::max(enter, ((d < 0 ? hi : lo) - o) / d - slack);
        leave = std::min(leave, ((d < 0 ? lo : hi) - o) / d + slack);
    }
    return enter <= leave;
}

std::vector<TriangleBlock> blocks_of(const Bvh &bvh, const TriangleSoup &soup) {
    std::vector<TriangleBlock> blocks;
    for (const BlockIds &ids : bvh.leaves[SHAPE_triangle])
        blocks.push_back(pack_block(soup, ids));
    return blocks;
}

// The nearest hit by way of the tree.
double hit_tree(const Ray &ray, const Bvh &bvh, const std::vector<TriangleBlock> &blocks) {
    std::vector<uint> stack{0};
    double nearest = infinity;
    while (!stack.empty()) {
        const uint at = stack.back();
        stack.pop_back();
        if (at & OPAL_LEAF) {
            if ((at >> OPAL_SHAPE_SHIFT & OPAL_SHAPE_BITS) != SHAPE_triangle)
                continue;
            const TriangleBlock &block = blocks[at & OPAL_BLOCK_BITS];
            const auto vertex = [&block](int corner, int place) {
                return Vec3{block.vertex[corner][0][place], block.vertex[corner][1][place],
                            block.vertex[corner][2][place]};
            };
            for (int place = 0; place < 8; place++)
                nearest = std::min(nearest, hit_triangle(ray, vertex(0, place), vertex(1, place), vertex(2, place)));
            continue;
        }
        for (int child = 0; child < 8; child++)
            if (meets_box(ray, bvh.nodes[at], child, nearest))
                stack.push_back(bvh.nodes[at].child[child]);
    }
    return nearest;
}

void check_against_brute_force(const TriangleSoup &soup, int rays) {
    const Bvh bvh = build_bvh(soup);
    const std::vector<TriangleBlock> triangle_blocks = blocks_of(bvh, soup);
    Random random(5);
    int hits = 0;
    for (int i = 0; i < rays; i++) {
        // Towards a point of some triangle from anywhere, or along an axis, or anyhow.
        Ray ray{to_vec(random.point(1.5f)), to_vec(random.point(1))};
        if (!soup.corners.empty() && i % 3 == 0) {
            const auto &corners = soup.corners[random.bits() % soup.corners.size()];
            const double u = random(), v = random() * (1 - u);
            const Vec3 a = to_vec(soup.vertices[corners[0]]), b = to_vec(soup.vertices[corners[1]]),
                       c = to_vec(soup.vertices[corners[2]]);
            ray.direction = a * (1 - u - v) + b * u + c * v - ray.origin;
        }
        if (i % 3 == 1)
            ray.direction = {i % 9 == 1 ? 1. : 0., i % 9 == 4 ? -1. : 0., i % 9 == 7 ? 1. : 0.};
        const double expected = hit_brute_force(ray, soup);
        const double found = hit_tree(ray, bvh, triangle_blocks);
        if (found != expected)
            FAIL("ray " << i << ": " << found << ", not " << expected);
        hits += expected < infinity;
    }
    if (!soup.corners.empty())
        CHECK(hits > rays / 10);
}

// Every node and block is reached once. Of whole triangles, too, and boxes hold exactly what is below them; of parts no
// block has two of the same.
struct Structure {
    const TriangleSoup &soup;
    const Bvh &bvh;
    bool whole;
    std::vector<int> triangle_seen = std::vector<int>(soup.corners.size());
    std::vector<int> other_seen = std::vector<int>(soup.others.size()); // in the order of soup.others
    std::size_t nodes = 0, blocks = 0, other_blocks = 0;

    Box visit(uint at) {
        if (at & OPAL_LEAF) {
            const uint shape = at >> OPAL_SHAPE_SHIFT & OPAL_SHAPE_BITS, block = at & OPAL_BLOCK_BITS;
            const BlockIds &ids = bvh.leaves.at(shape).at(block);
            return shape == SHAPE_triangle ? visit_block(pack_block(soup, ids)) : visit_others(shape, ids);
        }
        nodes++;
        Box all = Box::empty();
        const BvhNode &node = bvh.nodes.at(at);
        for (int child = 0; child < 8; child++) {
            const Box box{{node.lo[0][child], node.lo[1][child], node.lo[2][child]},
                          {node.hi[0][child], node.hi[1][child], node.hi[2][child]}};
            if (node.child[child] == OPAL_NONE) {
                if (box.lo != Box::empty().lo || box.hi != Box::empty().hi)
                    FAIL("an unused child has a box");
                continue;
            }
            const Box below = visit(node.child[child]);
            if (whole && (below.lo != box.lo || below.hi != box.hi))
                FAIL("box of child " << child << " of node " << at);
            all.add(box);
        }
        return all;
    }

    Box visit_others(uint shape, const BlockIds &ids) {
        other_blocks++;
        Box box = Box::empty();
        for (std::size_t place = 0; place < ids.size() && ids[place] != OPAL_NONE; place++) {
            const auto other = std::find_if(soup.others.begin(), soup.others.end(),
                                            [&](const BoundedPrimitive &p) { return p.id == ids[place]; });
            if (shape_of(ids[place]) != shape || other == soup.others.end())
                FAIL("primitive " << ids[place] << " in a block of shape " << shape);
            other_seen.at(std::size_t(other - soup.others.begin()))++;
            box.add(other->box);
        }
        if (ids[0] == OPAL_NONE)
            FAIL("an empty block");
        return box;
    }

    Box visit_block(const TriangleBlock &block) {
        blocks++;
        Box box = Box::empty();
        for (int place = 0; place < 8; place++) {
            const uint id = block.id[place];
            if (id != OPAL_NONE)
                triangle_seen.at(id)++;
            if (id != OPAL_NONE && std::count(block.id, block.id + 8, id) != 1)
                FAIL("triangle " << id << " is in a block twice");
            for (int corner = 0; corner < 3; corner++) {
                std::array<float, 3> vertex;
                for (int axis = 0; axis < 3; axis++)
                    vertex[axis] = block.vertex[corner][axis][place];
                if (id != OPAL_NONE)
                    box.add(vertex);
                const auto &expected = id != OPAL_NONE            ? soup.vertices[soup.corners[id][corner]]
                                       : block.id[0] != OPAL_NONE ? soup.vertices[soup.corners[block.id[0]][0]]
                                                                  : std::array<float, 3>{};
                if (vertex != expected)
                    FAIL("vertex of place " << place);
            }
        }
        return box;
    }
};

void check_structure(const TriangleSoup &soup, const Bvh &bvh) {
    const bool whole = split_primitives(soup).size() == soup.corners.size() + soup.others.size();
    Structure structure{soup, bvh, whole};
    structure.visit(0);
    CHECK(structure.nodes == bvh.nodes.size());
    std::size_t leaves = 0;
    for (const auto &of_shape : bvh.leaves)
        leaves += of_shape.size();
    const bool nothing = soup.corners.empty() && soup.others.empty(); // still has an empty block
    CHECK(structure.blocks + structure.other_blocks == (nothing ? 0 : leaves));
    CHECK(structure.other_seen == std::vector<int>(soup.others.size(), 1));
    if (whole)
        CHECK(structure.triangle_seen == std::vector<int>(soup.corners.size(), 1));
    else
        CHECK(std::count(structure.triangle_seen.begin(), structure.triangle_seen.end(), 0) == 0);
    CHECK(levels_of(bvh) <= OPAL_LEVELS);
}

// Builders that do worse: halves of the triangles in the given order, or along the longest axis.
void cut_in_halves(BinaryTree &tree, uint index, bool ordered) {
    BinaryNode &node = tree.nodes[index];
    const auto set = std::span(tree.primitives).subspan(node.first, node.count);
    node.box = Box::empty();
    for (const BuildPrimitive &primitive : set)
        node.box.add(primitive.box);
    node.left = 0;
    if (node.count <= block_size)
        return;
    const uint half = ordered ? uint(halve_at_median(set)) : node.count / 2;
    node.left = tree.node_count;
    tree.node_count += 2;
    tree.nodes[node.left] = {Box::empty(), node.first, half, 0};
    tree.nodes[node.left + 1] = {Box::empty(), node.first + half, node.count - half, 0};
    cut_in_halves(tree, tree.nodes[index].left, ordered);
    cut_in_halves(tree, tree.nodes[index].left + 1, ordered);
}

// The soup with `count` primitives of two other shapes, each around a vertex of it or anywhere.
TriangleSoup with_others(TriangleSoup soup, unsigned count) {
    Random random(count);
    std::array<uint, 2> found{};
    for (unsigned i = 0; i < count; i++) {
        const uint kind = random.bits() % 2;
        const Point3f middle =
            soup.vertices.empty() ? random.point(1) : soup.vertices[random.bits() % soup.vertices.size()];
        Box box = Box::empty();
        box.add(middle);
        box.add(Point3f{0.9f * middle[0], 0.9f * middle[1], 0.9f * middle[2]});
        soup.others.push_back({(SHAPE_triangle + 1 + kind) << OPAL_SHAPE_SHIFT | found[kind]++, box, 0});
    }
    return soup;
}

BinaryTree halves_of(const TriangleSoup &soup, bool ordered) {
    BinaryTree tree = build_binary_tree(whole_primitives(soup)); // for its primitives
    if (!ordered)
        std::shuffle(tree.primitives.begin(), tree.primitives.end(), std::mt19937(1));
    tree.nodes[0] = {Box::empty(), 0, uint(soup.corners.size()), 0};
    tree.node_count = 1;
    cut_in_halves(tree, 0, ordered);
    return tree;
}

double cost_of(BinaryTree &tree, const TriangleSoup &soup) {
    const Bvh bvh = collapse(tree, !soup.others.empty());
    check_structure(soup, bvh);
    return sah_cost(bvh);
}

double cost_of_halves(const TriangleSoup &soup, bool ordered) {
    BinaryTree tree = halves_of(soup, ordered);
    return cost_of(tree, soup);
}

} // namespace

TEST_CASE("closest hits by the tree are those of brute force", "[bvh]") {
    for (unsigned count : {0u, 1u, 2u, 7u, 8u, 9u, 64u, 65u, 500u, 3000u}) {
        INFO(count << " triangles");
        check_against_brute_force(random_soup(count, 0.2f, count), 3000);
        check_structure(random_soup(count, 0.2f, count), build_bvh(random_soup(count, 0.2f, count)));
    }
}

TEST_CASE("nasty triangles", "[bvh]") {
    for (int which = 0; which < nasty_count; which++) {
        INFO("case " << which);
        check_against_brute_force(nasty(which), 1500);
        check_structure(nasty(which), build_bvh(nasty(which)));
    }
}

TEST_CASE("100 000 triangles, and 40 000 whose middles are one", "[bvh]") {
    const TriangleSoup many = random_soup(100000, 0.02f, 1);
    check_structure(many, build_bvh(many));
    check_against_brute_force(many, 60);
    TriangleSoup one_middle;
    for (int i = 0; i < 40000; i++)
        add_triangle(one_middle, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    check_structure(one_middle, build_bvh(one_middle));
}

TEST_CASE("the worst of trees has no more levels than a walk has room for", "[bvh]") {
    const TriangleSoup soup = nested_clusters();
    const Bvh bvh = build_bvh(soup);
    check_structure(soup, bvh);
    CHECK(levels_of(bvh) == OPAL_LEVELS); // it would have had 60
    check_against_brute_force(soup, 500);
}

TEST_CASE("no leaf mixes shapes, and each primitive is in one", "[bvh]") {
    for (unsigned triangles : {0u, 1u, 5u, 60u, 3000u})
        for (unsigned others : {1u, 2u, 7u, 9u, 100u, 2000u}) {
            INFO(triangles << " triangles, " << others << " others");
            const TriangleSoup soup = with_others(random_soup(triangles, 0.2f, triangles), others);
            check_structure(soup, build_bvh(soup));
        }
    const TriangleSoup deep = with_others(nested_clusters(), 300); // a balanced tree takes the place of its depths
    const Bvh bvh = build_bvh(deep);
    check_structure(deep, bvh);
    CHECK(levels_of(bvh) >= OPAL_LEVELS - 1); // the last level is kept for leaves of several shapes
    check_against_brute_force(deep, 500);
}

TEST_CASE("the tree is the same whichever thread builds which part", "[bvh]") {
    const TriangleSoup soup = random_soup(70000, 0.02f, 9);
    const Bvh a = build_bvh(soup), b = build_bvh(soup);
    REQUIRE(a.nodes.size() == b.nodes.size());
    REQUIRE(a.leaves == b.leaves);
}

TEST_CASE("triangles that are left out change nothing about the others' tree", "[bvh]") {
    for (const TriangleSoup &soup : {with_others(random_soup(3000, 0.05f, 2), 50), needles(3000, 6)}) {
        const std::vector<uint> left_out{0, 1, 1000, 2999};
        TriangleSoup rest = soup;
        for (auto id = left_out.rbegin(); id != left_out.rend(); ++id)
            rest.corners.erase(rest.corners.begin() + *id);
        Bvh with_less = build_bvh(soup, left_out);
        const Bvh expected = build_bvh(rest);
        for (BlockIds &ids : with_less.leaves[SHAPE_triangle])
            for (uint &id : ids) // numbered as in `rest`
                id -= id == OPAL_NONE ? 0
                                      : uint(std::lower_bound(left_out.begin(), left_out.end(), id) - left_out.begin());
        CHECK(with_less.leaves == expected.leaves);
        CHECK(sah_cost(with_less) == sah_cost(expected));
    }
}

TEST_CASE("sah_cost of a tree known by hand", "[bvh]") {
    // Two unit squares of eight triangles, far apart: a node of two leaves.
    TriangleSoup soup;
    for (float x : {0.f, 10.f})
        for (int i = 0; i < 8; i++)
            add_triangle(soup, {x, 0, 0}, {x, 1, 0}, {x, i % 2 ? 1.f : 0.f, 1});
    const Bvh bvh = build_bvh(soup);
    CHECK(bvh.nodes.size() == 1);
    CHECK(bvh.leaves[SHAPE_triangle].size() == 2);
    // Half areas: each square 1, the whole box 10 + 10 + 1.
    CHECK(sah_cost(bvh) == Approx(node_cost + 2 * block_cost / 21));
    CHECK(sah_cost(build_bvh(random_soup(1, 1, 1))) == node_cost + block_cost);
}

// The limits are 3 % above the costs that this builder reached when it tried every split of every node (an unlimited
// max_sweep_size).
TEST_CASE("trees cost what good trees cost, and bad ones more", "[bvh]") {
    struct Case {
        const char *name;
        TriangleSoup soup;
        double limit;
    };
    const Case cases[] = {{"soup", random_soup(20000, 0.04f, 2), 1.03 * 29.83},
                          {"plane", grid(100, 0), 1.03 * 5.054},
                          {"hills", grid(100, 0.2f), 1.03 * 7.122}};
    for (const Case &c : cases) {
        const double cost = sah_cost(build_bvh(c.soup)), halves = cost_of_halves(c.soup, true),
                     unordered = cost_of_halves(c.soup, false);
        INFO(c.name << ": " << cost << ", halves along the longest axis " << halves << ", halves in no order "
                    << unordered);
        CHECK(cost <= c.limit);
        CHECK(halves > cost);
        CHECK(unordered > 2 * c.limit);
    }
}

TEST_CASE("reinsertion mends a poor tree and keeps it whole", "[bvh]") {
    // Small things everywhere and a few large ones among them: the large ones should not lie beside small ones.
    TriangleSoup soup = random_soup(5000, 0.02f, 4);
    Random random(8);
    for (int i = 0; i < 50; i++)
        add_triangle(soup, random.point(1), random.point(1), random.point(1));
    BinaryTree poor = halves_of(soup, true), mended = halves_of(soup, true);
    optimise_by_reinsertion(mended);
    CHECK(cost_of(mended, soup) < 0.95 * cost_of(poor, soup)); // 0.925 when written
}

TEST_CASE("the parts of long triangles cover them, and make a cheaper tree that finds the same", "[bvh]") {
    const TriangleSoup soup = needles(3000, 6);
    const LargeVector<BuildPrimitive> whole = whole_primitives(soup), parts = split_primitives(soup);
    REQUIRE(parts.size() > whole.size());
    CHECK(parts.size() < 3 * whole.size());
    std::vector<std::vector<Box>> boxes(soup.corners.size());
    for (const BuildPrimitive &part : parts)
        boxes[part.id].push_back(part.box);
    Random random(7);
    for (int i = 0; i < 100000; i++) {
        const uint id = random.bits() % uint(soup.corners.size());
        const auto &[a, b, c] = soup.corners[id];
        const double u = i % 4 ? random() : i % 8 / 4,
                     v = (i % 3 ? random() : i % 2) * (1 - u); // on corners and sides, too
        const Vec3 p =
            to_vec(soup.vertices[a]) * (1 - u - v) + to_vec(soup.vertices[b]) * u + to_vec(soup.vertices[c]) * v;
        const double rounding = 0x1p-51; // of p, whose coordinates are below 2
        const auto holds = [&](const Box &box) {
            for (int axis = 0; axis < 3; axis++)
                if (p[axis] < box.lo[axis] - rounding || p[axis] > box.hi[axis] + rounding)
                    return false;
            return true;
        };
        if (std::none_of(boxes[id].begin(), boxes[id].end(), holds))
            FAIL("a point of triangle " << id << " is in no box");
    }

    const Bvh bvh = build_bvh(soup);
    check_structure(soup, bvh);
    check_against_brute_force(soup, 3000);
    BinaryTree uncut = build_binary_tree(whole);
    optimise_by_reinsertion(uncut);
    CHECK(sah_cost(bvh) < 0.75 * cost_of(uncut, soup)); // 0.728 when written
}

TEST_CASE("triangles that fill their boxes stay whole", "[bvh]") {
    for (const TriangleSoup &soup : {grid(50, 0), grid(50, 0.2f), random_soup(1000, 0.1f, 3), nasty(0)})
        CHECK(split_primitives(soup).size() == soup.corners.size());
}
