// Materials whose parameters are at the ends of their ranges: what many samples of them are.
#include "probe/kernel_probe.h"
#include "scene/index_of_refraction.h"
#include "scene/parameters.h"
#include "scene/scene.h"
#include "support/device.h"
#include "support/probe.h"

#include <fmt/format.h>

#include <cstdlib>
#include <numbers>
#include <random>

using namespace opal;
using namespace opal::test;

namespace {

constexpr double degree = std::numbers::pi / 180;

struct Kind {
    std::string name;
    std::vector<uint> record; // with its defaults
};
#define OPAL_KIND(name, traits) {#name, words_of(bsdf_##name##_record{})},
const std::vector<Kind> kinds = {OPAL_BSDFS(OPAL_KIND)};
#undef OPAL_KIND

// The ends of a parameter's range, values that are nearly there, and some between.
std::vector<double> values_of(const Parameter &parameter) {
    if (parameter.type == ParameterType::FLAG)
        return {0, 1};
    if (parameter.name == "n") // an exponent
        return {0, 1e-6, 1, 20, 1e5};
    if (parameter.range.without_least) // an index of refraction
        return {1, 1.000277, 1.33, 1.5, 2.4};
    if (parameter.name == "eta" || parameter.name == "k") // of a metal
        return {0, 1e-3, 0.2, 1, 8};
    const double least = std::max(parameter.range.least, 0.0), most = std::min(parameter.range.most, 1.0);
    return {least, 1e-6, 1e-3, 0.1, 0.5, 1 - 0x1p-24, most};
}

// A material of that kind with values drawn from those. Nested indices are never equal, which readers refuse.
Bsdf drawn_material(const Kind &kind, std::mt19937 &random) {
    Bsdf bsdf;
    bsdf.words = kind.record;
    const auto draw = [&](const Parameter &parameter) {
        const std::vector<double> values = values_of(parameter);
        return values[random() % values.size()];
    };
    const auto set = [&](const Parameter &parameter, size_t channel, double value) {
        bsdf.words[parameter.word + channel] =
            parameter.type == ParameterType::FLAG ? uint(value) : std::bit_cast<uint>(float(value));
    };
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (is_property(parameter.type))
            for (size_t channel = 0; channel < (parameter.type == ParameterType::COLOR ? 3 : 1); channel++)
                set(parameter, channel, draw(parameter));
    const Parameter *const index = bsdf_parameter(bsdf.kind(), "eta"), *const share =
                                                                           bsdf_parameter(bsdf.kind(), "spec_trans");
    if (index && share) // as readers have it
        set(*index, 0, principled_index(std::bit_cast<float>(bsdf.words[index->word]), {}, true));
    const Parameter *const inside = bsdf_parameter(bsdf.kind(), "int_ior"), *const outside =
                                                                                bsdf_parameter(bsdf.kind(), "ext_ior");
    while (inside && outside && bsdf.words[inside->word] == bsdf.words[outside->word])
        set(*inside, 0, draw(*inside));
    return bsdf;
}

// The greatest directional albedo that scenes/README.md admits, and 1e-4. The lobes of principled materials do not know
// of each other.
double greatest_albedo(const std::string &kind) {
    const std::pair<const char *, double> known[] = {{"principled", 1.8},
                                                     {"principledthin", 2.1},
                                                     {"plastic", 1.03},
                                                     {"roughplastic", 1.08},
                                                     {"roughdielectric", 1.0018}};
    for (const auto &[name, albedo] : known)
        if (kind == name)
            return albedo + 1e-4;
    return 1 + 1e-4;
}

std::string text_of(const Bsdf &bsdf) {
    std::string text = bsdf_name(bsdf.kind());
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (is_property(parameter.type))
            text += parameter.type == ParameterType::FLAG
                        ? fmt::format(", {} {}", parameter.name, bsdf.words[parameter.word])
                        : fmt::format(", {} {}", parameter.name, std::bit_cast<float>(bsdf.words[parameter.word]));
    return text;
}

bool is_wrong(double x) { return !(x >= 0 && x < INFINITY); }

} // namespace

// OPAL_CORNER_SAMPLES=1e9: so many samples in place of 1e8.
TEST_CASE("No material at the corners of its parameters draws a NaN or creates light", "[material_corners][long]") {
    const char *const asked = std::getenv("OPAL_CORNER_SAMPLES");
    const double total = asked ? std::atof(asked) : 1e8;
    constexpr size_t materials = 100;
    const std::vector<double> angles = {0, 30, 60, 80, 89, 89.99, 120, 179};
    const Planes corners = corner_numbers(); // of the random numbers; then random ones follow
    const size_t samples = corners.count + size_t(total / double(materials * angles.size() * kinds.size()));
    double done = 0;
    for (const Kind &kind : kinds) {
        std::mt19937 random(7);
        std::vector<Bsdf> bsdfs;
        for (size_t i = 0; i < materials; i++)
            bsdfs.push_back(drawn_material(kind, random));
        KernelProbe probe = probe_of(scene_of_bsdfs(bsdfs), device().info.native_lanes, sources());
        NumberOptions options;
        size_t wrong = 0;
        double brightest = 0;
        std::string worst = "none", first;
        for (size_t id = 0; id < materials; id++)
            for (const double angle : angles) {
                options.seed++;
                Planes numbers = probe.numbers(samples, options);
                for (size_t i = 0; i < corners.count; i++)
                    for (size_t plane = 0; plane < 3; plane++)
                        numbers.at(plane, i) = corners.at(plane, i);
                const Vec3 wi = {std::sin(angle * degree) * 0.8, std::sin(angle * degree) * 0.6,
                                 std::cos(angle * degree)};
                const Planes drawn = probe.bsdf_sample(unsigned(id), wi, numbers);
                double sum[3] = {}, squares[3] = {};
                for (size_t i = 0; i < samples; i++) {
                    bool bad = is_wrong(drawn.at(BSDF_PDF, i)) || !(drawn.at(BSDF_ETA, i) > 0), is_drawn = false;
                    for (size_t c = 0; c < 3; c++) {
                        const double weight = drawn.at(BSDF_WEIGHT_R + c, i);
                        bad = bad || is_wrong(weight);
                        is_drawn = is_drawn || weight > 0;
                        sum[c] += i < corners.count ? 0 : weight;
                        squares[c] += i < corners.count ? 0 : weight * weight;
                    }
                    bad = bad || (is_drawn && !(std::abs(length(drawn.vec3(BSDF_WO_X, i)) - 1) < 1e-5));
                    if (bad && wrong++ == 0)
                        first = fmt::format("{} at {} degrees, numbers {} {} {}: weight {} {} {}, pdf {}",
                                            text_of(bsdfs[id]), angle, numbers.at(0, i), numbers.at(1, i),
                                            numbers.at(2, i), drawn.at(BSDF_WEIGHT_R, i), drawn.at(BSDF_WEIGHT_G, i),
                                            drawn.at(BSDF_WEIGHT_B, i), drawn.at(BSDF_PDF, i));
                }
                for (size_t c = 0; c < 3; c++) {
                    const double n = double(samples - corners.count), mean = sum[c] / n;
                    const double albedo = mean - 5 * std::sqrt(std::max(0.0, squares[c] / n - mean * mean) / n);
                    if (albedo > brightest) {
                        brightest = albedo;
                        worst = fmt::format("{} at {} degrees", text_of(bsdfs[id]), angle);
                    }
                }
                done += double(samples);
            }
        fmt::print("{:<16} {} wrong{}{}; albedo less 5 standard errors at most {:.5f}: {}\n", kind.name, wrong,
                   wrong ? ", first: " : "", first, brightest, worst);
        std::fflush(stdout);
        INFO(kind.name);
        CHECK(wrong == 0);
        CHECK(brightest <= greatest_albedo(kind.name));
    }
    fmt::print("{:.3g} samples\n", done);
}
