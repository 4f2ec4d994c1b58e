// Surfaces that light passes through unchanged (mask, null), emitters that the camera does not see, and several samples
// of a kind: means that are known, in every strategy.
#include "read/nori/load.h"
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/scratch.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace opal::test {

namespace {

struct How {
    std::string integrator;
    Overrides overrides;
};

const std::vector<How> paths = {{"path_mis", {{"lighting", "bsdf"}}},
                                {"path_mis", {{"lighting", "emitter"}}},
                                {"path_mis", {{"mis", "balance"}}},
                                {"path_mis", {{"mis", "power"}}}};

std::vector<How> all_strategies() {
    std::vector<How> all = paths;
    all.insert(all.end(), {{"direct_lighting", {{"lighting", "bsdf"}}},
                           {"direct_lighting", {{"lighting", "emitter"}}},
                           {"direct_lighting", {{"lighting", "mis"}, {"mis", "balance"}}},
                           {"direct_lighting", {{"lighting", "mis"}, {"mis", "power"}}},
                           {"direct_lighting", {{"lighting", "mis"}, {"mis", "one-sample"}}},
                           {"direct_lighting",
                            {{"lighting", "mis"}, {"mis", "power"}, {"emitter-samples", "3"}, {"bsdf-samples", "2"}}},
                           {"direct_lighting", {{"lighting", "emitter"}, {"bsdf-samples", "2"}}},
                           {"whitted", {}}});
    return all;
}

// The objects, seen from `origin` towards the point 0 0 0 through a narrow view.
SceneDescription view(const std::string &integrator, const std::string &objects, const char *origin = "0 1.7320508 1") {
    const ScratchFolder folder;
    return load_scene(folder.write(
        "view.xml",
        fmt::format(R"(<scene>
<integrator type="{}">{}</integrator>
<camera type="perspective"><float name="fov" value="0.1"/>
<integer name="width" value="8"/><integer name="height" value="8"/>
<transform name="toWorld"><lookat origin="{}" target="0 0 0" up="0.1 0.2 1"/></transform>
<rfilter type="box"/></camera>{}</scene>)",
                    integrator,
                    objects.starts_with("<!-- hide -->") ? "<boolean name=\"hide_emitters\" value=\"true\"/>" : "",
                    origin, objects)));
}

// A square of the plane z = height whose front is above.
std::string square(double height, const std::string &within, double half = 1) {
    return fmt::format(R"(<mesh type="parallelogram"><point name="origin" value="{0} {0} {1}"/>
<vector name="u" value="{2} 0 0"/><vector name="v" value="0 {2} 0"/>{3}</mesh>)",
                       -half, height, 2 * half, within);
}

// The walls of a cube around 0 0 0, seen from inside.
std::string cube(double half, const std::string &within) {
    std::string walls;
    const char *const axes[3] = {"{0} 0 0", "0 {0} 0", "0 0 {0}"};
    for (int axis = 0; axis < 3; axis++)
        for (double side : {-1.0, 1.0}) {
            const auto vector = [&](int i, double length) { return fmt::format(fmt::runtime(axes[i % 3]), length); };
            std::string origin = fmt::format("{0} {0} {0}", -half);
            if (side > 0)
                origin = axis == 0   ? fmt::format("{1} {0} {0}", -half, half)
                         : axis == 1 ? fmt::format("{0} {1} {0}", -half, half)
                                     : fmt::format("{0} {0} {1}", -half, half);
            const int u = side < 0 ? axis + 1 : axis + 2, v = side < 0 ? axis + 2 : axis + 1; // u x v points inwards
            walls += fmt::format(R"(<mesh type="parallelogram"><point name="origin" value="{}"/>
<vector name="u" value="{}"/><vector name="v" value="{}"/>{}</mesh>)",
                                 origin, vector(u, 2 * half), vector(v, 2 * half), within);
        }
    return walls;
}

std::string diffuse(double albedo) {
    return fmt::format(R"(<bsdf type="diffuse"><color name="albedo" value="{0} {0} {0}"/></bsdf>)", albedo);
}
std::string mask(double opacity, const std::string &within) {
    return fmt::format(R"(<bsdf type="mask"><float name="opacity" value="{}"/>{}</bsdf>)", opacity, within);
}
std::string area(double radiance) {
    return fmt::format(R"(<emitter type="area"><color name="radiance" value="{0} {0} {0}"/></emitter>)", radiance);
}
std::string sky(double radiance) {
    return fmt::format(R"(<emitter type="constant"><color name="radiance" value="{0} {0} {0}"/></emitter>)", radiance);
}
const std::string null = R"(<bsdf type="null"/>)", hide = "<!-- hide -->";

constexpr const char *oblique = "0 1.7320508 1";

// What is rendered by which kernels, and what was found.
struct Means {
    const Sources &sources;
    unsigned seed;
    Overrides kernel;           // specialise, lanes
    size_t first = 0, step = 1; // of several strategies these alone: a kernel of each takes a second to compile
    Findings findings{};

    // Every strategy shows this mean.
    void check(const std::string &what, const std::vector<How> &strategies, const std::string &objects, double expected,
               const char *origin = oblique) {
        for (size_t i = std::min(first, strategies.size() - 1); i < strategies.size(); i += step) {
            const How &how = strategies[i];
            Overrides overrides = how.overrides;
            overrides.insert(kernel.begin(), kernel.end());
            add(fmt::format("{}, {}", what, how.integrator), overrides, view(how.integrator, objects, origin),
                expected);
        }
    }
    void add(std::string what, const Overrides &overrides, const SceneDescription &scene, double expected) {
        for (const auto &[name, value] : overrides)
            what += " " + name + " " + value;
        RenderSetup setup;
        setup.sources = &sources;
        const Film film = render(with_strategy(scene, overrides), 1024, ++seed, setup);
        const stats::Sample image = sample_of(film, 0);
        findings.push_back(exact(what + ": no invalid samples", film.invalid == 0));
        if (image.variance > 1e-10)
            findings.push_back(p_value(what, stats::z_test(image, expected).p_value));
        // Without noise, and so that noise passes no wrong picture.
        findings.push_back(at_most(what + ": mean, off by", std::abs(image.mean - expected),
                                   image.variance > 1e-10 ? 0.05 * expected : 1e-6 * (1 + expected)));
    }
};

void add_masks(Means &means) {
    const std::vector<How> all = all_strategies();
    for (double opacity : {0.0, 0.3, 1.0}) {
        means.check(fmt::format("a floor of opacity {} under a sky", opacity), all,
                    sky(2) + square(0, mask(opacity, diffuse(0.4))), 2 * (opacity * 0.4 + 1 - opacity));
        means.check(fmt::format("a light behind a mask of opacity {}", opacity), all,
                    square(0, mask(opacity, diffuse(0.4))) + square(-0.5, area(3) + diffuse(0), 20), 3 * (1 - opacity));
    }
    means.check("a mask in a mask", all, sky(2) + square(0, mask(0.5, mask(0.6, diffuse(0.4)))), 2 * (0.3 * 0.4 + 0.7));
    means.check("a masked mirror", all, sky(2) + square(0, mask(0.6, R"(<bsdf type="mirror"/>)")), 2);
    means.check("null", all, sky(2) + square(0, null), 2);
    means.check("a light behind null", all, square(0, null) + square(-0.5, area(3) + diffuse(0), 20), 3);
    // Shadow rays are blocked, and paths pass.
    means.check("a floor in a masked cube", paths, sky(2) + cube(3, mask(0.25, diffuse(0))) + square(0, diffuse(0.4)),
                2 * 0.4 * 0.75);
    means.check("a floor in a cube of null", paths, sky(2) + cube(3, null) + square(0, diffuse(0.4)), 2 * 0.4);
    means.check("a point light behind a mask of opacity 0", {paths[1], paths[2]},
                R"(<emitter type="point"><point name="position" value="0 0 2"/>
<color name="power" value="9 9 9"/></emitter>)" +
                    square(0, diffuse(0.4)) + square(0.5, mask(0, diffuse(0)), 0.4),
                0);
}

void add_hidden(Means &means) {
    const std::vector<How> all = all_strategies();
    const std::string room = cube(30, area(1) + diffuse(0)), floor = square(0, diffuse(0.4));
    const char *const outside = "0 0 100";
    means.check("a room that is not hidden", all, room + floor, 0, outside); // its back is black
    means.check("a floor in a hidden room", all, hide + room + floor, 0.4, outside);
    means.check("a floor in two hidden rooms", all, hide + room + cube(35, area(7)) + floor, 0.4, outside);
    means.check("a mirror in a hidden room", all, hide + room + square(0, R"(<bsdf type="mirror"/>)"), 1, outside);
    means.check("nothing behind a hidden room", all, hide + room, 0, outside);
    means.check("a floor under a hidden sky", all, hide + sky(2) + floor, 0.8);
    means.check("a hidden sky", all, hide + sky(2) + floor, 0, "3 0.1 -1");
    means.check("a hidden sky behind null", all, hide + sky(2) + square(0, null), 0);
    means.check("a hidden light behind null", all, hide + square(0, null) + square(-0.5, area(3) + diffuse(0), 20), 3);
    means.check("a hidden sky behind a mask", all, hide + sky(2) + square(0, mask(0.3, diffuse(0.4))), 2 * 0.3 * 0.4);
    means.check("a hidden sky behind glass of index 1", paths, hide + sky(2) + square(0, R"(<bsdf type="dielectric">
<float name="intIOR" value="1"/><float name="extIOR" value="1"/></bsdf>)"),
                2);
}

void add_counts(Means &means) {
    for (const auto &[lighting, mis] :
         {std::pair{"bsdf", "balance"}, {"emitter", "balance"}, {"mis", "balance"}, {"mis", "power"}})
        for (const auto &[emitter, bsdf] : {std::pair{"1", "4"}, {"4", "1"}, {"3", "2"}}) {
            Overrides how = {{"integrator", "direct_lighting"},
                             {"lighting", lighting},
                             {"mis", mis},
                             {"emitter-samples", emitter},
                             {"bsdf-samples", bsdf}};
            how.insert(means.kernel.begin(), means.kernel.end());
            SceneDescription scene = triangle_light();
            scene.camera.width = scene.camera.height = 8;
            means.add("triangle light", how, scene, triangle_light_truth());
        }
}

using Add = void (*)(Means &);
Findings general(const Sources &sources, unsigned seed, Add add) {
    Means means{sources, seed, {{"specialise", "off"}}};
    add(means);
    return means.findings;
}
Findings specialised(unsigned seed, Add add) {
    Findings findings;
    // Each strategy at one of the two widths.
    for (const auto &[lanes, first] : {std::pair{"auto", size_t(0)}, {"1", size_t(1)}}) {
        Means means{Sources::embedded(), seed, {{"specialise", "on"}, {"lanes", lanes}}, first, 2};
        add(means);
        append(findings, means.findings);
    }
    return findings;
}

} // namespace

Findings check_masks(const Sources &sources, unsigned seed) { return general(sources, seed, add_masks); }
Findings check_hidden_emitters(const Sources &sources, unsigned seed) { return general(sources, seed, add_hidden); }
Findings check_sample_counts(const Sources &sources, unsigned seed) { return general(sources, seed, add_counts); }
Findings check_masks_specialised(unsigned seed) { return specialised(seed, add_masks); }
Findings check_hidden_emitters_specialised(unsigned seed) { return specialised(seed, add_hidden); }
Findings check_sample_counts_specialised(unsigned seed) { return specialised(seed, add_counts); }

} // namespace opal::test
