// opal test: Nori's <test> files on a device.
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "conformance/conformance.h"
#include "image/image.h"
#include "read/nori/tests.h"
#include "scene/options.h"

#include <fmt/format.h>

namespace opal {

namespace {

struct Options {
    SceneOptions scene;
    std::vector<std::string> files;
    DeviceOptions device;
    std::string json;
    int samples = 0;
    double significance = 0;
    unsigned seed = 0;
};

std::string text_of(const ConformanceCase &c) {
    const std::string figures = c.is_mean ? fmt::format("mean {:<11.6g} reference {:<11.6g} error {:<8.2g}", c.mean,
                                                        c.reference, c.standard_error)
                                          : fmt::format("chi-square {:<9.2f} dof {:<5g} samples {:<8.4g}",
                                                        c.result.statistic, c.result.dof, c.samples);
    return fmt::format("  {}  {:<32} {} p {:<8.3g}{}", c.passed ? "ok      " : "REJECTED", c.name, figures,
                       c.result.p_value, c.result.reason.empty() ? "" : " " + c.result.reason);
}

nlohmann::json json_of(const ConformanceCase &c) {
    nlohmann::json json = object({{"name", c.name},
                                  {"passed", c.passed},
                                  {"samples", c.samples},
                                  {"p_value", c.result.p_value},
                                  {"statistic", c.result.statistic},
                                  {"dof", c.result.dof},
                                  {"reason", c.result.reason}});
    if (c.is_mean)
        json.update(object({{"mean", c.mean}, {"reference", c.reference}, {"standard_error", c.standard_error}}));
    return json;
}

int run(const Options &o) {
    std::vector<TestDescription> tests; // all are read first, so that a mistake in the last is reported at once
    for (const std::string &file : o.files)
        tests.push_back(load_test(file, o.scene.load));
    prepare_json(o.json);

    Strategy strategy;
    override_strategy(strategy, o.scene.overrides);
    const DevicePick pick = choose_device(o.device);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene.cl_dir);
    ConformanceOptions options;
    options.build.lanes = lanes_for(pick.info, strategy.lanes, strategy.math);
    options.build.math = strategy.math;
    options.sources = &sources;
    options.seed = o.seed;
    options.overrides = o.scene.overrides;
    info(fmt::format("device  {}, {} lanes", text_of(pick), options.build.lanes));

    size_t cases = 0, rejected = 0, planned = 0;
    for (const TestDescription &test : tests)
        planned += count_cases(test);
    RunningProgress progress("test");
    nlohmann::json report = {
        {"device", pick.info.name}, {"driver", pick.info.driver}, {"lanes", options.build.lanes}, {"seed", o.seed}};
    for (size_t i = 0; i < tests.size(); i++) {
        TestDescription &test = tests[i];
        test.sample_count = o.samples ? o.samples : test.sample_count;
        test.significance_level = o.significance > 0 ? o.significance : test.significance_level;
        print("{} ({}, level {:g})\n", o.files[i], test.type, test.significance_level);
        nlohmann::json results = nlohmann::json::array();
        for (const ConformanceCase &c : run_test(test, device, options, [&](const ConformanceCase &c) {
                 print("{}\n", text_of(c));
                 progress.update(double(++cases), double(planned));
             })) {
            results.push_back(json_of(c));
            rejected += !c.passed;
        }
        report["tests"].push_back(object({{"file", o.files[i]},
                                          {"type", test.type},
                                          {"significance", test.significance_level},
                                          {"cases", results}}));
    }
    print("{} of {} cases passed\n", cases - rejected, cases);
    write_json(o.json, "test", report);
    return rejected ? exit_check_failed : exit_done;
}

} // namespace

Command test_command() {
    auto o = std::make_shared<Options>();
    return {.name = "test",
            .help = "Run Nori's tests: means against references, samples against densities",
            .options = append({{.flags = "FILE.xml",
                                .target = &o->files,
                                .help = "Files whose root is a <test>",
                                .type = "",
                                .required = true},
                               device_row(o->device),
                               threads_row(o->device),
                               {.flags = "--samples",
                                .target = &o->samples,
                                .help = "Of each mean or histogram [the file's sampleCount]",
                                .check = Range{2, 2000000000}},
                               {.flags = "--significance",
                                .target = &o->significance,
                                .help = "Level of each file, split over its cases [the file's]",
                                .check = Range{1e-12, 0.5}},
                               {.flags = "--seed", .target = &o->seed, .help = "Seed of the random numbers"},
                               json_row(o->json, "the results")},
                              strategy_rows(o->scene)),
            .examples = {"opal test tests/cases/conformance/furnace.xml",
                         "opal test my_test.xml --significance 0.001 --json test.json"},
            .run = [o] { return run(*o); }};
}

} // namespace opal
