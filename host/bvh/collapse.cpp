#include "bvh/collapse.h"

#include <cstdint>

namespace opal {
namespace {

// The dynamic program's table for one node of the binary tree. A forest of i trees stands for the node's subtree: each
// of its roots becomes a wide node or a leaf.
struct ForestTable {
    float cost[node_width]; // cost[i], i = 1 .. 7: the least cost of a forest of at most i trees
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
    Collapser(BinaryTree &tree, const TriangleSoup &soup) : tree_(tree), soup_(soup), tables_(tree.node_count) {
        for (uint i = tree.node_count; i-- > 0;) // children come after their parents
            fill_table(i);
    }

    Bvh emit() {
        bvh_.blocks.reserve(tree_.node_count / 2 + 1); // room for the worst case
        const uint root = emit(0, OPAL_LEVELS);
        if (root & OPAL_LEAF)
            set_child(add_node(), 0, tree_.nodes[0].box, root);
        return std::move(bvh_);
    }

private:
    BinaryTree &tree_;
    const TriangleSoup &soup_;
    std::vector<ForestTable> tables_;
    Bvh bvh_;

    // The most levels of nodes that emit_balanced makes of `count` primitives.
    int balanced_levels(uint count) const {
        int levels = soup_.others.empty() ? 0 : 1; // the last one tells shapes apart
        for (std::uint64_t room = block_size; room < count; room *= node_width)
            levels++;
        return levels;
    }

    bool fits_leaf(uint first, uint count) {
        return count <= block_size && (soup_.others.empty() || !is_mixed(primitives(first, first + count)));
    }

    void fill_table(uint index) {
        const BinaryNode &node = tree_.nodes[index];
        ForestTable &table = tables_[index];
        const float area = node.box.half_area();
        const float leaf = fits_leaf(node.first, node.count) ? area * float(block_cost) : Box::infinity;
        table.levels = 0;
        if (node.left == 0) {
            std::fill(std::begin(table.cost), std::end(table.cost), leaf);
            std::fill(std::begin(table.choice), std::end(table.choice), 0);
            return;
        }
        const float inner = distribute(node, node_width, table.choice[node_width]) + area * float(node_cost);
        table.choice[1] = inner < leaf;
        table.cost[1] = std::min(inner, leaf);
        for (int i = 2; i < node_width; i++) {
            table.cost[i] = distribute(node, i, table.choice[i]);
            if (table.cost[i] < table.cost[i - 1])
                continue;
            table.cost[i] = table.cost[i - 1];
            table.choice[i] = 0;
        }
        if (table.choice[1] == 0)
            return;
        const Roots roots = children_of(index);
        for (int i = 0; i < roots.count; i++)
            table.levels = std::max(table.levels, tables_[roots.index[i]].levels);
        table.levels++;
    }

    // The least cost of a forest of `count` trees from both children. left_share: how many come from the left one.
    float distribute(const BinaryNode &node, int count, unsigned char &left_share) const {
        const float *left = tables_[node.left].cost, *right = tables_[node.left + 1].cost;
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
        const BinaryNode &node = tree_.nodes[index];
        if (tables_[index].choice[1] == 0)
            return emit_leaf(node.first, node.count);
        const Roots roots = children_of(index);
        budget--;
        for (int i = 0; i < roots.count; i++) {
            const uint root = roots.index[i];
            if (std::min<int>(tables_[root].levels, balanced_levels(tree_.nodes[root].count)) > budget)
                return emit_balanced(node.first, node.count);
        }
        const uint place = add_node();
        for (int i = 0; i < roots.count; i++)
            set_child(place, i, tree_.nodes[roots.index[i]].box, emit(roots.index[i], budget));
        return place;
    }

    uint emit_leaf(uint first, uint count) {
        BlockIds ids;
        ids.fill(OPAL_NONE);
        for (uint i = 0; i < count; i++)
            ids[i] = tree_.primitives[first + i].id;
        // Parts of one triangle that meet in a block become one triangle again.
        std::sort(ids.begin(), ids.begin() + count);
        const auto end = std::unique(ids.begin(), ids.begin() + count);
        const uint shape = shape_of(ids[0]);
        if (shape == SHAPE_triangle) {
            bvh_.blocks.push_back(pack_block(soup_, ids.data(), uint(end - ids.begin())));
            return OPAL_LEAF | uint(bvh_.blocks.size() - 1);
        }
        bvh_.other_blocks[shape].push_back(ids);
        return OPAL_LEAF | shape << OPAL_SHAPE_SHIFT | uint(bvh_.other_blocks[shape].size() - 1);
    }

    // Emits a node that has a leaf for each shape of at most block_size primitives.
    uint emit_mixed(uint first, uint count) {
        const uint place = add_node(), end = first + count;
        for (int i = 0; first < end; i++) {
            const auto rest = primitives(first, end);
            const uint shape = shape_of(rest[0].id);
            const auto others = std::partition(rest.begin(), rest.end(),
                                               [&](const BuildPrimitive &p) { return shape_of(p.id) == shape; });
            const uint same = uint(others - rest.begin());
            set_child(place, i, box_of(first, first + same), emit_leaf(first, same));
            first += same;
        }
        return place;
    }

    // Emits the tree of least depth: each node has eight parts of equally many primitives.
    uint emit_balanced(uint first, uint count) {
        if (count <= block_size)
            return fits_leaf(first, count) ? emit_leaf(first, count) : emit_mixed(first, count);
        const uint place = add_node();
        std::array<uint, node_width + 1> ends{first, first + count};
        for (int parts = 1; parts < node_width; parts *= 2) // splits each part in two
            for (int i = parts; i > 0; i--) {
                ends[2 * i] = ends[i];
                ends[2 * i - 1] = ends[i - 1] + uint(halve_at_median(primitives(ends[i - 1], ends[i])));
            }
        for (int i = 0; i < node_width; i++)
            set_child(place, i, box_of(ends[i], ends[i + 1]), emit_balanced(ends[i], ends[i + 1] - ends[i]));
        return place;
    }

    Box box_of(uint begin, uint end) {
        Box box = Box::empty();
        for (const BuildPrimitive &primitive : primitives(begin, end))
            box.add(primitive.box);
        return box;
    }

    std::span<BuildPrimitive> primitives(uint begin, uint end) {
        return std::span(tree_.primitives).subspan(begin, end - begin);
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

Bvh collapse(BinaryTree &tree, const TriangleSoup &soup) { return Collapser(tree, soup).emit(); }

} // namespace opal
