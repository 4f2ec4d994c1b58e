#include "device/ask_driver.h"
#include "commands/commands.h"

#include <memory>

namespace opal {

Command probe_platform_command() {
    auto library = std::make_shared<std::string>();
    auto to_parent = std::make_shared<bool>(false);
    return {.name = "probe-platform",
            .help = "",
            .options = {{.flags = "library", .target = library.get(), .help = "The driver's library"},
                        {.flags = "--to-parent", .target = to_parent.get(), .help = "Answer the opal that started it"}},
            .run = [library, to_parent] {
                answer_probe(*library, *to_parent);
                return 0;
            }};
}

} // namespace opal
