#include "bvh/binary_tree.h"

#include <atomic>
#include <cassert>
#include <cmath>
#include <thread>

namespace opal {
namespace {

constexpr int bin_count = 32;
constexpr std::size_t max_sweep_size = 64;     // largest set of which every split is tried
constexpr std::size_t min_thread_size = 15000; // both parts of a split may get their own threads from this size on
constexpr int max_sah_depth = 90;              // deeper splits halve the set, which bounds the depth

// Whether primitives are of different shapes, so that they fit no leaf.
bool is_mixed(PrimitiveSpan set) {
    return std::any_of(set.begin(), set.end(),
                       [&](const BuildPrimitive &p) { return shape_of(p.id) != shape_of(set[0].id); });
}

float blocks_for(std::size_t count) { return float((count + block_size - 1) / block_size); }

// A split of a set along an axis.
struct Split {
    float cost = Box::infinity;
    int axis = -1;              // -1: no split was found
    std::size_t left_count = 0; // primitives of the left part
    int bin = 0;                // first bin of the right part, for a binned split
};

// Maps the centres of primitives to bins of equal width (Wald 2007, "On fast Construction of SAH-based Bounding Volume
// Hierarchies").
struct Binning {
    Point3f origin, factor; // factor 0: the centres have no extent along this axis
    explicit Binning(const Box &centers) {
        for (int axis = 0; axis < 3; axis++) {
            origin[axis] = centers.lo[axis];
            factor[axis] = float(bin_count) / (centers.hi[axis] - centers.lo[axis]);
            if (!std::isfinite(factor[axis]))
                factor[axis] = 0;
        }
    }
    int bin(const BuildPrimitive &primitive, int axis) const {
        return std::min(bin_count - 1, int((primitive.box.twice_center(axis) - origin[axis]) * factor[axis]));
    }
};

struct Bin {
    Box box = Box::empty();
    uint count = 0;
    void add(const Bin &other) {
        box.add(other.box);
        count += other.count;
    }
    float cost() const { return box.half_area() * blocks_for(count); }
};

// Updates `best` with the best split between two bins of one axis. Both parts must have primitives.
void improve_by_bins(const std::array<Bin, bin_count> &bins, int axis, Split &best) {
    std::array<float, bin_count> right_cost;
    Bin right, left;
    for (int i = bin_count - 1; i > 0; i--) {
        right.add(bins[i]);
        right_cost[i] = right.count ? right.cost() : Box::infinity;
    }
    for (int i = 1; i < bin_count; i++) {
        left.add(bins[i - 1]);
        if (left.count == 0)
            continue;
        const float cost = left.cost() + right_cost[i];
        if (cost < best.cost)
            best = {cost, axis, left.count, i};
    }
}

// The box of the doubled centres.
Box center_bounds(PrimitiveSpan set) {
    Box centers = Box::empty();
    for (const BuildPrimitive &r : set)
        centers.add(r.box.twice_center());
    return centers;
}

// Finds the best split between bins and partitions the set by it.
Split split_binned(PrimitiveSpan set) {
    const Binning binning(center_bounds(set));
    std::array<std::array<Bin, bin_count>, 3> bins;
    for (const BuildPrimitive &primitive : set)
        for (int axis = 0; axis < 3; axis++) {
            Bin &bin = bins[axis][binning.bin(primitive, axis)];
            bin.box.add(primitive.box);
            bin.count++;
        }
    Split best;
    for (int axis = 0; axis < 3; axis++)
        if (binning.factor[axis] > 0)
            improve_by_bins(bins[axis], axis, best);
    if (best.axis >= 0)
        std::partition(set.begin(), set.end(),
                       [&](const BuildPrimitive &r) { return binning.bin(r, best.axis) < best.bin; });
    return best;
}

// Tries every split along every axis (sweep SAH) and orders the set by the best one.
Split split_swept(PrimitiveSpan set) {
    struct Key {
        float center;
        uint index;
        bool operator<(const Key &other) const {
            return center < other.center || (center == other.center && index < other.index);
        }
    };
    std::array<std::array<Key, max_sweep_size>, 3> order;
    std::array<float, max_sweep_size> right_cost;
    const std::size_t count = set.size();
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        const auto keys = std::span(order[axis]).first(count);
        for (uint i = 0; i < count; i++)
            keys[i] = {set[i].box.twice_center(axis), i};
        std::sort(keys.begin(), keys.end());
        Box right = Box::empty(), left = Box::empty();
        for (std::size_t i = count - 1; i > 0; i--) {
            right.add(set[keys[i].index].box);
            right_cost[i] = right.half_area() * blocks_for(count - i);
        }
        for (std::size_t i = 1; i < count; i++) {
            left.add(set[keys[i - 1].index].box);
            const float cost = left.half_area() * blocks_for(i) + right_cost[i];
            if (cost < best.cost)
                best = {cost, axis, i, 0};
        }
    }
    std::array<BuildPrimitive, max_sweep_size> copy;
    std::copy(set.begin(), set.end(), copy.begin());
    for (std::size_t i = 0; i < count; i++)
        set[i] = copy[order[best.axis][i].index];
    return best;
}

class Builder {
public:
    explicit Builder(BinaryTree &tree)
        : tree_(tree), idle_threads_(int(std::max(1u, std::thread::hardware_concurrency())) - 1) {}

    // Builds the subtree of a node whose range is set.
    void build(uint index, int depth) {
        BinaryNode &node = tree_.nodes[index];
        const PrimitiveSpan set = std::span(tree_.primitives).subspan(node.first, node.count);
        for (const BuildPrimitive &primitive : set)
            node.box.add(primitive.box);
        const std::size_t left_count = split(set, node.box, depth);
        if (left_count == 0)
            return;
        node.left = node_count_.fetch_add(2);
        init_node(node.left, node.first, uint(left_count));
        init_node(node.left + 1, node.first + uint(left_count), node.count - uint(left_count));
        const uint left = node.left, smaller = std::min(uint(left_count), node.count - uint(left_count));
        if (smaller >= min_thread_size && take_thread()) {
            std::thread other([this, left, depth] {
                build(left, depth + 1);
                idle_threads_++;
            });
            build(left + 1, depth + 1);
            other.join();
        } else {
            build(left, depth + 1);
            build(left + 1, depth + 1);
        }
    }
    void init_node(uint index, uint first, uint count) { tree_.nodes[index] = {Box::empty(), first, count, 0}; }
    uint node_count() const { return node_count_; }

private:
    BinaryTree &tree_;
    std::atomic<uint> node_count_{1};
    std::atomic<int> idle_threads_;

    bool take_thread() {
        int idle = idle_threads_;
        while (idle > 0)
            if (idle_threads_.compare_exchange_weak(idle, idle - 1))
                return true;
        return false;
    }

    // Partitions the set and returns the size of the left part; 0: the node stays a leaf.
    static std::size_t split(PrimitiveSpan set, const Box &box, int depth) {
        if (set.size() == 1)
            return 0;
        Split best;
        if (depth < max_sah_depth)
            best = set.size() <= max_sweep_size ? split_swept(set) : split_binned(set);
        if (set.size() <= block_size && !is_mixed(set))
            return best.cost < box.half_area() ? best.left_count : 0;
        return best.axis < 0 ? halve_at_median(set) : best.left_count; // too deep, or all centres are equal
    }
};

} // namespace

std::size_t halve_at_median(PrimitiveSpan set) {
    const Box centers = center_bounds(set);
    int axis = 0;
    for (int other = 1; other < 3; other++)
        if (centers.hi[other] - centers.lo[other] > centers.hi[axis] - centers.lo[axis])
            axis = other;
    const std::size_t half = (set.size() + 1) / 2;
    std::nth_element(set.begin(), set.begin() + std::ptrdiff_t(half), set.end(),
                     [axis](const BuildPrimitive &a, const BuildPrimitive &b) {
                         return a.box.twice_center(axis) < b.box.twice_center(axis);
                     });
    return half;
}

BinaryTree build_binary_tree(LargeVector<BuildPrimitive> primitives) {
    assert(!primitives.empty());
    const uint count = uint(primitives.size());
    BinaryTree tree;
    tree.primitives = std::move(primitives);
    // The worst case is a leaf for each primitive; pages that are never written cost no memory.
    tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(2 * std::size_t(count));
    advise_huge_pages(tree.nodes.get(), 2 * std::size_t(count) * sizeof(BinaryNode));
    Builder builder(tree);
    builder.init_node(0, 0, count);
    builder.build(0, 0);
    tree.node_count = builder.node_count();
    return tree;
}

} // namespace opal
