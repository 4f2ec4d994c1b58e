// twosided: BSDFs that reflect on the front alone, one for each side of a surface, or one for both.
//   <bsdf type="twosided"> <bsdf type="diffuse"/> <bsdf type="mirror"/> </bsdf>
// Seen from behind, the shading normal points the other way. What a surface emits leaves on its front alone.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"

static BsdfOpening twosided_open(twosided_bsdf b, BsdfOpening o) {
    mask behind = o.wi.z < 0;
    o.at = uints_pick(behind, b.back, b.base);
    o.wi.z = fabs(o.wi.z);
    o.frame.n = v3_pick(behind, v3_neg(o.frame.n), o.frame.n);
    return o;
}
