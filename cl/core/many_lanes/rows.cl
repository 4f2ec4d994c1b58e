// many_lanes/rows: neighbouring words of each lane by one load a lane. Vectors of eight lanes, and of four in kernels
// of four, exchange rows with columns within their halves, as AVX does it at once; sixteen lanes are two of these.
#include "core/lanes.cl"

#if LANES == 4
#define PART 4
#else
#define PART 8
#endif
typedef CAT(uint, PART) lanes_part;
#define OF_PART(name) CAT(name, PART)

// x0 y0 x1 y1 and x2 y2 x3 y3; of four columns at a time.
#define WOVEN_LOW_4(x, y) (uint4)((x).s0, (y).s0, (x).s1, (y).s1)
#define WOVEN_HIGH_4(x, y) (uint4)((x).s2, (y).s2, (x).s3, (y).s3)
#define WOVEN_LOW_8(x, y) (uint8)(WOVEN_LOW_4((x).lo, (y).lo), WOVEN_LOW_4((x).hi, (y).hi))
#define WOVEN_HIGH_8(x, y) (uint8)(WOVEN_HIGH_4((x).lo, (y).lo), WOVEN_HIGH_4((x).hi, (y).hi))
#define WOVEN_LOW(x, y) OF_PART(WOVEN_LOW_)(x, y)
#define WOVEN_HIGH(x, y) OF_PART(WOVEN_HIGH_)(x, y)

// The words of lane k, and beside them those of lane k + 4.
#define WORDS_OF(at, k) vload4(0, words + (at).s##k)
#define ROWS_4(at, k, beside) WORDS_OF(at, k)
#define ROWS_8(at, k, beside) (uint8)(WORDS_OF(at, k), WORDS_OF(at, beside))

typedef struct { lanes_part a, b, c, d; } FourWordsOfPart;

static FourWordsOfPart four_words_of_part(global const uint *words, lanes_part at) {
    lanes_part r0 = OF_PART(ROWS_)(at, 0, 4), r1 = OF_PART(ROWS_)(at, 1, 5);
    lanes_part r2 = OF_PART(ROWS_)(at, 2, 6), r3 = OF_PART(ROWS_)(at, 3, 7);
    lanes_part ab_even = WOVEN_LOW(r0, r2), ab_odd = WOVEN_LOW(r1, r3);
    lanes_part cd_even = WOVEN_HIGH(r0, r2), cd_odd = WOVEN_HIGH(r1, r3);
    FourWordsOfPart rows = {WOVEN_LOW(ab_even, ab_odd), WOVEN_HIGH(ab_even, ab_odd), WOVEN_LOW(cd_even, cd_odd),
                            WOVEN_HIGH(cd_even, cd_odd)};
    return rows;
}

// The eight bytes of lanes k and l, and beside them those of lanes k + 4 and l + 4.
#define BYTES_OF(at, k) as_uint2(vload8(0, (global const uchar *)words + (at).s##k))
#define BYTES_4(at, k, l, k_beside, l_beside) (uint4)(BYTES_OF(at, k), BYTES_OF(at, l))
#define BYTES_8(at, k, l, k_beside, l_beside) \
    (uint8)(BYTES_4(at, k, l, 0, 0), BYTES_4(at, k_beside, l_beside, 0, 0))
#define EVEN_4(x, y) (uint4)((x).s0, (x).s2, (y).s0, (y).s2)
#define ODD_4(x, y) (uint4)((x).s1, (x).s3, (y).s1, (y).s3)
#define EVEN_8(x, y) (uint8)(EVEN_4((x).lo, (y).lo), EVEN_4((x).hi, (y).hi))
#define ODD_8(x, y) (uint8)(ODD_4((x).lo, (y).lo), ODD_4((x).hi, (y).hi))

typedef struct { lanes_part low, high; } EightBytesOfPart;

static EightBytesOfPart eight_bytes_of_part(global const uint *words, lanes_part at) {
    lanes_part first = OF_PART(BYTES_)(at, 0, 1, 4, 5), second = OF_PART(BYTES_)(at, 2, 3, 6, 7);
    EightBytesOfPart bytes = {OF_PART(EVEN_)(first, second), OF_PART(ODD_)(first, second)};
    return bytes;
}
