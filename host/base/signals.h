// Interrupts: the first Ctrl-C asks the program to end and keep its results so far, the second ends it at once.
#pragma once

#include "base/error.h"

#include <atomic>

namespace opal {

// From now on SIGINT, SIGTERM and SIGHUP set the flag that interrupted() returns; SIGHUP not under nohup. The second
// such signal ends the process.
void watch_interrupts();
bool interrupted();

// The exit code of a command that was interrupted and has kept its results: 128 + the signal, as shells have it. 130
// for Ctrl-C, 143 for SIGTERM, 129 for SIGHUP.
int interrupt_exit_code();

// A signal ended a wait, as that for a FIFO's reader. main exits with interrupt_exit_code.
class InterruptedWait : public Error {
public:
    using Error::Error;
};

// The name of a file that a signal which ends the process (SIGINT, SIGTERM, SIGHUP, SIGQUIT) removes while this object
// lives.
class RemovedBySignal {
public:
    // folder: a descriptor. Both must live as long as this.
    RemovedBySignal(int folder, const char *name);
    ~RemovedBySignal();
    RemovedBySignal(const RemovedBySignal &) = delete;
    RemovedBySignal &operator=(const RemovedBySignal &) = delete;
    void remove() const; // what the handler does

private:
    const int folder_;
    const char *const name_;
    std::atomic<const RemovedBySignal *> *slot_ = nullptr; // nullptr: none was free
};

} // namespace opal
