// The inputs and outputs of cl/kernels/probe.cl, written once for host and device.
#ifndef OPAL_PROBE_LIST_H
#define OPAL_PROBE_LIST_H

// The warps of cl/core/warp.cl, each with the domain (host/stats/domain.h) it draws from:
//   PLANE(name, domain), DIRECTION(name, domain), LOBE(name, domain, parameter, default)
#define OPAL_WARPS(PLANE, DIRECTION, LOBE) \
    PLANE(tent, biunit) \
    PLANE(uniform_disk, disk) \
    PLANE(concentric_disk, disk) \
    DIRECTION(uniform_sphere, sphere) \
    DIRECTION(uniform_hemisphere, hemisphere) \
    DIRECTION(cosine_hemisphere, hemisphere) \
    LOBE(beckmann, hemisphere, alpha, 0.1f) \
    LOBE(phong_lobe, hemisphere, n, 20.f)

#define OPAL_WARP_ENUM(name, domain) WARP_##name,
#define OPAL_LOBE_ENUM(name, domain, parameter, otherwise) WARP_##name,
enum { OPAL_WARPS(OPAL_WARP_ENUM, OPAL_WARP_ENUM, OPAL_LOBE_ENUM) WARP_COUNT };

// The dimensions, a pair of numbers each, that the kernel `numbers` writes.
#define OPAL_PROBE_PAIRS 3

// The columns of each kernel's output.
enum { WARP_X, WARP_Y, WARP_Z, WARP_PLANES };
enum {
    BSDF_WO_X, BSDF_WO_Y, BSDF_WO_Z, BSDF_WEIGHT_R, BSDF_WEIGHT_G, BSDF_WEIGHT_B, BSDF_PDF, BSDF_ETA, BSDF_DISCRETE,
    BSDF_PLANES
};
enum { EVAL_R, EVAL_G, EVAL_B, EVAL_PDF, EVAL_PLANES };
enum {
    LIGHT_D_X, LIGHT_D_Y, LIGHT_D_Z, LIGHT_DISTANCE, LIGHT_RADIANCE_R, LIGHT_RADIANCE_G, LIGHT_RADIANCE_B,
    LIGHT_DENSITY, LIGHT_ID, LIGHT_ACTIVE, LIGHT_PLANES
};
enum { FILM_X, FILM_Y, FILM_LENS, FILM_PLANES = 4 }; // of input: a point of the film, a pair of numbers
enum { RAY_O_X, RAY_O_Y, RAY_O_Z, RAY_D_X, RAY_D_Y, RAY_D_Z, RAY_TMIN, RAY_TMAX, RAY_PLANES };
enum {
    HIT_T, HIT_U, HIT_V, HIT_SLOT, HIT_ANY, HIT_EMITTER, HIT_RADIANCE_R, HIT_RADIANCE_G, HIT_RADIANCE_B,
    HIT_LIGHT_DENSITY, HIT_P_X, HIT_P_Y, HIT_P_Z, HIT_NORMAL_X, HIT_NORMAL_Y, HIT_NORMAL_Z, HIT_RAY_OFFSET,
    HIT_UV_U, HIT_UV_V, HIT_DPDU_X, HIT_DPDU_Y, HIT_DPDU_Z, HIT_DPDV_X, HIT_DPDV_Y, HIT_DPDV_Z, HIT_PLANES
};

#endif
