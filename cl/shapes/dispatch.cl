// dispatch: the blocks of the tree's leaves and the surfaces that are hit, by shape. A kernel of one shape has no
// branch and reads no shape: it is a constant.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shapes/*.cl"
#include "shapes/list.h"
#include "shared/types.h"
#include "surface.cl"

#define COUNT_SHAPE(name, Block) +OPAL_HAS_shape_##name
enum { SHAPE_KINDS = 0 OPAL_SHAPES(COUNT_SHAPE) }; // of this kernel

// The index of a leaf's block, and its shape, by the word that its parent holds.
static uint leaf_block(uint child) { return child & OPAL_BLOCK_BITS; }
static uint leaf_shape(uint child) { return child >> OPAL_SHAPE_SHIFT & OPAL_SHAPE_BITS; }

// A leaf's shape and block. The address is found once, as NVIDIA's compiler would hold one for each use.
typedef struct {
    uint shape;
    global const char *block; // of that shape's record
} Leaf;

// Does the kernel know that shape, and is it that of the leaf?
#define IS_SHAPE(name, shape) (OPAL_HAS_shape_##name && (SHAPE_KINDS == 1 || (shape) == SHAPE_##name))

static Leaf leaf_of(const Scene *scene, uint child) {
    Leaf leaf = {leaf_shape(child), 0};
#define FIND_BLOCK(name, Block) \
    if (IS_SHAPE(name, leaf.shape)) leaf.block = (global const char *)(scene->name##_blocks + leaf_block(child));
    OPAL_SHAPES(FIND_BLOCK)
    return leaf;
}

// Does the leaf have a primitive in that place? If not, nor in those after it.
static bool leaf_has(Leaf leaf, uint place) {
#define HAS_PRIMITIVE(name, Block) \
    if (IS_SHAPE(name, leaf.shape)) return ((global const Block *)leaf.block)->id[place] != OPAL_NONE;
    OPAL_SHAPES(HAS_PRIMITIVE)
    return false;
}

// A ray's line against the leaf's primitives, as intersect_NAME (shapes/interface.cl).
static BlockTest intersect_leaf(Leaf leaf, uint place, const LaneRay *ray) {
#define INTERSECT(name, Block) \
    if (IS_SHAPE(name, leaf.shape)) return intersect_##name((global const Block *)leaf.block, place, ray);
    OPAL_SHAPES(INTERSECT)
    BlockTest none = {0, 0, 0, 0, 0};
    return none;
}

// The surface that each active lane hit, of which there is one at least: a scene may have no surfaces. The others get
// any that there is.
static CALLED Surface surface_at(const Scene *scene, Ray ray, Hit hit, mask active) {
#define ONLY_SURFACE(name, Block) \
    if (OPAL_HAS_shape_##name && SHAPE_KINDS == 1) return surface_of_##name(scene, ray, hit, active);
    OPAL_SHAPES(ONLY_SURFACE)
    Surface s = no_surface();
#define SURFACE(name, Block) \
    if (OPAL_HAS_shape_##name) { \
        mask m = active & to_mask(hit.shape == SHAPE_##name); \
        if (ANY(m)) s = surface_pick(m, surface_of_##name(scene, ray, hit, m), s); \
    }
    OPAL_SHAPES(SURFACE)
    return s;
}
