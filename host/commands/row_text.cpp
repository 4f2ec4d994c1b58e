#include "commands/row_text.h"

#include "base/table.h"
#include "base/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace opal {

namespace {

template <class T> std::string range_text(const Range<T> &range) {
    return fmt::format("{:g} to {:g}", double(range.least), double(range.greatest));
}
std::string range_text(const Range<unsigned> &range) { return fmt::format("{} to {}", range.least, range.greatest); }
std::string range_text(const Range<int> &range) { return fmt::format("{} to {}", range.least, range.greatest); }

// "1 to 65535", "above 0", "precise, fast"; empty where the help says it, or where there is no limit.
std::string possible_of(const OptionRow &row) {
    if (const auto *range = std::get_if<Range<int>>(&row.check))
        return range_text(*range);
    if (const auto *range = std::get_if<Range<unsigned>>(&row.check))
        return range_text(*range);
    if (const auto *range = std::get_if<Range<double>>(&row.check))
        return range_text(*range);
    if (std::holds_alternative<Positive>(row.check))
        return "above 0";
    const std::vector<std::string> choices = choices_of(row);
    const bool told = std::all_of(choices.begin(), choices.end(),
                                  [&](const std::string &name) { return row.help.find(name) != std::string::npos; });
    return told ? "" : joined(choices);
}

template <class T> std::string number_default(const OptionRow &row, T value) {
    const auto *range = std::get_if<Range<T>>(&row.check);
    const auto *whole = std::get_if<Range<int>>(&row.check);
    const auto *names = std::get_if<OneOf<int>>(&row.check);
    const bool refused =
        (range && (value < range->least || value > range->greatest)) ||
        (whole && (double(value) < whole->least || double(value) > whole->greatest)) ||
        (names && std::find(names->values.begin(), names->values.end(), int(value)) == names->values.end()) ||
        (std::holds_alternative<Positive>(row.check) && !(value > 0));
    return refused ? "" : fmt::format("{}", value);
}

// The default as `--help` shows it. Empty where the row's help gives it in brackets, or where nothing is the default.
std::string default_of(const OptionRow &row) {
    if (row.help.find('[') != std::string::npos)
        return "";
    if (!row.default_text.empty())
        return row.default_text;
    if (const auto *target = std::get_if<int *>(&row.target))
        return number_default(row, **target);
    if (const auto *target = std::get_if<unsigned *>(&row.target))
        return number_default(row, **target);
    if (const auto *target = std::get_if<double *>(&row.target))
        return number_default(row, **target);
    if (const auto *target = std::get_if<std::string *>(&row.target))
        return **target;
    if (const auto *target = std::get_if<std::vector<unsigned> *>(&row.target))
        return fmt::format("{}", fmt::join(**target, ","));
    return "";
}

} // namespace

std::vector<std::string> choices_of(const OptionRow &row) {
    if (const auto *names = std::get_if<OneOf<std::string>>(&row.check))
        return names->values;
    if (const auto *accepts = std::get_if<Accepts>(&row.check))
        return accepts->values;
    std::vector<std::string> choices;
    if (const auto *numbers = std::get_if<OneOf<int>>(&row.check))
        for (int number : numbers->values)
            choices.push_back(std::to_string(number));
    return choices;
}

bool takes_value(const OptionRow &row) { return !std::holds_alternative<bool *>(row.target); }

std::string type_of(const OptionRow &row) {
    if (!takes_value(row))
        return "";
    if (row.type)
        return *row.type;
    if (const std::string names = fmt::format("{}", fmt::join(choices_of(row), "|")); !names.empty())
        return names.size() < 20 ? names : "NAME";
    if (std::holds_alternative<std::filesystem::path *>(row.target))
        return "FILE";
    if (std::holds_alternative<double *>(row.target))
        return "NUMBER";
    if (std::holds_alternative<std::vector<unsigned> *>(row.target))
        return "N,...";
    const bool is_text = std::holds_alternative<std::string *>(row.target) ||
                         std::holds_alternative<std::vector<std::string> *>(row.target) ||
                         std::holds_alternative<MapEntry>(row.target);
    return is_text ? "TEXT" : "N";
}

std::string flags_text(const OptionRow &row) {
    const std::string type = is_positional(row) ? "" : type_of(row);
    return joined(flags_of(row)) + (type.empty() ? "" : " " + type);
}

std::string meaning_of(const OptionRow &row) {
    std::vector<std::string> lines = lines_of(row.help);
    if (const std::string possible = possible_of(row); !possible.empty())
        lines[0].insert(lines[0].ends_with(']') ? lines[0].rfind(" [") : lines[0].size(),
                        fmt::format(" ({})", possible));
    if (const std::string value = default_of(row); !value.empty())
        lines[0] += fmt::format(" [{}]", value);
    return fmt::format("{}", fmt::join(lines, "\n"));
}

bool is_strategy(const OptionRow &row) { return row.group && std::string(row.group) == strategy_group; }

std::string usage_of(const Command &command, const std::string &path) {
    std::string usage = "opal " + path;
    if (!command.subcommands.empty())
        return usage + " COMMAND";
    bool has_flags = false;
    for (const OptionRow &row : command.options)
        has_flags = has_flags || !is_positional(row);
    usage += has_flags ? " [OPTIONS]" : "";
    for (const OptionRow &row : command.options)
        if (is_positional(row))
            usage += fmt::format(fmt::runtime(row.required ? " {}{}" : " [{}]{}"), row.flags,
                                 std::holds_alternative<std::vector<std::string> *>(row.target) ? "..." : "");
    return usage;
}

std::vector<std::string> visible_names(const std::vector<Command> &commands) {
    std::vector<std::string> names;
    for (const Command &command : commands)
        if (!command.help.empty())
            names.push_back(command.name);
    return names;
}

std::vector<OptionRow> strategy_options_of(const std::vector<Command> &commands) {
    for (const Command &command : commands) {
        std::vector<OptionRow> rows;
        std::copy_if(command.options.begin(), command.options.end(), std::back_inserter(rows), is_strategy);
        if (!rows.empty())
            return rows;
    }
    return {};
}

void for_each_command(const std::vector<Command> &commands, const std::string &above,
                      const std::function<void(const Command &, const std::string &)> &use) {
    for (const Command &command : commands) {
        if (command.help.empty())
            continue;
        const std::string path = above.empty() ? command.name : above + " " + command.name;
        if (command.subcommands.empty())
            use(command, path);
        for_each_command(command.subcommands, path, use);
    }
}

} // namespace opal
