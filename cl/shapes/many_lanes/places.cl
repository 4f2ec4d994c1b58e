// many_lanes/places: the eight primitives of a block are tested at once.
#include "core/lanes.cl"
#include "core/many_lanes/eight_wide.cl"

typedef real8 places;    // a number of each primitive
typedef mask8 place_mask;

// A row of a block as reals.
#define load_places(row) load8(row)
