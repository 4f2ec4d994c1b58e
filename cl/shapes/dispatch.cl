// dispatch: the blocks of the tree's leaves and the surfaces that are hit, by shape. A kernel of one shape has no
// branch and reads no shape: it is a constant.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/*.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "surface.cl"

#define COUNT_SHAPE(name) +OPAL_HAS_shape_##name
enum { SHAPE_KINDS = 0 OPAL_SHAPES(COUNT_SHAPE) }; // of this kernel

// The index of a leaf's block, and its shape, by the word that its parent holds.
static uint leaf_block(uint leaf) { return leaf & OPAL_BLOCK_BITS; }
static uint leaf_shape(uint leaf) { return leaf >> OPAL_SHAPE_SHIFT & OPAL_SHAPE_BITS; }

// Does the kernel know that shape, and is the leaf of it?
#define IS_LEAF_OF(name, leaf) (OPAL_HAS_shape_##name && (SHAPE_KINDS == 1 || leaf_shape(leaf) == SHAPE_##name))

// Where a leaf's block lies.
static global const char *leaf_address(const Scene *scene, uint leaf) {
#define ADDRESS(name) \
    if (IS_LEAF_OF(name, leaf)) return (global const char *)(scene->name##_blocks + leaf_block(leaf));
    OPAL_SHAPES(ADDRESS)
    return 0;
}

// Does a leaf's block have a primitive in that place? If not, nor in those after it.
static bool leaf_has(const Scene *scene, uint leaf, uint place) {
#define HAS_PRIMITIVE(name) \
    if (IS_LEAF_OF(name, leaf)) return scene->name##_blocks[leaf_block(leaf)].id[place] != OPAL_NONE;
    OPAL_SHAPES(HAS_PRIMITIVE)
    return false;
}

// A ray's line against a leaf's primitives, as intersect_NAME (shapes/interface.cl).
static BlockTest intersect_leaf(const Scene *scene, uint leaf, uint place, const LaneRay *ray) {
#define INTERSECT(name) \
    if (IS_LEAF_OF(name, leaf)) return intersect_##name(scene->name##_blocks + leaf_block(leaf), place, ray);
    OPAL_SHAPES(INTERSECT)
    BlockTest none = {0, 0, 0, 0, 0};
    return none;
}

// The surface that each active lane hit; the others get any that there is.
static Surface surface_at(const Scene *scene, Ray ray, Hit hit, mask active) {
    Surface s = no_surface();
#define SURFACE(name) \
    if (OPAL_HAS_shape_##name) { \
        if (SHAPE_KINDS == 1) return surface_of_##name(scene, ray, hit, active); \
        mask m = active & to_mask(hit.shape == SHAPE_##name); \
        if (ANY(m)) s = surface_pick(m, surface_of_##name(scene, ray, hit, m), s); \
    }
    OPAL_SHAPES(SURFACE)
    return s;
}
