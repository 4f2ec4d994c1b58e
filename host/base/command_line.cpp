#include "base/command_line.h"

#include <algorithm>
#include <cctype>
#include <chrono>

namespace opal {

namespace {

std::string kept;
const auto start = std::chrono::steady_clock::now(); // static data begin before main

bool is_plain(unsigned char c) {
    return std::isalnum(c) || std::string("_-./=,:+@%").find(char(c)) != std::string::npos;
}

} // namespace

std::string shell_word(const std::string &word) {
    if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain))
        return word;
    std::string quoted = "'";
    for (const char c : word)
        if (c == '\'')
            quoted += "'\\''";
        else
            quoted += c;
    quoted += '\'';
    return quoted;
}

void set_command_line(int argc, const char *const *argv) {
    kept.clear();
    for (int i = 0; i < argc; ++i) {
        if (i)
            kept += ' ';
        kept += shell_word(argv[i]);
    }
}

const std::string &command_line() { return kept; }

double seconds_since_start() { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(); }

} // namespace opal
