// A command of `opal` as data: its name, its options as rows, and the function that runs it.
// The parser (commands/parse.h) reads these rows, as everything else does that lists options.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace opal {

// A target: the entry of a map, made if the option is given: map["lighting"] = "mis".
struct MapEntry {
    std::map<std::string, std::string> *map;
    std::string key;
};

// The variable that an option sets. A bool is a flag without a value, a vector takes several values, a map those given
// as NAME=VALUE, an optional stays empty if the option is not given.
using OptionTarget = std::variant<bool *, std::map<std::string, std::string> *, int *, unsigned *, double *,
                                  std::string *, std::filesystem::path *, MapEntry, std::optional<unsigned> *,
                                  std::vector<unsigned> *, std::vector<std::string> *>;

// Checks of a value.
template <class T> struct Range {
    T least, greatest; // inclusive
};
template <class T> Range(T, T) -> Range<T>; // clang deduces no aggregates before version 17
template <class T> struct OneOf { std::vector<T> values; };
struct Positive {};
struct Duration {}; // a number of seconds above 0, or with a unit: 60s, 2min, 1h
struct Accepts {    // the texts for which `parse` throws no Error
    std::function<void(const std::string &)> parse;
    std::vector<std::string> values{}; // names among them
};
using OptionCheck = std::variant<std::monostate, Range<int>, Range<unsigned>, Range<double>, OneOf<int>,
                                 OneOf<std::string>, Positive, Duration, Accepts>;

struct OptionRow {
    std::string flags; // "-o,--output"; without dashes a positional argument, "SCENE.xml"
    OptionTarget target;
    std::string help;
    OptionCheck check{};
    std::optional<std::string> type{}; // name of the value in the help; none: by the target
    const char *group = nullptr;       // the heading in the help; nullptr: Options
    const char *excludes = nullptr;    // a flag that excludes this one
    std::string default_text{};        // the default in the help; empty: the target's value, unless `check` refuses it
    bool required = false;
    bool comma_separated = false; // values of a vector may be one word: 4,16,64
    bool many_words = false;      // a vector takes all words up to the next flag
};

struct Command {
    std::string name;
    std::string help; // one sentence; empty: hidden in `opal --help`
    std::vector<OptionRow> options{};
    std::vector<std::string> examples{}; // two, for the help
    std::function<int()> run{};          // returns the process's exit code; throws Error; empty: see subcommands
    std::vector<Command> subcommands{};  // one of them must be named
};

// The flags of a row: "-o" and "--output"; the name of a positional argument.
std::vector<std::string> flags_of(const OptionRow &row);
bool is_positional(const OptionRow &row);

// The heading of options that are explained once, by `opal help strategies`.
inline constexpr const char *strategy_group = "Strategy";

// `rows` and then `more`.
inline std::vector<OptionRow> append(std::vector<OptionRow> rows, std::vector<OptionRow> more) {
    rows.insert(rows.end(), more.begin(), more.end());
    return rows;
}

} // namespace opal
