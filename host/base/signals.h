// Interrupts: the first Ctrl-C asks the program to end and keep its results so far, a later one ends it at once.
#pragma once

#include "base/error.h"

#include <string>

namespace opal {

// Call first in main: under nohup, SIGHUP is blocked. Drivers' compilers install handlers of their own, which remove
// their temporary files when it comes.
void keep_hangup_ignored();

// From now on SIGINT, SIGTERM and SIGHUP set the flag that interrupted() returns; SIGHUP not under nohup. Another
// such signal ends the process, unless it comes within 0.5 s of the first.
void watch_interrupts();
bool interrupted();

// While one lives, a signal ends the process at once: for work that cannot be stopped and that keeps nothing, such as
// compiling.
class EndedBySignals {
public:
    EndedBySignals();
    ~EndedBySignals();
    EndedBySignals(const EndedBySignals &) = delete;
    EndedBySignals &operator=(const EndedBySignals &) = delete;

private:
    const int before_;
};

// The exit code of a command that was interrupted and has kept its results: 128 + the signal, as shells have it. 130
// for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
int interrupt_exit_code();

// A signal ended a wait, as that for a FIFO's reader. main exits with interrupt_exit_code.
class InterruptedWait : public Error {
public:
    using Error::Error;
};

// A file that a signal which ends the process (SIGINT, SIGTERM, SIGHUP, SIGQUIT) removes while this object lives.
class RemovedBySignal {
public:
    // folder: a descriptor, open as long as this lives. name: of at most 31 bytes.
    RemovedBySignal(int folder, const std::string &name);
    ~RemovedBySignal();
    RemovedBySignal(const RemovedBySignal &) = delete;
    RemovedBySignal &operator=(const RemovedBySignal &) = delete;

private:
    int slot_ = -1; // -1: none was free
};

} // namespace opal
