#include "bvh/reinsertion.h"

#include <algorithm>
#include <numeric>
#include <vector>

namespace opal {
namespace {

// The largest tenth of the subtrees is tried, but no more than max_tried; trying more gained nothing measurable.
constexpr uint tried_divisor = 10, max_tried = 20000;

class Optimiser {
public:
    explicit Optimiser(BinaryTree &tree) : tree_(tree), nodes_(tree.nodes.get()), parents_(tree.node_count) {
        for (uint i = 0; i < tree_.node_count; i++)
            if (nodes_[i].left)
                parents_[nodes_[i].left] = parents_[nodes_[i].left + 1] = i;
    }

    void run() {
        std::vector<uint> order(tree_.node_count);
        std::iota(order.begin(), order.end(), 0u);
        const auto end = order.begin() + std::min(tree_.node_count / tried_divisor, max_tried);
        const auto larger = [this](uint a, uint b) {
            const float x = nodes_[a].box.half_area(), y = nodes_[b].box.half_area();
            return x > y || (x == y && a < b);
        };
        std::nth_element(order.begin(), end, order.end(), larger);
        std::sort(order.begin(), end, larger);
        for (auto node = order.begin(); node != end; ++node)
            if (*node != 0 && parents_[*node] != 0)
                try_move(*node); // children of the root stay
    }

private:
    BinaryTree &tree_;
    BinaryNode *nodes_;
    std::vector<uint> parents_;

    // A node beside which the moved subtree could be inserted.
    struct Insertion {
        float gain; // decrease of the sum of areas, before the new parent's own area is added
        uint node;
    };
    std::vector<Insertion> stack_;

    static uint sibling(uint node) { return node % 2 ? node + 1 : node - 1; } // pairs start at odd numbers

    void try_move(uint moved) {
        const Box box = nodes_[moved].box;
        const float area = box.half_area();
        Insertion best{0, 0};
        // Climbs to the root and searches below the other child of each ancestor. `rest` is the ancestor's box without
        // the moved subtree.
        uint pivot = parents_[moved], other = sibling(moved);
        Box rest = nodes_[other].box;
        float gain = nodes_[pivot].box.half_area();
        for (;;) {
            stack_.push_back({gain, other});
            while (!stack_.empty()) {
                const Insertion insertion = stack_.back();
                stack_.pop_back();
                if (insertion.gain - area <= best.gain)
                    continue; // the merged box is at least as large as the moved one
                const BinaryNode &node = nodes_[insertion.node];
                Box merged = node.box;
                merged.add(box);
                const float here = insertion.gain - merged.half_area();
                if (here > best.gain)
                    best = {here, insertion.node};
                if (node.left == 0)
                    continue;
                const float below = here + node.box.half_area();
                stack_.push_back({below, node.left});
                stack_.push_back({below, node.left + 1});
            }
            if (pivot != parents_[moved]) {
                rest.add(nodes_[other].box);
                gain += nodes_[pivot].box.half_area() - rest.half_area();
            }
            if (pivot == 0)
                break;
            other = sibling(pivot);
            pivot = parents_[pivot];
        }
        if (best.gain > 0 && best.node != sibling(moved) && best.node != parents_[moved])
            move(moved, best.node);
    }

    // The sibling moves up into its parent's place. The pair of nodes that this leaves free below `target` then holds
    // target's old contents and the moved subtree.
    void move(uint moved, uint target) {
        const uint other = sibling(moved), parent = parents_[moved];
        const BinaryNode old_sibling = nodes_[other], old_target = nodes_[target];
        nodes_[target].left = std::min(moved, other);
        nodes_[other] = old_target;
        nodes_[parent] = old_sibling;
        if (old_target.left)
            parents_[old_target.left] = parents_[old_target.left + 1] = other;
        if (old_sibling.left)
            parents_[old_sibling.left] = parents_[old_sibling.left + 1] = parent;
        parents_[other] = parents_[moved] = target;
        refit(target);
        refit(parent);
    }

    // Recomputes boxes and counts from `node` up to the root.
    void refit(uint node) {
        for (;; node = parents_[node]) {
            if (const uint left = nodes_[node].left) {
                nodes_[node].box = nodes_[left].box;
                nodes_[node].box.add(nodes_[left + 1].box);
                nodes_[node].count = nodes_[left].count + nodes_[left + 1].count;
            }
            if (node == 0)
                return;
        }
    }
};

} // namespace

void optimise_by_reinsertion(BinaryTree &tree) { Optimiser(tree).run(); }

} // namespace opal
