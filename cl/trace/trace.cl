// trace: closest and any hit of each lane. The faces of the face list are tested against all lanes at once (faces.cl),
// everything else is in a tree, which each lane walks alone: by one_lane/walk.cl where the kernel carries one
// lane, as GPUs run it, else by many_lanes/walk.cl.
#include "core/lanes.cl"
#include "scene.cl"
#include "shapes/dispatch.cl"
#include "shapes/triangle.cl"
#include "shared/types.h"
#include "trace/faces.cl"
#include "trace/rays.cl"
#if LANES == 1
#include "trace/one_lane/walk.cl"
#else
#include "trace/many_lanes/walk.cl"
#endif

// Are there primitives outside the face list? A program for all scenes finds a root without children where there are
// none.
static bool has_tree(const Scene *scene) {
    if (!OPAL_HAS_tree) return false;
    return !GENERAL || scene->nodes->child[0] != OPAL_NONE;
}

// The lanes of `last` that cannot meet a light, by the nearest face of the list, which holds all surfaces that emit.
static mask cannot_meet_light(const Scene *scene, Hit face, mask last) {
    mask on_face = last & is_hit(face);
    uints triangle = triangle_id(scene, uints_pick(on_face, face.place, (uints)(0)));
    uints emitter = GATHER(uints, scene->meshes, GATHER(uints, scene->triangles, triangle, .mesh), .emitter);
    mask dark_face = on_face & to_mask(emitter == OPAL_NONE);
    return ENVIRONMENT_KINDS > 0 ? dark_face : dark_face | (last & !is_hit(face));
}

// The nearest hit of each active lane. last: the lanes whose ray asks for nothing but the light that it meets. Where
// that is none, their hit may be any but a light.
static CALLED Hit closest_hit(const Scene *scene, Ray ray, mask active, mask last) {
    Hit hit = no_hit(ray.tmax);
    if (OPAL_HAS_face_list) hit = faces_closest(scene, ray);
    if (!has_tree(scene)) return hit;
    if (OPAL_HAS_last_rays && ANY(last & active)) active = active & !cannot_meet_light(scene, hit, last & active);
    ray.tmax = hit.t;
    TreeRays rays;
    prepare_rays(&rays, scene, ray, active);
    if (rays.walking == 0) return hit;
    LaneHits hits;
    STORE(hit.t, hits.t); STORE(hit.u, hits.u); STORE(hit.v, hits.v); STORE(hit.place, hits.place);
    if (SHAPE_KINDS > 1) STORE(hit.shape, hits.shape);
    walk_closest(scene, &rays, &hits);
    Hit nearest = {LOAD(real, hits.t), LOAD(real, hits.u), LOAD(real, hits.v), hit.shape, LOAD(uints, hits.place)};
    if (SHAPE_KINDS > 1) nearest.shape = LOAD(uints, hits.shape);
    return nearest;
}

// The active lanes whose ray is blocked between tmin and tmax, by the tree or by the faces `among` of the face list.
static CALLED mask blocked_by(const Scene *scene, Ray ray, FaceRange among, mask active) {
    mask blocked = NO_LANES;
    if (OPAL_HAS_face_list && among.faces > 0) blocked = faces_any(scene, ray, among, active);
    if (!has_tree(scene)) return blocked;
    TreeRays rays;
    prepare_rays(&rays, scene, ray, active & !blocked);
    if (rays.walking == 0) return blocked;
    return blocked | mask_of(walk_any(scene, &rays));
}

static mask any_hit(const Scene *scene, Ray ray, mask active) {
    return blocked_by(scene, ray, scene->settings->face_list, active);
}

// any_hit for shadow rays. It skips faces that provably cannot occlude a light, such as the scene's outer walls and the
// only lamp (host: face list).
static mask any_hit_to_light(const Scene *scene, Ray ray, mask active) {
    return blocked_by(scene, ray, scene->settings->face_list_to_light, active);
}
