// planes: values of many samples in memory, value k of sample i at [k * stride + i], read and written a lane each. Integers
// are in them by their bits.
static real get(global const float *planes, uint plane, uint stride, uint base) {
    real1 lanes[LANES];
    for (uint lane = 0; lane < LANES; lane++) lanes[lane] = planes[plane * stride + base + lane];
    return LOAD(real, lanes);
}
static v2 get_v2(global const float *planes, uint plane, uint stride, uint base) {
    return v2_of(get(planes, plane, stride, base), get(planes, plane + 1, stride, base));
}
static v3 get_v3(global const float *planes, uint plane, uint stride, uint base) {
    return v3_of(get(planes, plane, stride, base), get(planes, plane + 1, stride, base), get(planes, plane + 2, stride, base));
}
static void put(global float *planes, uint plane, uint stride, uint base, real value) {
    real1 lanes[LANES];
    STORE(value, lanes);
    for (uint lane = 0; lane < LANES; lane++) planes[plane * stride + base + lane] = (float)lanes[lane];
}
static void put_v3(global float *planes, uint plane, uint stride, uint base, v3 value) {
    put(planes, plane, stride, base, value.x);
    put(planes, plane + 1, stride, base, value.y);
    put(planes, plane + 2, stride, base, value.z);
}
static void put_uints(global float *planes, uint plane, uint stride, uint base, uints value) {
    uint lanes[LANES];
    STORE(value, lanes);
    for (uint lane = 0; lane < LANES; lane++) planes[plane * stride + base + lane] = as_float(lanes[lane]);
}
static uints lane_indices(uint base) {
    uint lanes[LANES];
    for (uint lane = 0; lane < LANES; lane++) lanes[lane] = base + lane;
    return LOAD(uints, lanes);
}
