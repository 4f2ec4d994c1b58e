// The parser of the command line, by the rows of the commands.
#pragma once

#include "commands/command.h"

namespace opal {

// Sets the targets of the options in `words` (without the program's name) and returns the `run` of the command that
// they name. --help and --version print their text, and `run` then does nothing. Throws UsageError if the words are
// wrong. As usual in Unix: flags and arguments in any order, --flag VALUE or --flag=VALUE, -o VALUE or -oVALUE, and
// nothing is a flag after "--".
std::function<int()> parse(const std::vector<Command> &commands, const std::vector<std::string> &words);

} // namespace opal
