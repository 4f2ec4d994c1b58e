// The small parsers: numbers, durations, crops, values of options, definitions, names and kinds of files. The first
// byte of an input picks one.
#include "base/values.h"
#include "base/command_line.h"
#include "base/error.h"
#include "base/json.h"
#include "base/table.h"
#include "base/units.h"
#include "commands/vary.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "read/file_kind.h"
#include "read/xml.h"
#include "scene/options.h"

#include <cmath>
#include <limits>

namespace opal::fuzz {

namespace {

using Parser = void (*)(const std::string &text);

void number(const std::string &text) {
    require(std::abs(parse_number(text)) <= std::numeric_limits<float>::max(), "numbers are finite floats");
}

void numbers(const std::string &text) {
    require(parse_numbers(text, split(text).size()).size() == split(text).size(), "as many numbers as words");
}

void triple(const std::string &text) {
    const Vec3 v = parse_triple(text);
    require(std::isfinite(v.x + v.y + v.z), "triples are finite");
}

void whole(const std::string &text) { parse_integer(text); }
void boolean(const std::string &text) { parse_boolean(text); }

void seconds(const std::string &text) {
    const double value = parse_seconds(text);
    require(value > 0 && std::isfinite(value), "durations are positive and finite");
}

void fraction(const std::string &text) {
    const double value = parse_fraction(text);
    require(value > 0 && value < 1, "relative errors are above 0 and below 1");
}

void crop(const std::string &text) {
    Camera camera;
    set_crop(camera, text);
    const Crop part = camera.window();
    require(part.x >= 0 && part.y >= 0 && part.width >= 1 && part.height >= 1 && part.width <= camera.width - part.x &&
                part.height <= camera.height - part.y,
            "a crop is a part of the image");
}

// A name and a value for each option of a strategy, behind '='.
void option(const std::string &text) {
    const size_t end = std::min(text.find('='), text.size());
    Strategy strategy;
    set_option(strategy, text.substr(0, end), end < text.size() ? text.substr(end + 1) : "");
    for (size_t axis = 0; axis < AXIS_COUNT; axis++)
        require(strategy.choices[axis] >= 0 && size_t(strategy.choices[axis]) < axes()[axis].choices.size(),
                "choices are those of their axis");
    for (const StrategyOption &row : strategy_options())
        row.text(strategy);
}

// Lines: a scene, and the values of -D.
void definitions(const std::string &text) {
    const size_t end = std::min(text.rfind('\n'), text.size());
    Definitions given;
    for (const std::string_view word : split(std::string_view(text).substr(end))) {
        const size_t name_end = std::min(word.find('='), word.size());
        given.emplace(word.substr(0, name_end), word.substr(std::min(name_end + 1, word.size())));
    }
    XmlDocument document("a.xml", text.substr(0, end));
    document.define(given);
}

// --vary: a scene is loaded for each value.
void vary(const std::string &text) {
    SceneOptions options;
    options.file = std::filesystem::path(OPAL_FUZZ_FILES) / "varied.xml";
    load_variation(options, text);
}

void kind_of_file(const std::string &text) {
    const FileKindRow row = kind_of(text);
    wrong_kind_text("a.xml", row, FileKind::scene);
}

void names(const std::string &text) {
    static const std::vector<std::string> known = {"lighting", "emitter-choice", "mis", "max-depth"};
    unknown_name("name", text, known);
    is_definable(text);
    shell_word(text);
    with_hyphens(text);
    lines_of(text);
}

void json(const std::string &text) {
    try {
        const nlohmann::json value = parse_json(text);
        require(parse_json(dump(value)) == parse_json(dump(value, 1)), "JSON that is written is read");
    } catch (const nlohmann::json::exception &) { // each caller catches it
    }
}

constexpr Parser parsers[] = {number, numbers, triple,      whole, boolean,      seconds, fraction,
                              crop,   option,  definitions, vary,  kind_of_file, names,   json};

std::vector<std::string> option_words() {
    std::vector<std::string> words = {"60s",
                                      "500ms",
                                      "2min",
                                      "1h",
                                      "1%",
                                      "50 %",
                                      "0,0,8,8",
                                      "8,8,1272,712",
                                      "a=1,2",
                                      "w=0.1,0.5",
                                      "<scene><a b=\"$a\"/></scene>\na=1",
                                      "true",
                                      "\xef\xbb\xbf",
                                      "<default name=\"a\" value=\"1\"/>",
                                      "newmtl a",
                                      "v 1 2 3",
                                      "<scene"};
    for (const StrategyOption &option : strategy_options()) {
        words.push_back(option.name + "=");
        words.insert(words.end(), option.names.begin(), option.names.end());
    }
    return words;
}

const TextFormat &format() {
    static const TextFormat lines = {
        .words = [](std::string_view text) { return separated(text, ",= \n"); },
        .replacements = option_words(),
        .piece = ',',
        .start =
            [](Random &random) { return char(below(std::size(parsers), random)) + one_of(option_words(), random); }};
    return lines;
}

} // namespace

void try_input(std::string_view input) {
    if (input.empty())
        return;
    try {
        parsers[static_cast<unsigned char>(input[0]) % std::size(parsers)](std::string(input.substr(1)));
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format(), data, size, max_size, seed);
}
