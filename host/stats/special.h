// The distribution functions that the tests and intervals need, in double, from std::lgamma and std::erfc.
//
// Relative error below 1e-11 for parameters up to 1e5 (lgamma's cancellation grows with a ln a: 1e-9 near 1e6), checked
// in tests/host/stats_special.cpp. Tails are computed directly, never as 1 - cdf. An argument outside its range, or
// NaN, gives NaN.
#pragma once

namespace opal::stats {

// Regularised incomplete gamma functions P(a, x) and Q = 1 - P, a > 0, x >= 0. Series DLMF 8.11.4 below x = a + 1,
// continued fraction DLMF 8.9.2 (modified Lentz) above.
double gamma_p(double a, double x);
double gamma_q(double a, double x);

// Regularised incomplete beta function I_x(a, b), a, b > 0. Continued fraction DLMF 8.17.22 (modified Lentz).
// `y` is 1 - x, given apart so that x near 1 loses nothing.
double beta_i(double a, double b, double x, double y);

double normal_cdf(double z);      // P(Z <= z) = erfc(-z / sqrt 2) / 2
double normal_quantile(double p); // z with normal_cdf(z) = p: Abramowitz & Stegun 26.2.23, then Halley's iteration

double chi_square_sf(double x, double dof); // P(X > x) = Q(dof/2, x/2)

// Student's t with dof > 0, infinity included (the normal distribution). From dof = 1e6 on by Abramowitz &
// Stegun 26.7.8, whose error there is below 1e-9.
double student_t_sf(double t, double dof);       // P(T > t)
double student_t_cdf(double t, double dof);      // P(T <= t)
double student_t_quantile(double p, double dof); // bisection of the tail, to the last digits

// P(K > x) of Kolmogorov's distribution, the limit of sqrt(n) D_n. Both series of Marsaglia, Tsang & Wang, "Evaluating
// Kolmogorov's distribution", J. Stat. Softw. 8(18), 2003, section 1.
double kolmogorov_sf(double x);

} // namespace opal::stats
