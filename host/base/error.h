// Error: a failure that a user can cause or mend, such as bad input, a missing device, a full disk.
#pragma once

#include <stdexcept>
#include <string>

namespace opal {

// Its text is one sentence that names the place (file:line:col, device, path) and what was possible. main prints it
// after "error: " and exits with 1.
class Error : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

} // namespace opal
