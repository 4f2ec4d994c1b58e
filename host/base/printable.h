// Text of others (names, values, drivers' remarks) as messages and files of text may hold it.
#pragma once

#include <string>
#include <string_view>

namespace opal {

// Bytes that are not UTF-8 become \xe4, as text: for JSON and headers of EXRs.
std::string as_utf8(std::string_view text);

// as_utf8; and what would steer a terminal becomes text, too: control characters but the tab and the line feed (\x1b,
// \x7f, \u009b), and those that turn the direction of writing (\u202e).
std::string printable(std::string_view text);

// As printable, for the text of a JSON value, where the same characters are written as JSON writes them (\u001b).
std::string printable_json(std::string json);

// The text if it has at most that many bytes; else its beginning and its end, and how much was left out.
std::string shortened(std::string_view text, size_t most = 200);

// shortened, in single quotes: a value in a message.
std::string quoted(std::string_view text);

// A message, as it is printed and kept: words and quoted values of more than 200 bytes, and then lines of more than
// 2000, are shortened.
std::string shortened_message(const std::string &message);

// A message in one line: line feeds, which names may hold, become \n.
std::string in_one_line(std::string message);

} // namespace opal
