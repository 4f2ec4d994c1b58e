// filter: the pixel filters.
#include "core/lanes.cl"
#include "core/math.cl"
#include "shared/types.h"

// sin(pi x) / (pi x), x not negative. Below the threshold it rounds to 1, in double precision too.
static real sinc(real x) { return x > R(1e-9) ? cos_sin_2pi(R(0.5) * x).y / (PI * x) : (real)(1); }

// One factor of a sample's weight: that of its distance x from the pixel's centre along one axis, in pixels.
static real filter_1d(global const Settings *settings, real x) {
    real a = fabs(x), radius = settings->filter_radius;
    real w = 1;
    if (settings->filter == FILTER_tent) w = real_max(1 - a / radius, (real)(0));
    if (settings->filter == FILTER_gaussian) {
        real falloff = R(-0.5) / (square((real)(settings->filter_stddev)));
        w = real_max(exp(falloff * a * a) - exp(falloff * radius * radius), (real)(0));
    }
    if (settings->filter == FILTER_lanczos) w = sinc(a) * sinc(a / radius);
    if (settings->filter == FILTER_mitchell) { // Mitchell and Netravali 1988, eq. 8
        real t = 2 * a / radius, t2 = t * t, b = settings->filter_b, c = settings->filter_c;
        real inner = ((12 - 9 * b - 6 * c) * t + (-18 + 12 * b + 6 * c)) * t2 + (6 - 2 * b);
        real outer = (((-b - 6 * c) * t + (6 * b + 30 * c)) * t + (-12 * b - 48 * c)) * t + (8 * b + 24 * c);
        w = (t < 1 ? inner : outer) / 6;
    }
    return a <= radius ? w : (real)(0);
}
