// The JSON that a command leaves with --json: one envelope, then the command's own keys (schemas/).
#pragma once

#include "commands/command.h"

#include <nlohmann/json_fwd.hpp>

namespace opal {

// --json FILE|-. what: "the statistics of the render".
OptionRow json_row(std::string &file, const std::string &what);

// Whether an output's name is "-", /dev/stdout, or another name of stdout.
bool names_stdout(const std::string &file);
// "-" as the system names it: /dev/stdout.
std::filesystem::path path_of(const std::string &file);

// The files that a command writes itself: those in the folder, or in a folder of it, whose names begin so.
struct OwnFiles {
    std::filesystem::path folder;
    std::vector<std::string> beginnings;
};

// Call before the work: a file that cannot be written is an error now, and for "-" stdout is kept for the JSON alone.
// Empty: nothing is asked for. Throws UsageError for a file of `own`.
void prepare_json(const std::string &file, const OwnFiles &own = {});

// Writes the envelope and the report's keys: `opal` (version), `command` (its name), `command_line`, `seconds` (with
// `wall`, since the process began, beside the report's own), `warnings`.
void write_json(const std::string &file, const std::string &command, nlohmann::json report);

} // namespace opal
