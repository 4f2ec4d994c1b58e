// What a long computation says while it runs: a bar on a terminal, a line every few seconds elsewhere, nothing with
// --quiet.
#pragma once

#include <chrono>
#include <string>

namespace opal {

class Progress {
public:
    // total: how many `unit` ("samples", camera paths) there will be.
    Progress(std::string what, double total, std::string unit = "samples");
    ~Progress(); // leaves the terminal's line empty
    Progress(const Progress &) = delete;
    Progress &operator=(const Progress &) = delete;

    void update(double done); // may be called as often as one likes

private:
    using Clock = std::chrono::steady_clock;
    std::string what_, unit_;
    double total_;
    bool bar_, silent_;
    Clock::time_point start_, said_;
};

// "render  45 % [#########           ]  3.21 M samples/s  12 s left"; seconds: since the start; bar: whether to draw
// one.
std::string progress_line(const std::string &what, const std::string &unit, double done, double total, double seconds,
                          bool bar);

// "0.8 s", "12 s", "3 min 20 s", "2 h 5 min"
std::string duration_text(double seconds);

// "12.3 k", "3.21 M"
std::string count_text(double count);

} // namespace opal
