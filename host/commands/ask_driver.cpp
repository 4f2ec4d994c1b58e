#include "device/ask_driver.h"
#include "commands/commands.h"

#include <memory>

namespace opal {

Command probe_platform_command() {
    auto library = std::make_shared<std::string>();
    return {.name = "probe-platform",
            .help = "",
            .options = {{.flags = "library", .target = library.get(), .help = "The driver's library"}},
            .run = [library] {
                answer_probe(*library);
                return 0;
            }};
}

} // namespace opal
