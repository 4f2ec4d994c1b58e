// What Opal says beside its results: to stderr, one line each. Warnings are kept, so that tests and JSON can show them.
#pragma once

#include <string>
#include <vector>

namespace opal {

void set_quiet(bool quiet);             // --quiet silences info, never warnings
bool is_quiet();
void info(const std::string &line);
void set_verbose(bool verbose);         // --verbose
void detail(const std::string &text);   // said only where --verbose asks for it
void warn(const std::string &line);     // prints "warning: ..."
const std::vector<std::string> &warnings();

} // namespace opal
