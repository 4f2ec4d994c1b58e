// The records and functions that cl/kernels/selftest.cl checks, written once for host and device.
#ifndef OPAL_SELFTEST_LIST_H
#define OPAL_SELFTEST_LIST_H

#include "bsdfs/list.h"
#include "cameras/list.h"
#include "emitters/list.h"
#include "shapes/list.h"
#include "shared/types.h"

// Records whose sizes, and members whose offsets, must be the same on both sides.
#define OPAL_RECORDS(RECORD) \
    RECORD(BvhNode) RECORD(TriangleBlock) RECORD(Triangle) RECORD(FaceRecord) RECORD(FaceRange) RECORD(MeshRecord) \
    RECORD(Settings) RECORD(CameraRecord) RECORD(EmitterRecord) RECORD(LightTriangle) RECORD(EnvironmentTexel) \
    OPAL_EMITTERS(OPAL_EMITTER_SIZE)
#define OPAL_EMITTER_SIZE(name, traits) OPAL_SIZE(emitter_##name##_record)
#define OPAL_MEMBERS(MEMBER) \
    MEMBER(BvhNode, hi) MEMBER(BvhNode, child) MEMBER(TriangleBlock, id) MEMBER(Triangle, mesh) \
    MEMBER(FaceRecord, corner) MEMBER(MeshRecord, emitter) MEMBER(CameraRecord, forward) \
    MEMBER(CameraRecord, own) MEMBER(Settings, face_list_slot) MEMBER(Settings, rr_prob) \
    MEMBER(Settings, light_energy) MEMBER(Settings, filter_c) MEMBER(Settings, choices) \
    MEMBER(EmitterRecord, probability) MEMBER(EmitterRecord, other) MEMBER(EmitterRecord, u) \
    MEMBER(LightTriangle, inverse_pdf) MEMBER(EnvironmentTexel, other)

// Says the layout of all records by the statements OPAL_SIZE(T) and OPAL_OFFSET(T, member), which either side defines.
#define OPAL_LAYOUT \
    OPAL_RECORDS(OPAL_SIZE) OPAL_MEMBERS(OPAL_OFFSET) OPAL_ALL_BSDFS(OPAL_BSDF_LAYOUT) OPAL_CAMERAS(OPAL_CAMERA_LAYOUT)
#define OPAL_CAMERA_LAYOUT(name, record, traits) OPAL_SIZE(record)
#define OPAL_BSDF_LAYOUT(name, traits) \
    { \
        typedef bsdf_##name##_record Record; \
        OPAL_SIZE(Record) \
        OPAL_BSDF_##name(OPAL_PARAMETER_OFFSET) \
    }
#define OPAL_PARAMETER_OFFSET(type, name, xml, initial, range, meaning) OPAL_OFFSET(Record, name)

// Functions that rendering uses: MATH(name, on the device, on the host in double, lowest x, highest x, scale, limit).
// The error is counted in ulp of the larger of |result| and scale; limit: what OpenCL C 1.2, table 7.4, allows in ulp,
// and for our own functions what they promise. Where the lowest x is positive, x is spread over its exponents.
#define OPAL_MATH(MATH) \
    MATH(reciprocal, 1 / x, 1 / x, 1e-30, 1e30, 0, 2.5) \
    MATH(sqrt, sqrt(x), sqrt(x), 1e-30, 1e30, 0, 3) \
    MATH(rsqrt, rsqrt(x), 1 / sqrt(x), 1e-30, 1e30, 0, 2) \
    MATH(exp, exp(x), exp(x), -80, 80, 0, 3) \
    MATH(expm1, expm1(x), expm1(x), -1, 1, 0, 3) \
    MATH(log, log(x), log(x), 1e-30, 1e30, 0, 3) \
    MATH(log1p, log1p(x), log1p(x), -0.999, 1, 0, 2) \
    MATH(pow_20, pow(x, (real)(20)), pow(x, 20), 0.1, 1, 0, 16) \
    MATH(cos_2pi, cos_sin_2pi(x).x, cos(2 * pi * x), -1, 1, 1, 2) \
    MATH(sin_2pi, cos_sin_2pi(x).y, sin(2 * pi * x), -1, 1, 1, 2) \
    MATH(turn_of, turn_of(x, (real)(1)), atan(x) / (2 * pi), -4, 4, 0.125, 2)

#define OPAL_MATH_ENUM(name, device, host, low, high, scale, limit) MATH_##name,
enum { OPAL_MATH(OPAL_MATH_ENUM) MATH_COUNT };

#endif
