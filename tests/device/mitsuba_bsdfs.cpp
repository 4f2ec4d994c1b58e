// BSDFs against values that Mitsuba 3.9.1 (scalar_rgb) gives: f cos and density of pairs of directions, and samples.
#include "read/nori/parsers.h"
#include "support/kernel_checks.h"
#include "support/kernels.h"
#include "support/probe.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>

using namespace opal;
using namespace opal::test;

namespace {

struct Pair {
    Vec3 wi, wo;
};
constexpr Pair pairs[] = {{{0, 0, 1}, {0.5, 0, 0.8660254}},
                          {{0.8660254, 0, 0.5}, {-0.7544065, 0.1330222, 0.6427876}},
                          {{0.9254166, 0.3368241, 0.1736482}, {-0.1710101, 0.9698463, 0.1736482}},
                          {{0.5, 0, 0.8660254}, {-0.5, 0, -0.8660254}},
                          {{0.5, 0, -0.8660254}, {-0.5, 0, 0.8660254}},
                          {{0.3420201, 0, -0.9396926}, {-0.5150381, 0, -0.8571673}}};

const std::string red = R"(<bsdf type="diffuse"><color name="albedo" value="0.8 0.1 0.1"/>
<boolean name="use_cosine" value="true"/></bsdf>)";
const std::string green = R"(<bsdf type="diffuse"><color name="albedo" value="0.1 0.7 0.2"/>
<boolean name="use_cosine" value="true"/></bsdf>)";

} // namespace

TEST_CASE("f cos and densities of diffuse, twosided and mask are Mitsuba's", "[mitsuba_bsdfs]") {
    const Color front[3] = {{0.2205316, 0.02756644, 0.02756644},
                            {0.1636845, 0.02046057, 0.02046057},
                            {0.04421915, 0.005527393, 0.005527393}};
    const double pdf[3] = {0.2756644, 0.2046057, 0.05527393};
    const Color black{};
    struct Material {
        std::string xml;
        double opacity;
        Color back; // of the last pair, whose directions are both behind
        double back_pdf;
    };
    const Material materials[] = {
        {red, 1, black, 0},
        {"<bsdf type='twosided'>" + red + "</bsdf>", 1, {0.2182759, 0.02728448, 0.02728448}, 0.2728448},
        {"<bsdf type='twosided'>" + red + green + "</bsdf>", 1, {0.02728448, 0.1909914, 0.05456896}, 0.2728448},
        {"<bsdf type='mask'>" + red + "</bsdf>", 0.5, black, 0},
        {"<bsdf type='mask'><float name='opacity' value='0.3'/>" + red + "</bsdf>", 0.3, black, 0},
    };
    for (const Material &material : materials) {
        const XmlDocument document("a material", material.xml);
        KernelProbe probe = probe_of(scene_of_bsdfs({parse_bsdf(document.root(), {})}), device().info.native_lanes,
                                     Sources::embedded());
        for (size_t i = 0; i < std::size(pairs); i++) {
            INFO(material.xml << ", pair " << i);
            const Planes drawn = probe.bsdf_eval(0, pairs[i].wi, std::span(&pairs[i].wo, 1));
            const bool is_last = i + 1 == std::size(pairs);
            const Color expected = i < 3 ? front[i] : is_last ? material.back : black;
            for (size_t c = 0; c < 3; c++)
                CHECK(drawn.at(EVAL_R + c, 0) * std::abs(pairs[i].wo.z) ==
                      Approx(material.opacity * expected[c]).epsilon(2e-6).margin(1e-9));
            CHECK(drawn.at(EVAL_PDF, 0) == Approx(material.opacity * (i < 3     ? pdf[i]
                                                                      : is_last ? material.back_pdf
                                                                                : 0))
                                               .epsilon(2e-6)
                                               .margin(1e-9));
        }
    }
}

TEST_CASE("f cos and densities of principled and principledthin are Mitsuba's, those of oren_nayar its paper's",
          "[mitsuba_bsdfs][stat]") {
    require_all_pass(check_principled(Sources::embedded(), test_seed(127)));
}

TEST_CASE("Samples of dielectric, mask and null are Mitsuba's", "[mitsuba_bsdfs]") {
    struct Sample {
        const char *xml;
        Vec3 wi;
        float lobe, met; // random numbers
        Vec3 wo;
        double weight, eta; // the weight of radiance
    };
    const char *const glass = "<bsdf type='dielectric'><string name='intIOR' value='BK7'/></bsdf>",
                      *const diamond = "<bsdf type='dielectric'><string name='intIOR' value='diamond'/></bsdf>",
                      *const mask = "<bsdf type='mask'><bsdf type='dielectric'/></bsdf>",
                      *const null = "<bsdf type='null'/>";
    const Vec3 above{0.5, 0, 0.8660254}, below{0.5, 0, -0.8660254}, mirrored{-0.5, 0, 0.8660254};
    const Sample samples[] = {{glass, above, 0.02f, 0, mirrored, 1, 1},
                              {glass, above, 0.5f, 0, {-0.3324063, 0, -0.9431363}, 0.4419758, 1.504183},
                              {glass, below, 0.5f, 0, {-0.7520916, 0, 0.6590585}, 2.262567, 0.6648126},
                              {diamond, above, 0.17f, 0, mirrored, 1, 1}, // its reflectance is 0.1736477
                              {diamond, above, 0.18f, 0, {-0.2067543, 0, -0.9783929}, 0.1709893, 2.41833},
                              {diamond, below, 0.99f, 0, {-0.5, 0, -0.8660254}, 1, 1},
                              {mask, above, 0.02f, 0.49f, mirrored, 1, 1},
                              {mask, above, 0.02f, 0.5f, {-0.5, 0, -0.8660254}, 1, 1},
                              {null, above, 0, 0, {-0.5, 0, -0.8660254}, 1, 1},
                              {null, below, 0, 0, mirrored, 1, 1}};
    for (const Sample &sample : samples) {
        INFO(sample.xml << " " << sample.lobe << " " << sample.met);
        const XmlDocument document("a material", sample.xml);
        KernelProbe probe = probe_of(scene_of_bsdfs({parse_bsdf(document.root(), {})}), 1, Sources::embedded());
        Planes numbers(2 * OPAL_PROBE_PAIRS, 1);
        numbers.at(2, 0) = sample.lobe;
        numbers.at(3, 0) = sample.met;
        const Planes drawn = probe.bsdf_sample(0, sample.wi, numbers);
        const double eta = drawn.at(BSDF_ETA, 0);
        CHECK(drawn.at(BSDF_DISCRETE, 0) == 1);
        CHECK(length(drawn.vec3(BSDF_WO_X, 0) - sample.wo) < 1e-6);
        CHECK(eta == Approx(sample.eta).epsilon(1e-6));
        CHECK(drawn.at(BSDF_WEIGHT_R, 0) / (eta * eta) == Approx(sample.weight).epsilon(2e-6));
    }
}

TEST_CASE("f cos and densities of blendbsdf, normalmap and bumpmap, and of their nests, are Mitsuba's",
          "[mitsuba_bsdfs]") {
    require_all_pass(check_nested_bsdfs(Sources::embedded(), test_seed(1)));
}
