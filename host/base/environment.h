// Variables of the environment.
#pragma once

#include <optional>
#include <string>

namespace opal {

std::string variable(const char *name); // empty if it is not set

// Sets a variable while it lives, so that child processes after it do not inherit the value.
class ScopedVariable {
public:
    ScopedVariable(const char *name, const std::string &value); // name: lives as long
    ~ScopedVariable();
    ScopedVariable(const ScopedVariable &) = delete;
    ScopedVariable &operator=(const ScopedVariable &) = delete;

private:
    const char *name_;
    std::optional<std::string> before_;
};

} // namespace opal
