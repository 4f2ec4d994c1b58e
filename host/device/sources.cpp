#include "device/program.h"

#include "base/error.h"
#include "base/read_file.h"
#include "device/embedded.h"

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <sstream>

namespace opal {

namespace {

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
        const auto found = files_.find(name);
        if (found == files_.end())
            throw Error(fmt::format("{}: no file \"{}\" below cl/; available: {}", asked_from, name, names_of(files_)));
        if (left_out(name)) {
            text_ += '\n'; // keeps the place of the directive
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
    // What is there already, and what is for programs of another width.
    bool left_out(const std::string &name) const {
        const char *other_width = lanes_ == 1 ? "many_lanes/" : "one_lane/";
        return done_.count(name) != 0 || name.find(other_width) != std::string::npos;
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

} // namespace opal
