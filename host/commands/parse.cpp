#include "commands/parse.h"

#include "base/error.h"
#include "base/log.h"
#include "base/table.h"
#include "base/units.h"
#include "base/values.h"
#include "commands/help.h"
#include "commands/row_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <set>
#include <sstream>

namespace opal {

namespace {

template <class... Targets> struct Overloaded : Targets... { using Targets::operator()...; };
template <class... Targets> Overloaded(Targets...) -> Overloaded<Targets...>;

// " (opal help sweep)"
std::string see(const std::string &path) { return fmt::format(" (see opal help{}{})", path.empty() ? "" : " ", path); }

// "did you mean 16000? " for 16k, and so on for 1e6 and 4.0; empty where no whole number is meant.
std::string meant_number(const std::string &text) {
    char *end = nullptr;
    double number = std::strtod(text.c_str(), &end);
    const std::string unit = end;
    if (end == text.c_str() || (!unit.empty() && unit != "k" && unit != "K" && unit != "M"))
        return "";
    number *= unit.empty() ? 1 : unit == "M" ? 1e6 : 1e3;
    const bool whole = std::abs(number) < std::numeric_limits<int>::max() && std::round(number) == number;
    return whole ? fmt::format("did you mean {:.0f}? ", number) : "";
}

template <class T> T whole_number(const std::string &text, T least, T greatest) {
    long long value = 0; // wider than T
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const std::string possible = fmt::format("possible: {} to {}", least, greatest);
    if (error == std::errc::invalid_argument || end != text.data() + text.size())
        throw Error(fmt::format("'{}' is no whole number; {}{}", text, meant_number(text), possible));
    if (error != std::errc() || value < least || value > greatest)
        throw Error(fmt::format("{} is out of range; {}", text, possible));
    return T(value);
}

template <class T> T whole_number(const std::string &text, const OptionCheck &check) {
    if (const auto *range = std::get_if<Range<T>>(&check))
        return whole_number(text, range->least, range->greatest);
    if (const auto *range = std::get_if<Range<int>>(&check))
        return whole_number(text, T(range->least), T(range->greatest));
    return whole_number(text, std::numeric_limits<T>::min(), std::numeric_limits<T>::max());
}

double real_number(const std::string &text, const OptionCheck &check) {
    if (std::holds_alternative<Duration>(check))
        return parse_seconds(text);
    const double value = parse_number(text);
    if (std::holds_alternative<Positive>(check) && !(value > 0))
        throw Error(text + " is out of range; possible: above 0");
    if (const auto *range = std::get_if<Range<double>>(&check);
        range && !(value >= range->least && value <= range->greatest))
        throw Error(fmt::format("{} is out of range; possible: {:g} to {:g}", text, range->least, range->greatest));
    return value;
}

void check_text(const std::string &text, const OptionCheck &check) {
    if (const auto *accepts = std::get_if<Accepts>(&check))
        accepts->parse(text);
    if (const auto *one_of = std::get_if<OneOf<std::string>>(&check))
        if (std::find(one_of->values.begin(), one_of->values.end(), text) == one_of->values.end())
            throw Error(unknown_name("value", text, one_of->values));
}

// Sets the target to the value of one word; a vector gets one more value.
void set(const OptionRow &row, const std::string &text) {
    std::visit(
        Overloaded{[](bool *target) { *target = true; },
                   [&](int *target) {
                       *target = whole_number<int>(text, row.check);
                       const auto *one_of = std::get_if<OneOf<int>>(&row.check);
                       if (one_of &&
                           std::find(one_of->values.begin(), one_of->values.end(), *target) == one_of->values.end())
                           throw Error(
                               fmt::format("{} is not possible; available: {}", text, fmt::join(one_of->values, ", ")));
                   },
                   [&](unsigned *target) { *target = whole_number<unsigned>(text, row.check); },
                   [&](double *target) { *target = real_number(text, row.check); },
                   [&](std::optional<unsigned> *target) { *target = whole_number<unsigned>(text, row.check); },
                   [&](std::vector<unsigned> *target) { target->push_back(whole_number<unsigned>(text, row.check)); },
                   [&](std::vector<std::string> *target) {
                       check_text(text, row.check);
                       target->push_back(text);
                   },
                   [&](std::map<std::string, std::string> *target) {
                       const size_t name_end = text.find('=');
                       const std::string name = text.substr(0, name_end);
                       if (name_end == text.npos || name.empty())
                           throw Error(fmt::format("'{}' is not NAME=VALUE", text));
                       if (!target->emplace(name, text.substr(name_end + 1)).second)
                           throw Error(name + " is given twice");
                   },
                   [&](const MapEntry &target) {
                       check_text(text, row.check);
                       (*target.map)[target.key] = text;
                   },
                   [&](auto *target) {
                       check_text(text, row.check);
                       *target = text;
                   }},
        row.target);
}

// May be given several times.
bool is_repeatable(const OptionRow &row) {
    return std::holds_alternative<std::map<std::string, std::string> *>(row.target) ||
           std::holds_alternative<std::vector<unsigned> *>(row.target) ||
           std::holds_alternative<std::vector<std::string> *>(row.target);
}

void clear(const OptionRow &row) {
    std::visit(Overloaded{[](std::vector<unsigned> *target) { target->clear(); },
                          [](std::vector<std::string> *target) { target->clear(); }, [](const auto &) {}},
               row.target);
}

class CommandParser {
public:
    CommandParser(const Command &command, std::string path) : command_(command), path_(std::move(path)) {}

    void parse(const std::vector<std::string> &words) {
        size_t i = 0;
        const auto next_value = [&](const std::string &flag) {
            if (i >= words.size() || is_flag(words[i]))
                refuse(flag + " needs a value");
            return words[i++];
        };
        bool flags_may_follow = true;
        while (i < words.size()) {
            const std::string word = words[i++];
            if (flags_may_follow && word == "--") {
                flags_may_follow = false;
            } else if (!flags_may_follow || word == "-" || !word.starts_with('-')) {
                give_argument(word);
            } else {
                const auto [row, flag, attached] = find_flag(word);
                begin(*row, flag);
                if (std::holds_alternative<bool *>(row->target)) {
                    if (attached)
                        refuse(flag + " takes no value");
                    give(*row, flag, "");
                } else {
                    give(*row, flag, attached ? *attached : next_value(flag));
                    while (row->many_words && i < words.size() && !words[i].starts_with('-'))
                        give(*row, flag, words[i++]);
                }
            }
        }
        finish();
    }

private:
    [[noreturn]] void refuse(const std::string &message) const { throw UsageError(message + see(path_)); }

    struct Found {
        const OptionRow *row;
        std::string flag;                    // as typed
        std::optional<std::string> attached; // its value, in the same word
    };
    Found find_flag(const std::string &word) const {
        const bool is_long = word.starts_with("--");
        const size_t end = is_long ? word.find('=') : 2;
        const std::string flag = word.substr(0, end);
        std::vector<std::string> known = {"--help", "-h"};
        for (const OptionRow &row : command_.options)
            for (const std::string &name : flags_of(row)) {
                if (name == flag && !is_positional(row))
                    return {&row, flag,
                            end >= word.size() ? std::nullopt : std::optional(word.substr(end + (is_long ? 1 : 0)))};
                if (name.starts_with('-'))
                    known.push_back(name);
            }
        const std::string nearest = nearest_name(flag, known);
        refuse(fmt::format("unknown flag '{}' of opal {}{}", flag, path_,
                           nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }

    bool is_flag(const std::string &word) const {
        return std::any_of(command_.options.begin(), command_.options.end(), [&](const OptionRow &row) {
            const std::vector<std::string> flags = flags_of(row);
            return !is_positional(row) && std::find(flags.begin(), flags.end(), word) != flags.end();
        });
    }

    // The flag stands on the line: a vector's default is forgotten, and a single value may be given once.
    void begin(const OptionRow &row, const std::string &flag) {
        const bool first = given_.insert(&row).second;
        if (first)
            clear(row);
        else if (!is_repeatable(row) && !std::holds_alternative<bool *>(row.target))
            refuse(flag + " is given twice");
        for (const OptionRow &other : command_.options)
            for (const auto &[a, b] : {std::pair(&row, &other), std::pair(&other, &row)})
                if (a->excludes && given_.contains(a) && given_.contains(b)) {
                    const std::vector<std::string> flags = flags_of(*b);
                    if (std::find(flags.begin(), flags.end(), a->excludes) != flags.end())
                        refuse(fmt::format("{} and {} exclude each other", flags_of(*a).back(), a->excludes));
                }
    }

    void give(const OptionRow &row, const std::string &flag, const std::string &value) const {
        try {
            if (!row.comma_separated)
                return set(row, value);
            std::istringstream words(value);
            for (std::string word; std::getline(words, word, ',');)
                set(row, word);
        } catch (const Error &error) {
            refuse(flag + ": " + error.what());
        }
    }

    void give_argument(const std::string &word) {
        for (const OptionRow &row : command_.options)
            if (is_positional(row) && (is_repeatable(row) || !given_.contains(&row))) {
                if (!given_.contains(&row))
                    begin(row, row.flags);
                return give(row, row.flags, word == "-" ? "/dev/stdin" : word);
            }
        refuse(fmt::format("'{}' is one argument too many for opal {}", word, path_));
    }

    void finish() const {
        for (const OptionRow &row : command_.options)
            if (row.required && !given_.contains(&row))
                refuse(fmt::format("opal {} needs {}", path_, row.flags));
    }

    const Command &command_;
    std::string path_; // "bench rays"
    std::set<const OptionRow *> given_;
};

std::function<int()> printed(const std::string &text) {
    print_text(text);
    return [] { return 0; };
}

bool asks_for_help(const std::vector<std::string> &words) {
    const auto end = std::find(words.begin(), words.end(), "--");
    return std::any_of(words.begin(), end, [](const std::string &w) { return w == "-h" || w == "--help"; });
}

std::string unknown_command(const std::string &word, const std::vector<Command> &commands) {
    return unknown_name("command", word, visible_names(commands));
}

} // namespace

std::vector<std::string> flags_of(const OptionRow &row) {
    std::vector<std::string> flags;
    std::istringstream names(row.flags);
    for (std::string name; std::getline(names, name, ',');)
        flags.push_back(name);
    return flags;
}

bool is_positional(const OptionRow &row) { return !row.flags.starts_with('-'); }

std::function<int()> parse(const std::vector<Command> &commands, const std::vector<std::string> &words) {
    if (words.empty())
        throw UsageError("no command is given" + see(""));
    if (words[0] == "-h" || words[0] == "--help")
        return printed(help_of(commands));
    if (words[0] == "-V" || words[0] == "--version")
        return printed("opal " OPAL_VERSION "\n");
    const std::vector<Command> *level = &commands;
    const Command *command = nullptr;
    std::string path;
    size_t used = 0;
    do {
        const std::string word = used < words.size() ? words[used] : "";
        const auto found = std::find_if(level->begin(), level->end(), [&](const Command &c) { return c.name == word; });
        if (found == level->end()) {
            if (command && asks_for_help(words))
                return printed(help_of(*command, path));
            throw UsageError((word.empty() || word.starts_with('-')
                                  ? fmt::format("opal{}{} needs a command: {}", path.empty() ? "" : " ", path,
                                                joined(visible_names(*level)))
                                  : unknown_command(word, *level)) +
                             see(path));
        }
        command = &*found;
        path += (path.empty() ? "" : " ") + command->name;
        used++;
        level = &command->subcommands;
    } while (!level->empty());
    const std::vector<std::string> rest(words.begin() + std::ptrdiff_t(used), words.end());
    if (asks_for_help(rest))
        return printed(help_of(*command, path));
    CommandParser(*command, path).parse(rest);
    return command->run;
}

} // namespace opal
