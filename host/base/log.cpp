#include "base/log.h"

#include <fmt/core.h>

namespace opal {

namespace {
bool is_quiet = false;
std::vector<std::string> kept_warnings;
} // namespace

void set_quiet(bool quiet) { is_quiet = quiet; }

void info(const std::string &line) {
    if (!is_quiet)
        fmt::print(stderr, "{}\n", line);
}

void warn(const std::string &line) {
    kept_warnings.push_back(line);
    fmt::print(stderr, "warning: {}\n", line);
}

const std::vector<std::string> &warnings() { return kept_warnings; }

} // namespace opal
