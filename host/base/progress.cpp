#include "base/progress.h"

#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <unistd.h>

namespace opal {

namespace {

constexpr double bar_period = 0.1, line_period = 5, first_period = 1; // seconds
std::atomic<int> running = 0;                                         // RunningProgress that live

std::string share_text(double share, bool bar) {
    std::string text = fmt::format("{:3.0f} %", std::floor(100 * share));
    if (bar) {
        constexpr int width = 30;
        const int filled = static_cast<int>(share * width);
        text += fmt::format(" [{:<{}}]", std::string(static_cast<size_t>(filled), '#'), width);
    }
    return text;
}

double since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

std::string duration_text(double seconds) {
    if (seconds < 9.95)
        return fmt::format("{:.1f} s", seconds);
    const long long whole = std::llround(std::min(seconds, 1e15));
    if (whole < 60)
        return fmt::format("{} s", whole);
    if (whole < 3600)
        return fmt::format("{} min {} s", whole / 60, whole % 60);
    return fmt::format("{} h {} min", whole / 3600, whole % 3600 / 60);
}

std::string count_text(double count) {
    static const char *const units[] = {"", " k", " M", " G", " T"};
    int unit = 0;
    for (; count >= 1000 && unit < 4; ++unit)
        count /= 1000;
    return fmt::format("{:.3g}{}", count, units[unit]);
}

std::string progress_line(const std::string &what, const std::string &unit, double done, double total, double seconds,
                          bool bar) {
    const double share = total > 0 ? std::clamp(done / total, 0.0, 1.0) : 1;
    std::string line = fmt::format("{} {}", what, share_text(share, bar));
    if (done > 0 && seconds > 0)
        line += fmt::format("  {} {}/s  {} left", count_text(done / seconds), unit,
                            duration_text(seconds * (total - done) / done));
    return line;
}

Progress::Progress(std::string what, double total, std::string unit)
    : what_(std::move(what)), unit_(std::move(unit)), total_(total), bar_(isatty(STDERR_FILENO)), silent_(is_quiet()),
      start_(Clock::now()), said_(start_) {}

Progress::~Progress() {
    if (bar_ && !silent_)
        show(clear_line);
}

void Progress::update(double done) {
    if (silent_ || since(said_) < (bar_ ? bar_period : line_period))
        return;
    said_ = Clock::now();
    const std::string line = progress_line(what_, unit_, done, total_, since(start_), bar_);
    show(bar_ ? clear_line + line : line + "\n");
}

std::string running_line(const std::string &what, double seconds, std::optional<double> left, bool bar) {
    if (!left)
        return fmt::format("{:<7} {:.0f} s", what, seconds);
    return fmt::format("{:<7} {}  {} left", what, share_text(seconds / (seconds + *left), bar), duration_text(*left));
}

RunningProgress::RunningProgress(std::string what) : start_(Clock::now()) {
    if (running++ == 0 && !is_quiet())
        thread_ = std::thread([this, what = std::move(what)] { run(what); });
}

RunningProgress::~RunningProgress() {
    running--;
    if (!thread_.joinable())
        return;
    {
        const std::lock_guard lock(mutex_);
        ended_ = true;
    }
    ended_changed_.notify_one();
    thread_.join();
}

void RunningProgress::tell(std::string step) {
    const std::lock_guard lock(mutex_);
    step_ = std::move(step);
}

void RunningProgress::expect(double seconds) {
    const std::lock_guard lock(mutex_);
    end_ = since(start_) + std::max(seconds, 0.0);
}

void RunningProgress::update(double done, double total) {
    if (done > 0)
        expect(since(start_) * (total - done) / done);
}

void RunningProgress::run(const std::string &what) {
    const bool bar = isatty(STDERR_FILENO);
    double next = first_period; // seconds since the start
    std::unique_lock lock(mutex_);
    const auto wait = [&] { return std::chrono::duration<double>(next - since(start_)); };
    while (!ended_changed_.wait_for(lock, wait(), [&] { return ended_; })) {
        const double seconds = since(start_);
        const auto left = seconds < end_ ? std::optional(end_ - seconds) : std::nullopt;
        std::string line = running_line(what, seconds, left, bar);
        if (!step_.empty())
            line += "  " + step_;
        show(bar ? clear_line + line : line + "\n");
        next += bar ? first_period : line_period;
    }
    if (bar && next > first_period)
        show(clear_line);
}

} // namespace opal
