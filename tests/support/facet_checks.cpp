// Distributions of facets against integrals: D, the density of drawn normals, and their histogram.
#include "stats/hypothesis.h"
#include "support/kernel_checks.h"
#include "support/kernels.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <random>

namespace opal::test {

namespace {

constexpr double pi = std::numbers::pi;

// Normals are told by their slopes x / (z alpha_u), y / (z alpha_v) in polar coordinates: the share s = r / (1 + r) of
// the radius and the azimuth in turns. This many cells of s and of the azimuth, each with a grid of points.
constexpr size_t cells = 12, points_a_side = 24;
constexpr size_t points = cells * cells * points_a_side * points_a_side;
constexpr size_t draws = 1 << 18;
constexpr double sliver = 0.01; // normals that a cell expects where all its points are hidden from the viewer

struct Case {
    float alpha_u, alpha_v;
    bool ggx, visible;
    double degrees; // of the viewer
};

std::string text_of(const Case &c, int lanes, MathMode math) {
    return fmt::format("{} {:g} {:g}, {} facets, from {:g} degrees, {} lanes, {}", c.ggx ? "ggx" : "beckmann",
                       c.alpha_u, c.alpha_v, c.visible ? "visible" : "all", c.degrees, lanes,
                       math == MathMode::double_precision ? "double" : "single");
}

const char *const kernels = R"(
#include "bsdfs/microfacet_distribution.cl"
#include "kernels/sample_columns.cl"
kernel void values(float alpha_u, float alpha_v, int ggx, int visible, float x, float y, float z,
                   global const float *normals, global float *out, uint stride) {
    uint base = get_global_id(0) * LANES;
    MicrofacetDistribution m = {(real)(alpha_u), (real)(alpha_v), to_mask((ints)(ggx) != 0),
                                to_mask((ints)(visible) != 0)};
    v3 wi = v3_of((real)(x), (real)(y), (real)(z)), h = get_v3(normals, 0, stride, base);
    real d = facet_density(m, h);
    put(out, 0, stride, base, d);
    put(out, 1, stride, base, d * fabs(v3_dot(wi, h)) * facet_chance(m, wi, h));
}
kernel void draw(float alpha_u, float alpha_v, int ggx, int visible, float x, float y, float z,
                 global const float *numbers, global float *out, uint stride) {
    uint base = get_global_id(0) * LANES;
    MicrofacetDistribution m = {(real)(alpha_u), (real)(alpha_v), to_mask((ints)(ggx) != 0),
                                to_mask((ints)(visible) != 0)};
    v3 wi = v3_of((real)(x), (real)(y), (real)(z));
    put_v3(out, 0, stride, base, facet_sample(m, wi, get_v2(numbers, 0, stride, base)));
}
)";

// The integral over a cell of a function of h that is `value` at each point, times the cosine to the power `cosines`.
std::vector<double> integrals(const Case &c, const std::vector<float> &normals, const float *value, int cosines) {
    std::vector<double> sums(cells * cells);
    constexpr size_t side = cells * points_a_side;
    for (size_t i = 0; i < points; i++) {
        const size_t row = i / side, column = i % side;
        const double s = (double(row) + 0.5) / side, r = s / (1 - s), z = normals[2 * points + i];
        // The solid angle of slopes: alpha_u alpha_v r dr dphi cos^3, dr = ds / (1 - s)^2.
        const double solid_angle = double(c.alpha_u) * c.alpha_v * r / ((1 - s) * (1 - s)) * 2 * pi / (side * side);
        sums[row / points_a_side * cells + column / points_a_side] += value[i] * solid_angle * std::pow(z, 3 + cosines);
    }
    return sums;
}

double sum_of(const std::vector<double> &values) {
    double sum = 0;
    for (double value : values)
        sum += value;
    return sum;
}

Findings check_case(const cl::Program &program, const Case &c, const std::string &what, int lanes, unsigned seed) {
    const double theta = c.degrees * pi / 180;
    // Its azimuth in slopes is 0.6: the facets that it sees end between the points.
    const double phi = std::atan2(c.alpha_u * std::sin(0.6), c.alpha_v * std::cos(0.6));
    const Vec3 wi{std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    std::vector<float> normals(3 * points);
    constexpr size_t side = cells * points_a_side;
    for (size_t i = 0; i < points; i++) {
        const double s = (double(i / side) + 0.5) / side, azimuth = 2 * pi * (double(i % side) + 0.5) / side;
        const double r = s / (1 - s);
        const Vec3 h = normalize({c.alpha_u * r * std::cos(azimuth), c.alpha_v * r * std::sin(azimuth), 1});
        for (size_t k = 0; k < 3; k++)
            normals[k * points + i] = float(h[int(k)]);
    }
    const auto ask = [&](const char *kernel, size_t count, const std::vector<float> &in, const Output<float> &out) {
        run(program, kernel, count / size_t(lanes), c.alpha_u, c.alpha_v, int(c.ggx), int(c.visible), float(wi.x),
            float(wi.y), float(wi.z), in, out, cl_uint(count));
        return out.read();
    };
    std::vector<float> values = ask("values", points, normals, Output<float>(2 * points));
    Findings findings;
    const double area = sum_of(integrals(c, normals, values.data(), 1));
    findings.push_back(at_most("facets: projected area, off from 1 by", std::abs(area - 1), 1e-3, what));
    for (size_t i = 0; i < points; i++) { // facets that turn their back are not drawn
        const Vec3 h{normals[i], normals[points + i], normals[2 * points + i]};
        if (c.visible && dot(wi, h) <= 0)
            values[points + i] = 0;
    }
    std::vector<double> expected = integrals(c, normals, values.data() + points, 0);
    const double whole = sum_of(expected);
    findings.push_back(at_most("facets: integral of the density, off from 1 by", std::abs(whole - 1), 2e-3, what));
    for (double &cell : expected)
        cell = std::max(cell * draws / whole, sliver);

    std::mt19937 random(seed);
    std::vector<float> numbers(2 * draws);
    for (float &number : numbers)
        number = float(random() >> 8) * 0x1p-24f;
    for (size_t i = 0; i < 25; i++) { // the ends of the range, which must give finite normals
        const float ends[] = {0, 0x1p-24f, 0.5, 1 - 0x1p-23f, 1 - 0x1p-24f};
        numbers[i] = ends[i / 5];
        numbers[draws + i] = ends[i % 5];
    }
    const std::vector<float> drawn = ask("draw", draws, numbers, Output<float>(3 * draws));
    std::vector<double> observed(cells * cells);
    double wrong = 0;
    for (size_t i = 0; i < draws; i++) {
        const Vec3 h{drawn[i], drawn[draws + i], drawn[2 * draws + i]};
        const double x = h.x / h.z / c.alpha_u, y = h.y / h.z / c.alpha_v, r = std::hypot(x, y), s = r / (1 + r);
        const bool unit = std::abs(length(h) - 1) < 1e-6 && h.z > 0, seen = dot(wi, h) > -1e-7;
        wrong += !unit || (c.visible && !seen);
        if (!unit || i < 25)
            continue;
        const double turns = std::atan2(y, x) / (2 * pi);
        const auto place = [](double share) { return std::min(size_t(share * cells), cells - 1); };
        observed[place(s) * cells + place(turns < 0 ? turns + 1 : turns)]++;
    }
    findings.push_back(none_wrong("facets: no unit normal, or a hidden one", wrong, what));
    findings.push_back(
        p_value("facets: normals against density", stats::chi_square_test(observed, expected).p_value, what));
    return findings;
}

} // namespace

Findings check_facets(const Sources &sources, unsigned seed) {
    Findings findings;
    for (MathMode math : {MathMode::precise, MathMode::double_precision})
        for (int wanted : tested_lanes()) {
            if (math == MathMode::double_precision && (!device().info.fp64 || wanted != tested_lanes().back()))
                continue;
            const int lanes = math == MathMode::precise ? wanted : lanes_for(device().info, 0, math);
            const cl::Program program = program_from(sources, kernels, lanes, all_features(), math);
            for (bool ggx : {false, true})
                for (bool visible : {true, false})
                    for (const auto &[alpha_u, alpha_v] :
                         {std::pair{0.1f, 0.1f}, {1.f, 1.f}, {0.5f, 0.05f}, {1e-6f, 1e-6f}, {1e-6f, 0.3f}})
                        for (double degrees : {0.0, 30.0, 70.0, 85.0, 89.0, 89.9}) {
                            if (!visible && degrees != 70) // which all facets do not depend on
                                continue;
                            const Case c{alpha_u, alpha_v, ggx, visible, degrees};
                            append(findings, check_case(program, c, text_of(c, lanes, math), lanes, ++seed));
                        }
        }
    return findings;
}

} // namespace opal::test
