// Exit codes of `opal`: the one list of them, which the help and the man page print. base/signals.h has those of
// signals.
#pragma once

#include <array>

namespace opal {

enum ExitCode : int { exit_done = 0, exit_failed = 1, exit_usage = 2, exit_check_failed = 3 };

struct ExitCodeRow {
    const char *codes, *meaning;
};
inline constexpr std::array<ExitCodeRow, 5> exit_codes = {{
    {"0", "done"},
    {"1", "failed: a file, a scene, a device; the last line says why"},
    {"2", "the command line is wrong: an unknown command or flag, an impossible value, an output that is an input"},
    {"3", "the check says no: verify, test, selftest, extremes, warp, compare --fail"},
    {"129, 130, 143", "interrupted by SIGHUP, Ctrl-C, SIGTERM; what was reached is kept"},
}};

} // namespace opal
