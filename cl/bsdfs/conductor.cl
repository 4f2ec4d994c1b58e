// conductor: a smooth metal, one-sided, discrete. It reflects Fresnel's reflectance of its complex index.
//   <bsdf type="conductor"> <string name="material" value="Au"/> </bsdf>
//   <bsdf type="conductor"> <color name="eta" value="0.143 0.375 1.442"/> <color name="k" value="3.98 2.39 1.60"/>
//   </bsdf>
#include "bsdfs/fresnel.cl"
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"

static v3 conductor_eval(conductor_bsdf b, v3 wi, v3 wo) { return v3_all((real)(0)); }

static real conductor_pdf(conductor_bsdf b, v3 wi, v3 wo) { return (real)(0); }

static BsdfSample conductor_sample(conductor_bsdf b, v3 wi, v2 u, real lobe) {
    v3 reflectance = v3_mul(b.specular_reflectance, fresnel_conductor(wi.z, sin2_theta(wi), b.eta, b.k));
    return bsdf_sample_of(reflect_z(wi), v3_pick(wi.z > 0, reflectance, v3_all((real)(0))), (real)(0), (real)(1),
                          ALL_LANES);
}
