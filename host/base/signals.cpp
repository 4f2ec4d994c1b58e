#include "base/signals.h"

#include <array>
#include <csignal>
#include <initializer_list>

#include <unistd.h>

namespace opal {

namespace {

volatile std::sig_atomic_t watched = 0;
volatile std::sig_atomic_t received = 0; // the signal; 0: none

std::array<std::atomic<const RemovedBySignal *>, 16> temporary_files;     // an image's two files at once, and some more
static_assert(std::atomic<const RemovedBySignal *>::is_always_lock_free); // a handler reads them

void receive(int signal) {
    if (watched && received == 0 && signal != SIGQUIT) {
        received = signal;
        return;
    }
    for (const auto &slot : temporary_files)
        if (const RemovedBySignal *const file = slot)
            file->remove();
    std::signal(signal, SIG_DFL);
    std::raise(signal); // comes after the handler's end
}

// Installs the handler. all: also where the signal is ignored, as SIGINT in a shell's background job.
void handle(int signal, bool all) {
    struct sigaction action {
    }, before{};
    action.sa_handler = receive;
    action.sa_flags = SA_RESTART;
    sigaction(signal, &action, &before);
    if (!all && before.sa_handler == SIG_IGN)
        sigaction(signal, &before, nullptr);
}

} // namespace

void watch_interrupts() {
    watched = 1;
    handle(SIGINT, true);
    handle(SIGTERM, true);
    handle(SIGHUP, false);
}

bool interrupted() { return received != 0; }

int interrupt_exit_code() { return 128 + (received ? received : SIGINT); }

RemovedBySignal::RemovedBySignal(int folder, const char *name) : folder_(folder), name_(name) {
    static const bool handled = [] {
        for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
            handle(signal, false);
        return true;
    }();
    (void)handled;
    for (auto &slot : temporary_files) {
        const RemovedBySignal *none = nullptr;
        if (slot.compare_exchange_strong(none, this)) {
            slot_ = &slot;
            return;
        }
    }
}

RemovedBySignal::~RemovedBySignal() {
    if (slot_)
        *slot_ = nullptr;
}

void RemovedBySignal::remove() const { unlinkat(folder_, name_, 0); }

} // namespace opal
