#include "base/log.h"

#include <fmt/core.h>

namespace opal {

namespace {
bool quiet_chosen = false, verbose_chosen = false;
std::vector<std::string> kept_warnings;
} // namespace

void set_quiet(bool quiet) { quiet_chosen = quiet; }
bool is_quiet() { return quiet_chosen; }

void info(const std::string &line) {
    if (!quiet_chosen)
        fmt::print(stderr, "{}\n", line);
}

void set_verbose(bool verbose) { verbose_chosen = verbose; }

void detail(const std::string &text) {
    if (verbose_chosen)
        fmt::print(stderr, "{}\n", text);
}

void warn(const std::string &line) {
    kept_warnings.push_back(line);
    fmt::print(stderr, "warning: {}\n", line);
}

const std::vector<std::string> &warnings() { return kept_warnings; }

} // namespace opal
