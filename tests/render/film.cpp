// The film: sums lose no sample, and leave out and count those that are not finite.
#include "base/json.h"
#include "image/image.h"
#include "render/report.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/mutants.h"
#include "support/pictures.h"
#include "support/rooms.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <cmath>
#include <random>

using namespace opal;
using namespace opal::test;

namespace {

// Kernels that make every sample of pixels 5, 16, 27, ... NaN, or infinite where `what` says so.
Mutant spoiled(const std::string &what) {
    return {"pixels " + what, "kernels/retire.cl", "v3 light = path->radiance;",
            "v3 light = path->radiance;\n"
            "light.x = to_mask(film_pixel(scene->settings, path->sampler.pixel) % 11u == 5u) ? (real)(" +
                what + ") : light.x;"};
}

} // namespace

TEST_CASE("Sums of many samples lose nothing, and leave out what is not finite", "[film]") {
    require_all_pass(check_film(Sources::embedded(), test_seed(40)));
}

TEST_CASE("A crop has the bits of its part of the image, with filters of any width", "[film]") {
    require_all_pass(check_crops(Sources::embedded(), test_seed(42)));
}

TEST_CASE("A film of several bands has the bits of its parts", "[film]") {
    SceneDescription scene = gallery(1000, 600); // a band ends within row 524
    for (int kind : {FILTER_box, FILTER_gaussian}) {
        scene.camera.filter.kind = kind;
        scene.camera.filter.radius = kind == FILTER_box ? 0.5 : 2;
        scene.camera.crop = {};
        const Film whole = render(scene, 1, test_seed(43));
        for (const Crop &crop : {Crop{0, 523, 1000, 3, 1000, 600}, {280, 500, 20, 60, 1000, 600}}) {
            INFO(text_of(crop));
            scene.camera.crop = crop;
            const Image part = image_of(render(scene, 1, test_seed(43)), true);
            for (const Layer &layer : cropped(image_of(whole, true), crop).layers)
                CHECK((part.get(layer.name).values == layer.values));
        }
    }
}

TEST_CASE("A film without any pass is empty, and so is one after a restart", "[film]") {
    Renderer renderer = renderer_of(furnace(0.5, 1));
    for (int round = 0; round < 2; round++) {
        const Film film = renderer.film();
        REQUIRE(film.count.size() == size_t(film.width) * size_t(film.height));
        CHECK(film.count == std::vector<unsigned>(film.count.size(), 0));
        CHECK(film.sum == decltype(film.sum)(film.count.size()));
        renderer.render(2);
        CHECK(renderer.film().count == std::vector<unsigned>(film.count.size(), 2));
        renderer.restart(1);
    }
}

TEST_CASE("The last pixels of the largest image are gathered and cleared", "[film]") {
    require_all_pass(check_largest_film());
}

TEST_CASE("Scenes share the program of the film", "[film]") {
    const ScratchFolder folder;
    const auto programs = [&] {
        size_t count = 0;
        for (const auto &entry : std::filesystem::directory_iterator(folder / "cache"))
            count += entry.path().extension() == ".kernels";
        return count;
    };
    std::filesystem::create_directory(folder / "cache");
    std::vector<size_t> counts;
    // furnace has a wide filter, which draws by the sampler: a special kernel's film has it compiled in.
    for (const char *scene : {"cbox_mis.xml --specialise on", "cbox_nee.xml --specialise on --sampler sobol",
                              "furnace.xml --specialise on --sampler sobol", "cbox_mis.xml --specialise off",
                              "furnace.xml --specialise off"}) {
        const Outcome outcome = run_shell("POCL_CACHE_DIR=" + (folder / "cache").string() +
                                          " " OPAL_BINARY " render " OPAL_SOURCE_DIR "/scenes/" + scene +
                                          " --width 8 --height 8 --spp 1 --no-png -o " + (folder / "out.exr").string());
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        counts.push_back(programs());
    }
    CAPTURE(counts);
    if (counts[0] > 0) // another driver keeps none there
        CHECK(counts == std::vector<size_t>{2, 3, 5, 6, 6});
}

// Grey samples of noise around a radiance of 1, count(p) of them in pixel p.
TEST_CASE("The error of a film whose pixels differ in their counts is that of its noise", "[film]") {
    constexpr int pixels = 1000, films = 200;
    const auto count = [](int p) { return p % 5 == 0 ? 10u : 1u; }; // a second pass that was stopped after a fifth
    std::mt19937 random(test_seed(41));
    std::normal_distribution<double> noise(0, 0.5);
    stats::Moments means, errors;
    for (int i = 0; i < films; i++) {
        Film film{pixels, 1, {}, {}, {}, {}, 0, {}};
        for (int p = 0; p < pixels; p++) {
            double sum = 0, squares = 0;
            for (unsigned s = 0; s < count(p); s++) {
                const double x = 1 + noise(random);
                sum += x;
                squares += x * x;
            }
            film.sum.push_back({sum, sum, sum});
            film.squares.push_back({squares, squares, squares, squares});
            film.count.push_back(count(p));
        }
        const FilmStatistics s = statistics_of(film);
        CHECK(s.empty_pixels == 0);
        CHECK(s.single_sample_pixels == pixels / 5 * 4);
        means.add(s.mean_luminance);
        errors.add(s.stderr_luminance);
    }
    CHECK(errors.mean() == Approx(std::sqrt(means.sample().variance)).epsilon(0.2)); // of 200 films: 5 %
}

TEST_CASE("Invalid samples are counted, placed and left out of the mean", "[film]") {
    const SceneDescription scene = with_strategy(
        furnace(0.5, 1), {{"lighting", "bsdf"}, {"hemisphere", "cosine"}, {"rr", "off"}, {"max-depth", "3"}});
    for (const char *what : {"NAN", "INFINITY", "-INFINITY"}) {
        INFO(what);
        const Sources sources = mutated(Sources::embedded(), spoiled(what));
        RenderSetup setup;
        setup.sources = &sources;
        setup.max_pass_samples = 1;
        const Film film = render(scene, 4, 1, setup);
        size_t spoiled_pixels = 0;
        for (size_t p = 0; p < film.count.size(); p++) {
            CHECK(film.count[p] == (p % 11 == 5 ? 0u : 4u));
            spoiled_pixels += p % 11 == 5;
        }
        CHECK(film.invalid == 4 * spoiled_pixels);
        REQUIRE(film.invalid_places.size() == 8);
        for (const InvalidSample &place : film.invalid_places)
            CHECK((place.y * unsigned(film.width) + place.x) % 11 == 5);
        CHECK(statistics_of(film).invalid == film.invalid);
        CHECK(statistics_of(film).empty_pixels == spoiled_pixels);
        CHECK(statistics_of(film).mean_luminance == Approx(1.75).epsilon(1e-6));
        const Image image = image_of(film, true);
        for (const Layer &layer : image.layers)
            for (float value : layer.values)
                CHECK(std::isfinite(value));
    }
}

TEST_CASE("What a BSDF or a light makes of no number ends the path and is counted", "[film]") {
    const Mutant weight{"weight", "bsdfs/diffuse.cl", "return bsdf_sample_of(wo, reflected,",
                        "return bsdf_sample_of(wo, v3_of((real)(NAN), b.albedo.y, b.albedo.z),"};
    const Mutant light{"light", "bsdfs/diffuse.cl", "return v3_scale(b.albedo, above ? (real)(INV_PI) : (real)(0));",
                       "return v3_of((real)(NAN), b.albedo.y, b.albedo.z);"};
    for (const auto &[mutant, lighting] : {std::pair{weight, "bsdf"}, std::pair{light, "emitter"}})
        for (const char *math : {"precise", "fast"}) {
            INFO(mutant.name << ", " << math);
            const SceneDescription scene = with_strategy(
                furnace(0.5, 1), {{"lighting", lighting}, {"rr", "off"}, {"max-depth", "2"}, {"math", math}});
            const Sources sources = mutated(Sources::embedded(), mutant);
            RenderSetup setup;
            setup.sources = &sources;
            const Film film = render(scene, 4, 1, setup);
            const size_t samples = 4 * film.count.size();
            CHECK(film.invalid <= samples);
            CHECK(film.invalid >=
                  (mutant.name == "weight" ? samples : samples / 2)); // some points on the light are behind the surface
        }
}

TEST_CASE("The binary tells of invalid samples, in words and in the JSON", "[film]") {
    const ScratchFolder folder;
    for (const auto &[name, text] : mutated(Sources::embedded(), spoiled("NAN")).files)
        folder.write("cl/" + name, text);
    const std::string json = folder / "statistics.json";
    const Outcome outcome =
        run_shell(std::string(OPAL_BINARY) +
                  " render " OPAL_SOURCE_DIR "/scenes/furnace.xml --width 8 --height 8 --spp 1 --no-png -o " +
                  std::string(folder / "out.exr") + " --json " + json + " --cl-dir " + std::string(folder / "cl"));
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.err,
               Catch::Contains("6 samples were NaN or infinite") && Catch::Contains("pixel (5, 0) sample 0"));
    const nlohmann::json report = nlohmann::json::parse(read_text(json));
    CHECK(report["invalid_samples"] == 6);
    CHECK(report["invalid_places"].size() == 6);
    CHECK(report["empty_pixels"] == 6);
    CHECK(report["stderr_luminance"].is_null());
    CHECK(report["warnings"].size() == 2);
    CHECK_THAT(outcome.err, Catch::Contains("6 of 64 pixels (9.38 %) have no valid sample"));
    CHECK(std::isfinite(report["mean_luminance"].get<double>()));
}

TEST_CASE("An image that is NaN is written and told, in the EXR and the JSON, and the exit code is 1", "[film]") {
    const ScratchFolder folder;
    const auto scene = [&](const std::string &radiance) {
        return folder
            .write("scene.xml", "<scene><integrator type='path_mis'/><camera type='perspective'><integer name='width' "
                                "value='4'/><integer name='height' value='4'/></camera><mesh type='parallelogram'>"
                                "<point name='origin' value='-9 -9 5'/><vector name='u' value='0 18 0'/><vector "
                                "name='v' value='18 0 0'/><emitter type='area'><color name='radiance' value='" +
                                    radiance + "'/></emitter></mesh></scene>")
            .string();
    };
    const std::string in = "cd " + folder.path().string() + " && " OPAL_BINARY " render ";
    const std::string message = "16 pixels of the image are NaN or infinite";
    const Outcome outcome = run_shell(in + scene("1e38 1e38 1e38") + " --spp 64 -o out.exr --json out.json");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::Contains("warning: " + message));
    const nlohmann::json report = nlohmann::json::parse(read_text(folder / "out.json"));
    CHECK(report["invalid_pixels"] == 16);
    CHECK(report["samples_lost"] == false);
    CHECK_THAT(report["warnings"].dump(), Catch::Contains(message));
    const Image image = read_exr(folder / "out.exr");
    CHECK(image.number("opal.invalid_pixels") == 16);
    CHECK_THAT(image.text("opal.warnings"), Catch::Contains(message));
    CHECK(image.text("opal.scene_hash") == report["scene_hash"]);
    CHECK(std::filesystem::exists(folder / "out.png"));
    // One such scene of several fails, and the others are rendered.
    folder.write("good.xml", read_text(scene("1 1 1")));
    const std::string bad = scene("1e38 1e38 1e38");
    const Outcome several = run_shell(in + bad + " good.xml --spp 64 -o all/");
    CHECK(several.exit_code == 1);
    CHECK_THAT(several.err, Catch::Contains("1 of 2 scenes failed: "));
    CHECK(std::filesystem::exists(folder / "all/good.exr"));
    // The other way to lose all samples: an image that is black, of samples that are not.
    const auto black = [](std::array<double, 3> mean, unsigned long long samples, unsigned long long invalid) {
        FilmStatistics s;
        s.mean_rgb = mean;
        s.samples = samples;
        s.invalid = invalid;
        Image dark{1, 1, {{"R", {0}}, {"G", {0}}, {"B", {0}}}, {}};
        return find_fault(dark, s).samples_lost;
    };
    CHECK(black({0, 1e-3, 0}, 4, 0));
    CHECK(black({0, 0, 0}, 0, 4)); // none is finite
    CHECK_FALSE(black({0, 0, 0}, 4, 0));
    CHECK_FALSE(black({0, 0, 0}, 0, 0));
    const Outcome good = run_shell(in + scene("1 1 1") + " --spp 4 -o other.exr");
    CHECK(good.exit_code == 0);
    const Outcome compared =
        run_shell("cd " + folder.path().string() + " && " OPAL_BINARY " compare other.exr all/good.exr");
    CHECK(compared.err.find("different scene files") == std::string::npos);
    CHECK_THAT(run_shell("cd " + folder.path().string() + " && " OPAL_BINARY " compare other.exr out.exr").err,
               Catch::Contains("note: other.exr and out.exr are of different scene files"));
}
