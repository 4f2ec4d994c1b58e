// Renders and sweeps in which a system call on files of their folder fails, or a signal comes (faults_preload.cpp).
#pragma once

#include "support/scratch.h"

#include <string>
#include <vector>

namespace opal::test {

// A folder with a scene, its mesh, and what a render of it writes: o.exr, o.png, o.json.
class FaultyRender {
public:
    explicit FaultyRender(bool over_old_files);
    long calls() const { return calls_; } // of a render without a fault, on files of the folder
    // Renders with this fault at that call, from the same files each time. Returns what is wrong: a file that is
    // neither the old nor the new one, whole; a temporary file; an exit code that does not tell which; more than 10 s.
    // Empty: nothing.
    std::string broken_by(const std::string &fault, long call) const;

private:
    void prepare() const;
    ScratchFolder folder_;
    const bool over_old_files_;
    long calls_ = 0;
};

// Those of faults_preload.cpp: EIO, ENOSPC, EINTR and short are errors, KILL, TERM and INT are signals.
const std::vector<std::string> &fault_names();

// The assignments before a command that make a call fail. An empty fault: calls are only counted, in `log`.
std::string with_fault(const std::filesystem::path &folder, const std::string &fault, long call,
                       const std::filesystem::path &log = {});

long lines_in(const std::filesystem::path &file);

} // namespace opal::test
