// blendbsdf, normalmap, bumpmap and nests of them against values that Mitsuba 3.9.1 (scalar_rgb) gives.
#include "base/table.h"
#include "read/nori/parsers.h"
#include "support/kernel_checks.h"
#include "support/kernels.h"
#include "support/mitsuba_pairs.h"
#include "support/probe.h"

#include <fmt/format.h>

#include <cmath>
#include <span>

namespace opal::test {

namespace {

// A material; f cos and density of red for each of some pairs of directions.
struct Row {
    std::string xml;
    std::vector<double> f_cos, pdf;
};

const std::string red = R"(<bsdf type="diffuse"><color name="albedo" value="0.8 0.1 0.1"/>
<boolean name="use_cosine" value="true"/></bsdf>)";
const std::string green = R"(<bsdf type="diffuse"><color name="albedo" value="0.1 0.7 0.2"/>
<boolean name="use_cosine" value="true"/></bsdf>)";
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

// All rows in one kernel, at all tested widths.
Findings rows_findings(const std::vector<Row> &rows, std::span<const DirectionPair> pairs, const Sources &sources) {
    std::vector<Bsdf> bsdfs;
    for (const Row &row : rows) {
        const XmlDocument document("a material", row.xml);
        bsdfs.push_back(parse_bsdf(document.root(), {}));
        raise(bsdfs.back());
    }
    const auto error = [](double found, double expected) {
        return std::abs(found - expected) / (1e-7 + 5e-6 * std::abs(expected));
    };
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_bsdfs(bsdfs), lanes, sources);
        for (unsigned id = 0; id < rows.size(); id++)
            for (size_t i = 0; i < pairs.size(); i++) {
                const Vec3 wo = normalize(pairs[i].wo);
                const Planes drawn = probe.bsdf_eval(id, normalize(pairs[i].wi), std::span(&wo, 1));
                const std::string subject = fmt::format("{}, pair {}{}", rows[id].xml, i, at_width(lanes));
                findings.push_back(at_most("f cos against Mitsuba's, in tolerances",
                                           error(drawn.at(EVAL_R, 0) * std::abs(wo.z), rows[id].f_cos[i]), 1, subject));
                findings.push_back(at_most("density against Mitsuba's, in tolerances",
                                           error(drawn.at(EVAL_PDF, 0), rows[id].pdf[i]), 1, subject));
            }
    }
    return findings;
}

Findings single_findings(const Sources &sources) {
    const std::vector<Row> rows = {
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
        // About (0.9, -0.3, 0.1), whose slope is beyond what the shadowing function tells apart.
        {"<bsdf type='normalmap'><color name='normalmap' value='0.97172818 0.34275727 0.55241424'/>" + red + "</bsdf>",
         {0.02669435, 0.1329582, 0, 0, 0.1329582, 0, 0, 0, 0, 0, 0.01158551, 0, 0, 0.01957568},
         {0.03336794, 0.1790532, 0, 0, 0.1790532, 0, 0, 0, 0, 0, 0.01748118, 0, 0, 0.02451634}},
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
    return rows_findings(rows, std::span(mitsuba_pairs).first(rows.front().f_cos.size()), sources);
}

Findings nest_findings(const Sources &sources) {
    const std::vector<DirectionPair> pairs = {
        {{0.3, 0.2, 0.9}, {0.1, -0.5, 0.7}},   {{-0.9, 0.3, 0.2}, {0.1, -0.5, 0.7}},
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
    std::vector<Row> rows = {
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
    Findings findings = rows_findings(rows, pairs, sources);
    rows.pop_back(); // the blend, without which kernels open BSDFs before they ask them
    append(findings, rows_findings(rows, pairs, sources));
    return findings;
}

} // namespace

Findings check_nested_bsdfs(const Sources &sources, unsigned) {
    Findings findings = single_findings(sources);
    append(findings, nest_findings(sources));
    return findings;
}

} // namespace opal::test
