// How this process was started, for the records that results keep.
#pragma once

#include <string>

namespace opal {

void set_command_line(int argc, const char *const *argv); // by main
const std::string &command_line(); // as a shell would take it: words with blanks or signs are quoted; empty in tests

// 'it'\''s': one word, quoted for a shell where it must be.
std::string shell_word(const std::string &word);

} // namespace opal
