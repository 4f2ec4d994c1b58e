#include "base/process.h"

#include "base/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

namespace opal {

std::string Ending::signal_name() const { return strsignal(signal); }

ChildProcess::ChildProcess(const std::filesystem::path &binary, const std::vector<std::string> &arguments) {
    int ends[2];
    if (pipe2(ends, O_CLOEXEC) != 0)
        throw Error(fmt::format("cannot start a process: {}", std::strerror(errno)));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addopen(&actions, 2, "/dev/null", O_WRONLY, 0);
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
    : process_(std::exchange(other.process_, -1)), pipe_(std::exchange(other.pipe_, -1)),
      said_(std::move(other.said_)) {}

ChildProcess::~ChildProcess() {
    if (process_ != -1)
        finish(Clock::now());
}

// Reads the child's stdout until it is closed. False: the deadline came first.
bool ChildProcess::read_until(Clock::time_point deadline) {
    for (;;) {
        const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(deadline - Clock::now()).count();
        pollfd wait{pipe_, POLLIN, 0};
        const int ready = poll(&wait, 1, static_cast<int>(std::max<long long>(left, 0)));
        if (ready < 0 && errno == EINTR)
            continue;
        if (ready <= 0)
            return false;
        char bytes[4096];
        const ssize_t count = read(pipe_, bytes, sizeof bytes);
        if (count <= 0)
            return true;
        said_.append(bytes, static_cast<size_t>(count));
    }
}

Ending ChildProcess::finish(Clock::time_point deadline) {
    Ending ending;
    ending.in_time = read_until(deadline);
    if (!ending.in_time)
        kill(process_, SIGKILL);
    close(pipe_);
    int status = 0;
    while (waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    ending.signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    ending.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 0;
    return ending;
}

} // namespace opal
