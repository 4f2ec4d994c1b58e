// mask: a surface that light meets with probability `opacity`, and else passes unchanged, by a discrete sample.
//   <bsdf type="mask"> <float name="opacity" value="0.5"/> <bsdf type="diffuse"/> </bsdf>
// eval and pdf are those of the BSDF within it times the opacity. Shadow rays are blocked whatever the opacity is:
// paths that pass find the light behind the surface. bsdf_respond draws whether a path passes.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"

static BsdfOpening mask_open(mask_bsdf b, BsdfOpening o) {
    o.at = b.base;
    o.opacity = o.opacity * b.opacity;
    return o;
}
