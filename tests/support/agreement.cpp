// Strategies with one expectation, held against each other.
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/pictures.h"
#include "support/rooms.h"

#include <cmath>

namespace opal::test {

namespace {

using Strategies = std::vector<Overrides>;

struct Group {
    std::string name;
    SceneDescription scene;
    unsigned spp;
    Strategies strategies;
};

Group path_group() {
    return {"path",
            gallery(),
            384,
            {{{"lighting", "bsdf"}},
             {{"lighting", "bsdf"}, {"hemisphere", "cosine"}},
             {{"lighting", "emitter"}},
             {{"lighting", "mis"}, {"mis", "balance"}},
             {{"lighting", "mis"}, {"mis", "power"}},
             {{"lighting", "mis"}, {"hemisphere", "uniform"}}}};
}

Group direct_group() {
    return {"direct",
            matte_gallery(),
            512,
            {{{"integrator", "direct_lighting"}, {"lighting", "bsdf"}},
             {{"integrator", "direct_lighting"}, {"lighting", "emitter"}},
             {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "balance"}},
             {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "power"}},
             {{"integrator", "direct_lighting"}, {"lighting", "mis"}, {"mis", "one-sample"}},
             {{"integrator", "whitted"}},
             {{"integrator", "path_mis"},
              {"max-depth", "2"},
              {"emitter-choice", "uniform"},
              {"triangle-choice", "uniform"}},
             {{"integrator", "path_ems"}, {"max-depth", "2"}, {"triangle-choice", "uniform"}}}};
}

// The gallery without its ceiling.
SceneDescription open_gallery() {
    SceneDescription scene = matte_gallery();
    std::erase_if(scene.meshes, [](const Mesh &mesh) {
        const auto *shape = std::get_if<Parallelogram>(&mesh.shape);
        return shape && shape->origin.y == 1;
    });
    return scene;
}

Group sky_group(const char *name, const Light &sky) {
    SceneDescription scene = open_gallery();
    scene.lights = {sky};
    return {name,
            scene,
            512,
            {{{"lighting", "bsdf"}, {"hemisphere", "cosine"}},
             {{"lighting", "emitter"}},
             {{"lighting", "emitter"}, {"emitter-choice", "uniform"}},
             {{"lighting", "mis"}, {"mis", "balance"}},
             {{"lighting", "mis"}, {"mis", "power"}, {"emitter-choice", "uniform"}}}};
}

// The brighter half of the map alone is sampled where BSDF samples find the rest.
Light map_sky() {
    emitter_envmap sky;
    sky.map = examples::environment();
    sky.mis_compensation = true;
    return {sky, {}};
}

Group occlusion_group() {
    return {"occlusion",
            open_gallery(),
            1024,
            {{{"integrator", "ao"}, {"hemisphere", "uniform"}}, {{"integrator", "ao"}, {"hemisphere", "cosine"}}}};
}

// The mean luminance of each strategy against that of every other.
Findings agreement_of(const Group &group, const Sources &sources, unsigned seed) {
    RenderSetup setup;
    setup.sources = &sources;
    std::vector<stats::Sample> samples;
    Findings findings;
    for (Overrides how : group.strategies) {
        how["specialise"] = "off";
        const Film film = render(with_strategy(group.scene, how), group.spp, seed + unsigned(samples.size()), setup);
        samples.push_back(sample_of(film));
        findings.push_back(exact(group.name + ": no invalid samples", film.invalid == 0));
    }
    for (size_t i = 0; i < samples.size(); i++)
        for (size_t j = i + 1; j < samples.size(); j++)
            findings.push_back(p_value(group.name + ": strategies " + std::to_string(i) + " and " + std::to_string(j),
                                       stats::welch_test(samples[i], samples[j]).p_value));
    return findings;
}

} // namespace

Findings check_agreement(const Sources &sources, unsigned seed) {
    Findings findings = agreement_of(path_group(), sources, seed);
    for (const Group &group : {direct_group(), sky_group("sky", {emitter_constant{{1, 2, 3}}, {}}),
                               sky_group("map", map_sky()), occlusion_group()})
        append(findings, agreement_of(group, sources, seed + unsigned(findings.size())));
    return findings;
}

} // namespace opal::test
