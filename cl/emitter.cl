// emitter: choosing a light, a point on it, and what it sends from there; dispatch made from the list (emitters/list.h).
//   EmitterSample emitter_NAME_sample(scene, id, point, triangle)   point: a pair in [0, 1); triangle: a pair of random words
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

// An entry of an alias table of n rows, given two random words; `first`: the index of its first row in that table of records. The host
// counts which words lead to which entry (flatten/distribution.cpp), and what it counts is the probability that the records state.
#define ALIAS_ENTRY(scene, table, first, n, u, entry) { \
    uints row_ = alias_row((u).x, n); \
    mask kept_ = unit_real((u).y) < GATHER(real, (scene)->table, (first) + row_, .accept); \
    entry = (first) + uints_pick(kept_, row_, GATHER(uints, (scene)->table, (first) + row_, .other)); \
}

// Row floor(k n 2^-24) by the upper 24 bits k, which Sobol samples stratify; where there are so many rows that a row would have few of
// these numbers, by all 32 bits.
static uints alias_row(uints bits, uints n) {
    uints used = uints_pick(to_mask(n > OPAL_ALIAS_ROWS), bits, bits & 0xffffff00u);
    return mul_hi(used, n);
}

#include "emitters/mesh.cl"
#include "emitters/parallelogram.cl"
#include "emitters/point.cl"

// An emitter a lane, by the alias table of --emitter-choice.
static uints emitter_choose(const Scene *scene, u2 u) {
    uints id = (uints)(0);
    if (OPAL_HAS_many_emitters) ALIAS_ENTRY(scene, emitters, (uints)(0), (uints)(scene->settings->emitter_count), u, id)
    return id;
}

static real emitter_probability(const Scene *scene, uints id) {
    return OPAL_HAS_many_emitters ? GATHER(real, scene->emitters, id, .probability) : (real)(1);
}

static EmitterSample emitter_sample(const Scene *scene, uints id, v2 point, u2 triangle, mask live) {
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

// Density over area with which light sampling finds a point on a triangle of an area light, all choices included.
static real emitter_area_pdf(const Scene *scene, uints id, uints triangle, mask live) {
    real pdf = 0;
    if (EMITTER_KINDS > OPAL_HAS_emitter_mesh) pdf = GATHER(real, scene->emitters, id, .inverse_area);
    if (OPAL_HAS_emitter_mesh) {
        mask mesh = EMITTER_KINDS == 1 ? live : live & to_mask(GATHER(uints, scene->emitters, id, .kind) == EMITTER_mesh);
        uints row = GATHER(uints, scene->emitters, id, .first) + (triangle - GATHER(uints, scene->emitters, id, .first_triangle));
        pdf = mesh ? 1 / GATHER(real, scene->light_triangles, uints_pick(mesh, row, (uints)(0)), .area) : pdf;
    }
    return pdf * emitter_probability(scene, id);
}
