#include "base/json.h"

#include "base/printable.h"

#include <algorithm>

namespace opal {

nlohmann::json object(std::initializer_list<JsonMember> members) {
    nlohmann::json result = nlohmann::json::object();
    for (const JsonMember &member : members)
        result[member.key] = member.value;
    return result;
}

namespace {

// The same with all strings in UTF-8.
nlohmann::json in_utf8(const nlohmann::json &json) {
    if (json.is_string())
        return as_utf8(json.get_ref<const std::string &>());
    nlohmann::json result = json;
    if (json.is_object()) {
        result = nlohmann::json::object();
        for (const auto &[key, value] : json.items())
            result[as_utf8(key)] = in_utf8(value);
    } else if (json.is_array())
        std::ranges::transform(json, result.begin(), in_utf8);
    return result;
}

} // namespace

std::string dump(const nlohmann::json &json, int indent) {
    try {
        return printable_json(json.dump(indent));
    } catch (const nlohmann::json::type_error &) { // a string is not in UTF-8
        return printable_json(in_utf8(json).dump(indent));
    }
}

nlohmann::json parse_json(const std::string &text) { return nlohmann::json::parse(text); }

} // namespace opal
