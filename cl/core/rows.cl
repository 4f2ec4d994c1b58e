// rows: neighbouring words of a table, read together, each lane at a place of its own. Of words that lie side by side
// this takes fewer instructions than a GATHER of each: a lane's words are loaded at once, and the lanes' exchanged.
#include "core/lanes.cl"
#if LANES == 1
#include "core/one_lane/rows.cl"
#else
#include "core/many_lanes/rows.cl"
#endif

// Words as they would be of GATHER_WORD(real, ...).
#define reals_of_words(words) to_real(CAT(as_, WIDE(float))(words))

// Three floats at words[at] of each lane; a fourth is read, too.
static v3 v3_at(global const float *words, uints at) {
    FourWords row = four_words((global const uint *)words, at);
    return v3_of(reals_of_words(row.a), reals_of_words(row.b), reals_of_words(row.c));
}
