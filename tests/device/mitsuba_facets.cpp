// Metals and glass, smooth and of facets, against values that Mitsuba 3.9.1 (scalar_rgb) gives: f cos and density of
// pairs of directions, samples of smooth ones, albedos under a white sky.
#include "read/nori/parsers.h"
#include "scene/metals.h"
#include "support/kernel_checks.h"
#include "support/mitsuba_pairs.h"
#include "support/probe.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cmath>
#include <numbers>

using namespace opal;
using namespace opal::test;

namespace {

struct Value {
    size_t pair;
    std::vector<double> f_cos; // of R, G, B, or of all alike
    double pdf;
};
struct RoughMaterial {
    std::string type, properties;
    std::vector<Value> values; // other pairs have less than 1e-9
};
const RoughMaterial rough_materials[] = {
    {"roughconductor",
     "",
     {{0, {7.957747}, 7.957747},
      {1, {0.006965005}, 0.006965005},
      {2, {9.188816}, 9.188816},
      {3, {8.822989}, 8.822989},
      {5, {15.91549}, 15.91549},
      {6, {1.65537}, 1.65537},
      {8, {38.01765}, 38.01765},
      {10, {11.25396}, 11.25396},
      {11, {5.003779}, 5.003779}}},
    {"roughconductor",
     "<string name='material' value='Cu'/><float name='alpha' value='0.2'/>",
     {{0, {1.893975, 1.233028, 1.015715}, 1.989437},
      {1, {0.3614645, 0.2353215, 0.1938653}, 0.3796921},
      {2, {2.186139, 1.423267, 1.174208}, 2.297204},
      {3, {2.165275, 1.409708, 1.163277}, 2.275404},
      {4, {0.0009345458, 0.0006084139, 0.0005011849}, 0.0009816494},
      {5, {3.763714, 2.490501, 2.116099}, 3.978873},
      {6, {2.216183, 1.453858, 1.221963}, 2.338295},
      {7, {0.0002189316, 0.000142536, 0.000117619}, 0.0002300667},
      {8, {9.917803, 7.428914, 6.794112}, 10.53221},
      {10, {2.673107, 1.743004, 1.447942}, 2.813489},
      {11, {2.210935, 1.440736, 1.194479}, 2.325994},
      {12, {0.003264682, 0.002127438, 0.001763913}, 0.003434628},
      {13, {3.294847e-08, 2.147142e-08, 1.780388e-08}, 3.466425e-08}}},
    {"roughconductor",
     "<string name='material' value='Cu'/><float name='alpha' value='0.2'/><string name='distribution' value='ggx'/>",
     {{0, {1.893975, 1.233028, 1.015715}, 1.989437},
      {1, {0.277594, 0.18072, 0.1488828}, 0.2925611},
      {2, {2.171685, 1.413857, 1.166445}, 2.289597},
      {3, {2.127806, 1.385314, 1.143147}, 2.244727},
      {4, {0.04433703, 0.02886458, 0.02377738}, 0.04672647},
      {5, {3.553522, 2.351414, 1.997921}, 3.866174},
      {6, {1.520491, 0.9974706, 0.8383711}, 1.62674},
      {7, {0.0563044, 0.03665711, 0.03024903}, 0.05924638},
      {8, {7.008548, 5.249742, 4.801151}, 8.341874},
      {9, {0.01219842, 0.007945474, 0.006575869}, 0.01611279},
      {10, {2.620945, 1.708992, 1.419688}, 2.785903},
      {11, {1.835806, 1.196286, 0.9918115}, 1.944847},
      {12, {0.04783218, 0.03116995, 0.02584381}, 0.05387056},
      {13, {0.08561831, 0.05579461, 0.0462643}, 0.09008373}}},
    {"roughconductor",
     "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.1'/>",
     {{0, {2.652582}, 2.652582},
      {1, {1.372268}, 1.372268},
      {2, {3.062939}, 3.062939},
      {3, {3.019979}, 3.019979},
      {4, {0.1341274}, 0.1341274},
      {5, {5.305164}, 5.305164},
      {6, {1.288404}, 1.288404},
      {7, {0.0006778272}, 0.0006778272},
      {8, {12.71866}, 13.1154},
      {10, {3.751319}, 3.751319},
      {11, {2.161439}, 2.161439},
      {12, {0.1558908}, 0.1569222},
      {13, {0.002934491}, 0.002934491}}},
    {"roughconductor",
     "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.1'/><string name='distribution' value='ggx'/>",
     {{0, {2.652582}, 2.652582},
      {1, {0.9358751}, 0.9428424},
      {2, {3.017838}, 3.040305},
      {3, {2.928346}, 2.953823},
      {4, {0.2424898}, 0.244295},
      {5, {4.690804}, 4.988535},
      {6, {0.836922}, 0.8621873},
      {7, {0.08820601}, 0.08823522},
      {8, {7.954778}, 9.772917},
      {9, {0.001769341}, 0.001931136},
      {10, {3.715443}, 3.733338},
      {11, {1.536}, 1.544069},
      {12, {0.2060836}, 0.2358485},
      {13, {0.3745179}, 0.374525}}},
    {"roughconductor",
     "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.1'/><string name='distribution' "
     "value='ggx'/><boolean name='sample_visible' value='false'/>",
     {{0, {2.652582}, 2.652582},
      {1, {0.9358751}, 0.9428424},
      {2, {3.017838}, 3.062939},
      {3, {2.928346}, 3.005777},
      {4, {0.2424898}, 0.1845853},
      {5, {4.690804}, 5.305164},
      {6, {0.836922}, 0.7842388},
      {7, {0.08820601}, 0.0459553},
      {8, {7.954778}, 11.34147},
      {9, {0.001769341}, 0.0001406846},
      {10, {3.715443}, 3.751319},
      {11, {1.536}, 1.477217},
      {12, {0.2060836}, 0.2735449},
      {13, {0.3745179}, 0.07437877}}},
    {"roughconductor",
     "<float name='alpha' value='0.3'/><boolean name='sample_visible' value='false'/>",
     {{0, {0.8841941}, 0.8841941},
      {1, {0.4574226}, 0.4574226},
      {2, {1.02098}, 1.02098},
      {3, {1.01713}, 1.027372},
      {4, {0.04470915}, 0.03353186},
      {5, {1.768388}, 1.768388},
      {6, {1.432148}, 1.224923},
      {7, {0.03409485}, 0.0166977},
      {8, {4.223918}, 4.011002},
      {10, {1.25044}, 1.25044},
      {11, {1.159604}, 1.10408},
      {12, {0.06936358}, 0.0809278},
      {13, {0.001738861}, 0.0002338439}}},
    {"roughconductor",
     "<color name='eta' value='0.2 0.9 1.1'/><color name='k' value='3.9 2.4 2.1'/><color name='specular_reflectance' "
     "value='0.9 0.5 0.7'/><float name='alpha' value='0.25'/><string name='distribution' value='ggx'/>",
     {{0, {1.090857, 0.3920273, 0.4466443}, 1.273239},
      {1, {0.2700018, 0.09703234, 0.1105618}, 0.3167844},
      {2, {1.246184, 0.4479236, 0.5111681}, 1.462632},
      {3, {1.229688, 0.4420117, 0.5045406}, 1.444617},
      {4, {0.05525363, 0.01985681, 0.02262325}, 0.06482578},
      {5, {1.985645, 0.7276352, 0.8567012}, 2.437143},
      {6, {1.135593, 0.4120866, 0.479677}, 1.360285},
      {7, {0.07080152, 0.02544961, 0.02904978}, 0.08284583},
      {8, {3.638856, 1.518407, 1.930216}, 5.068398},
      {9, {0.01443696, 0.005193285, 0.005946759}, 0.02306979},
      {10, {1.493299, 0.5379544, 0.6184654}, 1.773345},
      {11, {1.189842, 0.428278, 0.491336}, 1.406076},
      {12, {0.05666524, 0.02039687, 0.02340155}, 0.07330387},
      {13, {0.09939949, 0.0357803, 0.04105449}, 0.1162167}}},
    {"roughdielectric",
     "",
     {{0, {0.322578}, 0.322578},
      {1, {0.000282902}, 0.000282902},
      {2, {0.3865531}, 0.3865531},
      {3, {0.3732784}, 0.3732783},
      {5, {1.430483}, 1.430483},
      {6, {0.1149717}, 0.1149717},
      {8, {11.88889}, 11.8889},
      {10, {0.5719828}, 0.5719827},
      {11, {0.2406817}, 0.2406817},
      {14, {120.1439}, 271.8337},
      {15, {94.45044}, 213.7004},
      {17, {43.64363}, 98.74664},
      {18, {0.4887052}, 1.105729},
      {20, {0.1588932}, 0.1588932},
      {21, {0.273186}, 0.273186}}},
    {"roughdielectric",
     "<float name='alpha' value='0.3'/>",
     {{0, {0.035842}, 0.035842},         {1, {0.01857942}, 0.01857942},   {2, {0.04295034}, 0.04295035},
      {3, {0.04303222}, 0.04303221},     {4, {0.001812346}, 0.001812346}, {5, {0.1589425}, 0.1589425},
      {6, {0.0994681}, 0.09946808},      {7, {0.001442406}, 0.001442406}, {8, {1.320905}, 1.372535},
      {10, {0.06355364}, 0.06355364},    {11, {0.05577691}, 0.05577691},  {12, {0.00334204}, 0.003366741},
      {13, {8.39605e-05}, 8.396051e-05}, {14, {13.34932}, 30.20374},      {15, {10.64896}, 24.09398},
      {16, {0.6750067}, 1.527248},       {17, {4.857851}, 10.99121},      {18, {5.173435}, 11.70524},
      {19, {1.527249}, 0.6750072},       {20, {0.04025152}, 0.04025153},  {21, {0.03595885}, 0.03595886}}},
    {"roughdielectric",
     "<float name='alpha' value='0.3'/><string name='distribution' value='ggx'/><float name='intIOR' "
     "value='1.5'/><float name='extIOR' value='1'/>",
     {{0, {0.03536776}, 0.03536776},    {1, {0.01250353}, 0.01259662},    {2, {0.04176952}, 0.04208048},
      {3, {0.04160728}, 0.04196966},    {4, {0.003233197}, 0.003257267},  {5, {0.1394525}, 0.1483037},
      {6, {0.07357011}, 0.07585044},    {7, {0.004366341}, 0.004379317},  {8, {0.8223943}, 1.028479},
      {9, {0.000927309}, 0.001378677},  {10, {0.06014461}, 0.06146872},   {11, {0.04882166}, 0.0495832},
      {12, {0.003741507}, 0.004295078}, {13, {0.006627807}, 0.006628948}, {14, {13.58122}, 30.55775},
      {15, {10.6677}, 24.07136},        {16, {1.241548}, 2.814279},       {17, {4.51789}, 10.27618},
      {18, {3.63521}, 8.240113},        {19, {2.793483}, 1.250791},       {20, {0.03575617}, 0.03604431},
      {21, {0.03467368}, 0.0347296},    {22, {0.7334796}, 0.346682}}},
    {"roughdielectric",
     "<float name='alpha_u' value='0.3'/><float name='alpha_v' value='0.1'/><string name='distribution' "
     "value='ggx'/><float name='intIOR' value='1.5'/><float name='extIOR' value='1'/>",
     {{0, {0.1061033}, 0.1061033},      {1, {0.03751059}, 0.03778985},   {2, {0.1253086}, 0.1262415},
      {3, {0.1222908}, 0.1233547},      {4, {0.009699591}, 0.009771802}, {5, {0.4183573}, 0.444911},
      {6, {0.05758662}, 0.05932506},    {7, {0.003683419}, 0.003684639}, {8, {2.481619}, 3.048818},
      {9, {8.00645e-05}, 8.738587e-05}, {10, {0.1866636}, 0.1875626},    {11, {0.07300014}, 0.0733836},
      {12, {0.009811078}, 0.0112281},   {13, {0.01786829}, 0.01786863},  {14, {40.74366}, 91.67323},
      {15, {32.0031}, 72.21407},        {16, {3.724643}, 8.442836},      {17, {13.55367}, 30.82854},
      {18, {10.3838}, 23.42183},        {19, {8.380448}, 3.752373},      {20, {0.1072685}, 0.1081329},
      {21, {0.09117839}, 0.0912715},    {22, {2.200439}, 1.040046}}},
    {"roughdielectric",
     "<float name='alpha' value='0.3'/><string name='distribution' value='ggx'/><float name='intIOR' "
     "value='1.5'/><float name='extIOR' value='1'/><boolean name='sample_visible' value='false'/>",
     {{0, {0.03536776}, 0.03536776},    {1, {0.01250353}, 0.01259662},    {2, {0.04176952}, 0.04124103},
      {3, {0.04160728}, 0.04155697},    {4, {0.003233197}, 0.002500127},  {5, {0.1394525}, 0.1407445},
      {6, {0.07357011}, 0.06436578},    {7, {0.004366341}, 0.002450164},  {8, {0.8223943}, 0.9910328},
      {9, {0.000927309}, 0.0001283017}, {10, {0.06014461}, 0.05900694},   {11, {0.04882166}, 0.04578515},
      {12, {0.003741507}, 0.004999737}, {13, {0.006627807}, 0.001619057}, {14, {13.58122}, 30.55775},
      {15, {10.6677}, 23.4528},         {16, {1.241548}, 2.160109},       {17, {4.51789}, 9.88682},
      {18, {3.63521}, 7.852637},        {19, {2.793483}, 0.9600488},      {20, {0.03575617}, 0.03709374},
      {21, {0.03467368}, 0.03492133},   {22, {0.7334796}, 0.1025647}}},
};

struct Furnace {
    std::string type, distribution;
    double alpha;
    double albedo[4]; // at 0, 45, 70 and 85 degrees from the normal, each with an error of 0.003
};
const Furnace furnaces[] = {
    {"roughconductor", "beckmann", 0.05, {1, 1, 1, 0.9415}},
    {"roughdielectric", "beckmann", 0.05, {0.4666, 0.4726, 0.5395, 0.7189}},
    {"roughconductor", "beckmann", 0.1, {1, 1, 0.9939, 0.9152}},
    {"roughdielectric", "beckmann", 0.1, {0.4662, 0.4728, 0.5373, 0.6532}},
    {"roughconductor", "beckmann", 0.3, {1.001, 0.9689, 0.9046, 0.9375}},
    {"roughdielectric", "beckmann", 0.3, {0.4676, 0.4717, 0.4898, 0.5559}},
    {"roughconductor", "beckmann", 0.6, {0.8588, 0.8371, 0.8828, 0.9396}},
    {"roughdielectric", "beckmann", 0.6, {0.4616, 0.4561, 0.4642, 0.484}},
    {"roughconductor", "beckmann", 1, {0.464, 0.6524, 0.8252, 0.9077}},
    {"roughdielectric", "beckmann", 1, {0.4409, 0.4365, 0.4107, 0.3753}},
    {"roughconductor", "ggx", 0.05, {0.9982, 0.9957, 0.9852, 0.8999}},
    {"roughdielectric", "ggx", 0.05, {0.4658, 0.4721, 0.5327, 0.6573}},
    {"roughconductor", "ggx", 0.1, {0.9903, 0.9821, 0.9473, 0.8752}},
    {"roughdielectric", "ggx", 0.1, {0.4656, 0.4706, 0.5174, 0.5818}},
    {"roughconductor", "ggx", 0.3, {0.8802, 0.847, 0.8088, 0.8495}},
    {"roughdielectric", "ggx", 0.3, {0.4598, 0.4565, 0.4547, 0.4529}},
    {"roughconductor", "ggx", 0.6, {0.5941, 0.6045, 0.6569, 0.7373}},
    {"roughdielectric", "ggx", 0.6, {0.4388, 0.4184, 0.373, 0.3149}},
    {"roughconductor", "ggx", 1, {0.3089, 0.3613, 0.4593, 0.5663}},
    {"roughdielectric", "ggx", 1, {0.4049, 0.3563, 0.2715, 0.1961}},
};

Bsdf bsdf_of(const std::string &type, const std::string &properties) {
    const XmlDocument document("a material", fmt::format("<bsdf type='{}'>{}</bsdf>", type, properties));
    return parse_bsdf(document.root(), {});
}

// Mitsuba's density of Beckmann's visible facets has Smith's G1 in the rational fit of Walter et al. Opal's has it
// exactly, because only then it integrates to 1. The latter over the former, seen from wi.
double exact_over_fit(const Bsdf &bsdf, Vec3 wi) {
    const auto at = [&](const char *name) { return bsdf.words[bsdf_parameter(bsdf.kind(), name)->word]; };
    if (at("ggx") || !at("sample_visible"))
        return 1;
    const double u = std::bit_cast<float>(at("alpha_u")) * wi.x, v = std::bit_cast<float>(at("alpha_v")) * wi.y;
    const double a = std::abs(wi.z) / std::hypot(u, v);
    if (!std::isfinite(a))
        return 1;
    const double lambda = (std::erf(a) - 1) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(std::numbers::pi));
    const double fit = a < 1.6 ? (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a) : 1;
    return 1 / (1 + lambda) / fit;
}

} // namespace

TEST_CASE("f cos and densities of facets are Mitsuba's", "[mitsuba_facets]") {
    std::vector<Bsdf> bsdfs;
    for (const RoughMaterial &material : rough_materials)
        bsdfs.push_back(bsdf_of(material.type, material.properties));
    KernelProbe probe = double_probe(bsdfs);
    for (unsigned id = 0; id < bsdfs.size(); id++) {
        const RoughMaterial &material = rough_materials[id];
        auto value = material.values.begin();
        for (size_t i = 0; i < std::size(mitsuba_pairs); i++) {
            INFO(material.type << " " << material.properties << ", pair " << i);
            const Planes drawn = probe.bsdf_eval(id, mitsuba_pairs[i].wi, std::span(&mitsuba_pairs[i].wo, 1));
            const bool is_known = value != material.values.end() && value->pair == i;
            for (size_t c = 0; c < 3; c++) {
                const double f_cos = drawn.at(EVAL_R + c, 0) * std::abs(mitsuba_pairs[i].wo.z);
                CHECK(f_cos == Approx(is_known ? value->f_cos[c % value->f_cos.size()] : 0).epsilon(1e-5).margin(1e-9));
            }
            const double pdf = is_known ? value->pdf * exact_over_fit(bsdfs[id], mitsuba_pairs[i].wi) : 0;
            CHECK(drawn.at(EVAL_PDF, 0) == Approx(pdf).epsilon(1e-5).margin(1e-9));
            value += is_known;
        }
        CHECK(value == material.values.end());
    }
}

TEST_CASE("Facets leave what Mitsuba's leave under a white sky", "[mitsuba_facets][stat]") {
    std::vector<Bsdf> bsdfs;
    for (const Furnace &furnace : furnaces)
        bsdfs.push_back(bsdf_of(furnace.type, fmt::format("<float name='alpha' value='{}'/><string name='distribution' "
                                                          "value='{}'/>",
                                                          furnace.alpha, furnace.distribution)));
    KernelProbe probe = double_probe(bsdfs);
    constexpr size_t side = 256; // a grid of random numbers: the mean is a quadrature
    Planes numbers(2 * OPAL_PROBE_PAIRS, side * side);
    for (size_t i = 0; i < numbers.count; i++) {
        numbers.at(0, i) = float((double(i / side) + 0.5) / side);
        numbers.at(1, i) = float((double(i % side) + 0.5) / side);
        numbers.at(2, i) = float((double(i * 40503 % 65536) + 0.5) / 65536);
    }
    for (unsigned id = 0; id < bsdfs.size(); id++)
        for (size_t k = 0; k < 4; k++) {
            const double theta = double(std::array{0, 45, 70, 85}[k]) * std::numbers::pi / 180;
            const Planes drawn = of_radiance(probe.bsdf_sample(id, {std::sin(theta), 0, std::cos(theta)}, numbers));
            double sum = 0;
            for (size_t i = 0; i < drawn.count; i++)
                sum += drawn.at(BSDF_WEIGHT_R, i);
            const Furnace &furnace = furnaces[id];
            INFO(furnace.type << " " << furnace.distribution << " " << furnace.alpha << ", angle " << k);
            CHECK(sum / double(drawn.count) == Approx(furnace.albedo[k]).margin(4 * 0.003));
        }
}

TEST_CASE("Samples of smooth metals and panes are Mitsuba's", "[mitsuba_facets]") {
    require_all_pass(check_metals(Sources::embedded(), 0));
}

// By quadrature over the random numbers, in double precision. Below 1 is what facets take that light meets twice. The
// albedo is the same however directions are drawn.
TEST_CASE("No metal or glass of facets gains light", "[mitsuba_facets]") {
    struct Case {
        bool is_glass;
        double alpha_u, alpha_v, ior;
        std::string distribution;
    };
    std::vector<Case> cases;
    std::vector<Bsdf> bsdfs;
    for (const bool is_glass : {false, true})
        for (const char *distribution : {"beckmann", "ggx"})
            for (const auto &[u, v] : {std::pair{1e-6, 1e-6}, {0.01, 0.01}, {0.1, 0.1}, {1., 1.}, {1., 0.02}})
                for (const double ior : is_glass ? std::vector{1.01, 2.4} : std::vector{0.}) {
                    cases.push_back({is_glass, u, v, ior, distribution});
                    const std::string glass = fmt::format("<float name='intIOR' value='{}'/>", ior);
                    bsdfs.push_back(bsdf_of(is_glass ? "roughdielectric" : "roughconductor",
                                            fmt::format("<float name='alpha_u' value='{}'/><float name='alpha_v' "
                                                        "value='{}'/><string name='distribution' value='{}'/>{}",
                                                        u, v, distribution, is_glass ? glass : "")));
                }
    KernelProbe probe = double_probe(bsdfs);
    const Planes numbers = grid_of_numbers(128, 9973);
    for (unsigned id = 0; id < bsdfs.size(); id++)
        for (double degrees : {0.0, 30.0, 60.0, 80.0, 88.0, 89.9, 135.0, 179.0}) {
            const Case &c = cases[id];
            const double albedo = albedo_of(probe, id, degrees, numbers);
            INFO((c.is_glass ? "glass " : "metal ") << c.distribution << " " << c.alpha_u << " " << c.alpha_v << " "
                                                    << c.ior << " at " << degrees << " degrees");
            // The fit of Beckmann's G1 is 1 where the exact one is down to 1 / 1.0018. Glass of nearly equal indices,
            // whose light goes almost straight on, gains that, as Mitsuba's does.
            CHECK(albedo <= 1 + (c.is_glass && c.distribution == "beckmann" ? 1.8e-3 : 1e-4));
            if (c.alpha_u < 1e-3) // all but smooth
                CHECK(albedo == Approx(c.is_glass || degrees < 90 ? 1 : 0).margin(1e-3));
        }
}

TEST_CASE("Metals have the indices that Mitsuba gives them, upper and lower case as there", "[mitsuba_facets]") {
    CHECK(metals().size() == 72);
    REQUIRE(find_metal("Au"));
    CHECK(find_metal("Au")->eta[2] == Approx(1.44205).epsilon(1e-5));
    CHECK(find_metal("Au")->k[0] == Approx(3.983).epsilon(1e-5));
    CHECK(find_metal("Cu_palik"));
    CHECK(find_metal("none")->k[1] == 1);
    CHECK_FALSE(find_metal("au"));
}
