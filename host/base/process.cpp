#include "base/process.h"

#include "base/descriptor.h"
#include "base/error.h"
#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace opal {

namespace {

// Not stdout, to which drivers print.
constexpr int answer_descriptor = 3;
constexpr size_t longest_answer = 4 << 20; // bytes; 100 devices take 50 000
bool answering = false;

} // namespace

std::string Ending::signal_name() const { return strsignal(signal); }

ChildProcess::ChildProcess(const std::filesystem::path &binary, const std::vector<std::string> &arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], answer_descriptor);
    for (const int printed : {STDOUT_FILENO, STDERR_FILENO})
        posix_spawn_file_actions_addopen(&actions, printed, "/dev/null", O_WRONLY, 0);
    std::string name = "opal";
    std::vector<std::string> words = arguments;
    std::vector<char *> pointers = {name.data()};
    for (std::string &word : words)
        pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const int failed = posix_spawn(&process_, binary.c_str(), &actions, nullptr, pointers.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    pipe_ = ends[0];
    if (failed) {
        process_ = -1;
        close(pipe_);
        throw Error(fmt::format("cannot start {}: {}", binary.string(), std::strerror(failed)));
    }
}

ChildProcess::ChildProcess(ChildProcess &&other) noexcept
    : process_(std::exchange(other.process_, -1)), pipe_(std::exchange(other.pipe_, -1)), status_(other.status_),
      said_(std::move(other.said_)) {}

ChildProcess::~ChildProcess() {
    if (pipe_ != -1)
        finish(Clock::now());
}

bool ChildProcess::has_ended() {
    if (process_ != -1 && waitpid(process_, &status_, WNOHANG) == process_)
        process_ = -1;
    return process_ == -1;
}

// Reads the child's answer until it is closed, too long, or the deadline has come. A process that a driver has started
// may keep the pipe open: when the child has ended, what lies in the pipe is the end of its answer.
Ending ChildProcess::read_until(Clock::time_point deadline) {
    using std::chrono::milliseconds;
    constexpr milliseconds glance(50);
    Ending ending;
    for (bool ended = false;;) {
        const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
        pollfd wait{pipe_, POLLIN, 0};
        const int ready = poll(&wait, 1, ended ? 0 : int(std::clamp(left, milliseconds(0), glance).count()));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0) {
            if (ended)
                return ending;
            ended = has_ended();
            ending.in_time = ended || Clock::now() < deadline;
            if (!ending.in_time)
                return ending;
            continue;
        }
        char bytes[4096];
        const ssize_t count = read(pipe_, bytes, sizeof bytes);
        if (count <= 0)
            return ending;
        said_.append(bytes, static_cast<size_t>(count));
        ending.too_long = said_.size() > longest_answer;
        // What lies in the pipe counts after the deadline, too, if the child has ended.
        ending.in_time = Clock::now() < deadline || has_ended();
        if (ending.too_long || !ending.in_time)
            return ending;
    }
}

Ending ChildProcess::finish(Clock::time_point deadline) {
    Ending ending = read_until(deadline);
    close(std::exchange(pipe_, -1));
    // The answer is whole, but a driver may hang at the end of the process.
    while (ending.in_time && !ending.too_long && !has_ended()) {
        ending.in_time = Clock::now() < deadline;
        usleep(200);
    }
    if (process_ != -1) {
        kill(process_, SIGKILL);
        while (waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
        }
        process_ = -1;
    }
    ending.signal = WIFSIGNALED(status_) ? WTERMSIG(status_) : 0;
    ending.exit_code = WIFEXITED(status_) ? WEXITSTATUS(status_) : 0;
    return ending;
}

void clean_search_paths(char **arguments) {
    const auto clean = [](const char *name, bool keep_relative) {
        const char *const before = std::getenv(name);
        std::istringstream folders(before ? before : "");
        std::string after;
        for (std::string folder; std::getline(folders, folder, ':');)
            if (folder.starts_with('/') || (keep_relative && !folder.empty())) {
                std::error_code ignored;
                after += (after.empty() ? "" : ":") + std::filesystem::absolute(folder, ignored).string();
            }
        if (!before || after == before)
            return false;
        after.empty() ? unsetenv(name) : setenv(name, after.c_str(), 1);
        return true;
    };
    clean("PATH", false);
    if (!std::getenv("PATH")) // as execvp(3) takes it; drivers' compilers find no linker without it
        setenv("PATH", "/bin:/usr/bin", 1);
    if (clean("LD_LIBRARY_PATH", true))
        execv("/proc/self/exe", arguments); // returns where there is no /proc: then some drivers may not be found
}

void begin_answer() {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    answering = fcntl(answer_descriptor, F_SETFD, FD_CLOEXEC) == 0;
    pollfd reader{answer_descriptor, 0, 0};
    if (answering && poll(&reader, 1, 0) > 0 && reader.revents & POLLERR) // the parent ended before prctl
        end_answer();
}

void answer(const std::string &line) {
    if (!answering)
        return print("{}\n", line);
    write_all(answer_descriptor, line + '\n'); // a parent that has ended needs no answer
}

void end_answer() { _exit(0); }

} // namespace opal
