// twosided: BSDFs that reflect on the front alone, one for each side of a surface, or one for both.
//   <bsdf type="twosided"> <bsdf type="diffuse"/> <bsdf type="mirror"/> </bsdf>
// Seen from behind, the shading normal points the other way. What a surface emits leaves on its front alone.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "scene.cl"
#include "surface.cl"

static BsdfOpening twosided_open(const Scene *scene, const Surface *s, twosided_bsdf b, BsdfOpening o, mask m) {
    mask behind = o.wi.z < 0;
    o.at = uints_pick(behind, b.back, b.base);
    o.wi.z = fabs(o.wi.z);
    o.frame.n = v3_pick(behind, v3_neg(o.frame.n), o.frame.n);
    o.mirrored = (o.mirrored & !behind) | (behind & !o.mirrored);
    for (int i = 0; i < OPAL_PERTURBATIONS; i++) { // on the viewer's side still
        o.perturbations[i].normal.x = behind ? -o.perturbations[i].normal.x : o.perturbations[i].normal.x;
        o.perturbations[i].normal.y = behind ? -o.perturbations[i].normal.y : o.perturbations[i].normal.y;
    }
    return o;
}
