// Child processes of Opal that answer in lines. Code that may crash, hang or print (drivers, checks of drivers) runs in
// one.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include <sys/types.h>

namespace opal {

// How a process ended.
struct Ending {
    bool in_time = true;   // false: it was killed at its deadline
    bool too_long = false; // its answer: it was killed
    int signal = 0;        // the signal that ended it, or 0
    int exit_code = 0;
    std::string signal_name() const; // "Aborted"
};

class ChildProcess {
public:
    using Clock = std::chrono::steady_clock;

    // Starts `binary` with these arguments and drops what it prints. Throws Error where it cannot be started.
    ChildProcess(const std::filesystem::path &binary, const std::vector<std::string> &arguments);
    ChildProcess(ChildProcess &&other) noexcept;
    ChildProcess &operator=(ChildProcess &&) = delete;
    ~ChildProcess(); // kills it if it still runs

    Ending finish(Clock::time_point deadline);        // waits until it ends, or kills it at the deadline
    const std::string &said() const { return said_; } // its answer, after finish

private:
    Ending read_until(Clock::time_point deadline);
    bool has_ended();
    pid_t process_ = -1;
    int pipe_ = -1;
    int status_ = 0; // of waitpid, where process_ is -1
    std::string said_;
};

// Call first in main. Drivers look up programs (ld) by $PATH and libraries by $LD_LIBRARY_PATH, in a working directory
// of their own: empty entries, which mean that directory, and relative ones of $PATH are removed; relative ones of
// $LD_LIBRARY_PATH become absolute, and the process starts anew, as the dynamic linker reads it at the start alone.
void clean_search_paths(char **arguments);

// In the child, before all else: it ends when its parent does, and programs that it starts have no part in the answer.
void begin_answer();
// A line of the answer. A child that was started otherwise prints it.
void answer(const std::string &line);
// Ends the child at once. What drivers do at the end of a process is neither waited for nor judged.
[[noreturn]] void end_answer();

} // namespace opal
