// Progress of a long computation: a bar on a terminal, a line every few seconds elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace opal {

class Progress {
public:
    // total: the amount of work, counted in `unit` ("samples", camera paths).
    Progress(std::string what, double total, std::string unit = "samples");
    ~Progress(); // clears the terminal's line
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    void update(double done); // cheap: prints at most ten times a second

private:
    using Clock = std::chrono::steady_clock;
    std::string what_, unit_;
    double total_;
    bool bar_, silent_;
    Clock::time_point start_, said_;
};

// The seconds of a computation that tells nothing of itself, such as a driver's compiler, from the first second on: by
// a thread of its own, "compile 3 s", in place on a terminal, a line every few seconds elsewhere, nothing with --quiet.
class RunningSeconds {
public:
    explicit RunningSeconds(std::string what);
    ~RunningSeconds(); // clears the terminal's line
    RunningSeconds(const RunningSeconds &) = delete;
    RunningSeconds &operator=(const RunningSeconds &) = delete;

private:
    void run(const std::string &what);
    std::mutex mutex_;
    std::condition_variable ended_changed_;
    bool ended_ = false;
    std::thread thread_; // none with --quiet
};

// "render  45 % [#########           ]  3.21 M samples/s  12 s left". seconds: since the start; bar: draw the bar.
std::string progress_line(const std::string &what, const std::string &unit, double done, double total, double seconds,
                          bool bar);

// "0.8 s", "12 s", "3 min 20 s", "2 h 5 min"
std::string duration_text(double seconds);

// "12.3 k", "3.21 M"
std::string count_text(double count);

} // namespace opal
