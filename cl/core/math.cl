// math: constants, frames, and the few functions that are faster or safer here than in the library.
#include "core/lanes.cl"

#define PI R(3.14159265358979323846)
#define INV_PI R(0.31830988618379067154)
#define INV_TWO_PI R(0.15915494309189533577)
#define INV_FOUR_PI R(0.07957747154594766788)
#define FAR R(1e30) // beyond any scene, which is flattened to about [-1, 1]; finite, as fast math has no infinity

static real square(real x) { return x * x; }
// Minimum and maximum by one comparison, as minps does it: NaN in a is dropped, NaN in b stays. fmin and fmax cost
// more.
static real real_min(real a, real b) { return a < b ? a : b; }
static real real_max(real a, real b) { return a > b ? a : b; }
static real safe_sqrt(real x) { return sqrt(real_max(x, (real)(0))); }

// cos and sin of 2 pi u (x and y) for any u of moderate size. u is reduced exactly to an eighth of a turn, where the
// Taylor series ends below half an ulp (x^11/11! < 2^-28; in double x^19/19! < 2^-57). The library's argument reduction
// costs more.
static v2 cos_sin_2pi(real u) {
    real quarter = rint(4 * u);
    real x = (u - R(0.25) * quarter) * R(6.28318530717958647693);
    real x2 = x * x;
    real s = R(2.7557319223985893e-06), c = R(-2.7557319223985888e-07);
    if (OPAL_DOUBLE) {
        real s4 = mul_add(x2, (real)(R(2.8114572543455206e-15)), (real)(R(-7.6471637318198164e-13)));
        real s3 = mul_add(x2, mul_add(x2, s4, (real)(R(1.6059043836821613e-10))), (real)(R(-2.5052108385441720e-08)));
        real c3 = mul_add(x2, (real)(R(4.7794773323873853e-14)), (real)(R(-1.1470745597729725e-11)));
        s = mul_add(x2, s3, s);
        c = mul_add(x2, mul_add(x2, c3, (real)(R(2.0876756987868099e-09))), c);
    }
    s = mul_add(x2, mul_add(x2, mul_add(x2, s, (real)(R(-1.9841269841269841e-04))), (real)(R(8.3333333333333333e-03))),
            (real)(R(-1.6666666666666667e-01)));
    s = mul_add(x * x2, s, x);
    c = mul_add(x2, mul_add(x2, mul_add(x2, c, (real)(R(2.4801587301587302e-05))), (real)(R(-1.3888888888888889e-03))),
            (real)(R(4.1666666666666667e-02)));
    c = mul_add(x2 * x2, c, mul_add(x2, (real)(R(-0.5)), (real)(1)));
    // Quarter turns: odd ones swap, 1 and 2 negate the cosine, 2 and 3 the sine.
    real turn = quarter - 4 * floor(R(0.25) * quarter);
    mask odd = turn == 1 | turn == 3;
    real cosine = odd ? s : c, sine = odd ? c : s;
    return v2_of((turn == 1 | turn == 2) ? -cosine : cosine, turn >= 2 ? -sine : sine);
}

// sin of 2 pi u for u from 0 to 1/4: its Taylor series ends below half an ulp, relatively (x^15/15! < 2^-30).
static real sin_2pi_of_quarter(real u) {
    if (OPAL_DOUBLE) return cos_sin_2pi(u).y;
    real x = u * R(6.28318530717958647693), x2 = x * x;
    real s = mul_add(x2, (real)(R(1.6059043836821613e-10)), (real)(R(-2.5052108385441720e-08)));
    s = mul_add(x2, mul_add(x2, s, (real)(R(2.7557319223985893e-06))), (real)(R(-1.9841269841269841e-04)));
    s = mul_add(x2, mul_add(x2, s, (real)(R(8.333333333333333e-03))), (real)(R(-1.6666666666666667e-01)));
    return mul_add(x * x2, s, x);
}

// The angle from the x axis to the point (x, y) as a share of a whole turn, -1/2 to 1/2; 0 at the origin. The
// polynomial in (y/x)^2 is off by 2e-9 of a turn; atan2 costs more.
static real turn_of(real y, real x) {
    if (OPAL_DOUBLE) return atan2(y, x) * INV_TWO_PI;
    real across = fabs(x), up = fabs(y);
    mask steep = up > across;
    real most = steep ? up : across, q = (steep ? across : up) / (most > 0 ? most : (real)(1)), q2 = q * q;
    real s = mul_add(q2, (real)(R(4.510553421e-04)), (real)(R(-2.547279719e-03)));
    s = mul_add(q2, mul_add(q2, s, (real)(R(6.778028242e-03))), (real)(R(-1.192937193e-02)));
    s = mul_add(q2, mul_add(q2, s, (real)(R(1.692891993e-02))), (real)(R(-2.260409302e-02)));
    s = mul_add(q2, mul_add(q2, s, (real)(R(3.181902586e-02))), (real)(R(-5.305122347e-02)));
    real turn = q * mul_add(q2, s, (real)(R(1.591549406e-01)));
    turn = steep ? R(0.25) - turn : turn;
    return turned_as(x < 0 ? R(0.5) - turn : turn, y);
}

// An orthonormal frame around the unit vector n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited"). Their
// frame jumps where n.z changes sign. On upright walls the last bit decides that, so that each precision and device
// turned the same random numbers differently. Here it jumps at FRAME_JUMP, a height that hardly any surface has; 1 /
// (sign + n.z) stays below 1.6.
#define FRAME_JUMP R(-0.3719)
typedef struct { v3 s, t, n; } Frame;

static Frame frame_with_jump(v3 n, real jump) {
    real sign = n.z < jump ? (real)(-1) : (real)(1);
    real a = -1 / (sign + n.z), b = n.x * n.y * a;
    Frame f = {v3_of(1 + sign * n.x * n.x * a, sign * b, -sign * n.x), v3_of(b, sign + n.y * n.y * a, -n.y), n};
    return f;
}
static Frame frame_of(v3 n) { return frame_with_jump(n, (real)(FRAME_JUMP)); }
static v3 to_local(Frame f, v3 v) { return v3_of(v3_dot(v, f.s), v3_dot(v, f.t), v3_dot(v, f.n)); }
static v3 to_world(Frame f, v3 v) { return v3_mad(f.s, v.x, v3_mad(f.t, v.y, v3_scale(f.n, v.z))); }

static real v3_largest(v3 a) { return real_max(a.x, real_max(a.y, a.z)); }
// sin^2 of the angle to z. 1 - cos^2 would lose all digits near the pole.
static real sin2_theta(v3 w) { return mul_add(w.x, w.x, w.y * w.y); }
static v3 reflect_z(v3 w) { return v3_of(-w.x, -w.y, w.z); }

// Luminance of linear RGB (ITU-R BT.709).
static real luminance(v3 c) { return R(0.212671) * c.x + R(0.715160) * c.y + R(0.072169) * c.z; }

#define float_bits(x) CAT(as_, WIDE(uint))(to_floats(x))

// Are all three finite? Exponent bits are compared, because fast math removes isfinite().
static mask is_finite(v3 c) {
    uints all = (uints)(0x7f800000u);
    uints x = float_bits(c.x), y = float_bits(c.y), z = float_bits(c.z);
    return to_mask((x & all) != all) & to_mask((y & all) != all) & to_mask((z & all) != all);
}
