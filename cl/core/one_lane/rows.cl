// one_lane/rows: words of one lane.
#include "core/lanes.cl"

typedef struct { uint a, b, c, d; } FourWords;

// words[at] to words[at + 3].
static FourWords four_words(global const uint *words, uint at) {
    FourWords row = {words[at], words[at + 1], words[at + 2], words[at + 3]};
    return row;
}

typedef struct { uint low, high; } EightBytes;

// Bytes at .. at + 7 of the words, the first one lowest, from the three words that may hold them.
static EightBytes eight_bytes(global const uint *words, uint at) {
    global const uint *from = words + (at >> 2);
    uint shift = (at & 3u) * 8u, up = 31u - shift; // at shift 0 a single shift would be by all 32 bits
    EightBytes bytes = {(from[0] >> shift) | ((from[1] << 1) << up), (from[1] >> shift) | ((from[2] << 1) << up)};
    return bytes;
}
