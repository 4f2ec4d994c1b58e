#include "base/json.h"

namespace opal {

nlohmann::json object(std::initializer_list<JsonMember> members) {
    nlohmann::json result = nlohmann::json::object();
    for (const JsonMember &member : members)
        result[member.key] = member.value;
    return result;
}

std::string dump(const nlohmann::json &json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

nlohmann::json parse_json(const std::string &text) { return nlohmann::json::parse(text); }

} // namespace opal
