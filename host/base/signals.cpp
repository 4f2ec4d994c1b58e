#include "base/signals.h"

#include <csignal>
#include <initializer_list>

namespace opal {

namespace {

volatile std::sig_atomic_t received = 0; // the signal; 0: none

void receive(int signal) { received = signal; }

} // namespace

void watch_interrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        struct sigaction action {
        }, before{};
        action.sa_handler = receive;
        action.sa_flags = SA_RESTART | SA_RESETHAND; // the second signal has its usual effect
        sigaction(signal, &action, &before);
        if (signal == SIGHUP && before.sa_handler == SIG_IGN)
            sigaction(signal, &before, nullptr);
    }
}

bool interrupted() { return received != 0; }

int interrupt_exit_code() { return 128 + (received ? received : SIGINT); }

} // namespace opal
