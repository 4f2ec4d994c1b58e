// rows: neighbouring words of a table, read together, each lane at a place of its own. Of words that lie side by side
// this takes fewer instructions than a GATHER of each: a lane's words are loaded at once, and the lanes' exchanged.
#include "core/lanes.cl"
#if LANES > 1
#include "core/many_lanes/rows.cl"
#endif

typedef struct { uints a, b, c, d; } FourWords;
typedef struct { uints low, high; } EightBytes;

// words[at] to words[at + 3] of each lane.
static FourWords four_words(global const uint *words, uints at) {
#if LANES == 1
    FourWords row = {words[at], words[at + 1], words[at + 2], words[at + 3]};
#elif LANES == 16
    FourWordsOfPart lo = four_words_of_part(words, at.lo), hi = four_words_of_part(words, at.hi);
    FourWords row = {(uint16)(lo.a, hi.a), (uint16)(lo.b, hi.b), (uint16)(lo.c, hi.c), (uint16)(lo.d, hi.d)};
#else
    FourWordsOfPart all = four_words_of_part(words, at);
    FourWords row = {all.a, all.b, all.c, all.d};
#endif
    return row;
}

// Bytes at .. at + 7 of the words, the first one lowest. One lane reads the three words that may hold them.
static EightBytes eight_bytes(global const uint *words, uints at) {
#if LANES == 1
    global const uint *from = words + (at >> 2);
    uint shift = (at & 3u) * 8u, up = 31u - shift; // at shift 0 a single shift would be by all 32 bits
    EightBytes bytes = {(from[0] >> shift) | ((from[1] << 1) << up), (from[1] >> shift) | ((from[2] << 1) << up)};
#elif LANES == 16
    EightBytesOfPart lo = eight_bytes_of_part(words, at.lo), hi = eight_bytes_of_part(words, at.hi);
    EightBytes bytes = {(uint16)(lo.low, hi.low), (uint16)(lo.high, hi.high)};
#else
    EightBytesOfPart all = eight_bytes_of_part(words, at);
    EightBytes bytes = {all.low, all.high};
#endif
    return bytes;
}

// Words as they would be of GATHER_WORD(real, ...).
#define reals_of_words(words) to_real(CAT(as_, WIDE(float))(words))

// Three floats at words[at] of each lane; a fourth is read, too.
static v3 v3_at(global const float *words, uints at) {
    FourWords row = four_words((global const uint *)words, at);
    return v3_of(reals_of_words(row.a), reals_of_words(row.b), reals_of_words(row.c));
}
