// `opal compare` as its users meet it.
#include "base/exit_code.h"
#include "base/json.h"
#include "image/image.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <random>

using namespace opal;
using namespace opal::test;

namespace {

// A noisy estimate of `mean`, 32 x 24, with variance layers, as opal render writes it.
Image noisy(double mean, unsigned seed, double samples = 16) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, 0.1);
    Image image{32, 24, {}, {{"opal.spp", fmt::format("{}", samples)}}};
    for (const char *name : {"R", "G", "B"}) {
        Layer layer{name, {}};
        for (int i = 0; i < 32 * 24; i++)
            layer.values.push_back(float(mean + noise(random)));
        image.layers.push_back(layer);
    }
    for (const char *name : {"R", "G", "B"})
        image.layers.push_back({std::string("variance.") + name, std::vector<float>(32 * 24, 0.01f)});
    return image;
}

struct ImageFolder {
    ScratchFolder scratch;
    std::string put(const std::string &name, const Image &image) const {
        write_exr(image, scratch / name);
        return name;
    }
    Outcome compare(const std::string &arguments) const {
        return run_shell("cd " + scratch.path().string() + " && " + OPAL_BINARY + " compare " + arguments);
    }
    nlohmann::json json(const std::string &arguments) const {
        const Outcome outcome = compare(arguments + " --json out.json");
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        return nlohmann::json::parse(read_text(scratch / "out.json"));
    }
};

} // namespace

TEST_CASE("Two images of one mean pass, and the figures are those of their noise", "[compare]") {
    const ImageFolder folder;
    folder.put("a.exr", noisy(1, 1));
    folder.put("b.exr", noisy(1, 2));
    const auto report = folder.json("a.exr b.exr -o d.exr");
    CHECK(report["mse"].get<double>() == Approx(0.02).epsilon(0.15)); // two noises of variance 0.01, 2304 values
    CHECK(report["rmse"].get<double>() == Approx(std::sqrt(report["mse"].get<double>())));
    CHECK(report["rel_mse_floor"].get<double>() == Approx(1e-4).epsilon(0.02));
    CHECK_FALSE(report["test"]["differ"].get<bool>());
    const Image map = read_exr(folder.scratch / "d.exr");
    CHECK(map.get("R").values[5] ==
          Approx(noisy(1, 1).get("R").values[5] - noisy(1, 2).get("R").values[5]).margin(1e-6));
    CHECK(map.find("z.G"));
    CHECK(std::filesystem::exists(folder.scratch / "d.png"));
}

TEST_CASE("A bright patch is found, with its place", "[compare]") {
    const ImageFolder folder;
    Image bright = noisy(1, 1);
    for (int y = 8; y < 16; y++)
        for (int x = 16; x < 32; x++)
            bright.layers[1].values[size_t(y * 32 + x)] += 0.1f;
    folder.put("a.exr", bright);
    folder.put("b.exr", noisy(1, 2));
    const auto region = folder.json("a.exr b.exr");
    REQUIRE(region["test"]["differ"].get<bool>());
    CHECK(region["test"]["region"]["channel"] == "G");
    CHECK(region["test"]["region"]["x"] == 16);
    CHECK(region["test"]["region"]["y"] == 8);
    CHECK(region["test"]["region"]["tiles"] == 2);
    CHECK(region["test"]["region"]["mean_image"].get<double>() >
          region["test"]["region"]["mean_reference"].get<double>());
}

TEST_CASE("An image without variance is compared, and the missing test is told", "[compare]") {
    const ImageFolder folder;
    Image plain = noisy(1, 1);
    plain.layers.resize(3);
    folder.put("plain.exr", plain);
    folder.put("b.exr", noisy(1, 2));
    folder.put("single.exr", noisy(1, 3, 1));
    CHECK(folder.json("b.exr plain.exr")["untested"].get<std::string>().find("plain.exr holds no layer variance.R") ==
          0);
    CHECK(folder.json("single.exr b.exr")["untested"] == "single.exr has one sample a pixel and so no variance");
    Image uneven = noisy(1, 4); // as a stopped render has it
    uneven.metadata["opal.single_sample_pixels"] = "7";
    folder.put("uneven.exr", uneven);
    CHECK(folder.json("b.exr uneven.exr")["untested"] == "uneven.exr has 7 pixels with one sample and so no variance");
    CHECK_FALSE(folder.json("plain.exr b.exr").contains("test"));
    CHECK(folder.json("plain.exr plain.exr")["psnr_db"].is_null()); // equal: infinite
}

TEST_CASE("A layer or an alpha more is noted, and the figures are those of R, G, B", "[compare]") {
    const ImageFolder folder;
    Image more = noisy(1, 1);
    for (const char *name : {"depth", "A"})
        more.layers.push_back({name, std::vector<float>(32 * 24)});
    folder.put("a.exr", noisy(1, 2));
    folder.put("b.exr", noisy(1, 1));
    folder.put("more.exr", more);
    const Outcome outcome = folder.compare("a.exr more.exr");
    CHECK(outcome.exit_code == 0);
    CHECK_THAT(outcome.err, Catch::Contains("note: more.exr: holds A, depth, which is left out"));
    CHECK(outcome.out == folder.compare("a.exr b.exr").out);
    CHECK(folder.compare("more.exr a.exr").exit_code == 0);
}

TEST_CASE("Luminance alone is held against the other's luminance, and XYZ against RGB", "[compare]") {
    const ImageFolder folder;
    Image color = noisy(1, 1), grey{32, 24, {{"Y", {}}}, {}}, xyz{32, 24, {{"X", {}}, {"Y", {}}, {"Z", {}}}, {}};
    for (size_t i = 0; i < 32 * 24; i++) {
        const float r = color.layers[0].values[i], g = color.layers[1].values[i] *= 2, b = color.layers[2].values[i];
        grey.layers[0].values.push_back(0.212671f * r + 0.715160f * g + 0.072169f * b);
        xyz.layers[0].values.push_back(0.412453f * r + 0.357580f * g + 0.180423f * b);
        xyz.layers[1].values.push_back(grey.layers[0].values.back());
        xyz.layers[2].values.push_back(0.019334f * r + 0.119193f * g + 0.950227f * b);
    }
    folder.put("color.exr", color);
    folder.put("grey.exr", grey);
    folder.put("xyz.exr", xyz);
    for (const auto &[pair, compared, untested] :
         {std::tuple{"color.exr grey.exr", "luminance", "share luminance alone"},
          {"grey.exr color.exr", "luminance", "share luminance alone"},
          {"xyz.exr grey.exr", "luminance", "share luminance alone"},
          {"grey.exr grey.exr", "luminance", "grey.exr holds no layer variance.R"},
          {"color.exr xyz.exr", "R, G, B", "xyz.exr holds no layer variance.R"}}) {
        INFO(pair);
        const auto report = folder.json(pair);
        CHECK(report["compared"] == compared);
        CHECK(report["max_difference"].get<double>() < 1e-5);
        CHECK_THAT(report["untested"].get<std::string>(), Catch::Contains(untested));
    }
    CHECK_THAT(folder.compare("color.exr grey.exr").out, Catch::StartsWith("Compared: luminance\n"));
    CHECK_THAT(folder.compare("color.exr color.exr").out, Catch::StartsWith("Compared: R, G, B\n"));
}

TEST_CASE("Pixels that are not finite never pass for equal", "[compare]") {
    const ImageFolder folder;
    Image broken = noisy(1, 1), rough = noisy(1, 1);
    broken.layers[1].values[5 * 32 + 7] = NAN;
    broken.layers[2].values[9 * 32 + 7] = INFINITY;
    rough.layers[4].values[3] = NAN; // of a variance
    folder.put("a.exr", noisy(1, 1));
    folder.put("broken.exr", broken);
    folder.put("rough.exr", rough);
    for (const char *pair : {"a.exr broken.exr", "broken.exr a.exr", "broken.exr broken.exr"}) {
        const Outcome outcome = folder.compare(std::string(pair) + " --json out.json");
        INFO(pair << outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err,
                   Catch::Contains("error: broken.exr: 2 pixels are NaN or infinite, the first at (7, 5)"));
        const auto report = nlohmann::json::parse(read_text(folder.scratch / "out.json"));
        CHECK(report["invalid_pixels"] == 2);
        CHECK(report["untested"] == "broken.exr has pixels in B that are NaN or infinite");
    }
    CHECK(folder.json("a.exr rough.exr")["untested"] == "rough.exr has pixels in variance.G that are NaN or infinite");
}

TEST_CASE("A relMSE above the limit of --fail exits with 3", "[compare]") {
    const ImageFolder folder;
    folder.put("a.exr", noisy(1, 1));
    folder.put("b.exr", noisy(1, 2));
    Image broken = noisy(1, 1);
    broken.layers[1].values[5] = NAN;
    folder.put("broken.exr", broken);
    Image black = noisy(1, 1);
    for (size_t c = 0; c < 3; c++)
        std::ranges::fill(black.layers[c].values, 0.f);
    folder.put("black.exr", black);
    const double rel_mse = folder.json("a.exr b.exr")["rel_mse"];
    for (const auto &[pair, limit, code] : {std::tuple{"a.exr b.exr", 0.99 * rel_mse, exit_check_failed},
                                            {"a.exr b.exr", 1.01 * rel_mse, exit_done},
                                            {"a.exr b.exr", 0.0, exit_check_failed},
                                            {"a.exr a.exr", 0.0, exit_done},
                                            {"a.exr black.exr", 1e6, exit_check_failed},
                                            {"black.exr black.exr", 0.0, exit_done},
                                            {"broken.exr a.exr", 1e6, exit_failed}}) {
        const Outcome outcome = folder.compare(fmt::format("{} --fail {} --quiet --json out.json", pair, limit));
        INFO(pair << " " << limit << "\n" << outcome.out << outcome.err);
        CHECK(outcome.exit_code == code);
        const auto report = nlohmann::json::parse(read_text(folder.scratch / "out.json"));
        CHECK(report["limit"] == limit);
        CHECK(report["within_limit"] == (code == exit_done));
        if (code != exit_failed)
            CHECK_THAT(outcome.out,
                       Catch::Contains(code == exit_done ? "is within the limit" : "is not within the limit"));
    }
    CHECK(folder.compare("a.exr b.exr --fail -1").exit_code == exit_usage);
}

TEST_CASE("A crop is held against its part of the whole image", "[compare]") {
    const ImageFolder folder;
    Image whole = noisy(1, 1), changed = whole;
    changed.layers[0].values[13 * 32 + 17] += 1;
    folder.put("whole.exr", whole);
    folder.put("part.exr", cropped(changed, {16, 10, 12, 8, 32, 24}));
    for (const char *pair : {"whole.exr part.exr", "part.exr whole.exr"}) {
        const auto report = folder.json(pair);
        CHECK(report["mae"].get<double>() == Approx(1.0 / (12 * 8 * 3)));
        CHECK(report["max_x"] == 17);
        CHECK(report["max_y"] == 13);
    }
}

TEST_CASE("What cannot be compared is refused with what differs", "[compare]") {
    const ImageFolder folder;
    folder.put("a.exr", noisy(1, 1));
    folder.put(
        "small.exr",
        Image{8, 4, {{"R", std::vector<float>(32)}, {"G", std::vector<float>(32)}, {"B", std::vector<float>(32)}}, {}});
    const auto refused = [&](const std::string &arguments, const std::string &reason) {
        const Outcome outcome = folder.compare(arguments);
        INFO(arguments << "\n" << outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains(reason));
    };
    refused("a.exr small.exr", "the sizes differ: a.exr has 32 x 24 pixels, small.exr has 8 x 4");
    Image no_green = noisy(1, 1);
    no_green.layers.erase(no_green.layers.begin() + 1);
    folder.put("no_green.exr", no_green);
    refused("a.exr no_green.exr", "no_green.exr: has no layer G, which is compared; it holds B, R");
    folder.put("depth.exr", Image{32, 24, {{"dd.y.T", std::vector<float>(32 * 24)}}, {}});
    refused("a.exr depth.exr", "depth.exr: has no layer R, which is compared; it holds dd.y.T");
    Image part = noisy(1, 1), other = noisy(1, 1);
    part.crop = {0, 0, 32, 24, 40, 24};
    other.crop = {8, 0, 32, 24, 40, 24};
    folder.put("part.exr", part);
    folder.put("other.exr", other);
    refused("part.exr other.exr", "the windows differ: part.exr has 32 x 24 at (0, 0) of 40 x 24 pixels, other.exr has "
                                  "32 x 24 at (8, 0) of 40 x 24");
    refused("a.exr part.exr", "the sizes differ: a.exr has 32 x 24 pixels, part.exr has 32 x 24 at (0, 0) of 40 x 24");
    refused("a.exr none.exr", "none.exr");
    refused("a.exr a.exr -o d.png", "names the EXR file");
    refused("a.exr a.exr -o none/d.exr", "there is no folder none");
}
