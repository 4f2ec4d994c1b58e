// JSON as text.
#pragma once

#include <nlohmann/json.hpp>

#include <string>

namespace opal {

// Text of a JSON value. Names of files and drivers need not be UTF-8, but JSON must be: bytes that are not become
// U+FFFD, as in browsers and editors. indent -1: one line.
inline std::string dump(const nlohmann::json &json, int indent = -1) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace opal
