#include "device/sources.h"

#include "base/error.h"
#include "base/read_file.h"
#include "device/embedded.h"
#include "flatten/flat_scene.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <sstream>

namespace opal {

namespace {

// A call that passes lanes passes them through memory, so every function is inlined: 10 to 15 % of the time of a render
// on PoCL. GPUs' compilers do so unasked. Clang knows this form of the attribute from version 14 on at the latest;
// NVIDIA's front end is a clang that is older, and refuses it. A simulator that knows no inlined code (Oclgrind) is
// given OPAL_KEEP_CALLS.
constexpr const char *inline_all = "#if defined(__clang__) && __clang_major__ >= 14 && !defined(OPAL_KEEP_CALLS)\n"
                                   "#pragma clang attribute push(__attribute__((always_inline)), apply_to = function)\n"
                                   "#endif\n";
constexpr const char *inline_end = "\n#if defined(__clang__) && __clang_major__ >= 14 && !defined(OPAL_KEEP_CALLS)\n"
                                   "#pragma clang attribute pop\n"
                                   "#endif\n";

// The name between the quotes of `#include "name"`; empty where the line is no such directive.
std::string included_file(const std::string &line) {
    size_t at = line.find_first_not_of(" \t");
    if (at == std::string::npos || line[at] != '#')
        return {};
    at = line.find_first_not_of(" \t", at + 1);
    if (at == std::string::npos || line.compare(at, 7, "include") != 0)
        return {};
    const size_t open = line.find('"', at + 7);
    const size_t close = open == std::string::npos ? open : line.find('"', open + 1);
    return close == std::string::npos ? std::string() : line.substr(open + 1, close - open - 1);
}

std::string names_of(const std::map<std::string, std::string> &files) {
    std::vector<std::string> names;
    for (const auto &[name, text] : files)
        names.push_back(name);
    return fmt::format("{}", fmt::join(names, ", "));
}

class Expansion {
public:
    Expansion(const std::map<std::string, std::string> &files, int lanes) : files_(files), lanes_(lanes) {}

    void append(const std::string &name, const std::string &asked_from) {
        if (name.ends_with("/*.cl"))
            return append_folder(name.substr(0, name.size() - 4), asked_from);
        const auto found = files_.find(name);
        if (found == files_.end())
            throw Error(fmt::format("{}: no file \"{}\" below cl/; available: {}", asked_from, name, names_of(files_)));
        if (left_out(name)) {
            text_ += '\n'; // an empty line keeps the numbers of the lines
            return;
        }
        done_.insert(name);
        std::istringstream lines(found->second);
        std::string line;
        text_ += fmt::format("#line 1 \"cl/{}\"\n", name);
        for (int number = 1; std::getline(lines, line); ++number)
            append_line(name, line, number);
    }

    std::string take() { return std::move(text_); }

private:
    // A file that is expanded already, or that is for programs of another width.
    bool left_out(const std::string &name) const {
        const char *other_width = lanes_ == 1 ? "many_lanes/" : "one_lane/";
        return done_.count(name) != 0 || name.find(other_width) != std::string::npos;
    }

    // The .cl files of a folder, "bsdfs/", in the order of their names, without those that are expanded already.
    void append_folder(const std::string &folder, const std::string &asked_from) {
        for (const auto &[name, text] : files_)
            if (name.starts_with(folder) && name.ends_with(".cl") &&
                name.find('/', folder.size()) == std::string::npos && !left_out(name))
                append(name, asked_from);
    }

    void append_line(const std::string &name, const std::string &line, int number) {
        const std::string include = included_file(line);
        if (include.empty()) {
            text_ += line + '\n';
            return;
        }
        const bool expanded = !left_out(include);
        append(include, fmt::format("cl/{}:{}", name, number));
        if (expanded)
            text_ += fmt::format("#line {} \"cl/{}\"\n", number + 1, name);
    }

    const std::map<std::string, std::string> &files_;
    const int lanes_;
    std::set<std::string> done_;
    std::string text_;
};

} // namespace

const Sources &Sources::embedded() {
    static const Sources sources{embedded_files()};
    return sources;
}

Sources Sources::from_folder(const std::string &folder) {
    namespace fs = std::filesystem;
    if (!fs::is_directory(folder))
        throw Error(fmt::format("{}: no such folder (--cl-dir takes a copy of Opal's cl/)", folder));
    Sources sources;
    for (const auto &entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file() && (entry.path().extension() == ".cl" || entry.path().extension() == ".h"))
            sources.files[fs::relative(entry.path(), folder).generic_string()] = read_file(entry.path());
    if (sources.files.empty())
        throw Error(fmt::format("{}: holds no .cl file (--cl-dir takes a copy of Opal's cl/)", folder));
    return sources;
}

std::string Sources::expand(const std::string &file, int lanes) const {
    Expansion expansion(files, lanes);
    expansion.append(file, "program");
    return expansion.take();
}

std::string program_text(const Features &features, const BuildOptions &options, const Sources &sources) {
    std::string text = fmt::format(
        "#define LANES {}\n#define OPAL_DOUBLE {}\n#define OPAL_FAST {}\n#define OPAL_COUNT_TESTS {}\n", options.lanes,
        int(options.math == MathMode::double_precision), int(options.math == MathMode::fast), int(options.count_tests));
    for (const char *stage : {"traversal", "sampling"})
        text += fmt::format("#define OPAL_REPEAT_{} {}\n", stage, int(options.repeat_stage == stage));
    if (!options.cache_salt.empty())
        text +=
            fmt::format("typedef int opal_note_{};\n", options.cache_salt); // drivers see through comments and defines
#define OPAL_FEATURE_ROW(name, shown)                                                                                  \
    text += fmt::format("#define OPAL_HAS_" #name " {}\n", int(features[FEATURE_##name]));
    OPAL_FEATURES
#undef OPAL_FEATURE_ROW
#define OPAL_TEXTURED_ROW(name, traits)                                                                                \
    text += fmt::format("#define OPAL_TEXTURED_bsdf_" #name " {}\n", features.textured[BSDF_##name]);                  \
    text += fmt::format("#define OPAL_NONZERO_bsdf_" #name " {}\n", features.nonzero[BSDF_##name]);
    OPAL_ALL_BSDFS(OPAL_TEXTURED_ROW)
#undef OPAL_TEXTURED_ROW
    text += fmt::format("#define OPAL_TEXTURE_KINDS {}\n", features.texture_kinds);
    text += fmt::format("#define OPAL_BITMAP_FORMS {}\n", features.bitmap_forms);
    text += fmt::format("#define OPAL_PERTURBATIONS {}\n", features.perturbations);
#define OPAL_AXIS_DEFINE(axis, needs, help)                                                                            \
    text += fmt::format("#define OPAL_AXIS_" #axis " {}\n", features.axes[AXIS_##axis]);
    OPAL_AXES(OPAL_AXIS_DEFINE)
#undef OPAL_AXIS_DEFINE
    const std::string loop = fmt::format("kernels/{}.cl", features.loop);
    const std::string body = sources.expand(options.kernels.empty() ? loop : options.kernels, options.lanes);
    return text + inline_all + body + inline_end;
}

} // namespace opal
