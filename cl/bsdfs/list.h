// The BSDFs: one row, one parameter record and one file cl/bsdfs/NAME.cl each. NAME is also the XML type.
#ifndef OPAL_BSDF_LIST_H
#define OPAL_BSDF_LIST_H

#include "shared/glue.h"

#define OPAL_BSDFS(BSDF) \
    BSDF(diffuse) \
    BSDF(mirror) \
    BSDF(dielectric) \
    BSDF(microfacet) \
    BSDF(phong)

#define OPAL_BSDF_ENUM(name) BSDF_##name,
enum { OPAL_BSDFS(OPAL_BSDF_ENUM) BSDF_COUNT };

#ifdef __cplusplus
namespace opal {
#endif

typedef struct {
    float albedo[3];   // reflectance of each colour, 0 to 1
    uint use_cosine;   // draw directions by their cosine (1) or uniformly (0)
} DiffuseParams;

typedef struct {
    float int_ior;     // index of refraction on the side the normal points away from
    float ext_ior;     // index of refraction on the side the normal points to
} DielectricParams;

typedef struct {
    float alpha;       // Beckmann roughness
    float int_ior, ext_ior;
    float ks;          // 1 - max(kd)
    float kd[3];       // diffuse reflectance
} MicrofacetParams;

typedef struct {
    float kd[3];       // diffuse reflectance
    float pd;          // probability of the diffuse part, and its share of the energy
    float ks[3];       // specular reflectance
    float n;           // exponent
} PhongParams;

// One material. kind is a BSDF_* value and says which member of u is meant.
typedef struct {
    uint kind;
    uint pad[3];
    union {
        DiffuseParams diffuse;
        DielectricParams dielectric;
        MicrofacetParams microfacet;
        PhongParams phong;
        float words[12];
    } u;
} BsdfRecord;
OPAL_SIZE_CHECK(BsdfRecord, 64);

#ifdef __cplusplus
}
#endif

#endif
