// The manual: README.md is short, its links lead somewhere, its commands and flags exist; the tables of
// scenes/README.md hold what Opal reads, and its first scene loads.
#include "base/log.h"
#include "base/values.h"
#include "cameras/list.h"
#include "commands/commands.h"
#include "flatten/scene_warnings.h"
#include "read/load.h"
#include "read/nori/tests.h"
#include "scene/options.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>

using namespace opal;
using namespace opal::test;

namespace fs = std::filesystem;

namespace {

const fs::path top = OPAL_SOURCE_DIR;

using Cells = std::vector<std::string>;
using Names = std::vector<std::string>;

bool contains(const Names &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// The words in backticks.
Names quoted_names(const std::string &text) {
    static const std::regex quoted("`([^`]+)`");
    Names names;
    for (std::sregex_iterator i(text.begin(), text.end(), quoted), end; i != end; ++i)
        names.push_back((*i)[1]);
    return names;
}

// The rows of the tables below a heading of scenes/README.md, without those of headings.
std::vector<Cells> rows_below(const std::string &heading) {
    std::vector<Cells> rows;
    bool is_within = false;
    for (const std::string &line : lines_of(read_text(top / "scenes/README.md"))) {
        if (line.starts_with("#"))
            is_within = line == "### " + heading;
        else if (is_within && line.starts_with("| ")) {
            Cells cells;
            std::istringstream stream(line.substr(1));
            for (std::string cell; std::getline(stream, cell, '|');)
                cells.push_back(cell);
            rows.push_back(cells);
        }
    }
    INFO(heading);
    REQUIRE(rows.size() > 1);
    return rows;
}

// The names that Opal lists as available in its message on an unknown `what` 'zzz'.
Names available(const std::string &what, const std::string &message) {
    for (const std::string &line : lines_of(message)) {
        const size_t list = line.find("available: ");
        if (line.find("unknown " + what + " 'zzz'") == std::string::npos || list == std::string::npos)
            continue;
        Names names;
        static const std::regex name("[A-Za-z_0-9]+");
        const std::string text = line.substr(list + 11);
        for (std::sregex_iterator i(text.begin(), text.end(), name), end; i != end; ++i)
            names.push_back(i->str());
        return names;
    }
    FAIL("no list of each '" << what << "' in: " << message);
    return {};
}

// A kind of objects: where one stands in a file.
struct Kind {
    std::string heading, what; // in the manual; in messages
    std::string before, after; // around it
    std::string tag;

    std::string error(const std::string &type, const std::string &body) const {
        const ScratchFolder folder;
        const fs::path file =
            folder.write("a.xml", fmt::format("{}<{} type='{}'>{}</{}>{}", before, tag, type, body, tag, after));
        return before.starts_with("<scene") || tag == "scene" ? error_of([&] { load_scene(file); })
                                                              : error_of([&] { load_test(file); });
    }
    Names types() const { return available(what + " type", error("zzz", "")); }
    Names properties(const std::string &type) const {
        return available("property", error(type, "<float name='zzz' value='1'/>"));
    }
};

const std::string camera = "<camera type='perspective'/>";
const std::vector<Kind> kinds = {
    {"`<camera>`", "camera", "<scene>", "</scene>", "camera"},
    {"`<rfilter>`", "rfilter", "<scene><camera type='perspective'>", "</camera></scene>", "rfilter"},
    {"`<sampler>`", "sampler", "<scene>" + camera, "</scene>", "sampler"},
    {"`<integrator>`", "integrator", "<scene>" + camera, "</scene>", "integrator"},
    {"`<mesh>`", "mesh", "<scene>" + camera, "</scene>", "mesh"},
    {"`<bsdf>`", "bsdf", "<scene>" + camera + "<mesh type='obj'>", "</mesh></scene>", "bsdf"},
    {"`<emitter>`", "emitter", "<scene>" + camera, "</scene>", "emitter"},
    {"`<test>`", "test", "", "", "test"},
};

// The emitters of a mesh stand there.
Kind placed(const Kind &kind, const std::string &type) {
    Kind other = kind;
    if (kind.tag == "emitter" && (type == "area" || type == "parallelogram_emitter")) {
        const bool is_nori = kind.before == "<scene>" + camera;
        other.before += is_nori ? "<mesh type='obj'>" : "<shape type='sphere'>";
        other.after = (is_nori ? "</mesh>" : "</shape>") + other.after;
    }
    return other;
}

// The same of Mitsuba's plug-ins; those of emitters but `area` stand in the scene.
const std::string mitsuba_scene = "<scene version='3.0.0'>", in_sensor = "<sensor type='perspective'>",
                  in_film = in_sensor + "<film type='hdrfilm'>";
const std::vector<Kind> mitsuba_kinds = {
    {"", "shape", mitsuba_scene, "</scene>", "shape"},
    {"", "texture", mitsuba_scene, "</scene>", "texture"},
    {"", "bsdf", mitsuba_scene, "</scene>", "bsdf"},
    {"", "emitter", mitsuba_scene, "</scene>", "emitter"},
    {"", "sensor", mitsuba_scene, "</scene>", "sensor"},
    {"", "film", mitsuba_scene + in_sensor, "</sensor></scene>", "film"},
    {"", "rfilter", mitsuba_scene + in_film, "</film></sensor></scene>", "rfilter"},
    {"", "sampler", mitsuba_scene + in_sensor, "</sensor></scene>", "sampler"},
    {"", "integrator", mitsuba_scene, "</scene>", "integrator"},
};

// Whether a row is about that type; those of all types, and those of the strategy, which begin with a property, are.
bool is_about(const Cells &row, const std::string &type, const Names &types) {
    const Names named = quoted_names(row[0]);
    return contains(named, type) ||
           std::none_of(named.begin(), named.end(), [&](const std::string &name) { return contains(types, name); });
}

// "| `phong` | `n` | float | 20 | 0 or more | exponent of the lobe |"
std::string row_of(const std::string &type, const Parameter &parameter) {
    return fmt::format("| `{}` | `{}` | {} | {} | {} | {} |\n", type, parameter.xml_name, xml_tag(parameter.type),
                       text_of_initial(parameter), text_of(parameter), parameter.meaning);
}

void check_flags(const Command &command, std::set<std::string> &flags) {
    for (const OptionRow &row : command.options) {
        std::istringstream names(row.flags);
        for (std::string name; std::getline(names, name, ',');)
            flags.insert(name);
    }
    for (const Command &sub : command.subcommands)
        check_flags(sub, flags);
}

const std::vector<std::string> readmes = {
    "README.md",    "scenes/README.md", "scripts/README.md", "host/README.md",
    "cl/README.md", "tests/README.md",  "CHANGELOG.md",      "scenes/eta_study/README.md"};

} // namespace

TEST_CASE("the manual names every type and property that Opal reads, and no other", "[manual]") {
    for (const Kind &kind : kinds) {
        const std::vector<Cells> rows = rows_below(kind.heading);
        const Names types = kind.types();
        for (const std::string &type : types) {
            const Names known = placed(kind, type).properties(type);
            Names written;
            bool is_there = false;
            for (const Cells &row : rows) {
                is_there = is_there || contains(quoted_names(row[0]), type);
                if (is_about(row, type, types))
                    for (const std::string &cell : row)
                        for (const std::string &name : quoted_names(cell))
                            written.push_back(name);
            }
            INFO(kind.heading << " " << type);
            CHECK((is_there || type == "parallelogram_emitter")); // which the text explains
            for (const std::string &name : known)
                if (name != "none" && type != "parallelogram_emitter") {
                    INFO(name);
                    CHECK(contains(written, name));
                }
            for (const Cells &row : rows)
                if (row.size() > 3 && contains(quoted_names(row[0]), type))
                    for (const std::string &name : quoted_names(kind.tag == "integrator" ? "" : row[1])) {
                        INFO(name);
                        CHECK(contains(known, name));
                    }
        }
    }
}

TEST_CASE("the manual names every plug-in and property of Mitsuba's that Opal reads, and no other", "[manual]") {
    const std::vector<Cells> rows = rows_below("Plug-ins and properties");
    for (const Kind &kind : mitsuba_kinds) {
        const Names types = kind.types();
        for (const std::string &type : types) {
            INFO(kind.tag << " " << type);
            Names known = placed(kind, type).properties(type), written;
            std::erase(known, "none"); // no property at all
            bool is_there = false;
            for (const Cells &row : rows) {
                const Names about = quoted_names(row[1]);
                if (!contains(quoted_names(row[0]), kind.tag) || (!contains(about, type) && row[1] != " all "))
                    continue;
                is_there = is_there || contains(about, type);
                const Names names = quoted_names(row[2]);
                written.insert(written.end(), names.begin(), names.end());
            }
            CHECK(is_there);
            std::ranges::sort(known);
            std::ranges::sort(written);
            CHECK(known == written);
        }
    }
}

TEST_CASE("the manual's rows of materials, lights and cameras are those of the lists", "[manual]") {
    const std::string manual = read_text(top / "scenes/README.md");
    std::vector<std::string> rows;
    for (uint kind = 0; kind < BSDF_COUNT; ++kind)
        for (const Parameter &parameter : bsdf_parameters(kind))
            if (is_property(parameter.type))
                rows.push_back(row_of(bsdf_name(kind), parameter));
    for (uint kind = 0; kind < EMITTER_COUNT; ++kind)
        for (const Parameter &parameter : emitter_parameters(kind))
            rows.push_back(row_of(emitter_name(kind), parameter));
#define OPAL_CAMERA_ROW(type, name, xml, initial, range, meaning)                                                      \
    rows.push_back(row_of(kind, {ParameterType::type, #name, xml, initial, range, meaning, 0, 0}));
#define OPAL_CAMERA_ROWS(name, record, traits)                                                                         \
    {                                                                                                                  \
        [[maybe_unused]] const char *const kind = #name;                                                               \
        OPAL_CAMERA_##name(OPAL_CAMERA_ROW)                                                                            \
    }
    OPAL_CAMERAS(OPAL_CAMERA_ROWS)
    REQUIRE(rows.size() > 14);
    for (const std::string &row : rows)
        CHECK_THAT(manual, Catch::Contains(row));
}

TEST_CASE("the manual has the options of the strategy with their types, flags and choices", "[manual]") {
    const std::vector<Cells> rows = rows_below("`<integrator>`");
    for (const StrategyOption &option : strategy_options()) {
        INFO(option.name);
        const auto row = std::find_if(rows.begin(), rows.end(), [&](const Cells &cells) {
            return cells.size() > 3 && cells[0] == " `" + option.xml_name + "` " &&
                   cells[2] == " `--" + option.name + "` ";
        });
        REQUIRE(row != rows.end());
        CHECK((*row)[1] == " " + option.xml_tag + " ");
        for (const Axis &axis : axes())
            if (axis.name == option.name)
                CHECK(quoted_names((*row)[3]) == [&] {
                    Names names;
                    for (const Choice &choice : axis.choices)
                        names.push_back(choice.name);
                    return names;
                }());
    }
}

TEST_CASE("the manual has all operations of a transform and all types of properties", "[manual]") {
    const ScratchFolder folder;
    const auto load = [&](const std::string &body) {
        const fs::path file = folder.write("a.xml", "<scene>" + body + "</scene>");
        return error_of([&] { load_scene(file); });
    };
    const auto written = [](const std::string &heading) {
        Names names;
        for (const Cells &row : rows_below(heading))
            for (const std::string &name : quoted_names(row[0]))
                names.push_back(name);
        return names;
    };
    Names operations = available(
        "operation", load("<camera type='perspective'><transform name='toWorld'><zzz/></transform></camera>"));
    Names named = written("Transforms");
    CHECK(std::set(operations.begin(), operations.end()) == std::set(named.begin(), named.end()));
    const std::string manual = read_text(top / "scenes/README.md");
    for (const std::string &tag : available("tag", load(camera + "<zzz/>"))) {
        INFO(tag);
        const bool is_object = manual.find("### `<" + tag + ">`") != std::string::npos;
        const bool is_property = manual.find("| `" + tag + "` |") != std::string::npos ||
                                 manual.find("| `point`, `vector` |") != std::string::npos;
        CHECK((is_object || is_property));
    }
}

TEST_CASE("the manual's first scene loads without a warning", "[manual]") {
    const ScratchFolder folder;
    const std::string manual = read_text(top / "scenes/README.md"), start = "```xml\n";
    const size_t first = manual.find(start) + start.size();
    const fs::path file = folder.write("first.xml", manual.substr(first, manual.find("```", first) - first));
    fs::copy_file(top / "scenes/meshes/torus.obj", folder / "torus.obj");
    const size_t before = warnings().size();
    const SceneDescription scene = load_scene(file);
    CHECK(scene.meshes.size() == 3);
    CHECK(has_light(scene));
    CHECK(scene_warnings(scene).empty());
    CHECK(warnings().size() == before);
}

TEST_CASE("README.md has at most 120 lines, and its commands and flags exist", "[manual]") {
    const std::string text = read_text(top / "README.md");
    CHECK(lines_of(text).size() <= 120);
    std::set<std::string> flags = {"--help"};
    Names commands;
    for (const Command &command : all_commands()) {
        commands.push_back(command.name);
        check_flags(command, flags);
    }
    for (const std::string &quoted : quoted_names(text)) {
        INFO(quoted);
        std::istringstream words(quoted);
        std::string word;
        const bool is_opal = words >> word && word == "opal";
        if (!is_opal || !(words >> word))
            continue;
        if (word.find('.') == std::string::npos && word != "COMMAND")
            CHECK(contains(commands, word));
        for (; words; words >> word)
            if (word.starts_with("--"))
                CHECK(flags.contains(word));
    }
}

TEST_CASE("links of the READMEs lead to files and headings that exist", "[manual]") {
    static const std::regex link(R"(\]\(([^)#\s]*)(#[^)\s]*)?\))"), heading("^#+ (.*)$");
    for (const std::string &readme : readmes) {
        const std::string text = read_text(top / readme);
        for (std::sregex_iterator i(text.begin(), text.end(), link), end; i != end; ++i) {
            const std::string target = (*i)[1], anchor = (*i)[2];
            if (target.starts_with("http"))
                continue;
            INFO(readme << ": " << i->str());
            const fs::path file = target.empty() ? top / readme : (top / readme).parent_path() / target;
            REQUIRE(fs::exists(file));
            if (anchor.empty())
                continue;
            std::set<std::string> anchors; // as GitHub makes them of headings
            for (const std::string &line : lines_of(read_text(file)))
                if (std::smatch match; std::regex_match(line, match, heading)) {
                    std::string made = "#";
                    for (char c : match[1].str())
                        if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_')
                            made += char(std::tolower(static_cast<unsigned char>(c)));
                        else if (c == ' ')
                            made += '-';
                    anchors.insert(made);
                }
            CHECK(anchors.contains(anchor));
        }
    }
}
