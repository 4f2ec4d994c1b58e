// Plastics against Mitsuba 3.9.1 (scalar_rgb): values, and albedos under a white sky.
#include "flatten/plastic_boundary.h"
#include "support/kernel_checks.h"
#include "support/probe.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>

using namespace opal;
using namespace opal::test;

namespace {

struct Furnace {
    double alpha, reflectance;
    bool nonlinear;
    double albedo[4]; // at 0, 45, 70 and 85 degrees from the normal, each with an error of 0.003
};
// Of Beckmann's distribution; alpha 0 is plastic.
const Furnace furnaces[] = {
    {0, 1.0, false, {1.003, 1.003, 1.003, 1.002}},       {0.05, 1.0, false, {0.979, 0.9792, 0.9825, 0.9445}},
    {0.1, 1.0, false, {0.9698, 0.97, 0.9717, 0.9176}},   {0.3, 1.0, false, {0.8764, 0.874, 0.8505, 0.8652}},
    {0.6, 1.0, false, {0.6851, 0.6737, 0.6691, 0.6702}}, {0, 0.5, false, {0.5209, 0.5259, 0.5859, 0.8059}},
    {0.05, 0.5, false, {0.509, 0.5142, 0.5756, 0.7366}}, {0.1, 0.5, false, {0.5044, 0.5098, 0.5689, 0.6742}},
    {0.3, 0.5, false, {0.4578, 0.4625, 0.4813, 0.5481}}, {0.6, 0.5, false, {0.3597, 0.3572, 0.3705, 0.3978}},
    {0, 1.0, true, {1.003, 1.003, 1.003, 1.002}},        {0.05, 1.0, true, {0.979, 0.9792, 0.9825, 0.9445}},
    {0.1, 1.0, true, {0.9698, 0.97, 0.9717, 0.9176}},    {0.3, 1.0, true, {0.8764, 0.874, 0.8505, 0.8652}},
    {0.6, 1.0, true, {0.6851, 0.6737, 0.6691, 0.6702}},  {0, 0.5, true, {0.3188, 0.326, 0.4112, 0.7238}},
    {0.05, 0.5, true, {0.317, 0.3245, 0.4096, 0.6517}},  {0.1, 0.5, true, {0.3167, 0.3244, 0.4067, 0.5755}},
    {0.3, 0.5, true, {0.3093, 0.3167, 0.3503, 0.4357}},  {0.6, 0.5, true, {0.2816, 0.2813, 0.2989, 0.3326}},
};

bsdf_roughplastic_record rough(double alpha, bool ggx, double index, double reflectance = 1, bool nonlinear = false) {
    return {.diffuse_reflectance = reflectance,
            .int_ior = index,
            .ext_ior = 1,
            .nonlinear = nonlinear,
            .alpha = alpha,
            .ggx = ggx};
}

} // namespace

TEST_CASE("f cos, densities and samples of plastics are Mitsuba's", "[mitsuba_plastics]") {
    require_all_pass(check_plastics(Sources::embedded(), 0));
}

TEST_CASE("Plastics leave what Mitsuba's leave under a white sky", "[mitsuba_plastics][stat]") {
    std::vector<Bsdf> bsdfs;
    for (const Furnace &furnace : furnaces) {
        Bsdf plastic = bsdf_plastic_record{.diffuse_reflectance = furnace.reflectance, .nonlinear = furnace.nonlinear};
        if (furnace.alpha > 0)
            plastic = bsdf_roughplastic_record{
                .diffuse_reflectance = furnace.reflectance, .nonlinear = furnace.nonlinear, .alpha = furnace.alpha};
        bsdfs.push_back(plastic);
    }
    KernelProbe probe = double_probe(bsdfs);
    const Planes numbers = grid_of_numbers(256, 40503);
    for (unsigned id = 0; id < bsdfs.size(); id++)
        for (size_t k = 0; k < 4; k++) {
            const Furnace &furnace = furnaces[id];
            const double degrees = std::array{0, 45, 70, 85}[k];
            INFO(furnace.alpha << " " << furnace.reflectance << " " << furnace.nonlinear << " at " << degrees);
            CHECK(albedo_of(probe, id, degrees, numbers) == Approx(furnace.albedo[k]).margin(4 * 0.003));
        }
}

// The smooth one reflects what Mitsuba's fit of the light that its coat sends back leaves too much. Of a coat that is
// thinner than what is outside, the table of 64 cosines blurs the angle from which on all is reflected.
TEST_CASE("White plastics gain no light but by Mitsuba's fit and table", "[mitsuba_plastics]") {
    struct Case {
        Bsdf bsdf;
        double most;
    };
    std::vector<Case> cases;
    for (const double index : {0.75, 1.05, 1.3, 1.49, 1.9, 3.}) {
        const double gain = (1 - diffuse_reflectance(1 / index)) / (1 - diffuse_reflectance_fit(1 / index));
        cases.push_back(
            {bsdf_plastic_record{.diffuse_reflectance = 1, .int_ior = index, .ext_ior = 1}, std::max(1., gain)});
        for (const bool ggx : {false, true})
            for (const double alpha : {1e-6, 0.01, 0.1, 0.4, 1.})
                cases.push_back({rough(alpha, ggx, index), index < 1 ? 1.003 : 1});
    }
    std::vector<Bsdf> bsdfs;
    for (const Case &each : cases)
        bsdfs.push_back(each.bsdf);
    KernelProbe probe = double_probe(bsdfs);
    const Planes numbers = grid_of_numbers(512, 40503);
    for (unsigned id = 0; id < bsdfs.size(); id++)
        for (double degrees : {0., 30., 60., 80., 88., 89.9, 135.}) {
            INFO(id << " at " << degrees << " degrees");
            const double albedo = albedo_of(probe, id, degrees, numbers);
            CHECK(albedo <= cases[id].most + 1e-4);
            if (degrees > 90)
                CHECK(albedo == 0);
        }
}

TEST_CASE("The boundary of a plastic is Mitsuba's", "[mitsuba_plastics]") {
    // Of `plastic` without parameters; and what the exact integral would be.
    CHECK(diffuse_reflectance_fit(1.000277 / 1.49) == Approx(0.59048).epsilon(1e-5));
    CHECK(diffuse_reflectance(1.000277 / 1.49) == Approx(0.58999).epsilon(1e-5));
    CHECK(diffuse_reflectance_fit(1.33) == Approx(diffuse_reflectance(1.33)).epsilon(1e-3));
    CHECK(diffuse_reflectance(1) == Approx(0).margin(1e-9));
    // What roughplastic reflects inside, from the ratio of its values with and without `nonlinear`.
    const std::pair<bsdf_roughplastic_record, double> known[] = {
        {{}, 0.5746619},
        {{.alpha = 0.2, .ggx = 1}, 0.4799818},
        {rough(0.6, true, 1.5), 0.2408422},
        {rough(0.05, true, 1.9), 0.7428221},
        {rough(0.02, false, 1.3), 0.4374455},
    };
    for (const auto &[plastic, inside] : known) {
        const std::vector<float> boundary = plastic_boundary(plastic);
        CHECK(boundary.at(PLASTIC_INSIDE) == Approx(inside).epsilon(5e-6));
        CHECK(boundary.size() == PLASTIC_TRANSMITTED + PLASTIC_COSINES);
    }
}

TEST_CASE("Plastics that differ in colour alone share their boundary", "[mitsuba_plastics]") {
    const size_t one = scene_of_bsdfs({rough(0.1, false, 1.5, 0.3)}).bsdfs.size();
    const size_t record = sizeof(bsdf_roughplastic_record) / sizeof(uint);
    CHECK(scene_of_bsdfs({rough(0.1, false, 1.5, 0.3), rough(0.1, false, 1.5, 0.4, true)}).bsdfs.size() ==
          one + record);
    CHECK(scene_of_bsdfs({rough(0.1, false, 1.5, 0.3), rough(0.2, false, 1.5, 0.3)}).bsdfs.size() >
          one + record + PLASTIC_COSINES);
}
