// JSON values and their text. Only .cpp files include this, as the library's header is slow to compile; headers include
// <nlohmann/json_fwd.hpp>.
#pragma once

#include <nlohmann/json.hpp>

#include <initializer_list>
#include <string>

namespace opal {

struct JsonMember {
    const char *key;
    nlohmann::json value;
};

// An object: object({{"spp", 4}, {"seed", 1}}). nlohmann's own initialiser list compiles to new code for each length of
// a key, and makes an array of pairs where it cannot tell.
nlohmann::json object(std::initializer_list<JsonMember> members);

// Text of a JSON value. Names of files and drivers need not be UTF-8, but JSON must be: bytes that are not become text,
// \xe4 (as_utf8). It holds no character that steers a terminal (printable_json). indent -1: one line.
std::string dump(const nlohmann::json &json, int indent = -1);

// The value of a text. Throws nlohmann::json::exception where it is no JSON.
nlohmann::json parse_json(const std::string &text);

} // namespace opal
