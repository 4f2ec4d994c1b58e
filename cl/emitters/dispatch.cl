// dispatch: points on emitters, their radiance and density, by the kind of each lane's emitter.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/choice.cl"
#include "emitters/interface.cl"
#include "emitters/list.h"
#include "emitters/mesh.cl"
#include "emitters/parallelogram.cl"
#include "emitters/point.cl"
#include "scene.cl"

#define COUNT_EMITTER(name) +OPAL_HAS_emitter_##name
enum { EMITTER_KINDS = 0 OPAL_EMITTERS(COUNT_EMITTER) }; // of this kernel

// A point on the emitters `id`, by random numbers `point` in [0, 1) and random words `triangle`; zeros in lanes that
// are not active.
static EmitterSample emitter_sample(const Scene *scene, uints id, v2 point, u2 triangle, mask active) {
    v3 zero = v3_all((real)(0));
    EmitterSample s = {zero, zero, zero, (real)(0), (real)(0), NO_LANES};
    uints kind = GATHER(uints, scene->emitters, id, .kind);
#define SAMPLE_EMITTER(name) \
    if (OPAL_HAS_emitter_##name) { \
        mask m = EMITTER_KINDS == 1 ? active : active & to_mask(kind == EMITTER_##name); \
        if (ANY(m)) s = emitter_sample_pick(m, emitter_##name##_sample(scene, id, point, triangle), s); \
    }
    OPAL_EMITTERS(SAMPLE_EMITTER)
    return s;
}

// Radiance that the emitters `id` send, W / (m^2 sr), the same in all directions; of a point light the intensity, W /
// sr.
static v3 emitter_radiance(const Scene *scene, uints id) { return GATHER_V3(scene->emitters, id, .radiance); }

// Density, area measure, with which light sampling finds a point on a triangle of an area light, the choices of emitter
// and triangle included. `id` and `triangle` must be valid in all lanes; the density is that of active ones.
static real emitter_area_pdf(const Scene *scene, uints id, uints triangle, mask active) {
    real pdf = 0;
    if (EMITTER_KINDS > OPAL_HAS_emitter_mesh) pdf = GATHER(real, scene->emitters, id, .inverse_area);
    if (OPAL_HAS_emitter_mesh) {
        uints kind = GATHER(uints, scene->emitters, id, .kind);
        mask mesh = EMITTER_KINDS == 1 ? active : active & to_mask(kind == EMITTER_mesh);
        uints place = triangle - GATHER(uints, scene->emitters, id, .first_triangle);
        uints row = uints_pick(mesh, GATHER(uints, scene->emitters, id, .first) + place, (uints)(0));
        pdf = mesh ? 1 / GATHER(real, scene->light_triangles, row, .inverse_pdf) : pdf;
    }
    return pdf * emitter_probability(scene, id);
}
