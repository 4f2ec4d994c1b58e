// The commands of `opal`: one function a file of this folder, named after it.
#pragma once

#include "commands/command.h"

namespace opal {

Command bench_command();
Command cache_command();
Command compare_command();
Command completion_command();
Command devices_command();
Command extremes_command();
Command help_command();
Command inspect_command();
Command man_command();
Command probe_platform_command(); // hidden, in ask_driver.cpp; see device/ask_driver.h
Command render_command();
Command scene_for_command();
Command selftest_command();
Command selftest_group_command(); // hidden, in selftest.cpp
Command sweep_command();
Command test_command();
Command verify_command();
Command version_command();
Command warp_command();

// All of them, in the order of the help.
std::vector<Command> all_commands();

} // namespace opal
