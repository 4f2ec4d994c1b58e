#include "commands/help.h"

#include "base/error.h"
#include "base/exit_code.h"
#include "base/log.h"
#include "base/table.h"
#include "base/values.h"
#include "commands/commands.h"
#include "commands/row_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace opal {

namespace {

constexpr size_t page_width = 100; // characters
constexpr size_t help_column = 28;

constexpr const char *about = "Opal " OPAL_VERSION ": a portable, physically based path tracer in OpenCL.\n";
const std::vector<std::string> first_examples = {"opal scenes/cbox_mis.xml", "opal scene-for model.obj > scene.xml"};

// `left`, and `text` in the column beside it. A line of the text keeps its indent where it goes on.
std::string two_columns(const std::string &left, const std::string &text) {
    std::string page = left;
    size_t at = left.size();
    if (at + 2 > help_column) {
        page += '\n';
        at = 0;
    }
    for (const std::string &line : lines_of(text)) {
        const size_t indent = help_column + std::min(line.find_first_not_of(' '), line.size());
        page.append(indent - std::min(indent, at), ' ');
        at = indent;
        std::istringstream words(line);
        bool first = true;
        for (std::string word; words >> word; first = false) {
            if (!first && at + 1 + word.size() > page_width) {
                page += '\n' + std::string(indent + 2, ' ');
                at = indent + 2;
            } else if (!first) {
                page += ' ';
                at++;
            }
            page += word;
            at += word.size();
        }
        page += '\n';
        at = 0;
    }
    return page;
}

std::string listed(const std::string &heading, const std::vector<std::string> &examples) {
    std::string text = examples.empty() ? "" : heading;
    for (const std::string &example : examples)
        text += "  " + example + "\n";
    return text;
}

std::string list_of(const std::vector<Command> &commands) {
    std::string text;
    for (const Command &command : commands)
        if (!command.help.empty())
            text += two_columns("  " + command.name, command.help);
    return text;
}

int run_help(const std::vector<std::string> &words) {
    std::vector<Command> level = all_commands();
    if (words.empty()) {
        print_text(help_of(level));
        return exit_done;
    }
    if (words[0] == "strategies") {
        print_text(strategies_help(level));
        return exit_done;
    }
    std::string path;
    Command command;
    for (const std::string &word : words) {
        const auto found = std::find_if(level.begin(), level.end(), [&](const Command &c) { return c.name == word; });
        if (found == level.end()) {
            std::vector<std::string> names = visible_names(level);
            if (path.empty())
                names.emplace_back("strategies");
            throw UsageError(unknown_name("command", word, names));
        }
        command = *found;
        path += (path.empty() ? "" : " ") + word;
        level = command.subcommands;
    }
    print_text(help_of(command, path));
    return exit_done;
}

} // namespace

std::string short_help() {
    return std::string(about) + "\n" +
           two_columns("  " + first_examples[0], "  renders a scene to cbox_mis.exr and cbox_mis.png") +
           two_columns("  " + first_examples[1], "  writes a scene around a mesh, to start from") +
           "\n`opal --help` lists the commands, `opal help COMMAND` explains one.\n";
}

std::string help_of(const std::vector<Command> &commands) {
    std::string text = std::string(about) +
                       "\nUsage: opal COMMAND [OPTIONS]\n       opal SCENE.xml is opal render SCENE.xml\n\nCommands\n" +
                       list_of(commands) + "\nOptions\n" +
                       two_columns("  -h, --help", "Print this, or a command's help") +
                       two_columns("  -V, --version", "Print the version; `opal version` says more") + "\nExit codes\n";
    for (const ExitCodeRow &row : exit_codes)
        text += two_columns(std::string("  ") + row.codes, row.meaning);
    return text + "\n" + listed("Examples\n", first_examples);
}

std::string help_of(const Command &command, const std::string &path) {
    std::string text = fmt::format("{}\n\nUsage: {}\n", command.help, usage_of(command, path));
    if (!command.subcommands.empty())
        return text + "\nCommands\n" + list_of(command.subcommands);
    std::string arguments, strategy;
    std::vector<std::string> groups = {"Options"};
    std::map<std::string, std::string> rows;
    for (const OptionRow &row : command.options) {
        const std::string line = two_columns("  " + flags_text(row), meaning_of(row));
        const std::string group = row.group ? row.group : "Options";
        if (is_positional(row))
            arguments += line;
        else if (is_strategy(row))
            strategy += (strategy.empty() ? "" : ", ") + flags_of(row).back();
        else
            rows[group] += line;
        if (!is_strategy(row) && std::find(groups.begin(), groups.end(), group) == groups.end())
            groups.push_back(group);
    }
    rows["Options"] += two_columns("  -h, --help", "Print this");
    if (!arguments.empty())
        text += "\nArguments\n" + arguments;
    for (const std::string &group : groups)
        text += "\n" + group + "\n" + rows[group];
    if (!strategy.empty())
        text += "\nStrategy: what the scene's XML says, or these (opal help strategies)\n" + two_columns("", strategy);
    return text + listed("\nExamples\n", command.examples);
}

std::string strategies_help(const std::vector<Command> &commands) {
    std::string text = "The strategy of a render: what the scene's XML says, unless the command line says other.\n\n";
    for (const OptionRow &row : strategy_options_of(commands))
        text += two_columns("  " + flags_text(row), meaning_of(row));
    return text + "\nExamples\n  opal render scenes/cbox_mis.xml --lighting emitter --max-depth 5\n"
                  "  opal sweep scenes/cbox_mis.xml --strategies course\n";
}

Command help_command() {
    auto words = std::make_shared<std::vector<std::string>>();
    return {.name = "help",
            .help = "Explain a command, or the options of the strategy",
            .options = {{.flags = "COMMAND",
                         .target = words.get(),
                         .help = "A command, as in bench rays, or strategies [a list of the commands]"}},
            .examples = {"opal help render", "opal help strategies"},
            .run = [words] { return run_help(*words); }};
}

} // namespace opal
