#include "base/json.h"

#include <nlohmann/json.hpp>

namespace opal {

std::string dump(const nlohmann::json &json, int indent) {
    return json.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

} // namespace opal
