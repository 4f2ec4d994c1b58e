#include "bvh/bvh.h"

#include "bvh/collapse.h"
#include "bvh/reinsertion.h"

#include <algorithm>

namespace opal {
namespace {

Box box_of_child(const BvhNode &node, int child) {
    return {{node.lo[0][child], node.lo[1][child], node.lo[2][child]},
            {node.hi[0][child], node.hi[1][child], node.hi[2][child]}};
}

// As Box::half_area, but in double.
double half_area(const Box &box) {
    const double x = double(box.hi[0]) - box.lo[0], y = double(box.hi[1]) - box.lo[1],
                 z = double(box.hi[2]) - box.lo[2];
    return x * y + y * z + z * x;
}

} // namespace

Bvh build_bvh(const TriangleSoup &soup, std::span<const uint> left_out) {
    if (soup.corners.size() == left_out.size() && soup.others.empty()) {
        Bvh bvh{{empty_node()}};
        bvh.leaves[SHAPE_triangle].emplace_back().fill(OPAL_NONE);
        return bvh;
    }
    BinaryTree tree = build_binary_tree(split_primitives(soup, left_out));
    optimise_by_reinsertion(tree);
    return collapse(tree, !soup.others.empty());
}

BvhNode empty_node() {
    BvhNode node;
    std::fill_n(&node.lo[0][0], 3 * node_width, Box::infinity);
    std::fill_n(&node.hi[0][0], 3 * node_width, -Box::infinity);
    std::fill_n(node.child, node_width, OPAL_NONE);
    return node;
}

TriangleBlock pack_block(const TriangleSoup &soup, const BlockIds &ids) {
    TriangleBlock block{};
    std::copy(ids.begin(), ids.end(), block.id);
    for (uint place = 0; place < block_size && ids[0] != OPAL_NONE; place++)
        for (int corner = 0; corner < 3; corner++) {
            const uint id = ids[place], vertex = id == OPAL_NONE ? soup.corners[ids[0]][0] : soup.corners[id][corner];
            for (int axis = 0; axis < 3; axis++)
                block.vertex[corner][axis][place] = soup.vertices[vertex][axis];
        }
    return block;
}

double sah_cost(const Bvh &bvh) {
    Box root = Box::empty();
    for (int child = 0; child < node_width; child++)
        if (bvh.nodes[0].child[child] != OPAL_NONE)
            root.add(box_of_child(bvh.nodes[0], child));
    double sum = node_cost * half_area(root);
    for (const BvhNode &node : bvh.nodes)
        for (int child = 0; child < node_width; child++)
            if (node.child[child] != OPAL_NONE)
                sum += half_area(box_of_child(node, child)) * (node.child[child] & OPAL_LEAF ? block_cost : node_cost);
    return sum / half_area(root);
}

int levels_of(const Bvh &bvh) {
    std::vector<int> levels(bvh.nodes.size(), 1);
    for (std::size_t i = bvh.nodes.size(); i-- > 0;) // children come after their parents
        for (uint child : bvh.nodes[i].child)
            if (child != OPAL_NONE && !(child & OPAL_LEAF))
                levels[i] = std::max(levels[i], levels[child] + 1);
    return levels[0];
}

} // namespace opal
