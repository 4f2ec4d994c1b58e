#include "flatten/listed.h"

#include "flatten/box.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <numeric>
#include <set>

namespace opal {
namespace {

Box box_of(const TriangleSoup &soup, uint id) {
    Box box = Box::empty();
    for (uint vertex : soup.corners[id])
        box.add(soup.vertices[vertex]);
    return box;
}

TriangleSoup only(const TriangleSoup &soup, const std::vector<uint> &ids) {
    TriangleSoup part{soup.vertices, {}};
    for (uint id : ids)
        part.corners.push_back(soup.corners[id]);
    return part;
}

// Blocks number triangles as the soup they were made of does; gives them their ids in the scene.
void rename(std::vector<TriangleBlock> &blocks, const std::vector<uint> &ids) {
    for (TriangleBlock &block : blocks)
        for (uint &id : block.id)
            id = id == OPAL_NONE ? OPAL_NONE : ids[id];
}

} // namespace

std::vector<uint> choose_listed(const TriangleSoup &soup) {
    Box scene = Box::empty();
    for (const auto &corners : soup.corners)
        for (uint vertex : corners)
            scene.add(soup.vertices[vertex]);
    const bool tiny = soup.corners.size() <= OPAL_TINY_TRIANGLES;
    std::vector<std::pair<float, uint>> candidates; // -area, id: the largest come first, equals in their order
    for (uint id = 0; id < soup.corners.size(); id++)
        if (const float area = box_of(soup, id).half_area(); tiny || area >= LISTED_SHARE * scene.half_area())
            candidates.push_back({-area, id});
    std::sort(candidates.begin(), candidates.end());

    std::vector<uint> listed;
    std::set<std::array<float, 3>> distinct;
    for (const auto &[area, id] : candidates) {
        std::set<std::array<float, 3>> with = distinct;
        for (uint vertex : soup.corners[id])
            with.insert(soup.vertices[vertex]);
        if (listed.size() == OPAL_TINY_TRIANGLES || with.size() > OPAL_TINY_VERTICES)
            break;
        distinct = std::move(with);
        listed.push_back(id);
    }
    std::sort(listed.begin(), listed.end());
    return listed;
}

void plant_tree(const TriangleSoup &soup, const std::vector<uint> &listed, FlatScene &scene) {
    Bvh bvh;
    if (listed.empty()) {
        bvh = build_bvh(soup);
    } else {
        std::vector<uint> all(soup.corners.size()), others;
        std::iota(all.begin(), all.end(), 0u);
        std::set_difference(all.begin(), all.end(), listed.begin(), listed.end(), std::back_inserter(others));
        bvh = build_bvh(only(soup, others));
        rename(bvh.blocks, others);
    }
    scene.sah_cost = sah_cost(bvh);
    scene.nodes = std::move(bvh.nodes);
    scene.blocks = std::move(bvh.blocks);
}

void list_triangles(const TriangleSoup &soup, const std::vector<uint> &listed, FlatScene &scene) {
    const uint first_slot = uint(scene.blocks.size()) * 8;
    if (!listed.empty()) {
        std::vector<TriangleBlock> blocks = pack_blocks(only(soup, listed));
        rename(blocks, listed);
        scene.blocks.insert(scene.blocks.end(), blocks.begin(), blocks.end());
    }
    std::map<std::array<float, 3>, uint> known;
    const auto number = [&](uint vertex) {
        return known.try_emplace(soup.vertices[vertex], uint(known.size())).first->second;
    };
    for (uint i = 0; i < listed.size(); i++) {
        const auto &corners = soup.corners[listed[i]];
        const uint a = number(corners[0]), b = number(corners[1]), c = number(corners[2]);
        scene.tiny_triangles.push_back({{a, b, c}, first_slot + i});
    }
    scene.tiny_vertices.resize(3 * known.size());
    for (const auto &[position, place] : known)
        std::copy(position.begin(), position.end(), &scene.tiny_vertices[3 * place]);
    scene.settings.tiny_triangle_count = uint(scene.tiny_triangles.size());
    scene.settings.tiny_vertex_count = uint(known.size());
}

} // namespace opal
