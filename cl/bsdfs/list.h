// The BSDFs: one row, one list of parameters bsdfs/NAME.h and one file bsdfs/NAME.cl each. NAME is also the XML type.
#ifndef OPAL_BSDF_LIST_H
#define OPAL_BSDF_LIST_H

#include "bsdfs/blendbsdf.h"
#include "bsdfs/bumpmap.h"
#include "bsdfs/conductor.h"
#include "bsdfs/dielectric.h"
#include "bsdfs/diffuse.h"
#include "bsdfs/mask.h"
#include "bsdfs/microfacet.h"
#include "bsdfs/mirror.h"
#include "bsdfs/normalmap.h"
#include "bsdfs/null.h"
#include "bsdfs/oren_nayar.h"
#include "bsdfs/phong.h"
#include "bsdfs/plastic.h"
#include "bsdfs/principled.h"
#include "bsdfs/principledthin.h"
#include "bsdfs/roughconductor.h"
#include "bsdfs/roughdielectric.h"
#include "bsdfs/roughplastic.h"
#include "bsdfs/thindielectric.h"
#include "bsdfs/twosided.h"
#include "shared/glue.h"
#include "shared/parameters.h"

// Traits of a kind, as bits.
enum {
    OPAL_SMOOTH = 1,       // some of its light has a density, so that light sampling serves it
    OPAL_DISCRETE = 2,     // some of its light leaves in single directions
    OPAL_TRANSMITS = 4,    // light passes through the surface
    OPAL_HOLDS_OPAQUE = 8, // of a BSDF that leads to others: these must not have the trait OPAL_TRANSMITS
    OPAL_TANGENTS = 16,    // asks for dpdu and dpdv of Surface: the kernel gets the feature `tangents`
    OPAL_PERTURBS = 32,    // of a BSDF that leads to another: it asks that about another shading normal
    OPAL_MANY_LOBES = 64   // a number that is 0 in all materials of a scene is 0 in its kernel (OPAL_NONZERO_bsdf_NAME)
};

// BSDF(name, traits)
#define OPAL_BSDFS(BSDF) \
    BSDF(diffuse, OPAL_SMOOTH) \
    BSDF(mirror, OPAL_DISCRETE) \
    BSDF(dielectric, OPAL_DISCRETE | OPAL_TRANSMITS) \
    BSDF(microfacet, OPAL_SMOOTH) \
    BSDF(phong, OPAL_SMOOTH) \
    BSDF(null, OPAL_DISCRETE | OPAL_TRANSMITS) \
    BSDF(conductor, OPAL_DISCRETE) \
    BSDF(roughconductor, OPAL_SMOOTH) \
    BSDF(thindielectric, OPAL_DISCRETE | OPAL_TRANSMITS) \
    BSDF(roughdielectric, OPAL_SMOOTH | OPAL_TRANSMITS) \
    BSDF(principled, OPAL_SMOOTH | OPAL_TRANSMITS | OPAL_TANGENTS | OPAL_MANY_LOBES) \
    BSDF(principledthin, OPAL_SMOOTH | OPAL_TRANSMITS | OPAL_TANGENTS | OPAL_MANY_LOBES) \
    BSDF(oren_nayar, OPAL_SMOOTH) \
    BSDF(plastic, OPAL_SMOOTH | OPAL_DISCRETE) \
    BSDF(roughplastic, OPAL_SMOOTH)

// BSDFs that lead to others, which are their parameters of type BSDF: BSDF(name, traits of its own). The others' traits
// come to them.
#define OPAL_NESTING_BSDFS(BSDF) \
    BSDF(twosided, OPAL_HOLDS_OPAQUE) \
    BSDF(mask, OPAL_DISCRETE | OPAL_TRANSMITS) \
    BSDF(blendbsdf, 0) \
    BSDF(normalmap, OPAL_TANGENTS | OPAL_PERTURBS) \
    BSDF(bumpmap, OPAL_TANGENTS | OPAL_PERTURBS)

#define OPAL_ALL_BSDFS(BSDF) OPAL_BSDFS(BSDF) OPAL_NESTING_BSDFS(BSDF)

#define OPAL_BSDF_ENUM(name, traits) BSDF_##name,
enum { OPAL_ALL_BSDFS(OPAL_BSDF_ENUM) BSDF_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

// The record of a kind, as `bsdf_phong_record`: the kind, then its parameters. A BSDF is known by the index of its
// record's first word in the scene's table of words.
#define OPAL_BSDF_RECORD(name, traits) \
    typedef struct bsdf_##name##_record { \
        uint kind OPAL_INITIALLY(BSDF_##name); \
        OPAL_BSDF_##name(OPAL_MEMBER) \
    } bsdf_##name##_record;
OPAL_ALL_BSDFS(OPAL_BSDF_RECORD)

#ifdef __cplusplus
}
#endif

#endif
