// Who may include whom: main -> commands -> {render, device, flatten, scene, image, stats} -> base.
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <map>
#include <regex>
#include <set>
#include <sstream>

namespace fs = std::filesystem;

namespace {

struct Include {
    std::string name; // as written
    bool quoted;
    int line;
};

std::vector<Include> includes_of(const std::string &text) {
    static const std::regex directive(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
    std::vector<Include> includes;
    std::istringstream lines(text);
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        std::smatch match;
        if (std::regex_match(line, match, directive))
            includes.push_back({match[2], match[1] == "\"", number});
    }
    return includes;
}

// The folders below host/ and cl/ that files of a folder may include beside their own. cl: the headers shared with the device.
const std::map<std::string, std::set<std::string>> allowed = {
    {"base", {}},
    {"image", {"base"}},
    {"stats", {"base"}},
    {"scene", {"base", "cl"}},
    {"flatten", {"base", "cl", "scene"}},
    {"device", {"base", "cl", "flatten"}},
    {"render", {"base", "cl", "scene", "flatten", "device", "image", "stats"}},
    {"trust", {"base", "cl", "scene", "flatten", "device", "image", "stats", "render"}},
    {"extremes", {"base", "cl", "scene", "flatten", "device", "image", "stats", "render", "trust"}},
    {"bench", {"base", "cl", "scene", "flatten", "device", "image", "stats", "render"}},
    {"sweep", {"base", "cl", "scene", "flatten", "device", "image", "stats", "render", "trust"}},
    {"commands", {"base", "cl", "scene", "flatten", "device", "image", "stats", "render", "trust", "sweep", "extremes", "bench"}},
};
const std::set<std::string> without_opencl = {"base", "image", "stats", "scene", "flatten"};

std::string first_folder(const std::string &path) { return path.substr(0, path.find('/')); }

// What is wrong with one include of a file in host/`folder`; empty: nothing.
std::string problem_of(const std::string &folder, const Include &include) {
    if (!include.quoted)
        return include.name.rfind("CL/", 0) == 0 && include.name != "CL/cl_platform.h" && without_opencl.count(folder)
                   ? "must compile without OpenCL"
                   : "";
    const fs::path root = OPAL_SOURCE_DIR;
    if (fs::exists(root / "cl" / include.name))
        return include.name.ends_with(".cl")     ? "C++ never includes a .cl"
               : allowed.at(folder).count("cl") ? ""
                                                : "may not include the headers of cl/";
    if (!fs::exists(root / "host" / include.name))
        return "is not written from the root of host/ or cl/";
    const std::string other = first_folder(include.name);
    return other == folder || allowed.at(folder).count(other) ? "" : "may not include " + other + "/";
}

std::vector<std::string> problems_below(const std::string &top, const std::function<std::string(const fs::path &, const Include &)> &judge) {
    std::vector<std::string> problems;
    for (const auto &entry : fs::recursive_directory_iterator(fs::path(OPAL_SOURCE_DIR) / top)) {
        if (!entry.is_regular_file())
            continue;
        const fs::path file = fs::relative(entry.path(), OPAL_SOURCE_DIR);
        for (const Include &include : includes_of(opal::test::read_text(entry.path())))
            if (const std::string problem = judge(file, include); !problem.empty())
                problems.push_back(file.string() + ":" + std::to_string(include.line) + ": " + include.name + ": " + problem);
    }
    return problems;
}

} // namespace

TEST_CASE("Every folder of host/ includes only what stands below it", "[includes]") {
    const auto problems = problems_below("host", [](const fs::path &file, const Include &include) -> std::string {
        const std::string folder = first_folder(fs::relative(file, "host").generic_string());
        if (folder == "main.cpp")
            return include.quoted && first_folder(include.name) != "commands" && first_folder(include.name) != "base"
                       ? "main includes commands and base only"
                       : "";
        return allowed.count(folder) ? problem_of(folder, include) : "host/" + folder + " is not in the table of this test";
    });
    CHECK(problems == std::vector<std::string>{});
}

TEST_CASE("Headers below cl/ include headers below cl/, and no .cl", "[includes]") {
    const auto problems = problems_below("cl", [](const fs::path &file, const Include &include) -> std::string {
        if (!include.quoted)
            return "has no place in code that the device reads too";
        if (!fs::exists(fs::path(OPAL_SOURCE_DIR) / "cl" / include.name))
            return "is not written from the root of cl/";
        return file.extension() == ".h" && include.name.ends_with(".cl") ? "a header never includes a .cl" : "";
    });
    CHECK(problems == std::vector<std::string>{});
}

TEST_CASE("A wrong include would be found", "[includes]") {
    CHECK(problem_of("scene", {"device/context.h", true, 1}) == "may not include device/");
    CHECK(problem_of("flatten", {"CL/opencl.hpp", false, 1}) == "must compile without OpenCL");
    CHECK(problem_of("flatten", {"kernels/render.cl", true, 1}) == "C++ never includes a .cl");
    CHECK(problem_of("image", {"shared/types.h", true, 1}) == "may not include the headers of cl/");
    CHECK(problem_of("base", {"error.h", true, 1}) == "is not written from the root of host/ or cl/");
    CHECK(problem_of("render", {"device/context.h", true, 1}).empty());
    CHECK(includes_of(" # include \"a.h\" // why\n\n#include <b>\n").back().line == 3);
}
