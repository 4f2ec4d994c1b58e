#include "support/kernels.h"

#include "device/ask_driver.h"
#include "support/scratch.h"

#include <fmt/format.h>

#include <filesystem>

namespace opal::test {

const Device &device() {
    static const Device opened = [] {
        set_probe_binary(OPAL_BINARY);
        return open_device(pick_device(wanted_device(), list_devices()).info);
    }();
    return opened;
}

std::vector<int> tested_lanes() {
    const int own = device().info.native_lanes;
    return own == 1 ? std::vector<int>{1} : std::vector<int>{1, own};
}

Features all_features(const std::vector<unsigned> &without) {
    Features features;
    features.list.fill({true, "a test"});
    for (unsigned feature : without)
        features.list[feature].on = false;
    features.axes.fill(-1);
    return features;
}

const Sources &sources() {
    static const Sources all = [] {
        Sources sources = Sources::embedded();
        for (const auto &entry : std::filesystem::directory_iterator(OPAL_SOURCE_DIR "/tests/device"))
            if (entry.path().extension() == ".cl")
                sources.files["tests/" + entry.path().filename().string()] = read_text(entry.path());
        return sources;
    }();
    return all;
}

namespace {

cl::Program build(const Sources &from, const std::string &kernels, int lanes, const Features &features, MathMode math) {
    static std::map<std::string, cl::Program> built;
    BuildOptions options;
    options.lanes = lanes;
    options.math = math;
    options.kernels = kernels;
    const std::string text = program_text(features, options, from);
    if (const auto found = built.find(text); found != built.end())
        return found->second;
    return built[text] = build_program(device(), text, options);
}

} // namespace

cl::Program program(const std::string &kernels, int lanes, const Features &features, MathMode math) {
    return build(sources(), kernels, lanes, features, math);
}

cl::Program program_of(const std::string &text, int lanes, const Features &features, MathMode math) {
    return program_from(sources(), text, lanes, features, math);
}

cl::Program program_from(const Sources &from, const std::string &text, int lanes, const Features &features,
                         MathMode math) {
    Sources with_text = from;
    with_text.files["tests/inline.cl"] = text;
    return build(with_text, "tests/inline.cl", lanes, features, math);
}

} // namespace opal::test
