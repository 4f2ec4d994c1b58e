// BSDFs against values that Mitsuba 3.9.1 (scalar_rgb) gives: f cos and density of pairs of directions, and samples.
#include "base/table.h"
#include "read/nori/parsers.h"
#include "support/kernels.h"
#include "support/probe.h"

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

namespace {

const std::string no_shadowing = "<boolean name='use_shadowing_function' value='false'/>";

// About the normal (0.3, -0.2, 1) / |.|.
std::string map(const std::string &flags) {
    return "<bsdf type='normalmap'><color name='normalmap' value='0.64111545 0.40592299 0.97038466'/>" + flags + red +
           "</bsdf>";
}
std::string bump(const std::string &properties) {
    return "<bsdf type='bumpmap'><float name='height' value='1'/>" + properties + red + "</bsdf>";
}

// A height that grows by 0.5 along u and by 0.25 along v, from the image's top.
BitmapTexture slope() {
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = 8;
    picture->channels = 1;
    for (int y = 0; y < 8; y++)
        for (int x = 0; x < 8; x++)
            picture->floats.push_back((0.5f * (float(x) + 0.5f) + 0.25f * (float(y) + 0.5f)) / 8);
    BitmapTexture texture{.picture = picture, .to_uv = {{{1, 0, 0.6}, {0, 1, 0.55}}}};
    texture.raw = true;
    return texture;
}

// The height of bumps gets that texture.
void raise(Bsdf &bsdf) {
    if (bsdf.is<bsdf_bumpmap_record>())
        bsdf.textures[find_row(bsdf_parameters(bsdf.kind()), "parameter", "height").texture_word] = slope();
    for (Bsdf &child : bsdf.children)
        raise(child);
}

struct Answer {
    Pair pair;
    double f_cos, pdf; // red
};

void check_answers(const std::string &xml, std::span<const Answer> answers) {
    const XmlDocument document("a material", xml);
    Bsdf bsdf = parse_bsdf(document.root(), {});
    raise(bsdf);
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_bsdfs({bsdf}), lanes, Sources::embedded());
        for (const Answer &answer : answers) {
            const Vec3 wo = normalize(answer.pair.wo);
            INFO(xml << ", " << lanes << " lanes, wi " << answer.pair.wi.x << " " << answer.pair.wi.y << " "
                     << answer.pair.wi.z << " wo " << wo.x << " " << wo.y << " " << wo.z);
            const Planes drawn = probe.bsdf_eval(0, normalize(answer.pair.wi), std::span(&wo, 1));
            CHECK(drawn.at(EVAL_R, 0) * std::abs(wo.z) == Approx(answer.f_cos).epsilon(5e-6).margin(1e-7));
            CHECK(drawn.at(EVAL_PDF, 0) == Approx(answer.pdf).epsilon(5e-6).margin(1e-7));
        }
    }
}

} // namespace

TEST_CASE("f cos and densities of blendbsdf, normalmap and bumpmap are Mitsuba's", "[mitsuba_bsdfs]") {
    struct Material {
        std::string xml;
        double f_cos[14], pdf[14]; // red
    };
    const Pair all[] = {{{0, 0, 1}, {0, 0, 1}},
                        {{0, 0, 1}, {0.5, 0, 0.8660254}},
                        {{0.5, 0, 0.8660254}, {-0.5, 0, 0.8660254}},
                        {{0.5, 0, 0.8660254}, {-0.5295965, 0.01849392, 0.8480481}},
                        {{0.5, 0, 0.8660254}, {0.5, 0, 0.8660254}},
                        {{0.8660254, 0, 0.5}, {-0.8660254, 0, 0.5}},
                        {{0.8660254, 0, 0.5}, {-0.7544065, 0.1330222, 0.6427876}},
                        {{0.8660254, 0, 0.5}, {0, 0.3420201, 0.9396926}},
                        {{0.9254166, 0.3368241, 0.1736482}, {-0.9076734, -0.3303661, 0.258819}},
                        {{0.9254166, 0.3368241, 0.1736482}, {-0.1710101, 0.9698463, 0.1736482}},
                        {{0.2418448, 0.664463, 0.7071068}, {-0.2418448, -0.664463, 0.7071068}},
                        {{0.2418448, 0.664463, 0.7071068}, {-0.3213938, -0.5566704, 0.7660444}},
                        {{-0.2432103, -0.08852133, 0.9659258}, {0.9254166, 0.1631759, 0.3420201}},
                        {{0.9961947, 0, 0.08715574}, {0, 0.08715574, 0.9961947}}};
    const Material materials[] = {
        {"<bsdf type='blendbsdf'><float name='weight' value='0.25'/>" + red + green + "</bsdf>",
         {0.1989437, 0.1722903, 0.1722903, 0.1687138, 0.1722903, 0.09947184, 0.1278785, 0.1869459, 0.05149041,
          0.03454621, 0.1406744, 0.1523997, 0.06804275, 0.1981867},
         {0.3183099, 0.2756644, 0.2756644, 0.2699421, 0.2756644, 0.1591549, 0.2046057, 0.2991135, 0.08238465,
          0.05527393, 0.2250791, 0.2438395, 0.1088684, 0.3170986}},
        {map(""),
         {0.2395526, 0.2430629, 0.1712941, 0.1639466, 0.2430629, 0.05685404, 0.09285954, 0.2086073, 0.01195609, 0,
          0.1831028, 0.186549, 0.1365533, 0.2344581},
         {0.2994407, 0.3042394, 0.2144072, 0.2052578, 0.3042394, 0.07192338, 0.1167403, 0.2608993, 0.01574766, 0,
          0.2298046, 0.2338514, 0.1757747, 0.2930817}},
        {map(no_shadowing),
         {0.2395526, 0.2433915, 0.1715257, 0.1642062, 0.2433915, 0.05753871, 0.09339227, 0.2087195, 0.01259813, 0,
          0.1838437, 0.1870811, 0.1406198, 0.2344654},
         {0.2994407, 0.3042394, 0.2144072, 0.2052578, 0.3042394, 0.07192338, 0.1167403, 0.2608993, 0.01574766, 0,
          0.2298046, 0.2338514, 0.1757747, 0.2930817}},
        {bump(""),
         {0.245248, 0.1815874, 0.2428496, 0.2396576, 0.1815874, 0.1744533, 0.1991306, 0.2199017, 0, 0.05761763,
          0.2081075, 0.2242567, 0.02174469, 0.2469821},
         {0.30656, 0.2271688, 0.3038088, 0.2998573, 0.2271688, 0.2196522, 0.2497733, 0.274966, 0, 0.0772919, 0.2607679,
          0.2808019, 0.02767288, 0.3087333}},
        {bump("<float name='scale' value='2'/>" + no_shadowing),
         {0.2222749, 0.136927, 0.2480644, 0.2463301, 0.136927, 0.2073853, 0.2193265, 0.1898645, 0, 0.07348514,
          0.2209735, 0.2369248, 0, 0.2262722},
         {0.2778436, 0.1711587, 0.3100805, 0.3079126, 0.1711587, 0.2592316, 0.2741581, 0.2373306, 0, 0.09185642,
          0.2762168, 0.296156, 0, 0.2828403}},
    };
    for (const Material &material : materials) {
        std::vector<Answer> answers;
        for (size_t i = 0; i < std::size(all); i++)
            answers.push_back({all[i], material.f_cos[i], material.pdf[i]});
        check_answers(material.xml, answers);
    }
}

TEST_CASE("Normal maps, bump maps, twosided and blends lie within each other as in Mitsuba", "[mitsuba_bsdfs]") {
    const Pair all[] = {{{0.3, 0.2, 0.9}, {0.1, -0.5, 0.7}},   {{-0.9, 0.3, 0.2}, {0.1, -0.5, 0.7}},
                        {{0.3, 0.2, -0.9}, {0.1, -0.5, -0.7}}, {{-0.9, 0.3, -0.2}, {0.1, -0.5, -0.7}},
                        {{0.9, 0.3, -0.2}, {0.1, -0.5, -0.7}}, {{0.6, -0.7, 0.3}, {-0.4, 0.8, 0.5}}};
    const auto one = [](const std::string &within) { // about (0.6, -0.3, 0.7)
        return "<bsdf type='normalmap'><color name='normalmap' value='0.80942637 0.34528681 0.86099744'/>" + within +
               "</bsdf>";
    };
    const auto two = [](const std::string &within) { // about (-0.2, 0.5, 0.8)
        return "<bsdf type='normalmap'><color name='normalmap' value='0.39630483 0.75923792 0.91478068'/>" + within +
               "</bsdf>";
    };
    const auto raised = [](const char *scale, const std::string &within) {
        return fmt::format("<bsdf type='bumpmap'><float name='height' value='1'/><float name='scale' value='{}'/>{}"
                           "</bsdf>",
                           scale, within);
    };
    const auto both_sides = [](const std::string &within) { return "<bsdf type='twosided'>" + within + "</bsdf>"; };
    struct Nest {
        std::string xml;
        double f_cos[6], pdf[6];
    };
    const Nest nests[] = {
        {both_sides(one(red)),
         {0.20915891, 0.083663553, 0.20915891, 0.083663553, 0.20915891, 0},
         {0.26537111, 0.10614844, 0.26537111, 0.10614844, 0.26537111, 0}},
        {one(both_sides(red)),
         {0.20915891, 0.083663553, 0.083663553, 0.083663553, 0.20915891, 0},
         {0.26537111, 0.10614844, 0.10614844, 0.10614844, 0.26537111, 0}},
        {one(two(red)), {0.17136669, 0, 0, 0, 0, 0}, {0.21876471, 0, 0, 0, 0, 0}},
        {one(two(both_sides(red))),
         {0.17136669, 0, 0.18244162, 0.18244162, 0.17352387, 0},
         {0.21876471, 0, 0.2552315, 0.2552315, 0.22151853, 0}},
        {both_sides(raised("2", red)),
         {0.19789207, 0.19789207, 0.19789207, 0.19789207, 0.15959038, 0.10526631},
         {0.24864028, 0.24864028, 0.24864028, 0.24864028, 0.20051636, 0.1355738}},
        {raised("2", both_sides(red)),
         {0.19789207, 0.19789207, 0.15959038, 0.19789207, 0.15959038, 0.10526631},
         {0.24864028, 0.24864028, 0.20051636, 0.24864028, 0.20051636, 0.1355738}},
        {raised("1", two(red)), {0.093067355, 0.093067355, 0, 0, 0, 0}, {0.11728192, 0.11728192, 0, 0, 0, 0}},
        {"<bsdf type='blendbsdf'><float name='weight' value='0.3'/>" + one(red) + both_sides(red) + "</bsdf>",
         {0.20816007, 0.12031332, 0.06174884, 0.06174884, 0.06174884, 0.037276637},
         {0.26294583, 0.15148996, 0.077186048, 0.077186048, 0.077186048, 0.046595797}},
    };
    for (const Nest &nest : nests) {
        std::vector<Answer> answers;
        for (size_t i = 0; i < std::size(all); i++)
            answers.push_back({all[i], nest.f_cos[i], nest.pdf[i]});
        check_answers(nest.xml, answers);
    }
}
