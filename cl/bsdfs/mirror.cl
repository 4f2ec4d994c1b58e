// mirror: a perfect one-sided mirror, discrete, weight 1.
//   <bsdf type="mirror"/>
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"

static v3 mirror_eval(mirror_bsdf b, v3 wi, v3 wo) { return v3_all((real)(0)); }

static real mirror_pdf(mirror_bsdf b, v3 wi, v3 wo) { return (real)(0); }

static BsdfSample mirror_sample(mirror_bsdf b, v3 wi, v2 u, real lobe) {
    return bsdf_sample_of(reflect_z(wi), v3_all(wi.z > 0 ? (real)(1) : (real)(0)), (real)(0), (real)(1), ALL_LANES);
}
