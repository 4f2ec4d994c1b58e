// perturb: shading normals that a BSDF changes (bsdfs/normalmap.cl, bumpmap.cl), as Mitsuba does it.
//
// The BSDF within is asked in the frame of the changed normal n', its cosine included. n is the normal before.
// - Where n' faces away from the viewer, it is turned about n by half a turn (flip_invalid_normals). Without that the
//   viewer is behind n', where most BSDFs are black.
// - A direction on one side of n and the other side of n' carries no light.
// - Light from wo is darkened by G = 2 / (1 + sqrt(1 + a^2 tan^2(n, wo))), where a^2 is tan^2(n, n') / 8 and at most 1,
//   so that it fades out before that edge (use_shadowing_function; Estevez, Lecocq and Stein 2019, "A Microfacet-Based
//   Shadowing Function to Solve the Bump Terminator Problem", Ray Tracing Gems, chapter 12). The weight of each sample
//   has G, too.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "surface.cl"

// A vector of squares and products of coordinates about 1 that is shorter has no direction.
#define SHORTEST_NORMAL R(1e-6)

// A vector of the surface in the frame of an opening: where that is mirrored, as the mirror shows it.
static v3 seen_from(BsdfOpening o, v3 v) {
    v3 seen = to_local(o.frame, v);
    seen.z = o.mirrored ? -seen.z : seen.z;
    return seen;
}

// Turns an opening to the shading normal n, unit, in the coordinates of its frame.
static BsdfOpening perturb(const Surface *s, v3 n, mask flips, mask shadows, BsdfOpening o) {
    mask away = flips & (o.wi.z * v3_dot(o.wi, n) <= 0);
    n.x = away ? -n.x : n.x;
    n.y = away ? -n.y : n.y;
    Frame turned = tangent_frame(n, seen_from(o, s->dpdu)); // in those coordinates
    for (int i = OPAL_PERTURBATIONS - 1; i > 0; i--) {
        o.perturbations[i] = o.perturbations[i - 1];
        o.perturbations[i].normal = to_local(turned, o.perturbations[i].normal);
    }
    o.perturbations[0].normal = v3_of(turned.s.z, turned.t.z, turned.n.z); // z before
    o.perturbations[0].shadows = shadows;
    o.wi = to_local(turned, o.wi);
    Frame frame = {to_world(o.frame, turned.s), to_world(o.frame, turned.t), to_world(o.frame, turned.n)};
    o.frame = frame;
    return o;
}

// G of all perturbations of an opened surface towards wo, local; 0 where wo is on different sides of two normals.
static real perturbation_factor(const Surface *s, v3 wo) {
    real factor = 1, cosine = wo.z;
    v3 normal = v3_of((real)(0), (real)(0), (real)(1));
    for (int i = 0; i < OPAL_PERTURBATIONS; i++) { // from the inmost
        v3 before = s->perturbations[i].normal;
        real cosine_before = v3_dot(before, wo), turn = v3_dot(before, normal);
        real product = fabs(cosine_before * turn); // G, multiplied out by the cosines
        real slope = real_min(R(0.125) * real_max(1 - square(turn), (real)(0)), square(turn));
        real sine2 = real_max(1 - square(cosine_before), (real)(0));
        real g = 2 * product / (product + sqrt(square(product) + slope * sine2));
        factor = s->perturbations[i].shadows ? factor * g : factor;
        factor = cosine * cosine_before > 0 ? factor : (real)(0);
        normal = before;
        cosine = cosine_before;
    }
    return factor;
}
