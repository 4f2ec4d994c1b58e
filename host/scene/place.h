// A place in a file, for messages.
#pragma once

#include <string>

namespace opal {

// Line and column count from 1; 0: unknown.
struct SourcePlace {
    std::string file;
    int line = 0, column = 0;
    std::string text() const; // "file:line:col"
};

} // namespace opal
