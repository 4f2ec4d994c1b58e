// The features of a kernel: each is compiled in or left out. flatten decides it for a scene. Each feature is always
// defined as OPAL_HAS_name, 0 or 1, in this order. Device code asks `if (OPAL_HAS_name)`, so that each variant is
// parsed and type-checked.
#ifndef OPAL_FEATURES_H
#define OPAL_FEATURES_H

#include "bsdfs/list.h"
#include "cameras/list.h"
#include "emitters/list.h"
#include "shapes/list.h"

#define OPAL_BSDF_FEATURE(name, traits) OPAL_FEATURE_ROW(bsdf_##name, "bsdf_" #name)
#define OPAL_EMITTER_FEATURE(name, traits) OPAL_FEATURE_ROW(emitter_##name, "emitter_" #name)
#define OPAL_SHAPE_FEATURE(name, Block) OPAL_FEATURE_ROW(shape_##name, "shape_" #name)
#define OPAL_CAMERA_FEATURE(name, record, traits) OPAL_FEATURE_ROW(camera_##name, "camera_" #name)

// Define OPAL_FEATURE_ROW(name, shown) and expand this; `shown` is what `opal inspect` calls the feature.
#define OPAL_FEATURES \
    OPAL_ALL_BSDFS(OPAL_BSDF_FEATURE) \
    OPAL_EMITTERS(OPAL_EMITTER_FEATURE) \
    OPAL_SHAPES(OPAL_SHAPE_FEATURE) \
    OPAL_CAMERAS(OPAL_CAMERA_FEATURE) \
    /* some microfacet coat has alpha 0: its BSDF has a density and single directions */ \
    OPAL_FEATURE_ROW(mirror_coats, "mirror_coats") \
    /* some rough surface has facets of Beckmann's distribution, or of GGX */ \
    OPAL_FEATURE_ROW(beckmann, "beckmann") \
    OPAL_FEATURE_ROW(ggx, "ggx") \
    /* some rough surface draws directions by all facets, else all by the visible ones */ \
    OPAL_FEATURE_ROW(all_facets, "all_facets") \
    /* some glass has a specular_reflectance or specular_transmittance other than 1 */ \
    OPAL_FEATURE_ROW(tinted_glass, "tinted_glass") \
    /* several emitters, one of which is chosen; else emitter 0 is meant */ \
    OPAL_FEATURE_ROW(many_emitters, "many_emitters") \
    /* some mesh emits on both sides */ \
    OPAL_FEATURE_ROW(two_sided_lights, "two_sided_lights") \
    /* some mesh interpolates vertex normals */ \
    OPAL_FEATURE_ROW(shading_normals, "shading_normals") \
    /* textures: surfaces have texture coordinates */ \
    OPAL_FEATURE_ROW(uv, "uv") \
    /* some BSDF asks for the derivatives of a surface's points over its texture coordinates */ \
    OPAL_FEATURE_ROW(tangents, "tangents") \
    /* a light has a texture */ \
    OPAL_FEATURE_ROW(light_textures, "light_textures") \
    /* rays of the camera pass emitters */ \
    OPAL_FEATURE_ROW(hidden_emitters, "hidden_emitters") \
    /* direct_lighting takes several samples of a kind */ \
    OPAL_FEATURE_ROW(sample_counts, "sample_counts") \
    /* the face list, tested by all lanes at once: a tiny scene, or the largest faces */ \
    OPAL_FEATURE_ROW(face_list, "listed") \
    /* a tree of the other triangles, walked lane by lane */ \
    OPAL_FEATURE_ROW(tree, "tree") \
    /* the tree is larger than a core's caches: walks prefetch waiting children */ \
    OPAL_FEATURE_ROW(large_tree, "large_tree") \
    /* the last ray of a path asks for lights alone, and no light is in the tree: most such rays need not walk it */ \
    OPAL_FEATURE_ROW(last_rays, "last_rays") \
    /* a path may be endless: a launch ends after so many rounds, and the next one goes on with its paths */ \
    OPAL_FEATURE_ROW(endless_paths, "endless_paths")

#define OPAL_FEATURE_ROW(name, shown) FEATURE_##name,
enum { OPAL_FEATURES FEATURE_COUNT };
#undef OPAL_FEATURE_ROW

#endif
