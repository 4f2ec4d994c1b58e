// Progress of a long computation: a bar on a terminal, a line every few seconds elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <optional>
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

// The progress of a computation that tells nothing of itself while a step of it lasts, such as a driver's compiler or a
// child process. A thread of its own tells it from the first second on: in place on a terminal, a line every few
// seconds elsewhere, nothing with --quiet. It tells the seconds that it runs, "compile 3 s", or the time left
// where that is known and has not passed. One that lives within another is silent.
class RunningProgress {
public:
    explicit RunningProgress(std::string what);
    ~RunningProgress(); // clears the terminal's line
    RunningProgress(const RunningProgress &) = delete;
    RunningProgress &operator=(const RunningProgress &) = delete;

    void tell(std::string step);            // what is being done now, at the end of the line
    void expect(double seconds);            // the time left from now on, as the caller knows it
    void update(double done, double total); // the time left by the work that is done; nothing done: not known

private:
    using Clock = std::chrono::steady_clock;
    void run(const std::string &what);
    const Clock::time_point start_;
    std::mutex mutex_;
    std::condition_variable ended_changed_;
    bool ended_ = false;
    std::string step_;
    double end_ = 0;     // when all will be done, seconds since the start; 0: not known
    std::thread thread_; // none with --quiet, or within another
};

// "render  45 % [#########           ]  3.21 M samples/s  12 s left". seconds: since the start; bar: draw the bar.
std::string progress_line(const std::string &what, const std::string &unit, double done, double total, double seconds,
                          bool bar);

// "compile 3 s"; where the time left is known: "sweep    45 % [#########           ]  12 s left".
std::string running_line(const std::string &what, double seconds, std::optional<double> left, bool bar);

// "0.8 s", "12 s", "3 min 20 s", "2 h 5 min"
std::string duration_text(double seconds);

// "12.3 k", "3.21 M"
std::string count_text(double count);

} // namespace opal
