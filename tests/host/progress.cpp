// Progress messages, and how Ctrl-C is noticed.
#include "base/progress.h"
#include "base/signals.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <sys/wait.h>
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
