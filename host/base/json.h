// JSON values and their text. Only .cpp files include this, as the library's header is slow to compile; headers include
// <nlohmann/json_fwd.hpp>.
#pragma once

#include <nlohmann/json.hpp>

#include <concepts>
#include <initializer_list>
#include <string>
#include <utility>

// A whole number of C++ is read from a whole number of JSON that it can hold. The library's own conversion cuts
// fractions off and lets others overflow.
template <std::integral T>
requires(!std::same_as<T, bool>) struct nlohmann::adl_serializer<T> {
    static void to_json(json &to, T number) { nlohmann::to_json(to, number); }
    static void from_json(const json &from, T &number) {
        const auto take = [&](auto value) {
            if (!std::in_range<T>(value))
                throw json::out_of_range::create(406, "the number " + from.dump() + " is out of range", &from);
            number = static_cast<T>(value);
        };
        if (const auto *positive = from.get_ptr<const json::number_unsigned_t *>())
            take(*positive);
        else if (const auto *negative = from.get_ptr<const json::number_integer_t *>())
            take(*negative);
        else
            throw json::type_error::create(302, "type must be a whole number, but is " + from.dump(), &from);
    }
};

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
