#include "support/checks.h"

#include "selftest/checks.h"
#include "stats/hypothesis.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>

namespace opal::test {

namespace {

// Renders by the general kernel, which decides about strategies at run time, so that a check compiles one kernel.
Film render_general(SceneDescription scene, const Overrides &overrides, unsigned spp, unsigned seed,
                    const Sources &sources) {
    Overrides all = overrides;
    all["specialise"] = "off";
    RenderSetup setup;
    setup.sources = &sources;
    return render(with_strategy(std::move(scene), all), spp, seed, setup);
}

std::string text_of(const Overrides &overrides) {
    std::string text;
    for (const auto &[name, value] : overrides)
        text += " " + name + " " + value;
    return text.empty() ? text : text.substr(1);
}

Finding mean_is(const std::string &what, const Film &film, double truth, int channel = 3) {
    return p_value(what, stats::z_test(sample_of(film, channel), truth).p_value);
}

// The level of each p-value.
double level_of(const Findings &findings) {
    const auto count =
        std::count_if(findings.begin(), findings.end(), [](const Finding &f) { return f.kind == FigureKind::p_value; });
    return stats::sidak_level(check_level, double(std::max<std::ptrdiff_t>(1, count)));
}

bool passes(const Finding &finding, double level) {
    return finding.kind == FigureKind::p_value ? finding.figure >= level : finding.passed;
}

} // namespace

const Finding &worst(const Findings &findings) {
    const double level = level_of(findings);
    const auto score = [level](const Finding &f) {
        return f.kind == FigureKind::p_value && f.figure >= 0 ? f.figure : passes(f, level) ? 1 : 0;
    };
    return *std::min_element(findings.begin(), findings.end(),
                             [&](const Finding &a, const Finding &b) { return score(a) < score(b); });
}

bool rejected(const Findings &findings) {
    const double level = level_of(findings);
    return !std::all_of(findings.begin(), findings.end(), [&](const Finding &f) { return passes(f, level); }) ||
           findings.empty();
}

void require_all_pass(const Findings &findings) {
    REQUIRE_FALSE(findings.empty());
    const double level = level_of(findings);
    for (const Finding &finding : findings) {
        INFO(text_of(finding));
        CHECK(passes(finding, level));
    }
}

std::string text_of(const Finding &finding) {
    const std::string what = finding.check + (finding.subject.empty() ? "" : ", " + finding.subject);
    return finding.kind == FigureKind::p_value
               ? fmt::format("{}: p = {:.2g}", what, finding.figure)
               : fmt::format("{}: {:.4g}, at most {:.4g}", what, finding.figure, finding.limit);
}

Finding exact(const std::string &what, bool holds) { return none_wrong(what, !holds); }

Findings check_furnace(const Sources &sources, unsigned seed) {
    Findings findings;
    const auto shows = [&](const SceneDescription &scene, const Overrides &overrides, double truth) {
        const Film film = render_general(scene, overrides, 128, seed + unsigned(findings.size()), sources);
        findings.push_back(mean_is("furnace, " + text_of(overrides), film, truth));
        findings.push_back(exact("no invalid samples", film.invalid == 0));
    };
    const SceneDescription box = furnace(0.5, 1);
    for (const char *rr : {"fixed", "throughput", "throughput-eta"})
        for (const Overrides &how : {Overrides{{"lighting", "bsdf"}, {"hemisphere", "cosine"}},
                                     Overrides{{"lighting", "mis"}, {"mis", "balance"}},
                                     Overrides{{"lighting", "mis"}, {"mis", "power"}, {"hemisphere", "cosine"}}}) {
            Overrides all = how;
            all["rr"] = rr;
            shows(box, all, 2);
        }
    // Without roulette every path gathers the partial sum of the geometric series, without noise.
    shows(box, {{"lighting", "bsdf"}, {"hemisphere", "cosine"}, {"rr", "off"}, {"max-depth", "5"}},
          2 * (1 - std::pow(0.5, 5)));
    return findings;
}

Findings check_glass_furnace(const Sources &sources, unsigned seed) {
    const Film film =
        render_general(glass_furnace(), {{"lighting", "mis"}, {"rr", "off"}, {"max-depth", "2000"}}, 64, seed, sources);
    Findings findings{mean_is("radiance in glass", film, 2.25), exact("no invalid samples", film.invalid == 0)};
    const stats::Sample sample = sample_of(film);
    const Film whitted = render_general(glass_furnace(), {{"integrator", "whitted"}}, 256, seed + 1, sources);
    findings.push_back(mean_is("radiance in glass, whitted", whitted, 2.25));
    findings.push_back(exact("without noise, variance " + std::to_string(sample.variance),
                             sample.variance < 1e-5)); // squares are rounded to float
    return findings;
}

Findings check_triangle_light(const Sources &sources, unsigned seed) {
    Findings findings;
    for (const Overrides &how :
         {Overrides{{"lighting", "bsdf"}}, Overrides{{"lighting", "emitter"}},
          Overrides{{"lighting", "mis"}, {"mis", "balance"}}, Overrides{{"lighting", "mis"}, {"mis", "power"}},
          Overrides{{"lighting", "bsdf"}, {"hemisphere", "uniform"}},
          Overrides{{"lighting", "emitter"}, {"sampler", "sobol"}},
          Overrides{{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "one-sample"}},
          Overrides{{"integrator", "whitted"}}}) {
        const Film film = render_general(triangle_light(), how, 4096, seed + unsigned(findings.size()), sources);
        findings.push_back(mean_is("triangle light, " + text_of(how), film, triangle_light_truth(), 0));
    }
    for (const char *lighting : {"bsdf", "emitter", "mis"}) {
        const Film film = render_general(averted_light(), {{"lighting", lighting}}, 64, seed, sources);
        findings.push_back(
            exact("a light that faces away sheds none, " + std::string(lighting), sample_of(film).mean == 0));
    }
    return findings;
}

Findings check_sphere_light(const Sources &sources, unsigned seed) {
    Findings findings;
    const auto shows = [&](const SceneDescription &scene, const std::string &what, const Overrides &how, unsigned spp,
                           double truth) {
        const Film film = render_general(scene, how, spp, seed + unsigned(findings.size()), sources);
        findings.push_back(mean_is(what + ", " + text_of(how), film, truth, 0));
        findings.push_back(exact("no invalid samples", film.invalid == 0));
    };
    for (const char *lighting : {"bsdf", "emitter", "mis"}) {
        shows(round_furnace(0.5, 1), "round furnace", {{"lighting", lighting}}, 128, 2);
        shows(sphere_light(0.6), "sphere light", {{"lighting", lighting}}, 4096, sphere_light_truth());
    }
    // BSDF samples find the smallest ones too rarely to tell their variance.
    for (const double radius : {1e-2, 1e-4})
        shows(sphere_light(radius), "sphere light of radius " + std::to_string(radius), {{"lighting", "emitter"}}, 1024,
              sphere_light_truth());
    return findings;
}

Findings check_point_light(const Sources &sources, unsigned seed) {
    Findings findings;
    for (const Overrides &how :
         {Overrides{{"lighting", "emitter"}}, Overrides{{"lighting", "mis"}}, Overrides{{"integrator", "whitted"}},
          Overrides{{"integrator", "direct_lighting"}, {"lighting", "emitter"}}}) {
        const Film film = render_general(point_light(), how, 4, seed, sources);
        findings.push_back(mean_is("point light, " + text_of(how), film, point_light_truth(), 0));
    }
    // energy / (4 pi^2) cos / d^2: the point light's radiance for an albedo of 1.
    SceneDescription simple = point_light();
    simple.simple_light = {std::get<emitter_point>(simple.lights[0].parameters).position, {80, 0, 0}};
    const Film film = render_general(simple, {{"integrator", "simple"}}, 4, seed, sources);
    findings.push_back(mean_is("integrator simple", film, point_light_truth(), 0));
    return findings;
}

Findings check_last_segments(const Sources &sources, unsigned seed) {
    Findings findings;
    const auto sample = [&](const SceneDescription &scene, Overrides how) {
        how["specialise"] = "on";
        how.try_emplace("lanes", "1"); // which compiles soonest
        RenderSetup setup;
        setup.sources = &sources;
        return render(with_strategy(scene, how), 4096, seed + unsigned(findings.size()), setup);
    };
    const auto shows = [&](const std::string &what, const SceneDescription &scene, const Overrides &how, double truth) {
        findings.push_back(mean_is(what + ", " + text_of(how), sample(scene, how), truth, 0));
    };
    const double reflected = fresnel_reflectance(1, 1, 1.5);
    shows("a pane before a lamp", reflection(1.5f), {{"lighting", "emitter"}}, reflected);
    shows("a pane before a lamp", reflection(1.5f), {{"lighting", "mis"}}, reflected);
    shows("triangle light", triangle_light(), {{"lighting", "mis"}}, triangle_light_truth());
    shows("point light", point_light(), {{"lighting", "mis"}, {"max-depth", "2"}}, point_light_truth());
    shows("point light", point_light(), {{"integrator", "direct_lighting"}}, point_light_truth());
    // With a ball, which is in the tree as the lamp is not: aside, and before the lamp.
    const Overrides by_bsdf{{"lighting", "bsdf"}, {"lanes", "8"}};
    SceneDescription ball = reflection(1.5f);
    ball.meshes.push_back(diffuse(Sphere{{0.7, 1.5, 0.7}, 0.2}));
    shows("a pane, a ball and a lamp", ball, by_bsdf, reflected);
    ball.meshes.back() = diffuse(Sphere{{0, 1.5, 0}, 0.2});
    findings.push_back(exact("a lamp behind a ball", sample_of(sample(ball, by_bsdf), 0).mean == 0));
    return findings;
}

Findings check_smooth_normals(const Sources &sources, unsigned seed) {
    const Film film = render_general(smooth_octahedron(), {}, 4, seed, sources);
    Findings findings;
    for (int channel = 0; channel < 3; channel++)
        findings.push_back(mean_is("smooth normal's component " + std::to_string(channel), film,
                                   std::abs(smooth_normal()[channel]), channel));
    return findings;
}

} // namespace opal::test
