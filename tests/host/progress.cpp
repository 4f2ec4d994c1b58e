// Progress messages, and how Ctrl-C is noticed.
#include "base/progress.h"
#include "base/log.h"
#include "base/signals.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <cstdio>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace opal;

TEST_CASE("Durations and counts are told in the unit that suits them", "[progress][alone]") {
    CHECK(duration_text(0.84) == "0.8 s");
    CHECK(duration_text(59.4) == "59 s");
    CHECK(duration_text(200) == "3 min 20 s");
    CHECK(duration_text(7530) == "2 h 5 min");
    CHECK(count_text(12) == "12");
    CHECK(count_text(12345) == "12.3 k");
    CHECK(count_text(3.21e6) == "3.21 M");
}

TEST_CASE("A progress line tells share, speed and time left", "[progress][alone]") {
    CHECK(progress_line("render", "samples", 45e6, 100e6, 10, false) == "render  45 %  4.5 M samples/s  12 s left");
    CHECK(progress_line("render", "samples", 5, 10, 1, true) ==
          "render  50 % [###############               ]  5 samples/s  1.0 s left");
    CHECK(progress_line("render", "samples", 0, 10, 0, false) == "render   0 %");
}

namespace {

// What `run` prints to stderr. It is a file then, where each line stays.
template <class Run> std::string told_by(const Run &run) {
    std::fflush(stderr);
    const int before = dup(STDERR_FILENO);
    std::FILE *file = std::tmpfile();
    dup2(fileno(file), STDERR_FILENO);
    run();
    std::fflush(stderr);
    dup2(before, STDERR_FILENO);
    close(before);
    std::string text(1000, '\0');
    std::rewind(file);
    text.resize(std::fread(text.data(), 1, text.size(), file));
    std::fclose(file);
    return text;
}

void sleep(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

} // namespace

TEST_CASE("Running seconds are told from the first second on, and not before", "[progress][alone]") {
    const auto told_in = [](double seconds) {
        return told_by([&] {
            const RunningProgress running("compile");
            sleep(seconds);
        });
    };
    CHECK(told_in(0.2).empty());
    CHECK(told_in(1.3) == "compile 1 s\n");
}

TEST_CASE("The time left is told where it is known, until it has passed", "[progress][alone]") {
    CHECK(running_line("sweep", 6, 2.0, true) == "sweep    75 % [######################        ]  2.0 s left");
    CHECK(running_line("verify", 90, 0.0, false) == "verify  100 %  0.0 s left");
    CHECK(running_line("selftest", 3, {}, true) == "selftest 3 s");
    const auto told_after = [](double left) {
        return told_by([&] {
            RunningProgress running("verify");
            running.expect(left);
            sleep(1.3);
        });
    };
    CHECK_THAT(told_after(8), Catch::Matches("verify   1\\d %  [67]\\.\\d s left\n"));
    CHECK(told_after(0.5) == "verify  1 s\n"); // it takes longer than was thought
    CHECK(told_by([] {
              RunningProgress running("test");
              running.update(0, 4); // nothing is known yet
              sleep(1.3);
          }) == "test    1 s\n");
    CHECK_THAT(told_by([] {
                   RunningProgress running("test");
                   sleep(0.2);
                   running.update(1, 40); // 39 times as long
                   sleep(1.1);
               }),
               Catch::Matches("test     1\\d %  [67]\\.\\d s left\n"));
}

TEST_CASE("The step that lasts is told at the end of the line", "[progress][alone]") {
    CHECK(told_by([] {
              RunningProgress running("pilots");
              running.tell("compile MIS, power heuristic");
              sleep(1.3);
          }) == "pilots  1 s  compile MIS, power heuristic\n");
}

TEST_CASE("A compilation within a longer task is told by the task's line", "[progress][alone]") {
    CHECK(told_by([] {
              const RunningProgress whole("sweep"), part("compile");
              sleep(1.3);
          }) == "sweep   1 s\n");
}

TEST_CASE("A message takes the place of a bar that stands on its line", "[progress][alone]") {
    CHECK(told_by([] {
              show("render  50 %");
              info("result");
              info("wrote");
          }) == "render  50 %\r\033[Kresult\nwrote\n");
}

TEST_CASE("The first interrupt sets the flag, one half a second later ends the process", "[progress][alone]") {
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
        raise(SIGINT); // at once: `timeout` sends two
        sleep(0.6);
        raise(SIGINT);
        _exit(3);
    }
    int status = 0;
    REQUIRE(waitpid(child, &status, 0) == child);
    CHECK((WIFSIGNALED(status) && WTERMSIG(status) == SIGINT));
}
