#include "bvh/reinsertion.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace opal {
namespace {

// One of SHARE subtrees is tried, the largest ones, and MOST at most; trying more gained nothing that could be
// measured.
constexpr uint SHARE = 10, MOST = 20000;

class Optimiser {
public:
    explicit Optimiser(BinaryTree &goal) : tree(goal), nodes(goal.nodes.get()), parents(goal.node_count) {
        for (uint i = 0; i < tree.node_count; i++)
            if (nodes[i].left)
                parents[nodes[i].left] = parents[nodes[i].left + 1] = i;
    }

    void run() {
        std::vector<uint> order(tree.node_count);
        std::iota(order.begin(), order.end(), 0u);
        const auto end = order.begin() + std::min(tree.node_count / SHARE, MOST);
        const auto larger = [this](uint a, uint b) {
            const float x = nodes[a].box.half_area(), y = nodes[b].box.half_area();
            return x > y || (x == y && a < b);
        };
        std::nth_element(order.begin(), end, order.end(), larger);
        std::sort(order.begin(), end, larger);
        for (auto node = order.begin(); node != end; ++node)
            if (*node != 0 && parents[*node] != 0)
                try_move(*node); // children of the root stay
        reorder();
    }

private:
    BinaryTree &tree;
    BinaryNode *nodes;
    std::vector<uint> parents;

    struct Place {
        float gain; // of area, from all that lies above
        uint node;
    };
    std::vector<Place> stack;

    static uint sibling(uint node) { return node % 2 ? node + 1 : node - 1; } // pairs start at odd numbers

    void try_move(uint moved) {
        const Box box = nodes[moved].box;
        const float area = box.half_area();
        Place best{0, 0};
        // Climb; at each ancestor look below its other child. `rest` is the ancestor's box without the moved subtree.
        uint pivot = parents[moved], other = sibling(moved);
        Box rest = nodes[other].box;
        float gain = nodes[pivot].box.half_area();
        for (;;) {
            stack.push_back({gain, other});
            while (!stack.empty()) {
                const Place place = stack.back();
                stack.pop_back();
                if (place.gain - area <= best.gain)
                    continue; // a box around it is no smaller than itself
                const BinaryNode &at = nodes[place.node];
                Box merged = at.box;
                merged.add(box);
                const float here = place.gain - merged.half_area();
                if (here > best.gain)
                    best = {here, place.node};
                if (at.left == 0)
                    continue;
                const float below = here + at.box.half_area();
                stack.push_back({below, at.left});
                stack.push_back({below, at.left + 1});
            }
            if (pivot != parents[moved]) {
                rest.add(nodes[other].box);
                gain += nodes[pivot].box.half_area() - rest.half_area();
            }
            if (pivot == 0)
                break;
            other = sibling(pivot);
            pivot = parents[pivot];
        }
        if (best.gain > 0 && best.node != sibling(moved) && best.node != parents[moved])
            move(moved, best.node);
    }

    // The sibling takes the parent's place; the parent's pair of nodes now holds `target` and `moved`, below target's
    // place.
    void move(uint moved, uint target) {
        const uint beside = sibling(moved), parent = parents[moved];
        const BinaryNode left_behind = nodes[beside], old_target = nodes[target];
        nodes[target].left = std::min(moved, beside);
        nodes[beside] = old_target;
        nodes[parent] = left_behind;
        if (old_target.left)
            parents[old_target.left] = parents[old_target.left + 1] = beside;
        if (left_behind.left)
            parents[left_behind.left] = parents[left_behind.left + 1] = parent;
        parents[beside] = parents[moved] = target;
        refit(target);
        refit(parent);
    }

    void refit(uint node) {
        for (;; node = parents[node]) {
            if (const uint left = nodes[node].left) {
                nodes[node].box = nodes[left].box;
                nodes[node].box.add(nodes[left + 1].box);
                nodes[node].count = nodes[left].count + nodes[left + 1].count;
            }
            if (node == 0)
                return;
        }
    }

    // Numbers nodes and references anew: parents before their children, each subtree's references side by side.
    void reorder() {
        auto sorted = std::make_unique_for_overwrite<BinaryNode[]>(tree.node_count);
        std::vector<Reference> references;
        references.reserve(tree.references.size());
        std::vector<std::pair<uint, uint>> todo{{0, 0}}; // from, to
        uint count = 1;
        while (!todo.empty()) {
            const auto [from, to] = todo.back();
            todo.pop_back();
            BinaryNode node = nodes[from];
            const uint first = uint(references.size());
            if (node.left) {
                todo.push_back({node.left + 1, count + 1});
                todo.push_back({node.left, count});
                node.left = std::exchange(count, count + 2);
            } else {
                const auto begin = tree.references.begin() + node.first;
                references.insert(references.end(), begin, begin + node.count);
            }
            node.first = first;
            sorted[to] = node;
        }
        tree.nodes = std::move(sorted);
        tree.references = std::move(references);
    }
};

} // namespace

void optimise_by_reinsertion(BinaryTree &tree) { Optimiser(tree).run(); }

} // namespace opal
