// Error: a failure that a user can cause or mend, such as bad input, a missing device, a full disk.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace opal {

// Its text is one sentence that names the place (file:line:col, device, path) and what was possible. main prints it
// after "error: " and exits with 1 (base/exit_code.h).
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// The command line is wrong; main exits with 2.
class UsageError : public Error {
public:
    using Error::Error;
};

// Runs `make`, which reads what the command line says; an Error in it is the command line's.
template <class Make> auto as_usage(Make make) {
    try {
        return make();
    } catch (const Error &error) {
        throw UsageError(error.what());
    }
}

// Several failures at once, a line each. main prints each after "error: ".
class ErrorList : public Error {
public:
    explicit ErrorList(std::vector<std::string> lines) : Error(text_of(lines)), lines_(std::move(lines)) {}
    const std::vector<std::string> &lines() const { return lines_; }

private:
    static std::string text_of(const std::vector<std::string> &lines) {
        std::string text;
        for (const std::string &line : lines)
            text += (text.empty() ? "" : "\n") + line;
        return text;
    }
    std::vector<std::string> lines_;
};

} // namespace opal
