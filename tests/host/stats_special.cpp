// The distribution functions against tables. Values to 15 digits were computed with mpmath 1.3 at 40 digits (gammainc,
// betainc, erfc, and the series 2 sum (-1)^(j-1) exp(-2 j^2 x^2)); those to fewer digits are the printed tables named
// beside them.
#include "stats/special.h"

#include <catch2/catch.hpp>
#include <cmath>

using namespace opal::stats;

namespace {
auto near(double value, double relative = 1e-11) { return Catch::Matchers::WithinRel(value, relative); }
} // namespace

TEST_CASE("chi-square tail", "[stats_special]") {
    CHECK_THAT(chi_square_sf(3.84, 1), near(0.050043521248705103));
    CHECK_THAT(chi_square_sf(18.307, 10), near(0.050000589091398120));
    CHECK_THAT(chi_square_sf(250, 199), near(0.0082301130447247595));
    CHECK_THAT(chi_square_sf(2200, 1999), near(0.0010053763294542919));
    CHECK_THAT(chi_square_sf(101000, 1e5), near(0.01286884037723367, 1e-10));
    CHECK_THAT(chi_square_sf(0.001, 3), near(0.99999159208094195));
    CHECK_THAT(chi_square_sf(300, 50), near(2.3141364165140699e-37));
    CHECK_THAT(chi_square_sf(23.209, 10), near(0.01, 1e-4)); // Abramowitz & Stegun, table 26.8
    CHECK_THAT(chi_square_sf(124.342, 100), near(0.05, 1e-4));
    CHECK(chi_square_sf(0, 4) == 1);
    CHECK(chi_square_sf(INFINITY, 4) == 0);
    CHECK(std::isnan(chi_square_sf(NAN, 4)));
    CHECK(std::isnan(chi_square_sf(-1, 4)));
    CHECK(std::isnan(chi_square_sf(1, 0)));
    CHECK_THAT(gamma_p(5, 3) + gamma_q(5, 3), near(1));
}

TEST_CASE("normal distribution", "[stats_special]") {
    CHECK_THAT(normal_cdf(-1.96), near(0.024997895148220436));
    CHECK_THAT(normal_cdf(-5), near(2.8665157187919391e-7));
    CHECK_THAT(normal_cdf(-37), near(5.7255712225245768e-300));
    CHECK_THAT(normal_cdf(1), near(0.841344746068543, 1e-14)); // Abramowitz & Stegun, table 26.1
    CHECK_THAT(normal_quantile(0.025), near(-1.9599639845400542));
    CHECK_THAT(normal_quantile(1e-5), near(-4.2648907939228246));
    CHECK_THAT(normal_quantile(1e-300), near(-37.047096299361199));
    CHECK_THAT(normal_quantile(0.7), near(0.52440051270804082));
    CHECK(std::abs(normal_quantile(0.5)) < 1e-15);
    CHECK(normal_quantile(0) == -INFINITY);
    CHECK(normal_quantile(1) == INFINITY);
    CHECK(std::isnan(normal_quantile(1.1)));
    CHECK(std::isnan(normal_quantile(NAN)));
}

TEST_CASE("Student's t", "[stats_special]") {
    CHECK_THAT(student_t_sf(1, 1), near(0.25)); // Cauchy
    CHECK_THAT(student_t_sf(2.228138851964939, 10), near(0.025000000000904315));
    CHECK_THAT(student_t_sf(5, 3), near(0.0076962190366511505));
    CHECK_THAT(student_t_sf(3.3, 47), near(0.00092494143456351461));
    CHECK_THAT(student_t_sf(40, 2.5), near(7.0978171452466915e-5));
    CHECK_THAT(student_t_sf(0.001, 10), near(0.49961089168737049));
    CHECK_THAT(student_t_sf(4.5, 1e5), near(3.4014958817258468e-6, 1e-9));
    CHECK_THAT(student_t_sf(4.5, 1e6), near(3.3980552524769493e-6, 1e-9));
    CHECK_THAT(student_t_sf(1.96, INFINITY), near(0.024997895148220436));
    CHECK_THAT(student_t_cdf(1, 1), near(0.75));
    CHECK_THAT(student_t_quantile(0.975, 10), near(2.2281388, 1e-6)); // Abramowitz & Stegun, table 26.10
    CHECK_THAT(student_t_quantile(0.975, 1), near(12.706, 1e-4));
    CHECK_THAT(student_t_quantile(0.995, 30), near(2.750, 1e-3));
    CHECK_THAT(student_t_quantile(0.025, INFINITY), near(-1.9599639845400542));
    for (double dof : {1.0, 2.7, 30.0, 1e4, 1e7})
        for (double p : {1e-9, 0.01, 0.3, 0.7, 0.99})
            CHECK_THAT(student_t_cdf(student_t_quantile(p, dof), dof), near(p, 1e-9));
    CHECK(student_t_sf(INFINITY, 5) == 0);
    CHECK(std::isnan(student_t_sf(NAN, 5)));
    CHECK(std::isnan(student_t_sf(1, 0)));
    CHECK(std::isnan(student_t_quantile(0.5, NAN)));
}

TEST_CASE("Kolmogorov's distribution and the incomplete beta function", "[stats_special]") {
    CHECK_THAT(kolmogorov_sf(0.3), near(0.99999069419866543));
    CHECK_THAT(kolmogorov_sf(0.5), near(0.96394524366487509));
    CHECK_THAT(kolmogorov_sf(1), near(0.26999967167735452));
    CHECK_THAT(kolmogorov_sf(1.1799999), near(0.1234538, 1e-5));
    CHECK_THAT(kolmogorov_sf(1.18), near(0.12345380942976571));
    CHECK_THAT(kolmogorov_sf(2.5), near(7.4533063441573416e-6));
    CHECK_THAT(kolmogorov_sf(1.3581), near(0.05, 1e-4)); // Smirnov, Ann. Math. Stat. 19, 1948
    CHECK(kolmogorov_sf(0) == 1);
    CHECK(std::isnan(kolmogorov_sf(NAN)));
    CHECK_THAT(beta_i(20, 81, 0.2, 0.8), near(0.53983862993542722));
    CHECK_THAT(beta_i(2, 3, 0.9, 0.1), near(0.9963));
}
