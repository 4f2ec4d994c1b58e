// selftest: the layout of the records that the device shares with the host, and values of the math functions.
#include "core/lanes.cl"
#include "core/math.cl"
#include "kernels/selftest_list.h"

// The sizes and offsets of OPAL_LAYOUT.
kernel void layout(global uint *out) {
    uint i = 0;
#define OPAL_SIZE(T) out[i++] = (uint)sizeof(T);
#define OPAL_OFFSET(T, member) \
    { \
        T record; \
        out[i++] = (uint)((private char *)&record.member - (private char *)&record); \
    }
    OPAL_LAYOUT
}

// The values of each of OPAL_MATH's functions at `count` numbers of its own, a multiple of LANES, one column after the
// other.
kernel void math_values(global const float *xs, uint count, global float *out) {
    uint base = (uint)get_global_id(0) * LANES;
    if (base >= count) return;
    real1 lanes[LANES];
    real x, value;
#define EVALUATE(name, device, host, low, high, scale, limit) \
    for (uint lane = 0; lane < LANES; lane++) lanes[lane] = xs[MATH_##name * count + base + lane]; \
    x = LOAD(real, lanes); \
    value = device; \
    STORE(value, lanes); \
    for (uint lane = 0; lane < LANES; lane++) out[MATH_##name * count + base + lane] = (float)lanes[lane];
    OPAL_MATH(EVALUATE)
}
