// The evidence of two pictures that disagree, and that none is left where they agree.
#include "support/evidence.h"
#include "base/error.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdlib>
#include <random>

using namespace opal;
namespace fs = std::filesystem;

namespace {

constexpr int width = 24, height = 16;

// Independent estimates of a grey picture with `extra` added in the right third of the red channel.
Image noisy(unsigned seed, float extra) {
    std::mt19937 rng(seed);
    std::normal_distribution<float> noise(0, 0.1f);
    Image image{width, height, {}, {}};
    for (const char *name : {"R", "G", "B"}) {
        image.layers.push_back({name, {}});
        for (int i = 0; i < width * height; ++i)
            image.layers.back().values.push_back(0.5f + noise(rng) + (name[0] == 'R' && i % width >= 16 ? extra : 0));
    }
    for (const char *name : {"variance.R", "variance.G", "variance.B"})
        image.layers.push_back({name, std::vector<float>(width * height, 0.01f)});
    return image;
}

// Sets $OPAL_EVIDENCE as long as it lives.
struct EvidenceFolder {
    explicit EvidenceFolder(const fs::path &path) { setenv("OPAL_EVIDENCE", path.c_str(), 1); }
    ~EvidenceFolder() { unsetenv("OPAL_EVIDENCE"); }
};

} // namespace

TEST_CASE("Pictures that agree leave nothing, those that don't leave all", "[evidence]") {
    test::ScratchFolder scratch;
    EvidenceFolder evidence(scratch.path());
    CHECK(test::same_picture("agree", test::estimated(noisy(1, 0), 100), test::estimated(noisy(2, 0), 100), 0.001)
              .agrees);
    CHECK_FALSE(fs::exists(scratch / "agree"));

    Image image = noisy(3, 0.2f), reference = noisy(4, 0);
    test::Verdict verdict =
        test::same_picture("differ", test::estimated(image, 100), test::estimated(reference, 100), 0.001);
    CHECK_FALSE(verdict.agrees);
    CHECK(verdict.message.find((scratch / "differ").string()) != std::string::npos);
    CHECK(verdict.message.find("2 R tiles within x 16..23 y 0..15") != std::string::npos);
    for (const char *name : {"image", "reference", "difference", "z", "p"})
        for (const char *extension : {".exr", ".png"})
            CHECK(fs::file_size(scratch / "differ" / (std::string(name) + extension)) > 100);

    CHECK(read_exr(scratch / "differ" / "image.exr").get("variance.G").values == image.get("variance.G").values);
    Image z = read_exr(scratch / "differ" / "z.exr"), p = read_exr(scratch / "differ" / "p.exr");
    size_t tile = 2; // of the upper row, red
    CHECK(z.get("R").values[20] == float(verdict.test.z[tile]));
    CHECK(z.get("R").values[20] > 5);
    CHECK(std::abs(z.get("B").values[20]) < 5);
    CHECK(p.get("R").values[20] == float(verdict.test.p[tile]));
    Image d = read_exr(scratch / "differ" / "difference.exr");
    CHECK(d.get("R").values[7] == image.get("R").values[7] - reference.get("R").values[7]);
}

TEST_CASE("NaN and pictures without variance are no agreement", "[evidence]") {
    test::ScratchFolder scratch;
    EvidenceFolder evidence(scratch.path());
    Image bad = noisy(5, 0), bare = noisy(6, 0), small = noisy(6, 0);
    bad.layers[1].values[3] = NAN;
    CHECK_FALSE(test::same_picture("nan", test::estimated(bad, 100), test::estimated(noisy(6, 0), 100), 0.001).agrees);
    CHECK(fs::exists(scratch / "nan" / "z.png"));
    small.height = 8;
    for (Layer &layer : small.layers)
        layer.values.resize(8 * width);
    CHECK_FALSE(
        test::same_picture("size", test::estimated(small, 100), test::estimated(noisy(6, 0), 100), 0.001).agrees);
    CHECK(fs::exists(scratch / "size" / "reference.png"));
    bare.layers.resize(3);
    CHECK_THROWS_AS(estimate_of(bare, 100, 99), Error);
}

TEST_CASE("False colours", "[evidence]") {
    Image image = false_colour({0, 2, -9, 1, NAN}, 5, 1, 2);
    auto colour = [&](size_t i) {
        return std::vector<float>{image.get("R").values[i], image.get("G").values[i], image.get("B").values[i]};
    };
    CHECK(colour(0) == std::vector<float>{1, 1, 1});
    CHECK(colour(1) == std::vector<float>{1, 0, 0});
    CHECK(colour(2) == std::vector<float>{0, 0, 1});
    CHECK(colour(3) == std::vector<float>{1, 0.5f, 0.5f});
    CHECK(std::isnan(colour(4)[1])); // write_png paints it magenta
    CHECK(false_colour({0, 1}, 2, 1, 0).get("G").values == std::vector<float>{1, 0});
}
