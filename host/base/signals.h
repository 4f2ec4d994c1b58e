// Interrupts: the first Ctrl-C asks the program to end and keep its results so far, the second ends it at once.
#pragma once

namespace opal {

constexpr int exit_interrupted = 130; // exit code of an interrupted render whose image was written

void watch_interrupts(); // from now on SIGINT and SIGTERM set the flag that interrupted() returns
bool interrupted();

} // namespace opal
