// Progress messages, and how Ctrl-C is noticed.
#include "base/progress.h"
#include "base/signals.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdio>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace opal;

TEST_CASE("Durations and counts are told in the unit that suits them", "[progress]") {
    CHECK(duration_text(0.84) == "0.8 s");
    CHECK(duration_text(59.4) == "59 s");
    CHECK(duration_text(200) == "3 min 20 s");
    CHECK(duration_text(7530) == "2 h 5 min");
    CHECK(count_text(12) == "12");
    CHECK(count_text(12345) == "12.3 k");
    CHECK(count_text(3.21e6) == "3.21 M");
}

TEST_CASE("A progress line tells share, speed and time left", "[progress]") {
    CHECK(progress_line("render", "samples", 45e6, 100e6, 10, false) == "render  45 %  4.5 M samples/s  12 s left");
    CHECK(progress_line("render", "samples", 5, 10, 1, true) ==
          "render  50 % [###############               ]  5 samples/s  1.0 s left");
    CHECK(progress_line("render", "samples", 0, 10, 0, false) == "render   0 %");
}

TEST_CASE("Running seconds are told from the first second on, and not before", "[progress]") {
    // Redirected, so that each line stays.
    const auto told_in = [](double seconds) {
        std::fflush(stderr);
        const int before = dup(STDERR_FILENO);
        std::FILE *file = std::tmpfile();
        dup2(fileno(file), STDERR_FILENO);
        {
            const RunningSeconds running("compile");
            std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        }
        std::fflush(stderr);
        dup2(before, STDERR_FILENO);
        close(before);
        std::string text(200, '\0');
        std::rewind(file);
        text.resize(std::fread(text.data(), 1, text.size(), file));
        std::fclose(file);
        return text;
    };
    CHECK(told_in(0.2).empty());
    CHECK(told_in(1.3) == "compile 1 s\n");
}

TEST_CASE("The first interrupt sets the flag, the second ends the process", "[progress]") {
    const pid_t child = fork();
    REQUIRE(child >= 0);
    if (child == 0) {
        signal(SIGINT, SIG_DFL);
        watch_interrupts();
        if (interrupted())
            _exit(1);
        raise(SIGINT);
        if (!interrupted())
            _exit(2);
        raise(SIGINT);
        _exit(3);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));
}
