#include "flatten/bvh.h"

#include "flatten/binary_tree.h"

#include <utility>

namespace opal {
namespace {

constexpr int WIDTH = 8;

// For a node of the binary tree and i = 1 .. 7: the least cost of covering it by at most i wide nodes or leaves.
// choice[1]: 1 a wide node, 0 a leaf. choice[i], i = 2 .. 7: how many of the i go to its left child; 0: i - 1 are as good.
// choice[8]: how many of the eight children of its own wide node go to the left.
struct Cover {
    float cost[WIDTH];
    unsigned char choice[WIDTH + 1];
};

class Collapse {
public:
    Collapse(const BinaryTree &from, const TriangleSoup &triangles) : tree(from), soup(triangles), covers(from.node_count) {
        for (uint i = tree.node_count; i-- > 0;) find_cover(i); // children come after their parents
    }

    Bvh emit() {
        bvh.root = emit(0);
        return std::move(bvh);
    }

private:
    const BinaryTree &tree;
    const TriangleSoup &soup;
    std::vector<Cover> covers;
    Bvh bvh;

    void find_cover(uint index) {
        const BinaryNode &node = tree.nodes[index];
        Cover &cover = covers[index];
        const float area = node.box.half_area();
        const float leaf = node.count <= BLOCK_SIZE ? area * float(BLOCK_COST) : Box::INF;
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
            if (cover.cost[i] < cover.cost[i - 1]) continue;
            cover.cost[i] = cover.cost[i - 1];
            cover.choice[i] = 0;
        }
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
    void gather(uint index, int count, std::array<uint, WIDTH> &roots, int &root_count) const {
        const Cover &cover = covers[index];
        while (count > 1 && cover.choice[count] == 0) count--;
        if (count == 1) {
            roots[root_count++] = index;
            return;
        }
        gather(tree.nodes[index].left, cover.choice[count], roots, root_count);
        gather(tree.nodes[index].left + 1, count - cover.choice[count], roots, root_count);
    }

    uint emit(uint index) {
        const BinaryNode &node = tree.nodes[index];
        if (covers[index].choice[1] == 0) return emit_leaf(node);
        std::array<uint, WIDTH> roots;
        int count = 0;
        const int left_share = covers[index].choice[WIDTH];
        gather(node.left, left_share, roots, count);
        gather(node.left + 1, WIDTH - left_share, roots, count);

        const uint place = uint(bvh.nodes.size());
        bvh.nodes.emplace_back();
        for (int i = 0; i < WIDTH; i++) {
            const Box box = i < count ? tree.nodes[roots[i]].box : Box::empty();
            for (int axis = 0; axis < 3; axis++) {
                bvh.nodes[place].lo[axis][i] = box.lo[axis];
                bvh.nodes[place].hi[axis][i] = box.hi[axis];
            }
            const uint child = i < count ? emit(roots[i]) : OPAL_NONE;
            bvh.nodes[place].child[i] = child;
        }
        return place;
    }

    uint emit_leaf(const BinaryNode &node);
};

TriangleBlock pack_block(const TriangleSoup &soup, const uint *ids, uint count) {
    TriangleBlock block{};
    for (uint place = 0; place < BLOCK_SIZE; place++) {
        block.id[place] = place < count ? ids[place] : OPAL_NONE;
        for (int corner = 0; corner < 3 && count > 0; corner++) {
            // An unused place is the first corner thrice.
            const uint vertex = place < count ? soup.corners[ids[place]][corner] : soup.corners[ids[0]][0];
            for (int axis = 0; axis < 3; axis++) block.vertex[corner][axis][place] = soup.vertices[vertex][axis];
        }
    }
    return block;
}

uint Collapse::emit_leaf(const BinaryNode &node) {
    std::array<uint, BLOCK_SIZE> ids;
    for (uint i = 0; i < node.count; i++) ids[i] = tree.references[node.first + i].triangle;
    bvh.blocks.push_back(pack_block(soup, ids.data(), node.count));
    return OPAL_LEAF | uint(bvh.blocks.size() - 1);
}

Box child_box(const BvhNode &node, int child) {
    return {{node.lo[0][child], node.lo[1][child], node.lo[2][child]},
            {node.hi[0][child], node.hi[1][child], node.hi[2][child]}};
}

double half_area(const Box &box) {
    const double x = double(box.hi[0]) - box.lo[0], y = double(box.hi[1]) - box.lo[1], z = double(box.hi[2]) - box.lo[2];
    return x * y + y * z + z * x;
}

} // namespace

Bvh build_bvh(const TriangleSoup &soup) {
    if (soup.corners.empty()) return {{}, pack_blocks(soup), OPAL_LEAF};
    return Collapse(build_binary_tree(soup), soup).emit();
}

std::vector<TriangleBlock> pack_blocks(const TriangleSoup &soup) {
    std::vector<TriangleBlock> packed;
    std::array<uint, BLOCK_SIZE> ids;
    uint count = 0;
    for (uint id = 0; id < soup.corners.size(); id++) {
        ids[count++] = id;
        if (count == BLOCK_SIZE) packed.push_back(pack_block(soup, ids.data(), std::exchange(count, 0)));
    }
    if (count > 0 || packed.empty()) packed.push_back(pack_block(soup, ids.data(), count));
    return packed;
}

double sah_cost(const Bvh &bvh) {
    if (bvh.root & OPAL_LEAF) return BLOCK_COST;
    Box root = Box::empty();
    for (int child = 0; child < WIDTH; child++) root.add(child_box(bvh.nodes[bvh.root], child));
    double sum = NODE_COST * half_area(root);
    for (const BvhNode &node : bvh.nodes)
        for (int child = 0; child < WIDTH; child++)
            if (node.lo[0][child] <= node.hi[0][child])
                sum += half_area(child_box(node, child)) * (node.child[child] & OPAL_LEAF ? BLOCK_COST : NODE_COST);
    return sum / half_area(root);
}

int stack_need(const Bvh &bvh) {
    std::vector<int> need(bvh.nodes.size());
    for (std::size_t i = bvh.nodes.size(); i-- > 0;) { // children come after their parents
        int children = 0;
        for (int child = 0; child < WIDTH; child++) {
            if (bvh.nodes[i].lo[0][child] > bvh.nodes[i].hi[0][child]) continue;
            children++;
            if (!(bvh.nodes[i].child[child] & OPAL_LEAF)) need[i] = std::max(need[i], need[bvh.nodes[i].child[child]]);
        }
        need[i] += children - 1;
    }
    return bvh.root & OPAL_LEAF ? 0 : need[bvh.root];
}

} // namespace opal
