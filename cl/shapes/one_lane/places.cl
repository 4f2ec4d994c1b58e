// one_lane/places: the primitives of a block are tested one after the other.
#include "core/lanes.cl"

typedef real1 places;    // a number of the one that is tested
typedef bool place_mask;

// A row of a block, from the place on that is tested, as reals.
#define load_places(row) ((real1)(row)[0])
