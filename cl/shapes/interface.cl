// interface: what every shape offers (shapes/NAME.cl for each row of shapes/list.h).
//   BlockTest intersect_NAME(block, place, ray)
//       a ray's line against primitives of a block (NAME_blocks of Scene): in kernels of one lane that in `place`, in
//       others all eight. Where a ray can meet a primitive twice, the first meeting after ray->tmin.
//   Surface surface_of_NAME(scene, ray, hit, active)
//       the surface where each active lane's ray hit; the other lanes get that of place 0. It may set a better t.
// A block has rows of eight words, one for each primitive. Its row `id` is OPAL_NONE in unused places, which come last;
// they hold what no ray hits, or repeat the first primitive.
#include "core/lanes.cl"
#include "shared/types.h"
#if LANES == 1
#include "shapes/one_lane/places.cl"
#else
#include "shapes/many_lanes/places.cl"
#endif

// The word of `place` (Hit) within a row of a block, counted from the first block's row, for GATHER_WORD. record: that
// of the blocks
#define WORD_OF_PLACE(record, place) word_of_place(place, sizeof(record) / 4)
static uints word_of_place(uints place, uint block_words) {
    return (place / (uint)(OPAL_WIDTH)) * block_words + place % (uint)(OPAL_WIDTH);
}

// One ray as a walk of the tree needs it. Its direction is (shear_x, shear_y, 1) / scale_z along the axes kx, ky, kz.
typedef struct {
    real1 o[3];                           // origin
    real1 inverse[3], widened[3];         // 1 / d, finite; the same times BOX_WIDENING
    uint near[3], far[3];                 // offsets of each axis' near and far planes, by the direction's sign
    uint kx, ky, kz;                      // axes, as in Shear
    real1 sheared_o[3];                   // o[kx], o[ky], o[kz]
    real1 shear_x, shear_y, scale_z;
    real1 tmin, tmax;
} LaneRay;

// Where a ray's line meets primitives, one a place: t = distance / determinant, and the coordinates u = b / determinant
// and v = c / determinant. They are left undivided because most are never used. determinant >= 0
typedef struct {
    places distance, determinant, b, c;
    place_mask inside; // where it meets them at all
} BlockTest;
