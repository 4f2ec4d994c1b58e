#include "base/environment.h"

#include <cstdlib>

namespace opal {

std::string variable(const char *name) {
    const char *const text = std::getenv(name);
    return text ? text : "";
}

ScopedVariable::ScopedVariable(const char *name, const std::string &value) : name_(name) {
    if (const char *const before = std::getenv(name))
        before_ = before;
    setenv(name, value.c_str(), 1);
}

ScopedVariable::~ScopedVariable() { before_ ? setenv(name_, before_->c_str(), 1) : unsetenv(name_); }

} // namespace opal
