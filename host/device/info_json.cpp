#include "device/info_json.h"

#include <nlohmann/json.hpp>

namespace opal {

#define OPAL_DEVICE_INFO(MEMBER)                                                                                       \
    MEMBER(index)                                                                                                      \
    MEMBER(platform)                                                                                                   \
    MEMBER(name) MEMBER(vendor) MEMBER(type) MEMBER(version) MEMBER(driver) MEMBER(memory) MEMBER(max_allocation)      \
        MEMBER(compute_units) MEMBER(fp64) MEMBER(vector_width) MEMBER(native_lanes) MEMBER(library)                   \
            MEMBER(platform_place) MEMBER(device_place) MEMBER(problem)

void to_json(nlohmann::json &json, const DeviceInfo &info) {
#define OPAL_WRITE(name) json[#name] = info.name;
    OPAL_DEVICE_INFO(OPAL_WRITE)
}

void from_json(const nlohmann::json &json, DeviceInfo &info) {
#define OPAL_READ(name) json.at(#name).get_to(info.name);
    OPAL_DEVICE_INFO(OPAL_READ)
}

} // namespace opal
