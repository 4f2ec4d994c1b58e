// Who may include whom: main includes commands and base, commands all rooms, and each room only rooms below it.
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

// The rooms of host/, from the ground up: what each may include beside itself. cl: the headers shared with the device.
// A room may include only rooms above it in this list, so that there is no circle.
struct Room {
    std::string name;
    std::set<std::string> may_include;
};
const std::vector<Room> rooms = {
    {"base", {}},
    {"image", {"base"}},
    {"stats", {"base"}},
    {"plot", {"base", "image"}},
    {"scene", {"base", "cl"}},
    {"read", {"base", "cl", "scene"}},
    {"read/nori", {"base", "cl", "scene", "read"}},
    {"strategies", {"base", "cl", "scene"}},
    {"bvh", {"base", "cl"}},
    {"flatten", {"base", "cl", "scene", "bvh"}},
    {"device", {"base", "cl", "scene", "flatten"}},
    {"film", {"base", "cl", "image"}},
    {"render", {"base", "cl", "scene", "flatten", "device", "image", "stats", "film"}},
    {"probe", {"base", "cl", "scene", "flatten", "device", "stats"}},
    {"densities", {"base", "cl", "scene", "read/nori", "flatten", "device", "stats", "plot", "probe"}},
    {"selftest",
     {"base", "cl", "scene", "read/nori", "flatten", "device", "image", "stats", "film", "render", "probe",
      "densities"}},
    {"conformance",
     {"base", "cl", "scene", "read/nori", "strategies", "flatten", "device", "stats", "film", "render", "densities"}},
    {"compare", {"base", "scene", "image", "stats", "strategies"}},
    {"bench", {"base", "cl", "scene", "bvh", "flatten", "device", "film", "render"}},
    {"extremes",
     {"base", "cl", "scene", "flatten", "device", "stats", "plot", "film", "render", "probe", "densities", "selftest"}},
    {"sweep", {"base", "cl", "scene", "strategies", "flatten", "device", "image", "stats", "plot", "film", "render"}},
    {"commands", {"base",     "cl",          "scene",   "read",  "read/nori", "strategies", "bvh",   "flatten",
                  "device",   "image",       "stats",   "plot",  "film",      "render",     "probe", "densities",
                  "selftest", "conformance", "compare", "bench", "extremes",  "sweep"}},
};
const std::set<std::string> without_opencl = {"base",      "image",      "stats", "plot",    "scene", "read",
                                              "read/nori", "strategies", "bvh",   "flatten", "film",  "compare"};

// The room that a path below host/ lies in: "read/nori" for read/nori/load.h.
std::string room_of(const std::string &path) { return path.substr(0, path.find_last_of('/')); }

const Room *find_room(const std::string &name) {
    const auto room = std::find_if(rooms.begin(), rooms.end(), [&](const Room &r) { return r.name == name; });
    return room == rooms.end() ? nullptr : &*room;
}

// What is wrong with one include of a file in `room`; empty: nothing.
std::string problem_of(const Room &room, const Include &include) {
    if (!include.quoted)
        return include.name.rfind("CL/", 0) == 0 && include.name != "CL/cl_platform.h" &&
                       without_opencl.count(room.name)
                   ? "must compile without OpenCL"
                   : "";
    const fs::path root = OPAL_SOURCE_DIR;
    if (fs::exists(root / "cl" / include.name))
        return include.name.ends_with(".cl")  ? "C++ never includes a .cl"
               : room.may_include.count("cl") ? ""
                                              : "may not include the headers of cl/";
    if (!fs::exists(root / "host" / include.name))
        return "is not written from the root of host/ or cl/";
    const std::string other = room_of(include.name);
    return other == room.name || room.may_include.count(other) ? "" : "may not include " + other + "/";
}

std::vector<std::string> problems_below(const std::string &top,
                                        const std::function<std::string(const fs::path &, const Include &)> &judge) {
    std::vector<std::string> problems;
    for (const auto &entry : fs::recursive_directory_iterator(fs::path(OPAL_SOURCE_DIR) / top)) {
        if (!entry.is_regular_file())
            continue;
        const fs::path file = fs::relative(entry.path(), OPAL_SOURCE_DIR);
        for (const Include &include : includes_of(opal::test::read_text(entry.path())))
            if (const std::string problem = judge(file, include); !problem.empty())
                problems.push_back(file.string() + ":" + std::to_string(include.line) + ": " + include.name + ": " +
                                   problem);
    }
    return problems;
}

} // namespace

TEST_CASE("Every folder of host/ includes only what stands below it", "[includes]") {
    const auto problems = problems_below("host", [](const fs::path &file, const Include &include) -> std::string {
        const std::string path = fs::relative(file, "host").generic_string();
        if (path == "main.cpp")
            return include.quoted && room_of(include.name) != "commands" && room_of(include.name) != "base"
                       ? "main includes commands and base only"
                       : "";
        const Room *room = find_room(room_of(path));
        return room ? problem_of(*room, include) : "host/" + room_of(path) + " is not in the table of this test";
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

TEST_CASE("Headers that are dear to compile have one door", "[includes]") {
    const std::map<std::string, std::string> doors = {{"CLI/CLI.hpp", "host/commands/parse.cpp"},
                                                      {"CL/opencl.hpp", "host/device/opencl.h"},
                                                      {"device/opencl.h", "a header of host/device/, or a .cpp"},
                                                      {"nlohmann/json.hpp", "a .cpp"}};
    const auto problems = problems_below("host", [&](const fs::path &file, const Include &include) -> std::string {
        const auto door = doors.find(include.name);
        const bool by_source = file.extension() == ".cpp";
        const bool may =
            door == doors.end() || door->second == file ||
            (include.name == "device/opencl.h" && (by_source || room_of(file.string()) == "host/device")) ||
            (include.name == "nlohmann/json.hpp" && by_source);
        return may ? "" : "is included by " + door->second + " only";
    });
    CHECK(problems == std::vector<std::string>{});
}

TEST_CASE("The rooms of host/ make no circle", "[includes]") {
    std::set<std::string> below = {"cl"};
    for (const Room &room : rooms) {
        for (const std::string &other : room.may_include)
            CHECK((below.count(other) || (room.name + " includes " + other + ", which is not below it").empty()));
        below.insert(room.name);
    }
}

TEST_CASE("A wrong include would be found", "[includes]") {
    CHECK(problem_of(*find_room("scene"), {"device/context.h", true, 1}) == "may not include device/");
    CHECK(problem_of(*find_room("flatten"), {"CL/opencl.hpp", false, 1}) == "must compile without OpenCL");
    CHECK(problem_of(*find_room("flatten"), {"kernels/render.cl", true, 1}) == "C++ never includes a .cl");
    CHECK(problem_of(*find_room("image"), {"shared/types.h", true, 1}) == "may not include the headers of cl/");
    CHECK(problem_of(*find_room("base"), {"error.h", true, 1}) == "is not written from the root of host/ or cl/");
    CHECK(problem_of(*find_room("render"), {"device/context.h", true, 1}).empty());
    CHECK(includes_of(" # include \"a.h\" // why\n\n#include <b>\n").back().line == 3);
}
