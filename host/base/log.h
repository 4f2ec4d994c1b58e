// Printing: results go to stdout, messages to stderr, a line each. Nothing here throws: a full disk or a closed
// terminal costs the message, never the render. No character of a name or value steers the terminal, and long values
// are shortened (base/printable.h). Warnings are kept for the JSON reports and the tests.
#pragma once

#include <fmt/core.h>

#include <exception>
#include <string>
#include <vector>

namespace opal {

void set_quiet(bool quiet); // --quiet silences info and notes, never warnings
bool is_quiet();
void info(const std::string &line);
void set_verbose(bool verbose);       // --verbose
void detail(const std::string &text); // printed only with --verbose
void note(const std::string &line);   // prints "note: ...": harmless, and worth knowing once; silent with --quiet
void warn(const std::string &line);   // prints "warning: ..."; of more than 1000 only that there are more
const std::vector<std::string> &warnings();
void forget_warnings();                       // those so far: the next render's reports begin anew
void tell_error(const char *line);            // prints "error: ..."
void tell_error(const std::exception &error); // the same; a line for each failure of an ErrorList
// Prints to stderr without a line end: a progress bar. The next message or result takes its place.
void show(const std::string &text);
inline constexpr const char *clear_line = "\r\033[K"; // for a terminal: shown alone, it takes the bar away

// A result, to stdout at once.
void print_text(const std::string &text);
template <class... Arguments> void print(fmt::format_string<Arguments...> text, Arguments &&...arguments) {
    print_text(fmt::format(text, std::forward<Arguments>(arguments)...));
}
void free_stdout();                       // from now on results go to stderr, and print_data alone to stdout
void print_data(const std::string &text); // to stdout in any case, as it is: a file that was asked for as "-"
int output_error();                       // errno of the first result that could not be written to stdout; 0: none

// Call first in main. From then on a failed write does not end the process by SIGPIPE or SIGXFSZ. A closed stdin,
// stdout or stderr is opened anew: else the next file would get its number, and printed text would end up in that file.
void prepare_streams();

} // namespace opal
