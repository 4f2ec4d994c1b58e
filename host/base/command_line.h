// The command line of this process, which images and reports record, and its age.
#pragma once

#include <string>

namespace opal {

void set_command_line(int argc, const char *const *argv); // by main
const std::string &command_line();                        // quoted as for a shell; empty in tests

double seconds_since_start(); // of the process, by the wall clock

// The word as a shell reads it back: 'it'\''s'. Quoted only where it must be.
std::string shell_word(const std::string &word);

} // namespace opal
