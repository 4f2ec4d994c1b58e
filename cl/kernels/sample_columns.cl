// sample_columns: values of many samples in memory, value `column` of sample i at [column * stride + i], read and
// written a lane each. Integers are stored by their bits.
#include "core/lanes.cl"

static real get(global const float *columns, uint column, uint stride, uint base) {
    real1 lanes[LANES];
    for (uint lane = 0; lane < LANES; lane++) lanes[lane] = columns[column * stride + base + lane];
    return LOAD(real, lanes);
}
static v2 get_v2(global const float *columns, uint column, uint stride, uint base) {
    return v2_of(get(columns, column, stride, base), get(columns, column + 1, stride, base));
}
static v3 get_v3(global const float *columns, uint column, uint stride, uint base) {
    return v3_of(get(columns, column, stride, base), get(columns, column + 1, stride, base),
                 get(columns, column + 2, stride, base));
}
static void put(global float *columns, uint column, uint stride, uint base, real value) {
    real1 lanes[LANES];
    STORE(value, lanes);
    for (uint lane = 0; lane < LANES; lane++) columns[column * stride + base + lane] = (float)lanes[lane];
}
static void put_v3(global float *columns, uint column, uint stride, uint base, v3 value) {
    put(columns, column, stride, base, value.x);
    put(columns, column + 1, stride, base, value.y);
    put(columns, column + 2, stride, base, value.z);
}
static void put_uints(global float *columns, uint column, uint stride, uint base, uints value) {
    uint lanes[LANES];
    STORE(value, lanes);
    for (uint lane = 0; lane < LANES; lane++) columns[column * stride + base + lane] = as_float(lanes[lane]);
}

// base, base + 1, ... one a lane.
static uints lane_indices(uint base) {
    uint lanes[LANES];
    for (uint lane = 0; lane < LANES; lane++) lanes[lane] = base + lane;
    return LOAD(uints, lanes);
}
