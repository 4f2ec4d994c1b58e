#include "bvh/collapse.h"

#include <cstdint>

namespace opal {
namespace {

// For a node of the binary tree and i = 1 .. 7: the least cost of covering it by at most i wide nodes or leaves.
// choice[1]: 1 a wide node, 0 a leaf. choice[i], i = 2 .. 7: how many of the i go to its left child; 0: i - 1 are as
// good. choice[8]: how many of the eight children of its own wide node go to the left.
struct Cover {
    float cost[WIDTH];
    unsigned char choice[WIDTH + 1];
    unsigned short levels; // of wide nodes, this one and below; 0: a leaf
};

struct Roots {
    std::array<uint, WIDTH> index;
    int count = 0;
};

// Levels of nodes that a tree of halves needs.
int balanced_levels(uint count) {
    int levels = 0;
    for (std::uint64_t room = BLOCK_SIZE; room < count; room *= WIDTH)
        levels++;
    return levels;
}

class Collapse {
public:
    Collapse(BinaryTree &from, const TriangleSoup &triangles) : tree(from), soup(triangles), covers(from.node_count) {
        for (uint i = tree.node_count; i-- > 0;)
            find_cover(i); // children come after their parents
    }

    Bvh emit() {
        bvh.blocks.reserve(tree.node_count / 2 + 1); // room for the worst case
        const uint root = emit(0, OPAL_LEVELS);
        if (root & OPAL_LEAF)
            set_child(add_node(), 0, tree.nodes[0].box, root);
        return std::move(bvh);
    }

private:
    BinaryTree &tree;
    const TriangleSoup &soup;
    std::vector<Cover> covers;
    Bvh bvh;

    void find_cover(uint index) {
        const BinaryNode &node = tree.nodes[index];
        Cover &cover = covers[index];
        const float area = node.box.half_area();
        const float leaf = node.count <= BLOCK_SIZE ? area * float(BLOCK_COST) : Box::INF;
        cover.levels = 0;
        if (node.left == 0) {
            std::fill(std::begin(cover.cost), std::end(cover.cost), leaf);
            std::fill(std::begin(cover.choice), std::end(cover.choice), 0);
            return;
        }
        const float inner = distribute(node, WIDTH, cover.choice[WIDTH]) + area * float(NODE_COST);
        cover.choice[1] = inner < leaf;
        cover.cost[1] = std::min(inner, leaf);
        for (int i = 2; i < WIDTH; i++) {
            cover.cost[i] = distribute(node, i, cover.choice[i]);
            if (cover.cost[i] < cover.cost[i - 1])
                continue;
            cover.cost[i] = cover.cost[i - 1];
            cover.choice[i] = 0;
        }
        if (cover.choice[1] == 0)
            return;
        const Roots roots = children_of(index);
        for (int i = 0; i < roots.count; i++)
            cover.levels = std::max(cover.levels, covers[roots.index[i]].levels);
        cover.levels++;
    }

    // Least cost of sharing `count` roots between both children, and how many the left one gets.
    float distribute(const BinaryNode &node, int count, unsigned char &left_share) const {
        const float *left = covers[node.left].cost, *right = covers[node.left + 1].cost;
        float best = Box::INF;
        left_share = 1;
        for (int k = 1; k < count; k++)
            if (left[k] + right[count - k] < best) {
                best = left[k] + right[count - k];
                left_share = static_cast<unsigned char>(k);
            }
        return best;
    }

    // Appends the roots that cover `index` by at most `count`.
    void gather(uint index, int count, Roots &roots) const {
        const Cover &cover = covers[index];
        while (count > 1 && cover.choice[count] == 0)
            count--;
        if (count == 1) {
            roots.index[roots.count++] = index;
            return;
        }
        gather(tree.nodes[index].left, cover.choice[count], roots);
        gather(tree.nodes[index].left + 1, count - cover.choice[count], roots);
    }

    Roots children_of(uint index) const {
        Roots roots;
        const int left_share = covers[index].choice[WIDTH];
        gather(tree.nodes[index].left, left_share, roots);
        gather(tree.nodes[index].left + 1, WIDTH - left_share, roots);
        return roots;
    }

    // `budget`: levels left. Either the cover fits it or halves do.
    uint emit(uint index, int budget) {
        const BinaryNode &node = tree.nodes[index];
        if (covers[index].choice[1] == 0)
            return emit_leaf(node.first, node.count);
        const Roots roots = children_of(index);
        budget--;
        for (int i = 0; i < roots.count; i++) {
            const uint root = roots.index[i];
            if (std::min<int>(covers[root].levels, balanced_levels(tree.nodes[root].count)) > budget)
                return emit_halves(node.first, node.count);
        }
        const uint place = add_node();
        for (int i = 0; i < roots.count; i++)
            set_child(place, i, tree.nodes[roots.index[i]].box, emit(roots.index[i], budget));
        return place;
    }

    uint emit_leaf(uint first, uint count) {
        std::array<uint, BLOCK_SIZE> ids;
        for (uint i = 0; i < count; i++)
            ids[i] = tree.references[first + i].triangle;
        // Parts of a triangle that came together are one again.
        std::sort(ids.begin(), ids.begin() + count);
        count = uint(std::unique(ids.begin(), ids.begin() + count) - ids.begin());
        bvh.blocks.push_back(pack_block(soup, ids.data(), count));
        return OPAL_LEAF | uint(bvh.blocks.size() - 1);
    }

    // The tree of least depth: eight parts of the same number of triangles, and so on.
    uint emit_halves(uint first, uint count) {
        if (count <= BLOCK_SIZE)
            return emit_leaf(first, count);
        const uint place = add_node();
        std::array<uint, WIDTH + 1> ends{first, first + count};
        for (int parts = 1; parts < WIDTH; parts *= 2) // each part becomes two
            for (int i = parts; i > 0; i--) {
                ends[2 * i] = ends[i];
                ends[2 * i - 1] = ends[i - 1] + uint(halve(references(ends[i - 1], ends[i])));
            }
        for (int i = 0; i < WIDTH; i++) {
            Box box = Box::empty();
            for (const Reference &reference : references(ends[i], ends[i + 1]))
                box.add(reference.box);
            set_child(place, i, box, emit_halves(ends[i], ends[i + 1] - ends[i]));
        }
        return place;
    }

    std::span<Reference> references(uint begin, uint end) {
        return std::span(tree.references).subspan(begin, end - begin);
    }

    uint add_node() {
        bvh.nodes.push_back(empty_node());
        return uint(bvh.nodes.size() - 1);
    }

    void set_child(uint place, int i, const Box &box, uint child) {
        for (int axis = 0; axis < 3; axis++) {
            bvh.nodes[place].lo[axis][i] = box.lo[axis];
            bvh.nodes[place].hi[axis][i] = box.hi[axis];
        }
        bvh.nodes[place].child[i] = child;
    }
};

} // namespace

Bvh collapse(BinaryTree &tree, const TriangleSoup &soup) { return Collapse(tree, soup).emit(); }

} // namespace opal
