// Nori's tests as XML: a <test> holds scenes or BSDFs and what is expected of them.
#pragma once

#include "read/nori/load.h"

namespace opal {

struct TestDescription {
    std::string type;                 // ttest or chi2test
    std::vector<double> references;   // ttest: expected means, one a scene, or one a BSDF and angle (BSDF-major)
    std::vector<double> angles;       // ttest of BSDFs: between wi and the normal, degrees
    int sample_count = 100000;        // ttest: samples a mean; chi2test: samples a histogram, -1: 5000 a bin
    double significance_level = 0.01; // of the whole test, over all its references
    int resolution = 10;              // chi2test: bins of cos(theta) over [-1, 1]; twice as many of phi
    int min_expected_frequency = 5;   // chi2test: bins expected to hold fewer are pooled
    int test_count = 5;               // chi2test: random wi for each BSDF
    std::vector<SceneDescription> scenes;
    std::vector<Bsdf> bsdfs;
    SourcePlace place;
};

// Throws Error "file:line:col: ...", as load_scene does; also where the root is a <scene>.
TestDescription load_test(const std::filesystem::path &file, const LoadOptions &options = {});

} // namespace opal
