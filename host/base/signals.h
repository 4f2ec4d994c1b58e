// Interrupts: the first Ctrl-C asks the program to end and keep its results so far, the second ends it at once.
#pragma once

namespace opal {

// From now on SIGINT, SIGTERM and SIGHUP set the flag that interrupted() returns; SIGHUP not under nohup.
void watch_interrupts();
bool interrupted();

// The exit code of a command that was interrupted and has kept its results: 128 + the signal, as shells have it. 130
// for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
int interrupt_exit_code();

} // namespace opal
