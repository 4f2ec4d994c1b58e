#include "base/signals.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <initializer_list>

#include <unistd.h>

namespace opal {

namespace {

volatile std::sig_atomic_t watched = 0;
volatile std::sig_atomic_t received = 0; // the signal; 0: none
std::atomic<int64_t> received_at = 0;    // of the first signal: ns of CLOCK_MONOTONIC; 0: none
static_assert(std::atomic<int64_t>::is_always_lock_free);

// One wish to end may come twice at once: `timeout` signals its command, and then its process group.
constexpr int64_t one_wish = 500'000'000; // ns

// What a handler reads: memory that is never freed, and numbers without locks.
struct TemporaryFile {
    std::atomic<int> folder = -1; // the descriptor; -1: the slot is free; -2: it is being filled
    std::array<char, 32> name{};
};
std::array<TemporaryFile, 16> temporary_files; // an image's two files at once, and some more
static_assert(std::atomic<int>::is_always_lock_free);

int64_t now() {
    timespec time{};
    clock_gettime(CLOCK_MONOTONIC, &time);
    return int64_t(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
}

void receive(int signal) {
    if (watched && signal != SIGQUIT) {
        int64_t first = 0;
        if (received_at.compare_exchange_strong(first, now()))
            received = signal;
        if (first == 0 || now() - first < one_wish)
            return;
    }
    for (const TemporaryFile &file : temporary_files)
        if (const int folder = file.folder; folder >= 0)
            unlinkat(folder, file.name.data(), 0);
    std::signal(signal, SIG_DFL);
    std::raise(signal); // comes after the handler's end
}

bool is_ignored(int signal) {
    struct sigaction action {};
    return sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

// Installs the handler. all: also where the signal is ignored, as SIGINT in a shell's background job.
void handle(int signal, bool all) {
    struct sigaction action {};
    action.sa_handler = !all && is_ignored(signal) ? SIG_IGN : receive;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, nullptr);
}

} // namespace

void keep_hangup_ignored() {
    if (!is_ignored(SIGHUP))
        return;
    sigset_t hangup;
    sigemptyset(&hangup);
    sigaddset(&hangup, SIGHUP);
    sigprocmask(SIG_BLOCK, &hangup, nullptr);
}

void watch_interrupts() {
    watched = 1;
    handle(SIGINT, true);
    handle(SIGTERM, true);
    handle(SIGHUP, false);
}

EndedBySignals::EndedBySignals() : before_(watched) { watched = 0; }
EndedBySignals::~EndedBySignals() { watched = before_; }

bool interrupted() { return received != 0; }

int interrupt_exit_code() { return 128 + (received ? received : SIGINT); }

RemovedBySignal::RemovedBySignal(int folder, const std::string &name) {
    static const bool handled = [] {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
            handle(signal, false);
        return true;
    }();
    (void)handled;
    for (size_t i = 0; i < temporary_files.size() && slot_ < 0; i++) {
        TemporaryFile &file = temporary_files[i];
        int free = -1;
        if (name.size() >= file.name.size() || !file.folder.compare_exchange_strong(free, -2))
            continue;
        name.copy(file.name.data(), name.size());
        file.name[name.size()] = '\0';
        file.folder = folder;
        slot_ = int(i);
    }
}

RemovedBySignal::~RemovedBySignal() {
    if (slot_ >= 0)
        temporary_files[size_t(slot_)].folder = -1;
}

} // namespace opal
