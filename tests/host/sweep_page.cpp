// The figures and the page of a sweep, from replicates whose truth is known.
#include "base/base64.h"
#include "support/scratch.h"
#include "sweep/auto.h"
#include "sweep/convergence_plot.h"
#include "sweep/page.h"
#include "sweep/reference.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <random>

using namespace opal;
using opal::test::ScratchFolder;

namespace {

// MSE = scale / spp and seconds = spp, both with 1 % of noise.
StrategyRecord strategy_of(const std::string &label, double scale, unsigned seed) {
    std::mt19937 engine(seed);
    std::normal_distribution<double> noise(1, 0.01);
    StrategyRecord s;
    s.name = s.label = label;
    for (unsigned spp : {4u, 16u, 64u}) {
        s.points.push_back({spp, {}});
        for (unsigned r = 0; r < 6; r++)
            s.points.back().replicates.push_back({r, spp * noise(engine), scale / spp * noise(engine),
                                                  2 * scale / spp * noise(engine), 1 + 0.01 * (noise(engine) - 1)});
    }
    return s;
}

SweepRecord record_of() {
    SweepRecord record;
    record.scene = "a<b>.xml";
    record.devices = {{0, "a device", "1.0"}};
    record.reference = {"lighting=mis", 1000, 1, 1, 1e-5, true};
    record.strategies = {strategy_of("slow & steady", 8, 1), strategy_of("quick", 2, 2)};
    return record;
}

} // namespace

TEST_CASE("Slope, cost, ratios and bias of replicates whose truth is known", "[sweep_page]") {
    SweepRecord record = record_of();
    const SweepSummary summary = summarise(record);
    CHECK(summary.best == 1);
    const StrategySummary &slow = summary.strategies[0], &quick = summary.strategies[1];
    CHECK(slow.slope.estimate == Approx(-1).margin(0.02));
    CHECK(slow.slope.high - slow.slope.low < 0.1);
    CHECK(slow.ranking_time().estimate == Approx(1600).epsilon(0.05));
    CHECK(slow.relative_time.estimate == Approx(4).epsilon(0.05));
    CHECK(slow.relative_time.low < slow.relative_time.estimate);
    CHECK(quick.efficiency.estimate == Approx(4).epsilon(0.05));
    CHECK(quick.bias_p > 1e-3);
    for (Replicate &r : record.strategies[1].points.back().replicates)
        r.mean_luminance *= 1.02;
    CHECK(summarise(record).strategies[1].bias_p < 1e-6);
    CHECK_THAT(verdict(record, summarise(record)).back(),
               Catch::StartsWith("quick is biased: its mean luminance is +2"));
}

TEST_CASE("Seconds, ratio, ranking and verdict are one definition, where slopes differ", "[sweep_page]") {
    // At the most samples `even` has a tenth of the cost of `steep`. The error of `steep` falls as spp^-2, so that it
    // is first at relMSE 1e-2.
    SweepRecord record = record_of();
    record.strategies = {strategy_of("even", 8, 1), strategy_of("steep", 8, 2)};
    for (SweepPoint &p : record.strategies[1].points)
        for (Replicate &r : p.replicates)
            r.rel_mse *= 640. / p.spp, r.mse *= 640. / p.spp;
    record.strategies[1].independent = false;
    const SweepSummary summary = summarise(record);
    const StrategySummary &even = summary.strategies[0], &steep = summary.strategies[1];
    CHECK(summary.best == 1);
    CHECK(even.ranking_time().estimate == Approx(1600).epsilon(0.05));
    CHECK(steep.ranking_time().estimate == Approx(64 * std::sqrt(2.5 / 0.01)).epsilon(0.05)); // 1012
    CHECK(even.relative_time.estimate == even.ranking_time().estimate / steep.ranking_time().estimate);
    CHECK(steep.ranking_time().low < steep.ranking_time().estimate);
    CHECK(steep.ranking_time().high < INFINITY);
    CHECK(steep.relative_time.estimate == 1);
    CHECK(even.relative_time.low > 1);
    const std::vector<std::string> sentences = verdict(record, summary);
    CHECK_THAT(sentences[0], Catch::Contains("steep is the fastest"));
    CHECK_THAT(sentences[1], Catch::StartsWith("even needs 1") && Catch::Contains("1.60 times longer"));
}

TEST_CASE("auto says what a sweep says, in its words, and that pilots say it", "[sweep_page]") {
    const AutoChoice choice{{{"a", "MIS", 1, 512}, {"b", "uniform hemisphere", 2.938, 8}}, 0, {}};
    CHECK(choice.text() == "auto    MIS: the fastest to relMSE 1e-2, taken (by a pilot of 512 samples a pixel)\n"
                           "auto    uniform hemisphere: 2.94 times longer (by a pilot of 8 samples a pixel)\n"
                           "auto    pilots estimate these times; opal sweep measures them");
    CHECK(choice.json()["candidates"][1]["relative_time"] == 2.938);
}

TEST_CASE("auto's pilots and a sweep have one ratio where samples are independent", "[sweep_page]") {
    // In one pixel of mean 1, a sample has variance `scale` in 1 s; the sweep's points have relMSE scale / spp.
    const auto pilot = [](double scale) { return Pilot{64, 1, {1}, {scale}, true}; };
    const std::vector<double> costs = pilot_costs({pilot(6), pilot(18)});
    SweepRecord record;
    for (double scale : {3., 9.})
        record.strategies.push_back(strategy_of(std::to_string(scale), scale, unsigned(scale)));
    record.replicates = 6;
    const SweepSummary summary = summarise(record);
    CHECK(costs[1] / costs[0] == Approx(3));
    CHECK(summary.strategies[1].relative_time.estimate == Approx(3).epsilon(0.02));
    CHECK(costs[0] / ranking_level == Approx(summary.strategies[0].ranking_time().estimate).epsilon(0.02));
}

TEST_CASE("The page is one file whose text is escaped", "[sweep_page]") {
    const SweepRecord record = record_of();
    const ScratchFolder folder;
    folder.write("reference.png", "a picture");
    const std::string page = html_page(record, summarise(record), folder.path());
    CHECK_THAT(page, Catch::Contains("slow &amp; steady needs ") && Catch::Contains("quick is the fastest") &&
                         Catch::Contains("a&lt;b&gt;"));
    CHECK(page.find("<b>.xml") == std::string::npos);
    for (const char *outside : {"http", "src=\"/", "<link", "@import", ">nan", " nan", "-nan", ">inf", " inf "}) {
        const size_t found = page.find(outside);
        INFO(page.substr(std::max<size_t>(std::min(found, page.size()), 60) - 60, 120));
        CHECK(found == std::string::npos);
    }
}

TEST_CASE("A picture that cannot be read is no empty picture", "[sweep_page]") {
    const SweepRecord record = record_of();
    const ScratchFolder folder;
    std::filesystem::create_symlink("/proc/self/mem", folder / "reference.png"); // EIO
    CHECK_THROWS_WITH(html_page(record, summarise(record), folder.path()),
                      (folder / "reference.png").string() + ": cannot read: Input/output error");
}

TEST_CASE("An error map's inputs: the reference's variance is subtracted without bias", "[sweep_page]") {
    std::mt19937 engine(7);
    std::normal_distribution<float> noise(0, 0.1f);
    const auto image = [&](float scale) {
        Image i{200, 200, {}, {}};
        for (const char *channel : {"R", "G", "B"}) {
            i.layers.push_back({channel, std::vector<float>(40000)});
            for (float &v : i.layers.back().values)
                v = 1 + scale * noise(engine);
        }
        return i;
    };
    const Image reference = reference_from_halves(image(1), image(1)); // variance 0.005 of its mean
    CHECK(error_against(reference, image(1)).mse == Approx(0.01).epsilon(0.03));
    CHECK(error_against(reference, image(0)).mse == Approx(0).margin(2e-4));
    CHECK(mean_luminance(reference) == Approx(1).epsilon(1e-3));
}

TEST_CASE("Base64 as RFC 4648 has it", "[sweep_page]") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe\xfd") == "//79");
}
