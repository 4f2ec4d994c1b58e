// What a row of options says, as text: for help, man page and shell completions.
#pragma once

#include "commands/command.h"

namespace opal {

bool takes_value(const OptionRow &row);
bool is_strategy(const OptionRow &row); // of strategy_group

// The names that the value may have; none where it is no name.
std::vector<std::string> choices_of(const OptionRow &row);
std::string type_of(const OptionRow &row);    // "FILE", "N", "precise|fast"; empty for a flag without a value
std::string flags_text(const OptionRow &row); // "-o, --output FILE"
// The help of a row with its range and its default, which come from what the parser checks and sets.
std::string meaning_of(const OptionRow &row);

std::string usage_of(const Command &command, const std::string &path); // "opal bench rays [OPTIONS] SCENE.xml"

std::vector<std::string> visible_names(const std::vector<Command> &commands); // without hidden ones
// The rows of strategy_group, of the first command that has some.
std::vector<OptionRow> strategy_options_of(const std::vector<Command> &commands);
// Runs `use` with each visible command that runs, and its path: "bench rays".
void for_each_command(const std::vector<Command> &commands, const std::string &above,
                      const std::function<void(const Command &, const std::string &)> &use);

} // namespace opal
