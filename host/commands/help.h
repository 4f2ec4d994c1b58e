// The help of commands, from their rows.
#pragma once

#include "commands/command.h"

namespace opal {

std::string short_help();                                  // of `opal` alone
std::string help_of(const std::vector<Command> &commands); // `opal --help`
// `opal COMMAND --help`. path: "bench rays".
std::string help_of(const Command &command, const std::string &path);
std::string strategies_help(const std::vector<Command> &commands); // the options of strategy_group

} // namespace opal
