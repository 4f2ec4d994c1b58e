// warp: maps from the unit square to other domains. square_to_NAME draws a point, square_to_NAME_pdf is its density:
// per area (tent, disk) or per solid angle (sphere, hemisphere, Beckmann, Phong lobe), and 0 outside the domain. z is
// the axis.
#include "core/lanes.cl"
#include "core/math.cl"

// Tent on [-1, 1]^2: (1 - |x|)(1 - |y|), by inversion of each half.
static real tent_1d(real u) { return u < R(0.5) ? sqrt(2 * u) - 1 : 1 - sqrt(2 - 2 * u); }
static v2 square_to_tent(v2 u) { return v2_of(tent_1d(u.x), tent_1d(u.y)); }
static real square_to_tent_pdf(v2 p) { return real_max(1 - fabs(p.x), (real)(0)) * real_max(1 - fabs(p.y), (real)(0)); }

// Uniform on the unit disk, polar.
static v2 square_to_uniform_disk(v2 u) {
    v2 cs = cos_sin_2pi(u.y);
    real r = sqrt(u.x);
    return v2_of(r * cs.x, r * cs.y);
}
static real square_to_uniform_disk_pdf(v2 p) {
    return mul_add(p.x, p.x, p.y * p.y) <= 1 ? (real)(INV_PI) : (real)(0);
}

// Uniform on the unit disk, squares to rings (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
static v2 square_to_concentric_disk(v2 u) {
    real x = 2 * u.x - 1, y = 2 * u.y - 1;
    mask wide = fabs(x) > fabs(y); // in the two sectors around the x axis
    real r = wide ? x : y, other = wide ? y : x;
    // An angle of at most pi / 4 to either side of the sector's axis.
    v2 cs = cos_sin_2pi(R(0.125) * other / (r == 0 ? (real)(1) : r));
    return v2_of(r * (wide ? cs.x : cs.y), r * (wide ? cs.y : cs.x));
}
static real square_to_concentric_disk_pdf(v2 p) { return square_to_uniform_disk_pdf(p); }

// The direction of height z and azimuth 2 pi v. The caller knows sine = sqrt(1 - z^2) without the digits that 1 - z^2
// loses near 1.
static v3 direction_of(real z, real sine, real v) {
    v2 cs = cos_sin_2pi(v);
    return v3_of(sine * cs.x, sine * cs.y, z);
}

// Uniform on the sphere: z = 1 - 2u, 1 - z^2 = 4u(1 - u).
static v3 square_to_uniform_sphere(v2 u) { return direction_of(1 - 2 * u.x, 2 * sqrt(u.x * (1 - u.x)), u.y); }
static real square_to_uniform_sphere_pdf(v3 w) { return (real)(INV_FOUR_PI) + 0 * w.z; }

// Uniform on the hemisphere z >= 0: z = 1 - u, 1 - z^2 = u(2 - u).
static v3 square_to_uniform_hemisphere(v2 u) { return direction_of(1 - u.x, sqrt(u.x * (2 - u.x)), u.y); }
static real square_to_uniform_hemisphere_pdf(v3 w) { return w.z >= 0 ? (real)(INV_TWO_PI) : (real)(0); }

// cos/pi on the hemisphere: the uniform disk lifted (Malley). z = sqrt(1 - u) is never 0, as u < 1.
static v3 square_to_cosine_hemisphere(v2 u) { return direction_of(sqrt(1 - u.x), sqrt(u.x), u.y); }
static real square_to_cosine_hemisphere_pdf(v3 w) { return real_max(w.z, (real)(0)) * INV_PI; }

// Beckmann half vectors: D = exp(-tan^2/alpha^2) / (pi alpha^2 cos^3), which integrates to 1 over solid angle
// (Walter et al. 2007, eq. 25 and 28, with one cosine in the density). tan^2 = -alpha^2 ln(1 - u).
static v3 square_to_beckmann(v2 u, real alpha) {
    real tan2 = -alpha * alpha * log1p(-u.x);
    real z = rsqrt(1 + tan2);
    return direction_of(z, sqrt(tan2) * z, u.y);
}
static real square_to_beckmann_pdf(v3 h, real alpha) {
    real q = 1 / (alpha * h.z); // squared below factor by factor, because alpha^2 may underflow
    real density = exp(-sin2_theta(h) * q * q) * INV_PI * q * q * (q * alpha);
    return h.z > 0 ? density : (real)(0);
}

// Phong lobe around z: (n + 1)/(2 pi) cos^n. z = u^(1/(n+1)), found as 1 - z by expm1, which keeps all digits for large
// n.
static v3 square_to_phong_lobe(v2 u, real n) {
    real lowered = -expm1(log(u.x) / (n + 1)); // 1 - z, which is 1 at u = 0, where the logarithm is -inf
    return direction_of(1 - lowered, sqrt(lowered * (2 - lowered)), u.y);
}
// cos^n as exp(n log cos). Near the axis log cos is computed from sin^2, because cos has rounded away the digits that a
// large n magnifies. pow() costs more, and PoCL 3.1's pow of eight doubles is wrong in all lanes where one lane's base
// is 0 or NaN.
static real phong_lobe_power(v3 w, real n) {
    real s2 = sin2_theta(w);
    real log_z = s2 < R(0.5) ? R(0.5) * log1p(-s2) : log(w.z);
    return w.z > 0 ? exp(n * log_z) : (real)(0);
}
static real square_to_phong_lobe_pdf(v3 w, real n) { return (n + 1) * INV_TWO_PI * phong_lobe_power(w, n); }
