#include "commands/commands.h"
#include "device/probe.h"

#include <memory>

namespace opal {

RunCommand setup_probe_platform(CLI::App &app) {
    auto icd = std::make_shared<std::string>();
    app.add_option("icd", *icd, "The driver's .icd file");
    return [icd] {
        print_probe(*icd);
        return 0;
    };
}

} // namespace opal
