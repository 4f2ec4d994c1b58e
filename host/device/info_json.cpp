#include "device/info_json.h"

#include "base/json.h"

namespace opal {

namespace {

// Calls visit(name, member) for each member; Info is a DeviceInfo or a const one.
template <class Info, class Visit> void visit_members(Info &info, const Visit &visit) {
    visit("index", info.index);
    visit("platform", info.platform);
    visit("name", info.name);
    visit("vendor", info.vendor);
    visit("type", info.type);
    visit("version", info.version);
    visit("driver", info.driver);
    visit("memory", info.memory);
    visit("max_allocation", info.max_allocation);
    visit("compute_units", info.compute_units);
    visit("fp64", info.fp64);
    visit("vector_width", info.vector_width);
    visit("native_lanes", info.native_lanes);
    visit("library", info.library);
    visit("platform_place", info.platform_place);
    visit("device_place", info.device_place);
    visit("problem", info.problem);
}

} // namespace

void to_json(nlohmann::json &json, const DeviceInfo &info) {
    visit_members(info, [&](const char *name, const auto &value) { json[name] = value; });
}

void from_json(const nlohmann::json &json, DeviceInfo &info) {
    visit_members(info, [&](const char *name, auto &value) { json.at(name).get_to(value); });
}

} // namespace opal
