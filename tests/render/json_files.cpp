// --json of every command: one envelope, then what schemas/COMMAND.json says.
#include "base/json.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <algorithm>

using nlohmann::json;
using namespace opal::test;

namespace {

const std::filesystem::path schemas = OPAL_SOURCE_DIR "/schemas";

bool has_type(const json &value, const std::string &type) {
    return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) ||
           (type == "string" && value.is_string()) || (type == "boolean" && value.is_boolean()) ||
           (type == "null" && value.is_null()) || (type == "number" && value.is_number()) ||
           (type == "integer" && value.is_number_integer());
}

// What is wrong with a value, by the part of JSON Schema that schemas/ uses; a keyword beside it is wrong, too.
void check(const json &value, const json &schema, const std::string &place, std::vector<std::string> &problems) {
    for (const auto &[keyword, rule] : schema.items()) {
        if (keyword == "type") {
            const json types = rule.is_array() ? rule : json::array({rule});
            if (std::none_of(types.begin(), types.end(), [&](const json &type) { return has_type(value, type); }))
                problems.push_back(place + ": is no " + rule.dump());
        } else if (keyword == "required") {
            for (const json &key : rule)
                if (!value.is_object() || !value.contains(key))
                    problems.push_back(place + ": lacks " + key.get<std::string>());
        } else if (keyword == "properties") {
            for (const auto &[key, inner] : rule.items())
                if (value.is_object() && value.contains(key))
                    check(value[key], inner, place + "/" + key, problems);
        } else if (keyword == "items") {
            for (size_t i = 0; value.is_array() && i < value.size(); i++)
                check(value[i], rule, place + "/" + std::to_string(i), problems);
        } else if (keyword == "const") {
            if (value != rule)
                problems.push_back(place + ": is not " + rule.dump());
        } else if (keyword == "allOf") {
            for (const json &part : rule)
                check(value, part, place, problems);
        } else if (keyword == "$ref") {
            check(value, json::parse(read_text(schemas / rule.get<std::string>())), place, problems);
        } else if (keyword != "$schema" && keyword != "title" && keyword != "description") {
            problems.push_back("the schema has an unknown keyword " + keyword);
        }
    }
}

std::vector<std::string> problems_of(const json &value, const std::string &schema) {
    std::vector<std::string> problems;
    check(value, json::parse(read_text(schemas / (schema + ".json"))), "", problems);
    return problems;
}

const std::string scenes = OPAL_SOURCE_DIR "/scenes/";

} // namespace

TEST_CASE("The JSON of every command is as its schema says", "[json_files]") {
    const ScratchFolder folder;
    const std::string box = scenes + "cbox_mis.xml", in = "cd " + folder.path().string() + " && " OPAL_BINARY " ";
    const std::string wall = folder.write(
        "wall.xml", "<scene><integrator type='path_mis'/><camera type='perspective'/><mesh type='parallelogram'>"
                    "<point name='origin' value='-1 -1 5'/><vector name='u' value='0 2 0'/><vector name='v' value='2 0 "
                    "0'/><bsdf type='diffuse'><color name='albedo' value='$a $a $a'/></bsdf></mesh><emitter "
                    "type='point'><point name='position' value='0 0 0'/><color name='power' value='9 9 9'/></emitter>"
                    "</scene>");
    const std::string bright = folder.write( // NaN: sums beyond single precision
        "bright.xml", "<scene><camera type='perspective'/><mesh type='parallelogram'><point name='origin' value='-9 -9 "
                      "5'/><vector name='u' value='0 18 0'/><vector name='v' value='18 0 0'/><emitter type='area'>"
                      "<color name='radiance' value='1e38 1e38 1e38'/></emitter></mesh></scene>");
    REQUIRE(run_shell(in + box + " --width 8 --spp 2 --layers variance -o a.exr").exit_code == 0);
    for (const auto &[schema, command] : std::vector<std::pair<std::string, std::string>>{
             {"render", "render " + box + " --width 8 --spp 1"},
             {"render", "render " + bright + " --width 4 --spp 64"},
             {"inspect", "inspect " + box},
             {"devices", "devices"},
             {"version", "version"},
             {"cache", "cache"},
             {"compare", "compare a.exr a.exr"},
             {"warp", "warp square_to_uniform_disk --samples 1000"},
             {"test", "test " OPAL_SOURCE_DIR "/tests/cases/conformance/furnace.xml --samples 10"},
             {"bench-render", "bench render " + box + " --seconds 0.01 --rounds 1"},
             {"verify", "verify " + box + " --budget 3s"},
             {"verify-vary", "verify " + wall + " --vary a=0.2,0.6 --budget 1s"},
             {"sweep", "sweep " + box + " --width 8 --spp 2 --replicates 2 --strategies lighting=emitter lighting=mis"},
             {"sweep-vary",
              "sweep " + wall +
                  " --vary a=0.2,0.6 --width 8 --spp 2 --replicates 2 --strategies "
                  "sampler=independent sampler=sobol"},
             {"selftest", "selftest --group basics"},
             {"extremes", "extremes --quick --row alpha --side 8 --spp 4"},
             {"bench-rays", "bench rays " + box + " --rays 1000 --runs 1"}}) {
        INFO(command);
        const Outcome outcome = run_shell(in + command + " --json -");
        INFO(outcome.err);
        json report;
        REQUIRE_NOTHROW(report = json::parse(outcome.out)); // nothing else on stdout
        CHECK(problems_of(report, schema) == std::vector<std::string>{});
        CHECK_THAT(command, Catch::StartsWith(report["command"].get<std::string>()));
        report.erase("opal");
        CHECK(problems_of(report, schema) == std::vector<std::string>{": lacks opal"});
    }
}

TEST_CASE("inspect folds meshes that differ in their names alone, and its JSON has all", "[json_files]") {
    const ScratchFolder folder;
    const auto inspect = [&](int meshes) {
        std::string text = "<scene><camera type='perspective'/>";
        for (int i = 0; i < meshes; i++)
            text += "<mesh type='parallelogram'><string name='name' value='m" + std::to_string(i) +
                    "'/><point name='origin' value='-1 -1 5'/><vector name='u' value='2 0 0'/><vector name='v' "
                    "value='0 2 0'/><bsdf type='diffuse'><color name='albedo' value='" +
                    std::to_string(0.001 * (i % 30)) + " 0 0'/></bsdf></mesh>";
        const std::string scene = folder.write("scene.xml", text + "</scene>");
        return run_shell(OPAL_BINARY " inspect " + scene + " --json " + (folder / "out.json").string());
    };
    const auto lines = [](const Outcome &outcome) { return std::count(outcome.out.begin(), outcome.out.end(), '\n'); };
    const Outcome few = inspect(100), outcome = inspect(1000);
    INFO(outcome.out);
    REQUIRE(few.exit_code == 0);
    REQUIRE(outcome.exit_code == 0);
    CHECK(lines(outcome) <= lines(few) + 2);
    CHECK_THAT(outcome.out, Catch::Contains("m0 and 33 more: ") && Catch::Contains("... and 10 more kinds of meshes"));
    const json report = json::parse(read_text(folder / "out.json"));
    CHECK(report["meshes"].size() == 1000);
    CHECK(report["meshes"][999]["name"] == "m999");
}
