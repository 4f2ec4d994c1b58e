// blendbsdf: two BSDFs, the second one with the share `weight`, clamped to [0, 1], and the first one with the rest.
//   <bsdf type="blendbsdf"> <float name="weight" value="0.3"/> <bsdf type="diffuse"/> <bsdf type="mirror"/> </bsdf>
// eval and pdf are the sums of both, each times its share. bsdf_respond draws one of the BSDFs by their shares. They
// may lead to others, blends too.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "surface.cl"

static BsdfOpening blendbsdf_open(const Scene *scene, const Surface *s, blendbsdf_bsdf b, BsdfOpening o, mask m) {
    real weight = real_min(real_max(b.weight, (real)(0)), (real)(1));
    real middle = o.leaf.low + (o.leaf.high - o.leaf.low) * (1 - weight);
    uints bit = (uints)(0x80000000u) >> o.leaf.blends;
    mask by_number = o.leaf.number < middle, by_place = to_mask((o.leaf.place & bit) == 0u);
    mask first = (o.leaf.drawn & by_number) | (by_place & !o.leaf.drawn);
    o.at = uints_pick(first, b.first, b.second);
    o.leaf.share = o.leaf.share * (first ? 1 - weight : weight);
    o.leaf.low = first ? o.leaf.low : middle;
    o.leaf.high = first ? middle : o.leaf.high;
    o.leaf.place = uints_pick(first, o.leaf.place, o.leaf.place | bit);
    o.leaf.blends = o.leaf.blends + 1u;
    return o;
}
