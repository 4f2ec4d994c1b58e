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

namespace opal::fuzz {

namespace {

SweepRecord small_record() {
    SweepRecord record;
    record.version = "0.1.0";
    record.scene = "a.xml";
    record.scene_hash = "0123456789abcdef";
    record.dialect = "upstream";
    record.clock = "kernel";
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
                 {{0, 0.25 * spp, 0.1 / spp, 0.2 / spp, 0.3, 0}, {1, 0.26 * spp, 0.11 / spp, 0.21 / spp, 0.31, 1}}});
        strategy.shot = {16, 0.5, 0.01, "equal_time_1"};
    }
    return record;
}

// The text that a run leaves behind.
std::string record_text() {
    char folder[] = "/tmp/opal_fuzz_XXXXXX";
    require(mkdtemp(folder) != nullptr, "a folder in /tmp");
    save(small_record(), folder);
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

void show(const SweepRecord &record, const std::filesystem::path &folder) {
    const SweepSummary summary = summarise(record);
    json_of(summary);
    csv(summary);
    svg_file(convergence_plot(summary));
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
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
