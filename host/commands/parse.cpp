#include "commands/parse.h"

#include "base/error.h"
#include "base/log.h"

#include <CLI/CLI.hpp>

namespace opal {

namespace {

CLI::Option *add(CLI::App &app, const OptionRow &row, bool *target) {
    return app.add_flag(row.flags, *target, row.help);
}
CLI::Option *add(CLI::App &app, const OptionRow &row, const MapEntry &entry) {
    return app.add_option_function<std::string>(
        row.flags, [entry](const std::string &value) { (*entry.map)[entry.key] = value; }, row.help);
}
CLI::Option *add(CLI::App &app, const OptionRow &row, std::optional<unsigned> *target) {
    return app.add_option_function<unsigned>(
        row.flags, [target](unsigned value) { *target = value; }, row.help);
}
template <class T> CLI::Option *add(CLI::App &app, const OptionRow &row, T *target) {
    return app.add_option(row.flags, *target, row.help);
}

void add_check(CLI::Option &, std::monostate) {}
template <class T> void add_check(CLI::Option &option, const Range<T> &range) {
    option.check(CLI::Range(range.least, range.greatest));
}
template <class T> void add_check(CLI::Option &option, const OneOf<T> &one_of) {
    option.check(CLI::IsMember(one_of.values));
}
void add_check(CLI::Option &option, Positive) { option.check(CLI::PositiveNumber); }
void add_check(CLI::Option &option, Duration) {
    option.transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}}));
    option.check(CLI::PositiveNumber);
}

void add_row(CLI::App &app, const OptionRow &row) {
    CLI::Option *option = std::visit([&](const auto &target) { return add(app, row, target); }, row.target);
    std::visit([&](const auto &check) { add_check(*option, check); }, row.check);
    option->required(row.required);
    if (row.type)
        option->type_name(*row.type);
    if (row.group)
        option->group(row.group);
    if (row.excludes)
        option->excludes(app.get_option(row.excludes));
    if (!row.default_text.empty())
        option->default_str(row.default_text);
    if (row.comma_separated)
        option->delimiter(',');
    if (row.many_words)
        option->expected(1, -1);
}

using Runs = std::map<const CLI::App *, std::function<int()>>;

void add_command(CLI::App &parent, const Command &command, Runs &runs) {
    CLI::App *app = parent.add_subcommand(command.name, command.help);
    if (command.help.empty())
        app->group("");
    for (const OptionRow &row : command.options)
        add_row(*app, row);
    if (!command.subcommands.empty())
        app->require_subcommand(1);
    for (const Command &sub : command.subcommands)
        add_command(*app, sub, runs);
    runs[app] = command.run;
}

} // namespace

std::function<int()> parse(const std::vector<Command> &commands, const std::vector<std::string> &words) {
    CLI::App app("Opal " OPAL_VERSION ": a portable, physically based path tracer in OpenCL.\n"
                 "`opal SCENE.xml` is `opal render SCENE.xml`.",
                 "opal");
    app.set_version_flag("--version", "opal " OPAL_VERSION);
    app.set_help_flag("-h,--help", "Print this and exit");
    app.require_subcommand(1);
    app.option_defaults()->always_capture_default();
    Runs runs;
    for (const Command &command : commands)
        add_command(app, command, runs);
    try {
        app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::Success &asked) { // --help, --version
        std::ostringstream text;
        const int code = app.exit(asked, text, text);
        print_text(text.str());
        return [code] { return code; };
    } catch (const CLI::ParseError &error) {
        throw Error(std::string(error.what()) + " (opal --help, or opal COMMAND --help, lists what there is)");
    }
    const CLI::App *chosen = &app;
    while (!chosen->get_subcommands().empty())
        chosen = chosen->get_subcommands().front();
    return runs.at(chosen);
}

} // namespace opal
