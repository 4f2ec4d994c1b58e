// Child processes. Code that may crash or hang (drivers, checks of drivers) runs in one.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace opal {

// How a process ended.
struct Ending {
    bool in_time = true; // false: it was killed at its deadline
    int signal = 0;      // the signal that ended it, or 0
    int exit_code = 0;
    std::string signal_name() const; // "Aborted"
};

class ChildProcess {
public:
    using Clock = std::chrono::steady_clock;

    // Starts `binary` with these arguments and drops its stderr. Throws Error where it cannot be started.
    ChildProcess(const std::filesystem::path &binary, const std::vector<std::string> &arguments);
    ChildProcess(ChildProcess &&other) noexcept;
    ChildProcess &operator=(ChildProcess &&) = delete;
    ~ChildProcess(); // kills it if it still runs

    Ending finish(Clock::time_point deadline);        // waits until it ends, or kills it at the deadline
    const std::string &said() const { return said_; } // its stdout, after finish

private:
    bool read_until(Clock::time_point deadline);
    pid_t process_ = -1;
    int pipe_ = -1;
    std::string said_;
};

} // namespace opal
