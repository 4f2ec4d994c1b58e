// The figures and the page of a sweep, from replicates whose truth is known.
#include "base/base64.h"
#include "base/error.h"
#include "base/json.h"
#include "support/error_of.h"
#include "support/scratch.h"
#include "sweep/auto.h"
#include "sweep/convergence_plot.h"
#include "sweep/lock.h"
#include "sweep/page.h"
#include "sweep/reference.h"

#include <catch2/catch.hpp>

#include <functional>
#include <random>

#include <unistd.h>

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

TEST_CASE("The plot leaves out points of infinite or no time or error", "[sweep_page]") {
    StrategyRecord record;
    StrategySummary strategy;
    strategy.record = &record;
    const stats::Interval error{0.1, 0.05, 0.2};
    for (const double seconds : {1.0, 4.0, 0.0, double(INFINITY)})
        strategy.points.push_back({4, 2, seconds, error, error});
    strategy.points.push_back({4, 2, 1, error, {INFINITY, 0, INFINITY}});
    const std::string svg = convergence_plot({{strategy}, 0});
    size_t circles = 0;
    for (size_t at = svg.find("<title>"); at != svg.npos; at = svg.find("<title>", at + 1))
        circles++;
    CHECK(circles == 2);
    CHECK(svg.find("inf") == svg.npos);
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

namespace {

// A record that a sweep could have written.
SweepRecord whole_record() {
    SweepRecord record = record_of();
    record.clock = "kernel";
    record.kernel = "special";
    record.width = record.height = 4;
    record.replicates = 2;
    record.spp = {4, 16};
    record.seed = 7;
    record.definitions = {{"a", "1"}};
    record.options = {{"max-depth", "5"}};
    for (StrategyRecord &s : record.strategies) {
        s.points.resize(2);
        for (SweepPoint &point : s.points) {
            point.replicates.resize(2);
            for (unsigned i = 0; i < 2; i++)
                point.replicates[i].seed = 8 + i;
        }
        s.shot = {4, 1, 0.5, "equal_time_" + std::to_string(&s - record.strategies.data() + 1)};
    }
    return record;
}

} // namespace

TEST_CASE("A sweep.json with anything in it is refused with the key, or can be summed up", "[sweep_page]") {
    const ScratchFolder folder;
    save(whole_record(), folder.path());
    const nlohmann::json whole = nlohmann::json::parse(test::read_text(folder / "sweep.json"));
    size_t refused = 0, taken = 0;
    const auto try_text = [&](const std::string &text, const std::string &key) {
        folder.write("sweep.json", text);
        INFO(key << " " << text.substr(0, 2000));
        try {
            const SweepRecord record = load_record(folder.path());
            const SweepSummary summary = summarise(record);
            csv(summary);
            convergence_plot(summary);
            if (!summary.strategies.empty())
                html_page(record, summary, folder.path());
            taken++;
        } catch (const Error &error) {
            refused++;
            CHECK_THAT(error.what(),
                       Catch::StartsWith((folder / "sweep.json").string() + ": is no sweep that could be continued: "));
        }
    };
    try_text(whole.dump(), "whole");
    REQUIRE(taken == 1);
    const std::string text = whole.dump();
    for (size_t end = 0; end < text.size(); end += 13)
        try_text(text.substr(0, end), "cut");
    CHECK(refused == (text.size() + 12) / 13);
    const nlohmann::json::object_t empty;
    const std::vector<nlohmann::json> strange = {nullptr,
                                                 true,
                                                 "text",
                                                 -1,
                                                 0,
                                                 2.5,
                                                 1e300,
                                                 -1e300,
                                                 4294967295u,
                                                 1ull << 40,
                                                 1ull << 63,
                                                 empty,
                                                 nlohmann::json::array(),
                                                 {1, "a"}};
    const std::function<void(const nlohmann::json::json_pointer &)> mutate =
        [&](const nlohmann::json::json_pointer &at) {
            const nlohmann::json &value = whole[at];
            if (!at.empty()) {
                for (const nlohmann::json &other : strange) {
                    nlohmann::json changed = whole;
                    changed[at] = other;
                    try_text(changed.dump(), at.to_string());
                }
                nlohmann::json changed = whole;
                nlohmann::json &parent = changed[at.parent_pointer()];
                if (parent.is_object())
                    parent.erase(at.back());
                else
                    parent.erase(std::stoul(at.back()));
                try_text(changed.dump(), at.to_string() + " erased");
            }
            if (value.is_object())
                for (const auto &[name, inner] : value.items())
                    mutate(at / name);
            if (value.is_array())
                for (size_t i = 0; i < value.size(); i++)
                    mutate(at / i);
        };
    mutate(nlohmann::json::json_pointer());
    CHECK(refused > 1000);
    CHECK(taken > 100);

    const auto reason = [&](const std::string &at, const nlohmann::json &value) {
        nlohmann::json changed = whole;
        changed[nlohmann::json::json_pointer(at)] = value;
        folder.write("sweep.json", changed.dump());
        return test::error_of([&] { load_record(folder.path()); });
    };
    CHECK_THAT(reason("/strategies/1/points/0/replicates/1/seed", 8),
               Catch::Contains("strategies[1].points[0].replicates[1].seed is 8, not 9"));
    CHECK_THAT(reason("/strategies/0/points/0/replicates/1/seconds", -1),
               Catch::Contains("strategies[0].points[0].replicates[1].seconds is below 0"));
    CHECK_THAT(reason("/strategies/0/points/0/replicates/1/mse", nullptr),
               Catch::Contains("strategies[0].points[0].replicates[1].mse is no number"));
    CHECK_THAT(reason("/strategies/0/shot/file", "../secret"), Catch::Contains("strategies[0].shot.file is not "));
    CHECK_THAT(reason("/replicates", -2), Catch::Contains("replicates is no whole number from 0"));
    CHECK_THAT(reason("/spp", {16, 4}), Catch::Contains("spp is no rising list"));
    // A point without replicates, of a sweep that was stopped, is measured again.
    CHECK(reason("/strategies/0/points/1/replicates", nlohmann::json::array()).empty());
    CHECK(load_record(folder.path()).strategies[0].points.size() == 1);
}

TEST_CASE("A folder's lock is held by one at a time, and ends with its holder", "[sweep_page]") {
    const ScratchFolder folder;
    {
        const FolderLock lock(folder.path());
        CHECK_THAT(test::error_of([&] { FolderLock other(folder.path()); }),
                   Catch::StartsWith(folder.path().string() + ": another sweep (process " + std::to_string(getpid()) +
                                     ") writes there"));
    }
    const FolderLock again(folder.path());
    const ScratchFolder linked;
    std::filesystem::create_symlink(linked / "victim", linked / ".sweep.lock");
    CHECK_THAT(test::error_of([&] { FolderLock other(linked.path()); }), Catch::Contains("cannot write"));
    CHECK_FALSE(std::filesystem::exists(linked / "victim"));
}

TEST_CASE("Base64 as RFC 4648 has it", "[sweep_page]") {
    CHECK(base64("") == "");
    CHECK(base64("f") == "Zg==");
    CHECK(base64("fo") == "Zm8=");
    CHECK(base64("foobar") == "Zm9vYmFy");
    CHECK(base64("\xff\xfe\xfd") == "//79");
}
