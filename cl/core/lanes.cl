// lanes: the types that hold LANES paths at once, and the few operations that depend on the width.
//
// A work-item carries LANES paths, one to a lane. Shading code is written in these types and reads the same at every
// width (1, 4, 8, 16) and in both precisions. At width 1 they are plain scalars.
//   real   one number a lane: float, or double where OPAL_DOUBLE
//   mask   one truth value a lane, as comparisons of reals give it. Combine masks with & | !, never with ~, because a
//          scalar's true is 1.
//   ints, uints   one integer a lane. Convert their comparisons by to_mask before combining them with a mask.
//   real1, real8  one number; eight numbers of one ray (children of a node, triangles of a block)
//   key1, mask8   an integer as wide as a real1; eight of them (the keys of trace/)
#if defined(__clang__) && LANES > 1
// clang warns that wide vectors are passed in memory. It does not matter: every caller is in this program.
#pragma clang diagnostic ignored "-Wpsabi"
#endif
// Is this a program for all scenes?
#define GENERAL (OPAL_AXIS_integrator < 0)
// Marks a long function with several callers: a program for all scenes calls it instead of inlining a copy for each.
#if GENERAL && defined(__clang__)
#define CALLED __attribute__((noinline))
#else
#define CALLED
#endif
#define CAT_(a, b) a##b
#define CAT(a, b) CAT_(a, b)

#if OPAL_DOUBLE
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double real1;
typedef double8 real8;
typedef long8 mask8;
typedef long key1;
typedef long4 half_keys;
typedef long2 quarter_keys;
#define keys_of(x) as_long8(x)
#define key_of(x) as_long(x)
#define NO_KEY LONG_MAX
#define R(x) x
#define REAL_NAME double
#define MASK_NAME long
#define EPSILON 1.1102230246251565e-16 // half an ulp of 1
#else
typedef float real1;
typedef float8 real8;
typedef int8 mask8;
typedef int key1;
typedef int4 half_keys;
typedef int2 quarter_keys;
#define keys_of(x) as_int8(x)
#define key_of(x) as_int(x)
#define NO_KEY INT_MAX
#define R(x) x##f
#define REAL_NAME float
#define MASK_NAME int
#define EPSILON 5.9604645e-08f
#endif

#if LANES == 1
#define WIDE(T) T
#define ANY(m) (m)
#define LANE_BITS(m) ((uint)(m))
#define LANE_PLACES 1
#define LANE_NUMBERS 0u
#define STORE(v, array) ((array)[0] = (v))
#define LOAD(T, array) ((array)[0])
#define to_mask(condition) (condition)
#define to_ints(m) (m)
#define GATHER(T, array, i, field) ((T)(array[i] field))
#define GATHER_WORD(T, pointer, word) ((T)((pointer)[word]))
#else
#define WIDE(T) CAT(T, LANES)
// Is any lane true? Lanes are tested two to a 64-bit word, because PoCL's any() tests one lane after the other.
#define HALF_4 2
#define HALF_8 4
#define HALF_16 8
#define ANY_4(w) (((w).x | (w).y) != 0)
#define ANY_8(w) ANY_4((w).lo | (w).hi)
#define ANY_16(w) ANY_8((w).lo | (w).hi)
#define ANY(m) CAT(ANY_, LANES)(CAT(as_ulong, CAT(HALF_, LANES))(to_ints(m)))
#define BITS_2(w) ((uint)((w).x | (w).y))
#define BITS_4(w) BITS_2((w).lo | (w).hi)
#define BITS_8(w) BITS_4((w).lo | (w).hi)
#define BITS_16(w) BITS_8((w).lo | (w).hi)
#define PLACES_4 (int4)(1, 2, 4, 8)
#define PLACES_8 (int8)(PLACES_4, PLACES_4 << 4)
#define PLACES_16 (int16)(PLACES_8, PLACES_8 << 8)
#define LANE_PLACES CAT(PLACES_, LANES)
#define NUMBERS_4 (uint4)(0, 1, 2, 3)
#define NUMBERS_8 (uint8)(NUMBERS_4, NUMBERS_4 + 4)
#define NUMBERS_16 (uint16)(NUMBERS_8, NUMBERS_8 + 8)
#define LANE_NUMBERS CAT(NUMBERS_, LANES)
#define LANE_BITS(m) CAT(BITS_, LANES)((m) & LANE_PLACES)
#define STORE(v, array) CAT(vstore, LANES)(v, 0, array)
#define LOAD(T, array) CAT(vload, LANES)(0, array)
#define to_mask(condition) CAT(convert_, WIDE(MASK_NAME))(condition)
#define to_ints(m) CAT(convert_, WIDE(int))(m)
#define GATHER_4(p, i) p[(i).s0], p[(i).s1], p[(i).s2], p[(i).s3]
#define GATHER_8(p, i) GATHER_4(p, i), p[(i).s4], p[(i).s5], p[(i).s6], p[(i).s7]
#define GATHER_16(p, i) \
    GATHER_8(p, i), p[(i).s8], p[(i).s9], p[(i).sa], p[(i).sb], p[(i).sc], p[(i).sd], p[(i).se], p[(i).sf]
// Reads `field` of array[i], each lane with its own i: GATHER(real, scene->emitters, id, .probability). It reads for
// inactive lanes too: every lane's index must be valid. One vector of word indices lets compilers emit hardware
// gathers.
#define GATHER(T, array, i, field) GATHER_WORD(T, &(array)[0] field, (i) * (uint)(sizeof((array)[0]) / 4))
// Likewise pointer[word], of 4-byte words.
#define GATHER_WORD(T, pointer, word) ((T)(CAT(GATHER_, LANES)((pointer), (word))))
#endif

// Reads a field of three floats as one v3: GATHER_V3(scene->emitters, id, .u.of_point.position)
#define GATHER_V3(array, i, field) \
    v3_of(GATHER(real, array, i, field[0]), GATHER(real, array, i, field[1]), GATHER(real, array, i, field[2]))

typedef WIDE(REAL_NAME) real;
#if LANES == 1
typedef int mask;
#else
typedef WIDE(MASK_NAME) mask;
#endif
typedef WIDE(MASK_NAME) lane_keys; // an integer as wide as a real
typedef WIDE(int) ints;
typedef WIDE(uint) uints;

#define real_bits(x) CAT(as_, WIDE(MASK_NAME))(x)
#define real_of_bits(i) CAT(as_, WIDE(REAL_NAME))(i)
#define to_real(i) CAT(convert_, WIDE(REAL_NAME))(i)
#define to_floats(x) CAT(convert_, WIDE(float))(x)
#define to_uints(x) CAT(convert_, WIDE(uint))(x)
#define as_signed(i) CAT(as_, WIDE(int))(i)
#define as_unsigned(i) CAT(as_, WIDE(uint))(i)

// a b + c, which compilers contract to one instruction where the device has it. PoCL's mad() stays two.
#define mul_add(a, b, c) ((a) * (b) + (c))

#define NO_LANES ((mask)(0))
#define ALL_LANES (!NO_LANES)

// Every function but kernels is static: compilers then drop unused ones unread, a quarter of the cold compile time.
typedef struct { real x, y; } v2;
typedef struct { real x, y, z; } v3;

static v2 v2_of(real x, real y) { v2 v = {x, y}; return v; }
static v3 v3_of(real x, real y, real z) { v3 v = {x, y, z}; return v; }
static v3 v3_all(real x) { return v3_of(x, x, x); }
static v3 v3_from(global const float *p) { return v3_of((real)(p[0]), (real)(p[1]), (real)(p[2])); }
static v3 v3_add(v3 a, v3 b) { return v3_of(a.x + b.x, a.y + b.y, a.z + b.z); }
static v3 v3_sub(v3 a, v3 b) { return v3_of(a.x - b.x, a.y - b.y, a.z - b.z); }
static v3 v3_mul(v3 a, v3 b) { return v3_of(a.x * b.x, a.y * b.y, a.z * b.z); }
static v3 v3_scale(v3 a, real s) { return v3_of(a.x * s, a.y * s, a.z * s); }
static v3 v3_neg(v3 a) { return v3_of(-a.x, -a.y, -a.z); }
static v3 v3_mad(v3 a, real s, v3 b) { // a s + b
    return v3_of(mul_add(a.x, s, b.x), mul_add(a.y, s, b.y), mul_add(a.z, s, b.z));
}
static real v3_dot(v3 a, v3 b) { return mul_add(a.x, b.x, mul_add(a.y, b.y, a.z * b.z)); }
static v3 v3_cross(v3 a, v3 b) { return v3_of(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x); }
static v3 v3_normalize(v3 a) { return v3_scale(a, rsqrt(v3_dot(a, a))); }
static v3 v3_abs(v3 a) { return v3_of(fabs(a.x), fabs(a.y), fabs(a.z)); }

// A set of lanes as bits, lane i in bit i, to loop over by lowest_lane.
static uint lanes_of(mask m) { return LANE_BITS(to_ints(m)); }
static int lowest_lane(uint lanes) { return (int)popcount(~lanes & (lanes - 1)); } // CL 1.2 has no ctz
static mask mask_of(uint lanes) { return to_mask((LANE_PLACES & (int)lanes) != 0); }
static int count_lanes(mask m) { return (int)popcount(lanes_of(m)); }

// `yes` in the lanes of m, `no` in the others.
static uints uints_pick(mask m, uints yes, uints no) { return to_ints(m) ? yes : no; }
static v3 v3_pick(mask m, v3 yes, v3 no) { return v3_of(m ? yes.x : no.x, m ? yes.y : no.y, m ? yes.z : no.z); }

// a, or -a where s is negative.
static real turned_as(real a, real s) { return real_of_bits(real_bits(a) ^ (real_bits(s) & ~NO_KEY)); }
