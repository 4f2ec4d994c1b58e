#include "bvh/binary_tree.h"

#include <atomic>
#include <cassert>
#include <cmath>
#include <thread>

namespace opal {
namespace {

constexpr int BINS = 32;
constexpr std::size_t SWEEP_SIZE = 64;     // up to here every split is tried
constexpr std::size_t THREAD_SIZE = 15000; // from here on both parts may get threads of their own
constexpr int DEEPEST_SAH = 90;            // from this depth on splits halve the set, so that depth stays bounded

using References = std::span<Reference>;

float blocks(std::size_t count) { return float((count + BLOCK_SIZE - 1) / BLOCK_SIZE); }

// A way to cut a set in two: the first `left` of it once it is ordered.
struct Split {
    float cost = Box::INF;
    int axis = -1;
    std::size_t left = 0;
    int bin = 0; // binned: first bin of the right part
};

struct Binning {
    std::array<float, 3> origin, factor; // factor 0: the set has no extent along this axis
    explicit Binning(const Box &middles) {
        for (int axis = 0; axis < 3; axis++) {
            origin[axis] = middles.lo[axis];
            factor[axis] = float(BINS) / (middles.hi[axis] - middles.lo[axis]);
            if (!std::isfinite(factor[axis]))
                factor[axis] = 0;
        }
    }
    int bin(const Reference &reference, int axis) const {
        return std::min(BINS - 1, int((reference.box.middle2(axis) - origin[axis]) * factor[axis]));
    }
};

struct Bin {
    Box box = Box::empty();
    uint count = 0;
    void add(const Bin &other) {
        box.add(other.box);
        count += other.count;
    }
    float cost() const { return box.half_area() * blocks(count); }
};

// The best cut between two bins of one axis, if it is better than `best`. A cut with an empty side is none.
void best_of_bins(const std::array<Bin, BINS> &bins, int axis, Split &best) {
    std::array<float, BINS> right_cost;
    Bin right, left;
    for (int i = BINS - 1; i > 0; i--) {
        right.add(bins[i]);
        right_cost[i] = right.count ? right.cost() : Box::INF;
    }
    for (int i = 1; i < BINS; i++) {
        left.add(bins[i - 1]);
        if (left.count == 0)
            continue;
        const float cost = left.cost() + right_cost[i];
        if (cost < best.cost)
            best = {cost, axis, left.count, i};
    }
}

Box middles_of(References set) {
    Box middles = Box::empty();
    for (const Reference &r : set)
        middles.add(r.box.middle2());
    return middles;
}

Split split_binned(References set) {
    const Binning binning(middles_of(set));
    std::array<std::array<Bin, BINS>, 3> bins;
    for (const Reference &reference : set)
        for (int axis = 0; axis < 3; axis++) {
            Bin &bin = bins[axis][binning.bin(reference, axis)];
            bin.box.add(reference.box);
            bin.count++;
        }
    Split best;
    for (int axis = 0; axis < 3; axis++)
        if (binning.factor[axis] > 0)
            best_of_bins(bins[axis], axis, best);
    if (best.axis >= 0)
        std::partition(set.begin(), set.end(),
                       [&](const Reference &r) { return binning.bin(r, best.axis) < best.bin; });
    return best;
}

// Tries every split along every axis, and orders the set by the best one.
Split split_swept(References set) {
    struct Key {
        float middle;
        uint index;
        bool operator<(const Key &other) const {
            return middle < other.middle || (middle == other.middle && index < other.index);
        }
    };
    std::array<std::array<Key, SWEEP_SIZE>, 3> order;
    std::array<float, SWEEP_SIZE> right_cost;
    const std::size_t count = set.size();
    Split best;
    for (int axis = 0; axis < 3; axis++) {
        const auto keys = std::span(order[axis]).first(count);
        for (uint i = 0; i < count; i++)
            keys[i] = {set[i].box.middle2(axis), i};
        std::sort(keys.begin(), keys.end());
        Box right = Box::empty(), left = Box::empty();
        for (std::size_t i = count - 1; i > 0; i--) {
            right.add(set[keys[i].index].box);
            right_cost[i] = right.half_area() * blocks(count - i);
        }
        for (std::size_t i = 1; i < count; i++) {
            left.add(set[keys[i - 1].index].box);
            const float cost = left.half_area() * blocks(i) + right_cost[i];
            if (cost < best.cost)
                best = {cost, axis, i, 0};
        }
    }
    std::array<Reference, SWEEP_SIZE> copy;
    std::copy(set.begin(), set.end(), copy.begin());
    for (std::size_t i = 0; i < count; i++)
        set[i] = copy[order[best.axis][i].index];
    return best;
}

class Builder {
public:
    explicit Builder(BinaryTree &goal)
        : tree(goal), idle_threads(int(std::max(1u, std::thread::hardware_concurrency())) - 1) {}

    void build(uint index, int depth) {
        BinaryNode &node = tree.nodes[index];
        const References set = std::span(tree.references).subspan(node.first, node.count);
        for (const Reference &reference : set)
            node.box.add(reference.box);
        const std::size_t left_count = split(set, node.box, depth);
        if (left_count == 0)
            return;
        node.left = node_count.fetch_add(2);
        start(node.left, node.first, uint(left_count));
        start(node.left + 1, node.first + uint(left_count), node.count - uint(left_count));
        const uint left = node.left, smaller = std::min(uint(left_count), node.count - uint(left_count));
        if (smaller >= THREAD_SIZE && take_thread()) {
            std::thread other([this, left, depth] {
                build(left, depth + 1);
                idle_threads++;
            });
            build(left + 1, depth + 1);
            other.join();
        } else {
            build(left, depth + 1);
            build(left + 1, depth + 1);
        }
    }
    void start(uint index, uint first, uint count) { tree.nodes[index] = {Box::empty(), first, count, 0}; }

    BinaryTree &tree;
    std::atomic<uint> node_count{1};

private:
    std::atomic<int> idle_threads;

    bool take_thread() {
        int idle = idle_threads;
        while (idle > 0)
            if (idle_threads.compare_exchange_weak(idle, idle - 1))
                return true;
        return false;
    }

    // Orders the set and returns how many of it go to the left; 0: it stays together.
    static std::size_t split(References set, const Box &box, int depth) {
        if (set.size() == 1)
            return 0;
        Split found;
        if (depth < DEEPEST_SAH)
            found = set.size() <= SWEEP_SIZE ? split_swept(set) : split_binned(set);
        if (set.size() <= BLOCK_SIZE)
            return found.cost < box.half_area() ? found.left : 0;
        return found.axis < 0 ? halve(set) : found.left; // too deep, or all middles are one
    }
};

} // namespace

std::size_t halve(References set) {
    const Box middles = middles_of(set);
    int axis = 0;
    for (int other = 1; other < 3; other++)
        if (middles.hi[other] - middles.lo[other] > middles.hi[axis] - middles.lo[axis])
            axis = other;
    const std::size_t half = (set.size() + 1) / 2;
    std::nth_element(
        set.begin(), set.begin() + std::ptrdiff_t(half), set.end(),
        [axis](const Reference &a, const Reference &b) { return a.box.middle2(axis) < b.box.middle2(axis); });
    return half;
}

BinaryTree build_binary_tree(std::vector<Reference> references) {
    assert(!references.empty());
    const uint count = uint(references.size());
    BinaryTree tree;
    tree.references = std::move(references);
    // Room for the worst case; pages that are never written cost nothing.
    tree.nodes = std::make_unique_for_overwrite<BinaryNode[]>(2 * std::size_t(count));
    Builder builder(tree);
    builder.start(0, 0, count);
    builder.build(0, 0);
    tree.node_count = builder.node_count;
    return tree;
}

} // namespace opal
