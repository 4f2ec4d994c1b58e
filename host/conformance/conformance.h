// Runs Nori's <test> files (read/nori/tests.h) on a device.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "read/nori/tests.h"
#include "stats/hypothesis.h"

#include <functional>
#include <map>

namespace opal {

struct ConformanceOptions {
    BuildOptions build;
    const Sources *sources = &Sources::embedded();
    unsigned seed = 0;
    std::map<std::string, std::string> overrides; // of the scenes' strategies
};

// One mean against its reference, or one histogram against its density.
struct ConformanceCase {
    std::string name;
    bool is_mean = true;
    double mean = 0, reference = 0, standard_error = 0; // of a mean
    double samples = 0;
    stats::TestResult result;
    bool passed = false;
};

size_t count_cases(const TestDescription &test); // means or histograms

// Judges every case of the test at its significance level, split over the cases (Sidak). Calls on_case after each.
std::vector<ConformanceCase> run_test(const TestDescription &test, const Device &device,
                                      const ConformanceOptions &options,
                                      const std::function<void(const ConformanceCase &)> &on_case = {});

} // namespace opal
