#include "commands/commands.h"

namespace opal {

std::vector<Command> all_commands() {
    return {render_command(), scene_for_command(),      devices_command(),       inspect_command(),
            sweep_command(),  bench_command(),          compare_command(),       verify_command(),
            test_command(),   warp_command(),           extremes_command(),      selftest_command(),
            cache_command(),  help_command(),           version_command(),       completion_command(),
            man_command(),    selftest_group_command(), probe_platform_command()};
}

} // namespace opal
