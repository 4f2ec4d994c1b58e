// rng: random numbers that depend on (pixel, sample index, dimension, seed) alone, so that an image does not depend on
// how its samples are cut into passes or spread over lanes. Every number is k 2^-24 with k < 2^24: in [0, 1), exact in
// float. draw() in scene.cl picks the sampler that the scene asks for.
//
// A dimension is a pair of numbers, drawn by its key. The camera has DIM_FILM (key 0), which places the sample in its
// pixel, and each segment of a path has the DIMS_A_SEGMENT dimensions below (keys from 1 on). These leave no room for
// another one, and moving them would change all pictures. A new dimension is ADDED_DIMENSION + n, with an n below
// ADDED_A_SEGMENT that its segment, or the camera, does not have yet. Nothing else is reserved.
#include "core/lanes.cl"
#include "core/math.cl"

#define ADDED_DIMENSION 0x80000000u
#define ADDED_A_SEGMENT 8

// Of the camera.
#define DIM_FILM 0
#define DIM_LENS (ADDED_DIMENSION + 0) // the point on the lens; of cameras that have one

// Of a segment.
#define DIM_BSDF 0         // direction
#define DIM_LOBE 1         // .x which lobe, .y Russian roulette
#define DIM_LIGHT 2        // point on the light
#define DIM_EMITTER 3      // which emitter: .x row, .y alias
#define DIM_TRIANGLE 4     // which triangle: .x row, .y alias
#define DIM_MET (ADDED_DIMENSION + 0) // .x whether light meets a masked surface, .y which BSDF of a blend; of kernels
                                      // with masks or blends
#define DIMS_A_SEGMENT 5

// The key of a dimension in a path's segment d, which counts from 1; 0: an added dimension of the camera. Keys are
// distinct up to 2^28 segments. Those of added dimensions have the highest bit set. The other bits count them in steps
// of 2^32 / golden ratio: numbers of two keys that differ in the highest bit alone are correlated, because multiplying
// carries bits upwards only.
static uints segment_dimension(uints d, uint dimension) {
    if (dimension & ADDED_DIMENSION)
        return ADDED_DIMENSION | (d * (uint)ADDED_A_SEGMENT + (dimension - ADDED_DIMENSION + 1u)) * 0x9e3779b9u;
    return 1u + (d - 1u) * (uint)DIMS_A_SEGMENT + dimension;
}

typedef struct {
    uints pixel, sample;   // y * width + x; index of the sample within its pixel
    uints key0, key1;      // their hash with the seed
} Sampler;

typedef struct { uints x, y; } u2;
typedef struct { uints x, y, z; } u3;

// pcg3d and pcg4d of Jarzynski and Olano 2020, "Hash Functions for GPU Rendering".
static u3 pcg3d(uints x, uints y, uints z) {
    x = x * 1664525u + 1013904223u; y = y * 1664525u + 1013904223u; z = z * 1664525u + 1013904223u;
    x += y * z; y += z * x; z += x * y;
    x ^= x >> 16; y ^= y >> 16; z ^= z >> 16;
    x += y * z; y += z * x; z += x * y;
    u3 r = {x, y, z};
    return r;
}
static void pcg4d(uints *x, uints *y, uints *z, uints *w) {
    *x = *x * 1664525u + 1013904223u; *y = *y * 1664525u + 1013904223u;
    *z = *z * 1664525u + 1013904223u; *w = *w * 1664525u + 1013904223u;
    *x += *y * *w; *y += *z * *x; *z += *x * *y; *w += *y * *z;
    *x ^= *x >> 16; *y ^= *y >> 16; *z ^= *z >> 16; *w ^= *w >> 16;
    *x += *y * *w; *y += *z * *x; *z += *x * *y; *w += *y * *z;
}

// The sampler of sample `sample` of a pixel.
static Sampler sampler_start(uints pixel, uints sample, uint seed) {
    uints x = pixel, y = sample, z = (uints)(seed), w = (uints)(0x9e3779b9u); // any constant: here 2^32 / golden ratio
    pcg4d(&x, &y, &z, &w);
    Sampler s = {pixel, sample, x, y};
    return s;
}

#define GRID R(16777216.0)                      // 2^24 numbers ...
#define GRID_STEP R(5.9604644775390625e-08)     // ... 2^-24 apart

// The upper 24 bits as a number in [0, 1).
static real unit_real(uints bits) { return to_real(bits >> 8) * GRID_STEP; }

// The probability that u < p for a random number u, with p in [0, 1]: ceil(p 2^24) 2^-24, because u is a multiple of
// 2^-24. Weights must divide by it. Dividing by p is a bias, 1 % of it where p is 1e-6.
static real drawn_probability(real p) {
    // ceil() by an integer, because PoCL's own is a dozen instructions.
    real numbers = p * GRID, whole = to_real(CAT(convert_, WIDE(int))(numbers));
    return (whole < numbers ? whole + 1 : whole) * GRID_STEP;
}

// A choice between two things. Weights divide by `probability`, which is exact, never by the p that was asked for.
typedef struct {
    mask first;        // u < p: the first one is chosen
    real probability;  // of the one that is chosen
} Choice;

// Chooses the first of two things with probability p, by the random number u.
static Choice choose(real p, real u) {
    real drawn = drawn_probability(p);
    Choice c;
    c.first = u < p;
    c.probability = c.first ? drawn : 1 - drawn;
    return c;
}

static uints reverse_bits(uints x) {
    x = ((x >> 1) & 0x55555555u) | ((x & 0x55555555u) << 1);
    x = ((x >> 2) & 0x33333333u) | ((x & 0x33333333u) << 2);
    x = ((x >> 4) & 0x0f0f0f0fu) | ((x & 0x0f0f0f0fu) << 4);
    x = ((x >> 8) & 0x00ff00ffu) | ((x & 0x00ff00ffu) << 8);
    return (x >> 16) | (x << 16);
}

// An Owen scramble of the bits of x, highest first, as a hash (Laine and Karras 2011, improved by Vegdahl 2021).
static uints owen_scramble(uints x, uints seed) {
    x = reverse_bits(x);
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1u;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return reverse_bits(x);
}

// The second Sobol dimension of index i. Its generator matrix is Pascal's triangle mod 2, which sums over subsets of
// bit positions: five butterflies on the reversed bits.
static uints sobol_second(uints i) {
    uints x = reverse_bits(i);
    x ^= (x & 0x55555555u) << 1;
    x ^= (x & 0x33333333u) << 2;
    x ^= (x & 0x0f0f0f0fu) << 4;
    x ^= (x & 0x00ff00ffu) << 8;
    x ^= (x & 0x0000ffffu) << 16;
    return x;
}

// A pair of Owen-scrambled Sobol points, padded: each dimension shuffles the order of its points (Burley 2020).
static u2 sobol_pair(Sampler s, uints dimension, uint seed) {
    u3 h = pcg3d(s.pixel, dimension, (uints)(seed));
    uints i = owen_scramble(s.sample, h.x);
    u2 pair = {owen_scramble(reverse_bits(i), h.y), owen_scramble(sobol_second(i), h.z)};
    return pair;
}

// The place of i in a random permutation of 0 ... n-1, which p selects (Kensler 2013, "Correlated Multi-Jittered
// Sampling", listing 3). The result is rotated by `turn`, because p alone favours some places by up to 0.3 % where n is
// small.
static uints permute(uints i, uint n, uints p, uints turn) {
    uint w = n - 1;
    w |= w >> 1; w |= w >> 2; w |= w >> 4; w |= w >> 8; w |= w >> 16;
    uints r = i;
    mask out = to_mask(r == r);
    while (ANY(out)) {
        uints x = r;
        x ^= p; x *= 0xe170893du; x ^= p >> 16; x ^= (x & w) >> 4; x ^= p >> 8; x *= 0x0929eb3fu;
        x ^= p >> 23; x ^= (x & w) >> 1; x *= 1 | p >> 27; x *= 0x6935fa69u; x ^= (x & w) >> 11; x *= 0x74dcb303u;
        x ^= (x & w) >> 2; x *= 0x9e501cc3u; x ^= (x & w) >> 2; x *= 0xc860a3dfu; x &= w; x ^= x >> 5;
        r = uints_pick(out, x, r);
        out = out & to_mask(r >= n);
    }
    return (r + turn % n) % n;
}

// One jittered stratum of a grid of at least `spp` cells. Each dimension goes through the cells in an order of its own.
static u2 stratified_pair(Sampler s, uints dimension, uint spp, uint seed) {
    spp = min(spp, 1u << 30); // or the number of cells overflows
    uint columns = max(1u, (uint)sqrt((float)spp)), rows = (spp + columns - 1) / columns, cells = columns * rows;
    uints round = s.sample / cells; // past spp the strata start over
    u3 h = pcg3d(s.pixel, dimension, (uints)(seed) ^ (round * 0x85ebca6bu));
    u3 jitter = pcg3d(s.key0, s.key1, dimension);
    uints cell = permute(s.sample - round * cells, cells, h.x, h.y);
    uints row = cell / columns, column = cell - row * columns;
    // (cell + u) / n may round up to 1 in the last cell, hence the minimum.
    uints x = to_uints(real_min((to_real(column) + unit_real(jitter.x)) / (real1)columns * GRID, (real)(GRID - 1)));
    uints y = to_uints(real_min((to_real(row) + unit_real(jitter.y)) / (real1)rows * GRID, (real)(GRID - 1)));
    u2 pair = {x << 8 | (jitter.x & 255u), y << 8 | (jitter.y & 255u)};
    return pair;
}
