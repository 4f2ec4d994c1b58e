// Ctrl-C: the first asks the program to end with what it has, the second ends it.
#pragma once

namespace opal {

constexpr int exit_interrupted = 130; // the exit code of a render that was interrupted and wrote what it had

void watch_interrupts(); // from now on SIGINT and SIGTERM set the flag
bool interrupted();

} // namespace opal
