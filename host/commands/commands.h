// The commands of `opal`. Each adds its options to its own sub-command and returns what runs it.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace opal {

using RunCommand = std::function<int()>; // the process's exit code; throws Error

// One function a file of this folder, named after it. Called for every command before the command line is parsed.
RunCommand setup_bench(CLI::App &app);
RunCommand setup_compare(CLI::App &app);
RunCommand setup_devices(CLI::App &app);
RunCommand setup_extremes(CLI::App &app);
RunCommand setup_inspect(CLI::App &app);
RunCommand setup_probe_platform(CLI::App &app); // hidden; see device/ask_driver.h
RunCommand setup_render(CLI::App &app);
RunCommand setup_sweep(CLI::App &app);
RunCommand setup_selftest(CLI::App &app);
RunCommand setup_selftest_group(CLI::App &app); // hidden; in selftest.cpp
RunCommand setup_test(CLI::App &app);
RunCommand setup_verify(CLI::App &app);
RunCommand setup_warp(CLI::App &app);

} // namespace opal
