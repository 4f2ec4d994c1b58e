#include "bvh/collapse.h"

#include <cstdint>

namespace opal {
namespace {

// The dynamic program's tables for one node of the binary tree. A forest of i trees stands for the node's subtree: each
// of its roots becomes a wide node or a leaf.

// The least costs of a forest of at most i trees, i = 1 .. 7. They are dropped once those of the parent are known.
using ForestCosts = std::array<float, node_width>;

// The choices that give these costs.
struct ForestTable {
    // choice[1]: 1 if the single root is a wide node, 0 if it is a leaf. choice[i], i = 2 .. 7: how many of the i trees
    // come from the left child; 0 if i - 1 trees cost as little. choice[8]: how many of the eight children of this
    // node's own wide node come from the left child.
    unsigned char choice[node_width + 1];
    unsigned short levels; // of wide nodes from this one down; 0: a leaf
};

// The roots of a forest, as indices of binary nodes.
struct Roots {
    std::array<uint, node_width> index;
    int count = 0;
};

class Collapser {
public:
    Collapser(const BinaryTree &tree, bool has_others)
        : tree_(tree), has_others_(has_others), tables_(tree.node_count) {
        fill_tables();
    }

    Bvh emit() {
        const uint root = emit(0, OPAL_LEVELS);
        if (root & OPAL_LEAF)
            set_child(add_node(), 0, tree_.nodes[0].box, root);
        return std::move(bvh_);
    }

private:
    const BinaryTree &tree_;
    const bool has_others_; // primitives of other shapes than triangles
    LargeVector<ForestTable> tables_;
    Bvh bvh_;

    // The most levels of nodes that emit_balanced makes of `count` primitives.
    int balanced_levels(uint count) const {
        int levels = has_others_ ? 1 : 0; // the last one tells shapes apart
        for (std::uint64_t room = block_size; room < count; room *= node_width)
            levels++;
        return levels;
    }

    bool fits_leaf(uint index) const {
        return tree_.nodes[index].count <= block_size && !(has_others_ && is_mixed(ids_of(index)));
    }

    // Fills the tables of all nodes, children before their parents.
    void fill_tables() {
        struct Visit {
            uint node;
            bool children_done;
        };
        std::vector<Visit> todo{{0, false}};
        std::vector<ForestCosts> costs; // of the subtrees that are done and whose parents are not
        while (!todo.empty()) {
            const auto [index, children_done] = todo.back();
            todo.pop_back();
            const BinaryNode &node = tree_.nodes[index];
            if (node.left && !children_done) {
                todo.push_back({index, true});
                todo.push_back({node.left + 1, false});
                todo.push_back({node.left, false});
                continue;
            }
            const float leaf = fits_leaf(index) ? node.box.half_area() * float(block_cost) : Box::infinity;
            if (node.left) {
                const ForestCosts right = costs.back();
                costs.pop_back();
                costs.back() = fill_table(index, leaf, costs.back(), right);
            } else {
                costs.emplace_back().fill(leaf);
            }
        }
    }

    // Fills the table of an inner node. leaf: its cost as a leaf; left, right: the costs of its children.
    ForestCosts fill_table(uint index, float leaf, const ForestCosts &left, const ForestCosts &right) {
        ForestTable &table = tables_[index];
        ForestCosts cost;
        table.levels = 0;
        const float inner = distribute(left, right, node_width, table.choice[node_width]) +
                            tree_.nodes[index].box.half_area() * float(node_cost);
        table.choice[1] = inner < leaf;
        cost[1] = std::min(inner, leaf);
        for (int i = 2; i < node_width; i++) {
            cost[i] = distribute(left, right, i, table.choice[i]);
            if (cost[i] < cost[i - 1])
                continue;
            cost[i] = cost[i - 1];
            table.choice[i] = 0;
        }
        if (table.choice[1] == 0)
            return cost;
        const Roots roots = children_of(index);
        for (int i = 0; i < roots.count; i++)
            table.levels = std::max(table.levels, tables_[roots.index[i]].levels);
        table.levels++;
        return cost;
    }

    // The least cost of a forest of `count` trees from both children. left_share: how many come from the left one.
    static float distribute(const ForestCosts &left, const ForestCosts &right, int count, unsigned char &left_share) {
        float best = Box::infinity;
        left_share = 1;
        for (int k = 1; k < count; k++)
            if (left[k] + right[count - k] < best) {
                best = left[k] + right[count - k];
                left_share = static_cast<unsigned char>(k);
            }
        return best;
    }

    // Appends the roots of the cheapest forest of at most `count` trees for the subtree of `index`.
    void gather(uint index, int count, Roots &roots) const {
        const ForestTable &table = tables_[index];
        while (count > 1 && table.choice[count] == 0)
            count--;
        if (count == 1) {
            roots.index[roots.count++] = index;
            return;
        }
        gather(tree_.nodes[index].left, table.choice[count], roots);
        gather(tree_.nodes[index].left + 1, count - table.choice[count], roots);
    }

    Roots children_of(uint index) const {
        Roots roots;
        const int left_share = tables_[index].choice[node_width];
        gather(tree_.nodes[index].left, left_share, roots);
        gather(tree_.nodes[index].left + 1, node_width - left_share, roots);
        return roots;
    }

    // Emits the subtree of `index` in at most `budget` levels and returns its child word. The optimal forest or the
    // balanced tree fits: the callers see to that.
    uint emit(uint index, int budget) {
        if (tables_[index].choice[1] == 0)
            return emit_leaf(ids_of(index));
        const Roots roots = children_of(index);
        budget--;
        for (int i = 0; i < roots.count; i++) {
            const uint root = roots.index[i];
            if (std::min<int>(tables_[root].levels, balanced_levels(tree_.nodes[root].count)) > budget) {
                std::vector<BuildPrimitive> set = primitives_of(index);
                return emit_balanced(set);
            }
        }
        const uint place = add_node();
        for (int i = 0; i < roots.count; i++)
            set_child(place, i, tree_.nodes[roots.index[i]].box, emit(roots.index[i], budget));
        return place;
    }

    // The primitives of a subtree, from left to right.
    std::vector<BuildPrimitive> primitives_of(uint index) const {
        std::vector<BuildPrimitive> found;
        found.reserve(tree_.nodes[index].count);
        std::vector<uint> todo{index};
        while (!todo.empty()) {
            const BinaryNode &node = tree_.nodes[todo.back()];
            todo.pop_back();
            if (node.left) {
                todo.push_back(node.left + 1);
                todo.push_back(node.left);
            } else {
                const auto begin = tree_.primitives.begin() + node.first;
                found.insert(found.end(), begin, begin + node.count);
            }
        }
        return found;
    }

    // The ids of the primitives of a subtree of at most block_size of them.
    BlockIds ids_of(uint index) const {
        BlockIds ids;
        ids.fill(OPAL_NONE);
        add_ids(index, ids.begin());
        return ids;
    }
    uint *add_ids(uint index, uint *place) const {
        const BinaryNode &node = tree_.nodes[index];
        if (node.left)
            return add_ids(node.left + 1, add_ids(node.left, place));
        for (uint i = 0; i < node.count; i++)
            *place++ = tree_.primitives[node.first + i].id;
        return place;
    }
    static BlockIds ids_of(PrimitiveSpan set) {
        BlockIds ids;
        ids.fill(OPAL_NONE);
        std::ranges::transform(set, ids.begin(), &BuildPrimitive::id);
        return ids;
    }

    static bool is_mixed(const BlockIds &ids) {
        return std::ranges::any_of(ids, [&](uint id) { return id != OPAL_NONE && shape_of(id) != shape_of(ids[0]); });
    }

    uint emit_leaf(BlockIds ids) {
        // Parts of one triangle that meet in a block become one triangle again. OPAL_NONE is the largest number.
        std::ranges::sort(ids);
        std::fill(std::unique(ids.begin(), ids.end()), ids.end(), OPAL_NONE);
        const uint shape = shape_of(ids[0]);
        bvh_.leaves[shape].push_back(ids);
        return OPAL_LEAF | shape << OPAL_SHAPE_SHIFT | uint(bvh_.leaves[shape].size() - 1);
    }

    // Emits a node that has a leaf for each shape of at most block_size primitives.
    uint emit_mixed(PrimitiveSpan rest) {
        const uint place = add_node();
        for (int i = 0; !rest.empty(); i++) {
            const uint shape = shape_of(rest[0].id);
            const auto others = std::partition(rest.begin(), rest.end(),
                                               [&](const BuildPrimitive &p) { return shape_of(p.id) == shape; });
            const PrimitiveSpan same(rest.begin(), others);
            set_child(place, i, box_of(same), emit_leaf(ids_of(same)));
            rest = {others, rest.end()};
        }
        return place;
    }

    // Emits the tree of least depth: each node has eight parts of equally many primitives.
    uint emit_balanced(PrimitiveSpan set) {
        if (set.size() <= block_size)
            return is_mixed(ids_of(set)) ? emit_mixed(set) : emit_leaf(ids_of(set));
        const uint place = add_node();
        std::array<std::size_t, node_width + 1> ends{0, set.size()};
        for (int parts = 1; parts < node_width; parts *= 2) // splits each part in two
            for (int i = parts; i > 0; i--) {
                ends[2 * i] = ends[i];
                ends[2 * i - 1] = ends[i - 1] + halve_at_median(set.subspan(ends[i - 1], ends[i] - ends[i - 1]));
            }
        for (int i = 0; i < node_width; i++) {
            const PrimitiveSpan part = set.subspan(ends[i], ends[i + 1] - ends[i]);
            set_child(place, i, box_of(part), emit_balanced(part));
        }
        return place;
    }

    static Box box_of(PrimitiveSpan set) {
        Box box = Box::empty();
        for (const BuildPrimitive &primitive : set)
            box.add(primitive.box);
        return box;
    }

    uint add_node() {
        bvh_.nodes.push_back(empty_node());
        return uint(bvh_.nodes.size() - 1);
    }

    void set_child(uint place, int i, const Box &box, uint child) {
        for (int axis = 0; axis < 3; axis++) {
            bvh_.nodes[place].lo[axis][i] = box.lo[axis];
            bvh_.nodes[place].hi[axis][i] = box.hi[axis];
        }
        bvh_.nodes[place].child[i] = child;
    }
};

} // namespace

Bvh collapse(const BinaryTree &tree, bool has_others) { return Collapser(tree, has_others).emit(); }

} // namespace opal
