#include "base/json.h"
#include "base/log.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "device/info_json.h"

#include <fmt/format.h>

#include <memory>

namespace opal {

namespace {

struct DevicesOptions {
    std::string device, json;
    double time_limit = 20;
};

std::string memory_text(unsigned long long bytes) {
    return fmt::format("{:.1f} GiB", static_cast<double>(bytes) / (1 << 30));
}

std::string lanes_text(int lanes) { return fmt::format("{} lane{}", lanes, lanes == 1 ? "" : "s"); }

// The features of the device that a render uses.
std::string used_of(const DeviceInfo &d) {
    const std::string doubles =
        d.fp64 ? fmt::format(", double ({})", lanes_text(lanes_for(d, 0, MathMode::double_precision))) : "";
    return fmt::format("{}, work-groups of {}, buffers of at most {}; --math precise, fast{}",
                       lanes_text(d.native_lanes), group_size(d), bytes_text(d.max_allocation), doubles);
}

// The features that kernels do not use, and those that the device lacks.
std::string unused_of(const DeviceInfo &d) {
    std::string text = "local memory";
    if (d.native_lanes == 1 && d.vector_width > 1)
        text += fmt::format("; vectors of {} floats, as {}", d.vector_width,
                            d.type == "gpu" ? "a GPU runs a path a work-item" : "4 is the least");
    return text + (d.fp64 ? "" : "; --math double, as the device lacks cl_khr_fp64");
}

void print_table(const std::vector<DeviceInfo> &devices) {
    constexpr const char *row = "{:>5}  {:<11}  {:>5}  {:>10}  {:>4}  {:>5}  {}\n";
    print(row, "index", "type", "units", "memory", "fp64", "lanes", "name");
    for (const DeviceInfo &d : devices) {
        if (!d.problem.empty()) {
            print("{:>5}  {}{}: {}\n", d.index, d.platform, d.name.empty() ? "" : ", " + d.name, d.problem);
            continue;
        }
        print(row, d.index, d.type, d.compute_units, memory_text(d.memory), d.fp64 ? "yes" : "no", d.native_lanes,
              d.name);
        print("{:>7}{}; {}; driver {}\n", "", d.platform, d.version, d.driver);
        print("{:>7}used: {}\n{:>7}not used: {}\n", "", used_of(d), "", unused_of(d));
    }
}

int run_devices(const DevicesOptions &options) {
    prepare_json(options.json);
    const std::vector<DeviceInfo> devices = list_devices(options.time_limit, true);
    print_table(devices);
    const DevicePick pick = pick_device(options.device, devices);
    print("\nrender takes {}: {} ({}). --device takes an index, cpu, gpu, or part of a name.\n", pick.info.index,
          pick.info.name, pick.reason);
    write_json(options.json, "devices",
               object({{"devices", devices}, {"pick", pick.info.index}, {"reason", pick.reason}}));
    return 0;
}

} // namespace

Command devices_command() {
    auto o = std::make_shared<DevicesOptions>();
    return {.name = "devices",
            .help = "List every OpenCL platform and device, and which one `render` takes",
            .options = {json_row(o->json, "the list"),
                        {.flags = "--device",
                         .target = &o->device,
                         .help = "What `render` would take: an index, cpu, gpu, or part of a name",
                         .type = "DEVICE"},
                        {.flags = "--time-limit",
                         .target = &o->time_limit,
                         .help = "Seconds that a driver has to answer",
                         .check = Range{0.001, 3600.0}}},
            .examples = {"opal devices", "opal devices --device gpu --json -"},
            .run = [o] { return run_devices(*o); }};
}

} // namespace opal
