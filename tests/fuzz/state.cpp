// State files: sweep.json, as a later run continues and shows it; and what a driver's probe prints about devices.
#include "base/error.h"
#include "base/json.h"
#include "base/read_file.h"
#include "device/info_json.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "plot/svg.h"
#include "sweep/convergence_plot.h"
#include "sweep/page.h"

#include <cmath>
#include <cstring>

namespace opal::fuzz {

namespace {

SweepRecord small_record() {
    SweepRecord record;
    record.version = "0.1.0";
    record.scene = "a.xml";
    record.scene_hash = "0123456789abcdef";
    record.dialect = "upstream";
    record.clock = "kernel";
    record.kernel = "special";
    record.definitions = {{"a", "1"}};
    record.devices = {{0, "a device", "a driver"}};
    record.width = record.height = 8;
    record.replicates = 2;
    record.spp = {4, 16};
    record.reference = {"mis", 64, 1.5, 0.3, 0.001, true, 0.2};
    for (const char *name : {"mis", "emitters"}) {
        StrategyRecord &strategy = record.strategy(name, "a label");
        for (const unsigned spp : record.spp)
            strategy.points.push_back(
                {spp,
                 {{1, 0.25 * spp, 0.1 / spp, 0.2 / spp, 0.3, 0}, {2, 0.26 * spp, 0.11 / spp, 0.21 / spp, 0.31, 1}}});
        strategy.shot = {16, 0.5, 0.01, "equal_time_" + std::to_string(record.strategies.size())};
    }
    return record;
}

// The text that a run leaves behind.
std::string record_text() {
    char folder[] = "/tmp/opal_fuzz_XXXXXX";
    require(mkdtemp(folder) != nullptr, "a folder in /tmp");
    save(small_record(), folder);
    load_record(folder); // throws where this is no record any more, so that the target says so
    const std::string text = read_file(std::filesystem::path(folder) / "sweep.json");
    std::filesystem::remove_all(folder);
    return text;
}

const TextFormat format = {
    .words = [](std::string_view text) { return separated(text, " \t\r\n,:[]{}"); },
    .replacements = {"null", "true", "[]", "{}", "\"\"", "\"a\"", "\"\\u0000\"", "\"\xff\"", "[[]]", "1.5", "-1"},
    .piece = '\n',
    .start =
        [](Random &random) {
            static const std::string record = record_text();
            static const std::string device = dump(nlohmann::json(DeviceInfo{}));
            return below(4, random) == 0 ? device : record;
        }};

// All values within a value, itself included.
void gather(nlohmann::json &value, std::vector<nlohmann::json *> &all) {
    all.push_back(&value);
    if (value.is_structured())
        for (nlohmann::json &child : value)
            gather(child, all);
}

// The text with one value changed, and still JSON; the text itself where it is none.
std::string with_other_value(const std::string &text, Random &random) {
    static const std::vector<nlohmann::json> others = {0,
                                                       -1,
                                                       1,
                                                       0.5,
                                                       1e308,
                                                       -1e308,
                                                       5e-324,
                                                       2147483648u,
                                                       -2147483649,
                                                       4294967296,
                                                       18446744073709551615u,
                                                       NAN,
                                                       true,
                                                       "",
                                                       "a",
                                                       "a\"<b>",
                                                       "../a",
                                                       nullptr,
                                                       nlohmann::json::array(),
                                                       nlohmann::json::object()};
    nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
    if (json.is_discarded())
        return text;
    std::vector<nlohmann::json *> all;
    gather(json, all);
    nlohmann::json &value = *all[below(all.size(), random)];
    const nlohmann::json copy = *all[below(all.size(), random)];
    switch (below(5, random)) {
    case 0: // in the place of another
        value = copy;
        break;
    case 1: // one more, or one less
        if (value.is_array() && !value.empty() && below(2, random) == 0)
            value.erase(below(value.size(), random));
        else if (value.is_array())
            value.push_back(value.empty() ? copy : value[below(value.size(), random)]);
        else if (value.is_object() && !value.empty())
            value.erase(std::next(value.begin(), std::ptrdiff_t(below(value.size(), random))));
        break;
    default:
        value = one_of(others, random);
    }
    return dump(json, 1);
}

void show(const SweepRecord &record, const std::filesystem::path &folder) {
    const SweepSummary summary = summarise(record);
    json_of(summary);
    csv(summary);
    svg_file(convergence_plot(summary));
    if (!summary.strategies.empty()) // a page is made of a sweep that has measured
        html_page(record, summary, folder);
}

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("sweep/sweep.json");
    static const SweepRecord fresh = small_record();
    file.write(input);
    const std::filesystem::path folder = file.path().parent_path();
    try {
        show(load_record(folder), folder);
        resume(folder, fresh);
    } catch (const Error &) {
    }
    try {
        parse_json(std::string(input)).get<DeviceInfo>();
    } catch (const nlohmann::json::exception &) { // each caller catches it
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    if (opal::fuzz::Random random(seed); opal::fuzz::below(3, random) > 0) {
        const std::string text =
            opal::fuzz::with_other_value(std::string(reinterpret_cast<const char *>(data), size), random);
        if (text.size() <= max_size) {
            std::memcpy(data, text.data(), text.size());
            return text.size();
        }
    }
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
