#include "device/ask_driver.h"
#include "commands/commands.h"

#include <memory>

namespace opal {

RunCommand setup_probe_platform(CLI::App &app) {
    auto library = std::make_shared<std::string>();
    app.add_option("library", *library, "The driver's library");
    return [library] {
        print_probe(*library);
        return 0;
    };
}

} // namespace opal
