// opal completion: what a shell needs to complete commands, flags and values, from the rows of the commands.
#include "base/exit_code.h"
#include "base/log.h"
#include "commands/commands.h"
#include "commands/row_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace opal {

namespace {

std::string replaced(std::string text, const std::string &what, const std::string &with) {
    for (size_t at = text.find(what); at != text.npos; at = text.find(what, at + with.size()))
        text.replace(at, what.size(), with);
    return text;
}

std::string words_of(const std::vector<std::string> &words) { return fmt::format("{}", fmt::join(words, " ")); }

std::string flags_of_command(const Command &command) {
    std::vector<std::string> flags = {"--help"};
    for (const OptionRow &row : command.options)
        if (!is_positional(row))
            for (const std::string &flag : flags_of(row))
                flags.push_back(flag);
    return words_of(flags);
}

// The names that an option or argument of the command takes, by "PATH FLAG"; an argument's flag is empty.
std::map<std::string, std::string> choices_by_flag(const Command &command, const std::string &path) {
    std::map<std::string, std::string> choices;
    for (const OptionRow &row : command.options)
        if (const std::vector<std::string> names = choices_of(row); !names.empty())
            for (const std::string &flag : flags_of(row))
                choices[path + " " + (is_positional(row) ? "" : flag)] = words_of(names);
    return choices;
}

// bash completes a value after its flag, a flag after "-", a command's name first, and files else.
std::string bash_completion(const std::vector<Command> &commands) {
    std::string flags, values;
    for_each_command(commands, "", [&](const Command &command, const std::string &path) {
        flags += fmt::format("        '{}') flags='{}' ;;\n", path, flags_of_command(command));
        for (const auto &[flag, names] : choices_by_flag(command, path))
            values += fmt::format("        '{}') values='{}' ;;\n", flag, names);
    });
    std::string groups;
    for (const Command &command : commands)
        if (!command.subcommands.empty())
            groups +=
                fmt::format("        {}) names='{}' ;;\n", command.name, words_of(visible_names(command.subcommands)));
    std::string text = R"(# bash completion for opal; written by `opal completion bash`
_opal() {
    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} path=${COMP_WORDS[1]} names= flags= values=
    case $path in
GROUPS    esac
    if [[ -n $names ]]; then
        if [[ $COMP_CWORD -eq 2 ]]; then
            COMPREPLY=($(compgen -W "$names" -- "$word"))
            return
        fi
        path="$path ${COMP_WORDS[2]}"
    fi
    [[ $path == *.xml ]] && path=render
    if [[ $COMP_CWORD -eq 1 ]]; then
        COMPREPLY=($(compgen -W 'COMMANDS' -- "$word") $(compgen -f -X '!*.xml' -- "$word") $(compgen -d -- "$word"))
        return
    fi
    case $path in
FLAGS    esac
    if [[ $word == -* ]]; then
        COMPREPLY=($(compgen -W "$flags" -- "$word"))
        return
    fi
    [[ $before == -* ]] || before=
    case "$path $before" in
VALUES    esac
    if [[ -n $values ]]; then
        COMPREPLY=($(compgen -W "$values" -- "$word"))
    else
        COMPREPLY=($(compgen -f -- "$word"))
    fi
}
complete -o filenames -F _opal opal
)";
    text = replaced(text, "GROUPS", groups);
    text = replaced(text, "COMMANDS", words_of(visible_names(commands)));
    text = replaced(text, "FLAGS", flags);
    return replaced(text, "VALUES", values);
}

// The first line of a text, without what means something to zsh's _arguments.
std::string zsh_text(const std::string &text) {
    std::string line = text.substr(0, text.find('\n'));
    for (const char *special : {"'", "[", "]", ":", "`", "\\", "\""})
        line = replaced(line, special, "");
    return line;
}

// '(-o --output)'{-o,--output}'[help]:FILE:_files'
std::string zsh_spec(const OptionRow &row) {
    const std::vector<std::string> choices = choices_of(row), flags = flags_of(row);
    const std::string action = choices.empty() ? "_files" : "(" + words_of(choices) + ")";
    if (is_positional(row))
        return fmt::format("'*:{}:{}'", zsh_text(row.flags), action);
    std::string spec;
    for (const std::string &flag : flags)
        spec += fmt::format("{}'{}[{}]{}'", spec.empty() ? "" : " ", flag, zsh_text(row.help),
                            takes_value(row) ? fmt::format(":{}:{}", zsh_text(type_of(row)), action) : "");
    return spec;
}

std::string zsh_completion(const std::vector<Command> &commands) {
    std::string names, groups, cases;
    for (const Command &command : commands) {
        if (command.help.empty())
            continue;
        names += fmt::format("        '{}:{}'\n", command.name, zsh_text(command.help));
        if (!command.subcommands.empty())
            groups += fmt::format("        {}) subcommands=({}) ;;\n", command.name,
                                  words_of(visible_names(command.subcommands)));
    }
    for_each_command(commands, "", [&](const Command &command, const std::string &path) {
        cases += fmt::format("        '{}') specs=(", path);
        for (const OptionRow &row : command.options)
            cases += "\n            " + zsh_spec(row);
        cases += ") ;;\n";
    });
    std::string text = R"(#compdef opal
# zsh completion for opal; written by `opal completion zsh`
_opal() {
    local -a commands subcommands specs
    commands=(
NAMES    )
    if (( CURRENT == 2 )); then
        _describe command commands
        _files -g '*.xml'
        return
    fi
    local at="${words[2]}"
    case $at in
GROUPS    esac
    if (( $#subcommands )); then
        if (( CURRENT == 3 )); then
            _values command $subcommands
            return
        fi
        at="$at ${words[3]}"
        shift words
        (( CURRENT-- ))
    fi
    [[ $at == *.xml ]] && at=render
    shift words
    (( CURRENT-- ))
    case $at in
CASES    esac
    _arguments '--help[Print the help]' $specs
}
_opal "$@"
)";
    text = replaced(text, "NAMES", names);
    text = replaced(text, "GROUPS", groups);
    return replaced(text, "CASES", cases);
}

} // namespace

Command completion_command() {
    auto shell = std::make_shared<std::string>();
    return {.name = "completion",
            .help = "Print what bash or zsh needs to complete commands, flags and values",
            .options = {{.flags = "SHELL",
                         .target = shell.get(),
                         .help = "bash or zsh",
                         .check = OneOf<std::string>{{"bash", "zsh"}},
                         .required = true}},
            .examples = {"opal completion bash > ~/.local/share/bash-completion/completions/opal",
                         "opal completion zsh > ~/.zfunc/_opal"},
            .run = [shell] {
                print_text(*shell == "bash" ? bash_completion(all_commands()) : zsh_completion(all_commands()));
                return exit_done;
            }};
}

} // namespace opal
