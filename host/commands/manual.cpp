// opal man: the manual page, in roff, from the rows of the commands.
#include "base/exit_code.h"
#include "base/log.h"
#include "base/values.h"
#include "commands/commands.h"
#include "commands/row_text.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

// Text that roff prints as it is.
std::string escaped(const std::string &text) {
    std::string result;
    bool line_begins = true;
    for (const char c : text) {
        if (line_begins && (c == '.' || c == '\''))
            result += "\\&";
        result += c == '\\' ? "\\e" : c == '-' ? "\\-" : std::string(1, c);
        line_begins = c == '\n';
    }
    return result;
}

// Lines of their own, as the help has them.
std::string broken(const std::string &text) {
    std::string result;
    for (const std::string &line : lines_of(text))
        result += (result.empty() ? "" : ".br\n") +
                  escaped(line.substr(std::min(line.find_first_not_of(' '), line.size()))) + "\n";
    return result;
}

std::string entry(const std::string &name, const std::string &text) {
    return ".TP\n\\fB" + escaped(name) + "\\fR\n" + broken(text);
}

std::string command_text(const Command &command, const std::string &path) {
    std::string text = fmt::format(".SS \"{}\"\n{}", escaped(usage_of(command, path)), broken(command.help));
    for (const OptionRow &row : command.options)
        if (!is_strategy(row))
            text += entry(flags_text(row), meaning_of(row));
    for (const std::string &example : command.examples)
        text += ".PP\n.EX\n" + escaped(example) + "\n.EE\n";
    return text;
}

std::string man_page(const std::vector<Command> &commands) {
    std::string text = ".TH OPAL 1 \"\" \"opal " OPAL_VERSION "\" \"User commands\"\n"
                       ".SH NAME\nopal \\- a portable, physically based path tracer in OpenCL\n"
                       ".SH SYNOPSIS\n.B opal\nCOMMAND [OPTIONS]\n.br\n.B opal\nSCENE.xml [OPTIONS]\n"
                       ".SH DESCRIPTION\nOpal renders scenes in the format of Nori or of Mitsuba on any OpenCL "
                       "device, and measures how right and how fast that is. `opal SCENE.xml` is `opal render "
                       "SCENE.xml`.\n.SH COMMANDS\n";
    for_each_command(commands, "",
                     [&](const Command &command, const std::string &path) { text += command_text(command, path); });
    text += ".SH STRATEGY\nThe strategy of a render: what the scene's XML says, unless the command line says other. "
            "Commands that load scenes have these options, too.\n";
    for (const OptionRow &row : strategy_options_of(commands))
        text += entry(flags_text(row), meaning_of(row));
    text += ".SH EXIT STATUS\n";
    for (const ExitCodeRow &row : exit_codes)
        text += entry(row.codes, row.meaning);
    return text;
}

} // namespace

Command man_command() {
    return {.name = "man",
            .help = "Print the manual page, in roff: opal man | man -l -",
            .examples = {"opal man > opal.1", "opal help render"},
            .run = [] {
                print_text(man_page(all_commands()));
                return exit_done;
            }};
}

} // namespace opal
