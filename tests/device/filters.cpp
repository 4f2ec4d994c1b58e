// The pixel filters' weights against those that Mitsuba 3.9.1 (scalar_rgb) gives at distances of 1/4 pixel.
#include "support/device.h"
#include "support/kernels.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace opal;
using namespace opal::test;

namespace {

struct Row {
    const char *name;
    int filter;
    float radius, stddev, b, c;
    std::vector<double> weights; // at 0, 0.25, 0.5, ...
    double margin;               // Mitsuba's Gaussian is a fit, which is off by 4e-4
};

const std::vector<Row> rows = {
    {"tent", FILTER_tent, 1, 0, 0, 0, {1, 0.75, 0.5, 0.25, 0}, 1e-6},
    {"tent of radius 2", FILTER_tent, 2, 0, 0, 0, {1, 0.875, 0.75, 0.625, 0.5, 0.375, 0.25, 0.125, 0}, 1e-6},
    {"gaussian",
     FILTER_gaussian,
     2,
     0.5f,
     0,
     0,
     {0.9992471, 0.8821667, 0.606423, 0.3242426, 0.1349605, 0.04360346, 0.01075821, 0.001843098, 0},
     5e-4},
    {"mitchell",
     FILTER_mitchell,
     2,
     0,
     1 / 3.f,
     1 / 3.f,
     {0.888889, 0.7821181, 0.5347223, 0.2560764, 0.05555562, -0.02343742, -0.03472197, -0.01475666, 0},
     1e-6},
    {"catmullrom",
     FILTER_mitchell,
     2,
     0,
     0,
     0.5f,
     {1, 0.8671875, 0.5625, 0.2265625, 0, -0.0703125, -0.0625, -0.0234375, 0},
     1e-6},
    {"lanczos",
     FILTER_lanczos,
     3,
     0,
     0,
     0,
     {1, 0.890067, 0.6079271, 0.2701898, 0, -0.132871, -0.1350949, -0.06779131, 0, 0.03002109, 0.02431707, 0.007355916,
      0, 0},
     1e-6},
    {"lanczos of 2 lobes",
     FILTER_lanczos,
     2,
     0,
     0,
     0,
     {1, 0.8773541, 0.5731592, 0.2353467, 0, -0.08472481, -0.06368435, -0.01790517, 0, 0},
     1e-6},
};

std::vector<float> weights_at(const Row &row, std::vector<float> distances) {
    const int lanes = device().info.native_lanes;
    const size_t count = distances.size();
    distances.resize((count + size_t(lanes) - 1) / size_t(lanes) * size_t(lanes));
    Settings settings{};
    settings.filter = row.filter;
    settings.filter_radius = row.radius;
    settings.filter_stddev = row.stddev;
    settings.filter_b = row.b;
    settings.filter_c = row.c;
    const Output<float> out(distances.size());
    run(program_of("#include \"film/filter.cl\"\n"
                   "kernel void weights(global const Settings *settings, global const float *x, global float *out) {\n"
                   "    size_t i = get_global_id(0) * LANES;\n"
                   "    real w = filter_1d(settings, LOAD(real, (x + i)));\n"
                   "    STORE(w, (out + i));\n}\n",
                   lanes),
        "weights", distances.size() / size_t(lanes), std::vector<Settings>{settings}, distances, out);
    std::vector<float> weights = out.read();
    weights.resize(count);
    return weights;
}

} // namespace

TEST_CASE("Filters weigh as Mitsuba's do", "[filters]") {
    for (const Row &row : rows)
        for (const float side : {1.f, -1.f}) {
            INFO(row.name);
            std::vector<float> distances;
            for (size_t i = 0; i < row.weights.size(); i++)
                distances.push_back(side * float(i) / 4);
            const std::vector<float> weights = weights_at(row, distances);
            for (size_t i = 0; i < weights.size(); i++) {
                INFO("at " << distances[i]);
                CHECK(std::abs(weights[i] - row.weights[i]) < row.margin);
            }
        }
}

TEST_CASE("Lanczos's weight near the centre is 1, without 0 / 0", "[filters]") {
    for (const float weight : weights_at(rows[5], {0, 1e-45f, 1e-38f, 1e-20f, 1e-10f, 1e-9f, 1e-5f, -1e-30f}))
        CHECK(weight == Approx(1).epsilon(1e-7));
}
