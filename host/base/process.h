// Running a program as a process of its own, whose crash or hang is a fact to report and not a disaster.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace opal {

// How a process ended.
struct Ending {
    bool in_time = true; // else it was killed at its deadline
    int signal = 0;      // that ended it, or 0
    int exit_code = 0;
    std::string signal_name() const; // "Aborted"
};

class ChildProcess {
public:
    using Clock = std::chrono::steady_clock;

    // Starts `binary` with these arguments; what it says to stderr is dropped. Throws Error where that is not possible.
    ChildProcess(const std::filesystem::path &binary, const std::vector<std::string> &arguments);
    ChildProcess(ChildProcess &&other) noexcept;
    ChildProcess &operator=(ChildProcess &&) = delete;
    ~ChildProcess(); // kills it if it still runs

    Ending finish(Clock::time_point deadline);        // waits for it, or kills it at the deadline
    const std::string &said() const { return said_; } // to stdout, until finish

private:
    bool read_until(Clock::time_point deadline);
    pid_t process_ = -1;
    int pipe_ = -1;
    std::string said_;
};

} // namespace opal
