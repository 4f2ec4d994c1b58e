// JSON as text.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include <string>

namespace opal {

// Text of a JSON value, whatever bytes its strings hold: names of files and drivers need not be UTF-8, JSON must be.
// What is not becomes U+FFFD, as in browsers and editors; the names are there to be read, and no file is opened by
// them. indent -1: one line.
std::string dump(const nlohmann::json &json, int indent = -1);

} // namespace opal
