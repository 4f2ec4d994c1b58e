#include "base/signals.h"

#include <csignal>

namespace opal {

namespace {

volatile std::sig_atomic_t flag = 0;

void set_flag(int) { flag = 1; }

} // namespace

void watch_interrupts() {
    struct sigaction action {};
    action.sa_handler = set_flag;
    action.sa_flags = SA_RESTART | SA_RESETHAND; // the second signal has its usual effect
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() { return flag != 0; }

} // namespace opal
