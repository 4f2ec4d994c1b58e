// emitter: choosing a light, a point on it, and what it sends from there; dispatch made from the list (emitters/list.h).
//   EmitterSample emitter_NAME_sample(scene, id, point, triangle)   point, triangle: two pairs in [0, 1)
typedef struct {
    v3 p;            // the point
    v3 normal;       // geometric normal there, unit
    v3 facing;       // shading normal there: light leaves on its side
    real area;       // 1 / density of p over area, m^2 in flattened units, given the emitter; 1 for a point light
    real margin;     // as in Surface
    mask discrete;   // a point light: no direction hits it by chance
} EmitterSample;

#define COUNT_EMITTER(name) +OPAL_HAS_emitter_##name
enum { EMITTER_KINDS = 0 OPAL_EMITTERS(COUNT_EMITTER) }; // that this kernel has

// Row floor(u n) of n, u in [0, 1): u n may round up to n.
static uints alias_row(real u, uints n) {
    uints row = to_uints(u * to_real(n));
    return min(row, n - 1u);
}

#include "emitters/mesh.cl"
#include "emitters/parallelogram.cl"
#include "emitters/point.cl"

// An emitter a lane, by the alias table of --emitter-choice.
static uints emitter_choose(const Scene *scene, v2 u) {
    if (!OPAL_HAS_many_emitters) return (uints)(0);
    uints row = alias_row(u.x, (uints)(scene->settings->emitter_count));
    mask kept = u.y < GATHER(real, scene->emitters, row, .accept);
    return uints_pick(kept, row, GATHER(uints, scene->emitters, row, .other));
}

static real emitter_probability(const Scene *scene, uints id) {
    return OPAL_HAS_many_emitters ? GATHER(real, scene->emitters, id, .probability) : (real)(1);
}

static EmitterSample emitter_sample(const Scene *scene, uints id, v2 point, v2 triangle, mask live) {
    EmitterSample s;
    uints kind = GATHER(uints, scene->emitters, id, .kind);
    s.p = s.normal = s.facing = v3_all((real)(0));
    s.area = s.margin = 0;
    s.discrete = NO_LANES;
#define SAMPLE_EMITTER(name) \
    if (OPAL_HAS_emitter_##name) { \
        mask m = EMITTER_KINDS == 1 ? live : live & to_mask(kind == EMITTER_##name); \
        if (ANY(m)) { \
            EmitterSample t = emitter_##name##_sample(scene, id, point, triangle); \
            s.p = v3_pick(m, t.p, s.p); s.normal = v3_pick(m, t.normal, s.normal); s.facing = v3_pick(m, t.facing, s.facing); \
            s.area = m ? t.area : s.area; s.margin = m ? t.margin : s.margin; \
            s.discrete = s.discrete | (m & t.discrete); \
        } \
    }
    OPAL_EMITTERS(SAMPLE_EMITTER)
    return s;
}

static v3 emitter_radiance(const Scene *scene, uints id) { return GATHER_V3(scene->emitters, id, .radiance); }

// Density over area with which light sampling finds a point on an area light, all choices included, given the area of
// the triangle it lies on.
static real emitter_area_pdf(const Scene *scene, uints id, real triangle_area) {
    real pdf = GATHER(real, scene->emitters, id, .inverse_area);
    if (OPAL_HAS_emitter_mesh && CHOSEN(scene, triangle_choice, uniform)) {
        mask mesh = to_mask(GATHER(uints, scene->emitters, id, .kind) == EMITTER_mesh);
        real count = to_real(GATHER(uints, scene->emitters, id, .count));
        pdf = mesh ? 1 / (count * triangle_area) : pdf;
    }
    return pdf * emitter_probability(scene, id);
}
