// null: light passes through the surface unchanged, by a discrete sample. Shadow rays are blocked, as by a mask.
//   <bsdf type="null"/>
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"

static v3 null_eval(null_bsdf b, v3 wi, v3 wo) { return v3_all((real)(0)); }

static real null_pdf(null_bsdf b, v3 wi, v3 wo) { return (real)(0); }

static BsdfSample null_sample(null_bsdf b, v3 wi, v2 u, real lobe) {
    return passing_sample(wi, (real)(1));
}
