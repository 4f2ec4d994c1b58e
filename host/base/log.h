// What Opal says: results to stdout, all else to stderr, a line each. Nothing here throws because it cannot print: a
// log on a full disk or a closed terminal costs the message, never the render. Warnings are kept, so that tests and
// JSON can show them.
#pragma once

#include <fmt/core.h>

#include <string>
#include <vector>

namespace opal {

void set_quiet(bool quiet); // --quiet silences info, never warnings
bool is_quiet();
void info(const std::string &line);
void set_verbose(bool verbose);       // --verbose
void detail(const std::string &text); // said only where --verbose asks for it
void warn(const std::string &line);   // prints "warning: ..."
const std::vector<std::string> &warnings();
void tell_error(const char *line);  // prints "error: ..."; for what ends a process
void show(const std::string &text); // to stderr as it is: a progress bar

// A result, to stdout at once.
void print_text(const std::string &text);
template <class... Arguments> void print(fmt::format_string<Arguments...> text, Arguments &&...arguments) {
    print_text(fmt::format(text, std::forward<Arguments>(arguments)...));
}
int output_error(); // the errno of the first result that stdout did not take; 0: it took all

// For the start of main. A write that fails does not end the process by SIGPIPE or SIGXFSZ from now on. Where stdin,
// stdout or stderr is closed, its number is taken, so that no file of ours gets it and with it what is printed.
void prepare_streams();

} // namespace opal
