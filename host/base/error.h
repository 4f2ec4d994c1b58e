// The one kind of failure that a user can cause or mend: bad input, a missing device, a full disk.
#pragma once

#include <stdexcept>
#include <string>

namespace opal {

// Thrown with one clear sentence that names the place (file:line:col, device, path) and what was possible.
// main prints "error: " and the sentence, and exits with 1.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace opal
