#include "read/nori/tests.h"

#include "base/values.h"
#include "read/nori/parsers.h"

#include <fmt/format.h>

namespace opal {

namespace {

// The numbers in a string property.
std::vector<double> numbers(Properties &properties, const std::string &name) {
    std::string text = properties.string(name).value_or("");
    try {
        return parse_numbers(text, split(text).size());
    } catch (const Error &error) {
        properties.fail_at(name, error.what());
    }
}

int positive(Properties &properties, const std::string &name, int otherwise) {
    int value = properties.integer(name).value_or(otherwise);
    properties.check(value >= 1, name, "must be at least 1");
    return value;
}

void parse_ttest(Properties &properties, TestDescription &test) {
    test.references = numbers(properties, "references");
    test.angles = numbers(properties, "angles");
    test.sample_count = positive(properties, "sampleCount", 100000);
    properties.check(test.sample_count >= 2, "sampleCount", "must be at least 2: one sample has no variance");
    if (!test.scenes.empty() && !test.bsdfs.empty())
        properties.mistake("a ttest holds scenes or BSDFs, not both");
    properties.check(test.scenes.empty() || test.angles.empty(), "angles", "mean nothing for scenes");
    size_t means = test.scenes.empty() ? test.bsdfs.size() * test.angles.size() : test.scenes.size();
    properties.check(means == test.references.size(), "references",
                     fmt::format("{} numbers for {} means", test.references.size(), means));
}

void parse_chi2test(Properties &properties, TestDescription &test) {
    test.sample_count = properties.integer("sampleCount").value_or(-1);
    properties.check(test.sample_count >= 1 || test.sample_count == -1, "sampleCount",
                     "must be at least 1, or -1 for 5000 a bin");
    test.resolution = positive(properties, "resolution", test.resolution);
    test.min_expected_frequency = positive(properties, "minExpFrequency", test.min_expected_frequency);
    test.test_count = positive(properties, "testCount", test.test_count);
    if (!test.scenes.empty())
        properties.mistake("a chi2test holds BSDFs, not scenes");
}

struct TestType {
    std::string name;
    void (*parse)(Properties &, TestDescription &);
};

const std::vector<TestType> test_types = {{"ttest", parse_ttest}, {"chi2test", parse_chi2test}};

TestDescription parse_test(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    const TestType *type = properties.row_of_type(test_types, "nothing is tested");
    TestDescription test;
    if (!type)
        return test;
    test.type = type->name;
    test.place = node.place();
    test.significance_level = properties.number("significanceLevel").value_or(test.significance_level);
    properties.check(test.significance_level > 0 && test.significance_level < 1, "significanceLevel",
                     "must lie between 0 and 1");
    for (const XmlNode &scene : properties.children("scene"))
        context.attempt(scene, [&] { test.scenes.push_back(parse_scene(scene, context)); });
    for (const XmlNode &bsdf : properties.children("bsdf"))
        context.attempt(bsdf, [&] { test.bsdfs.push_back(parse_bsdf(bsdf, context)); });
    context.attempt(node, [&] { type->parse(properties, test); });
    if (test.scenes.empty() && test.bsdfs.empty())
        properties.lacks("the test holds nothing to test");
    properties.finish();
    return test;
}

} // namespace

TestDescription load_test(const std::filesystem::path &file, const LoadOptions &options) {
    if (options.dialect == name_of(Dialect::mitsuba))
        throw UsageError(file.string() + ": a <test> is Nori's: --dialect mitsuba is for scenes");
    XmlDocument document(file);
    XmlNode root = document.root();
    if (root.tag() == "scene")
        root.fail("this is a <scene>, not a <test>: run it with `opal render`");
    if (root.tag() != "test")
        root.fail(unknown_name("root", root.tag(), {"scene", "test"}));
    Mistakes mistakes;
    const ParseContext context = context_for(file, options, mistakes);
    document.define(options.definitions, context.handler());
    mistakes.throw_all();
    const TestDescription test = parse_test(root, context);
    mistakes.throw_all();
    return test;
}

} // namespace opal
