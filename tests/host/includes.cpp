// Who may include whom: main includes commands and base, commands all rooms, and each room only rooms below it. Device
// files do likewise, and each includes the files whose names it uses.
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
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
    {"read", {"base", "cl", "image", "scene"}},
    {"read/nori", {"base", "cl", "scene", "read"}},
    {"read/mitsuba", {"base", "cl", "scene", "read"}},
    {"read/formats", {"base", "scene", "read", "read/nori", "read/mitsuba"}},
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

// The floors of cl/, from the ground up: folders, and files that are floors of their own.
const std::vector<Room> floors = {
    {"integrators/list.h", {}},
    {"shared", {"integrators/list.h"}},
    {"shapes/list.h", {"shared"}},
    {"bsdfs/list.h", {"shared"}},
    {"emitters/list.h", {"shared"}},
    {"cameras/list.h", {"shared"}},
    {"textures/list.h", {"shared"}},
    {"scene_tables.h",
     {"shared", "shapes/list.h", "bsdfs/list.h", "emitters/list.h", "cameras/list.h", "textures/list.h"}},
    {"core", {}},
    {"scene.cl", {"shared", "emitters/list.h", "scene_tables.h", "core"}},
    {"surface.cl", {"shared", "core", "scene.cl"}},
    {"shapes", {"shared", "shapes/list.h", "core", "scene.cl", "surface.cl"}},
    {"trace", {"shared", "shapes/list.h", "core", "scene.cl", "shapes"}},
    {"cameras", {"cameras/list.h", "core", "scene.cl"}},
    {"film", {"shared", "core", "scene.cl", "cameras"}},
    {"textures", {"shared", "textures/list.h", "core", "scene.cl", "surface.cl"}},
    {"parameters.cl", {"shared", "core", "scene.cl", "textures"}},
    {"bsdfs", {"shared", "bsdfs/list.h", "core", "scene.cl", "surface.cl", "textures", "parameters.cl"}},
    {"emitters", {"shared", "emitters/list.h", "core", "scene.cl", "surface.cl", "shapes", "textures"}},
    {"integrators", {"shared", "core", "scene.cl", "surface.cl", "shapes", "trace", "bsdfs", "emitters"}},
    {"kernels",
     {"shared", "shapes/list.h", "bsdfs/list.h", "emitters/list.h", "cameras/list.h", "core", "scene.cl", "surface.cl",
      "shapes", "trace", "cameras", "film", "bsdfs", "emitters", "integrators"}},
};

using Files = std::map<std::string, std::string>; // "core/math.cl" -> text

Files device_files() {
    Files files;
    const fs::path root = fs::path(OPAL_SOURCE_DIR) / "cl";
    for (const auto &entry : fs::recursive_directory_iterator(root))
        if (entry.path().extension() == ".cl" || entry.path().extension() == ".h")
            files[fs::relative(entry.path(), root).generic_string()] = opal::test::read_text(entry.path());
    return files;
}

// The floor of a file below cl/. The headers of kinds, "bsdfs/phong.h", lie on that of their list.
const Room *floor_of(const std::string &path) {
    const std::string folder = path.substr(0, path.find('/'));
    const auto named = [](const std::string &name) {
        const auto floor = std::find_if(floors.begin(), floors.end(), [&](const Room &f) { return f.name == name; });
        return floor == floors.end() ? nullptr : &*floor;
    };
    const Room *list = path.ends_with(".h") ? named(folder + "/list.h") : nullptr;
    return list ? list : named(path) ? named(path) : named(folder);
}

// What is wrong with one include of the device file `path`; empty: nothing.
std::string floor_problem(const std::string &path, const std::string &included) {
    if (included.ends_with("/*.cl"))
        return floor_problem(path, room_of(included) + "/interface.cl");
    const Room *from = floor_of(path), *to = floor_of(included);
    if (!from || !to)
        return (from ? included : path) + " is not in the table of this test";
    return from == to || from->may_include.count(to->name) ? "" : "may not include " + to->name;
}

// The files that an include brings: all .cl files of a folder but `from` where it is a pattern, "bsdfs/*.cl".
std::vector<std::string> files_of(const Files &files, const std::string &from, const Include &include) {
    if (!include.name.ends_with("/*.cl"))
        return {include.name};
    const std::string folder = include.name.substr(0, include.name.size() - 5);
    std::vector<std::string> names;
    for (const auto &[name, text] : files)
        if (name != from && name.ends_with(".cl") && room_of(name) == folder)
            names.push_back(name);
    return names;
}

// The files that a device file includes, and those that these include; itself only where it includes itself.
std::set<std::string> all_includes(const Files &files, const std::string &path) {
    std::set<std::string> seen;
    std::vector<std::string> waiting = {path};
    while (!waiting.empty()) {
        const auto file = files.find(waiting.back());
        waiting.pop_back();
        if (file == files.end())
            continue;
        for (const Include &include : includes_of(file->second))
            for (const std::string &name : files_of(files, file->first, include))
                if (seen.insert(name).second)
                    waiting.push_back(name);
    }
    return seen;
}

// A device file's text without comments, strings, include directives and the names of members.
std::string bare(const std::string &text) {
    static const std::regex left_out(R"re(/\*[^]*?\*/|//[^\n]*|"[^"\n]*"|#\s*include[^\n]*|(\.|->)\s*[A-Za-z_]\w*)re");
    return std::regex_replace(text, left_out, " ");
}

std::set<std::string> matches_of(const std::string &text, const std::string &pattern) {
    const std::regex name(pattern);
    std::set<std::string> names;
    for (std::sregex_iterator match(text.begin(), text.end(), name), end; match != end; ++match)
        names.insert((*match)[1]);
    return names;
}

// The functions that a device file defines, and its other names: types, macros, members of enums.
std::set<std::string> functions_of(const std::string &text) { return matches_of(text, R"(\nstatic [\w\s*]*?(\w+)\()"); }
std::set<std::string> other_names_of(const std::string &text) {
    std::set<std::string> names = matches_of(text, R"(\n\s*#\s*define (\w+))");
    names.merge(matches_of(text, R"(\n(?:typedef struct [^\n]*)?\}\s*(\w+);)"));
    names.merge(matches_of(text, R"(\ntypedef [^{;]*?(\w+);)"));
    for (const std::string &members : matches_of(text, R"(enum \{([^}]*)\})"))
        names.merge(matches_of("," + members + ",", R"(,\s*([A-Z]\w*)\s*(?:=[^,]*)?(?=,))"));
    return names;
}

// The uses of names in .cl files that neither they nor the files that they include themselves define.
std::vector<std::string> missing_includes(const Files &files) {
    std::map<std::string, std::set<std::string>> functions, others; // name -> files that define it
    Files bare_files;
    for (const auto &[path, text] : files) {
        const std::string &body = bare_files[path] = "\n" + bare(text);
        for (const std::string &name : functions_of(body))
            functions[name].insert(path);
        for (const std::string &name : other_names_of(body))
            others[name].insert(path);
    }
    std::vector<std::string> missing;
    for (const auto &[path, body] : bare_files) {
        if (!path.ends_with(".cl"))
            continue;
        std::set<std::string> known = {path};
        for (const Include &include : includes_of(files.at(path)))
            for (const std::string &name : files_of(files, path, include))
                known.insert(name);
        const auto judge = [&](const std::set<std::string> &used, const auto &definitions) {
            for (const std::string &name : used) {
                const auto defined = definitions.find(name);
                if (defined != definitions.end() &&
                    std::none_of(defined->second.begin(), defined->second.end(),
                                 [&](const std::string &file) { return known.count(file) != 0; }))
                    missing.push_back(path + " uses " + name + " of " + *defined->second.begin());
            }
        };
        judge(matches_of(body, R"(\b([A-Za-z_]\w*)\()"), functions);
        judge(matches_of(body, R"(\b([A-Za-z_]\w*)\b)"), others);
    }
    return missing;
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

TEST_CASE("Every device file includes only what stands below it, headers only headers", "[includes]") {
    const auto problems = problems_below("cl", [](const fs::path &file, const Include &include) -> std::string {
        if (!include.quoted)
            return "has no place in code that the device reads too";
        const std::string path = include.name.ends_with("/*.cl") ? room_of(include.name) : include.name;
        if (!fs::exists(fs::path(OPAL_SOURCE_DIR) / "cl" / path))
            return "is not written from the root of cl/";
        if (file.extension() == ".h" && include.name.ends_with(".cl"))
            return "a header never includes a .cl";
        return file.extension() == ".md" ? "" : floor_problem(fs::relative(file, "cl").generic_string(), include.name);
    });
    CHECK(problems == std::vector<std::string>{});
}

TEST_CASE("Headers that are dear to compile have one door", "[includes]") {
    const std::map<std::string, std::string> doors = {{"CL/opencl.hpp", "host/device/opencl.h"},
                                                      {"device/opencl.h", "a header of host/device/, or a .cpp"},
                                                      {"nlohmann/json.hpp", "host/base/json.h"},
                                                      {"base/json.h", "a .cpp"}};
    const auto problems = problems_below("host", [&](const fs::path &file, const Include &include) -> std::string {
        const auto door = doors.find(include.name);
        const bool by_source = file.extension() == ".cpp";
        const bool may =
            door == doors.end() || door->second == file ||
            (include.name == "device/opencl.h" && (by_source || room_of(file.string()) == "host/device")) ||
            (include.name == "base/json.h" && by_source);
        return may ? "" : "is included by " + door->second + " only";
    });
    CHECK(problems == std::vector<std::string>{});
}

TEST_CASE("The floors of cl/ make no circle, nor do its files", "[includes]") {
    std::set<std::string> below;
    for (const Room &floor : floors) {
        for (const std::string &other : floor.may_include)
            CHECK((below.count(other) || (floor.name + " includes " + other + ", which is not below it").empty()));
        below.insert(floor.name);
    }
    const Files files = device_files();
    for (const auto &[path, text] : files) {
        INFO(path);
        CHECK_FALSE(all_includes(files, path).count(path));
    }
}

TEST_CASE("Every device file includes the files whose names it uses", "[includes]") {
    CHECK(missing_includes(device_files()) == std::vector<std::string>{});
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
    CHECK(floor_problem("core/math.cl", "scene.cl") == "may not include scene.cl");
    CHECK(floor_problem("scene.cl", "trace/trace.cl") == "may not include trace");
    CHECK(floor_problem("bsdfs/list.h", "bsdfs/interface.cl") == "may not include bsdfs");
    CHECK(floor_problem("integrators/path.cl", "bsdfs/dispatch.cl").empty());
    CHECK(floor_problem("colour.cl", "core/math.cl") == "colour.cl is not in the table of this test");
    CHECK(all_includes({{"a.cl", "#include \"b.cl\"\n"}, {"b.cl", "#include \"a.cl\"\n"}}, "a.cl").count("a.cl"));
}

TEST_CASE("A name that no include brings would be found", "[includes]") {
    const Files files = {
        {"list.h", "enum { KIND_a, KIND_b = 2, KINDS };\ntypedef struct { int x; } Record;\n"},
        {"math.cl", "#define PI 3\ntypedef struct {\n    int s;\n} Frame;\nstatic int half_of(int x) { return x; }\n"},
        {"all.cl", "#include \"list.h\"\n#include \"math.cl\"\nRecord r; Frame f; int x = PI + half_of(KINDS);\n"},
        {"none.cl", "int x = half_of(KIND_b); // PI\nRecord r;\nint half_of = f.PI;\n"},
        {"nearly.cl", "#include \"all.cl\"\nint x = PI;\n"},
    };
    CHECK(missing_includes(files) ==
          std::vector<std::string>{"nearly.cl uses PI of math.cl", "none.cl uses half_of of math.cl",
                                   "none.cl uses KIND_b of list.h", "none.cl uses Record of list.h"});
}
