// mask: a surface with holes.
#include "bsdfs/interface.cl"
#include "core/lanes.cl"

static BsdfOpening mask_open(mask_bsdf b, BsdfOpening o) {
    o.at = b.base;
    return o;
}
