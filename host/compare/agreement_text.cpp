// An Agreement as text and as JSON.
#include "base/json.h"
#include "compare/agreement.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

std::string p_text(double p) { return p >= 0.01 ? fmt::format("{:.2f}", p) : fmt::format("{:.0e}", p); }

std::string matrix_of(const Agreement &agreement, size_t count) {
    std::string text = "     ";
    for (size_t b = 0; b + 1 < count; b++)
        text += fmt::format("{:>8}", b + 1);
    text += "\n";
    for (size_t row = 1; row < count; row++) {
        text += fmt::format("{:>5}", row + 1);
        for (const PairTest &pair : agreement.pairs) // a < b: those of a row come in the order of its columns
            if (pair.b == row)
                text += fmt::format(" {:>6}{}", p_text(pair.test.p_value), agreement.is_rejected(pair) ? "X" : " ");
        text += "\n";
    }
    return text;
}

std::string percent(double x) { return fmt::format("{:.2g} %", 100 * x); }

std::string power_text(const Agreement &a, const std::vector<StrategyRender> &renders) {
    const auto [least, most] = std::minmax_element(a.detectable.begin(), a.detectable.end());
    return fmt::format(
        "Power: with {:g} % probability this would have found a bias of the image's mean of {} in any one strategy "
        "({} in the one that is seen best; the noisiest is {})",
        100 * a.power, percent(*most), percent(*least), renders[size_t(most - a.detectable.begin())].how.name);
}

} // namespace

std::string text_of(const Agreement &agreement, const std::vector<StrategyRender> &renders) {
    std::string text;
    for (size_t i = 0; i < renders.size(); i++)
        text += fmt::format("{:>5}  {:<8.4g} spp  finds {:<8} {}{}\n", i + 1, renders[i].samples,
                            percent(agreement.detectable[i]), renders[i].how.name,
                            renders[i].invalid ? fmt::format("  {} SAMPLES NaN OR INFINITE", renders[i].invalid) : "");
    text +=
        fmt::format("p that both have one mean (Welch per tile and whole image, Sidak over these; X: below {:.2g})\n{}",
                    agreement.pair_level, matrix_of(agreement, renders.size()));
    if (agreement.rejected) {
        const PairTest &worst = agreement.worst();
        text +=
            fmt::format("DISAGREE: {} of {} pairs, p = {} for all (Sidak), level {:g}\n{}\nworst pair {} and {}: {}\n",
                        agreement.rejected, agreement.pairs.size(), p_text(agreement.p_value), agreement.significance,
                        agreement.suspect, worst.a + 1, worst.b + 1, describe(worst.test));
    } else
        text += fmt::format("All {} strategies agree: p = {} for all {} pairs (Sidak), level {:g}\n", renders.size(),
                            p_text(agreement.p_value), agreement.pairs.size(), agreement.significance);
    if (agreement.invalid)
        text += fmt::format("FAILED: {} samples were NaN or infinite\n", agreement.invalid);
    return text + power_text(agreement, renders) + "\n";
}

nlohmann::json json_of(const Agreement &agreement, const std::vector<StrategyRender> &renders) {
    nlohmann::json j = {
        {"agree", agreement.holds()},
        {"p_value", agreement.p_value},
        {"significance", agreement.significance},
        {"pair_level", agreement.pair_level},
        {"rejected_pairs", agreement.rejected},
        {"suspect", agreement.suspect},
        {"invalid_samples", agreement.invalid},
        {"power", agreement.power},
        {"detectable_bias", *std::max_element(agreement.detectable.begin(), agreement.detectable.end())}};
    for (size_t i = 0; i < renders.size(); i++)
        j["strategies"].push_back(object({{"name", renders[i].how.name},
                                          {"spp", renders[i].samples},
                                          {"seconds", renders[i].seconds},
                                          {"invalid_samples", renders[i].invalid},
                                          {"detectable_bias", agreement.detectable[i]}}));
    for (const PairTest &pair : agreement.pairs)
        j["pairs"].push_back(object({{"a", pair.a},
                                     {"b", pair.b},
                                     {"p_value", pair.test.p_value},
                                     {"worst_z", pair.test.worst_z},
                                     {"disagrees", agreement.is_rejected(pair)},
                                     {"detectable_bias", pair.detectable}}));
    return j;
}

} // namespace opal
