// many_lanes/eight_wide: operations on eight numbers of one ray (real8, mask8).
#include "core/lanes.cl"

// Minimum and maximum by one comparison, as minps does it: NaN in a is dropped, NaN in b stays.
static real8 real8_min(real8 a, real8 b) { return a < b ? a : b; }
static real8 real8_max(real8 a, real8 b) { return a > b ? a : b; }

// The true elements of a comparison as a set, one byte (0 or 1) each, to loop over by first_of.
static ulong bytes_of(mask8 truth) { return as_ulong(convert_char8(truth)) & 0x0101010101010101ul; }
static uint first_of(ulong bytes) { return (uint)(popcount(~bytes & (bytes - 1)) >> 3); } // CL 1.2 has no ctz

static key1 least_key(mask8 keys) {
    half_keys four = min(keys.lo, keys.hi);
    quarter_keys two = min(four.lo, four.hi);
    return min(two.x, two.y);
}

// Eight floats of a record in memory, as reals.
static real8 load8(global const float *p) {
#if OPAL_DOUBLE
    return convert_double8(vload8(0, p));
#else
    return vload8(0, p);
#endif
}

// Prefetches the cache line at p, a pointer to global char. PoCL's prefetch() does nothing; clang for the CPU has a
// builtin.
#define CACHE_LINE 64
#if defined(__clang__) && defined(__x86_64__)
#define FETCH(p) __builtin_prefetch((const void *)(size_t)(p))
#else
#define FETCH(p) prefetch(p, CACHE_LINE)
#endif
