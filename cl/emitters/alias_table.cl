// alias_table: choosing a row of a table with given probabilities by two random words (Walker 1977, "An Efficient
// Method for Generating Discrete Random Variables with General Distributions"). The host makes the tables.
#include "core/lanes.cl"
#include "core/rng.cl"
#include "emitters/list.h"

// Row floor(k n 2^-24) of n rows, by the upper 24 bits k, which Sobol samples stratify. Tables of more than
// OPAL_ALIAS_ROWS rows would leave a row too few of these numbers and use all 32 bits.
static uints alias_row(uints bits, uints n) {
    uints used = uints_pick(to_mask(n > OPAL_ALIAS_ROWS), bits, bits & 0xffffff00u);
    return mul_hi(used, n);
}

// Sets `entry` to an entry of an alias table of n rows, given two random words; `first`: index of its first row in that
// table of records. Exactly the words that the host counted (flatten/distribution.cpp) lead to an entry, so that its
// probability in the records is exact.
#define ALIAS_ENTRY(scene, table, first, n, u, entry) { \
    uints row_ = alias_row((u).x, n); \
    mask kept_ = unit_real((u).y) < GATHER(real, (scene)->table, (first) + row_, .accept); \
    entry = (first) + uints_pick(kept_, row_, GATHER(uints, (scene)->table, (first) + row_, .other)); \
}
