// `opal compare` as its users meet it.
#include "image/image.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

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

TEST_CASE("What cannot be compared is refused with what differs", "[compare]") {
    const ImageFolder folder;
    folder.put("a.exr", noisy(1, 1));
    folder.put(
        "small.exr",
        Image{8, 4, {{"R", std::vector<float>(32)}, {"G", std::vector<float>(32)}, {"B", std::vector<float>(32)}}, {}});
    Image more = noisy(1, 1);
    more.layers.push_back({"depth", std::vector<float>(32 * 24)});
    folder.put("more.exr", more);
    const auto refused = [&](const std::string &arguments, const std::string &reason) {
        const Outcome outcome = folder.compare(arguments);
        INFO(arguments << "\n" << outcome.err);
        CHECK(outcome.exit_code == 1);
        CHECK_THAT(outcome.err, Catch::Contains(reason));
    };
    refused("a.exr small.exr", "the sizes differ: a.exr has 32 x 24 pixels, small.exr has 8 x 4");
    refused("a.exr more.exr", "the layers differ: a.exr has no depth, which more.exr holds");
    refused("more.exr a.exr", "the layers differ: a.exr has no depth, which more.exr holds");
    refused("a.exr none.exr", "none.exr");
    refused("a.exr a.exr -o d.png", "names the EXR file");
    refused("a.exr a.exr -o none/d.exr", "there is no folder none");
}
