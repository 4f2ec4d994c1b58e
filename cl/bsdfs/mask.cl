// mask: a surface that light meets with probability `opacity`, and else passes unchanged, by a discrete sample.
//   <bsdf type="mask"> <float name="opacity" value="0.5"/> <bsdf type="diffuse"/> </bsdf>
// eval and pdf are those of the BSDF within it times the opacity. Shadow rays are blocked whatever the opacity is:
// paths that pass find the light behind the surface. bsdf_respond draws whether a path passes.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "surface.cl"

static BsdfOpening mask_open(const Scene *scene, const Surface *s, mask_bsdf b, BsdfOpening o, mask m) {
    o.at = b.base;
    o.opacity = o.opacity * real_min(real_max(b.opacity, (real)(0)), (real)(1)); // textures know no limits
    return o;
}
