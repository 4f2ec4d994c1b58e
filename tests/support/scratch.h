// A folder for a test's files, empty at first and gone with the object.
#pragma once

#include <filesystem>
#include <string>

namespace opal::test {

class ScratchFolder {
public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder &) = delete;
    ScratchFolder &operator=(const ScratchFolder &) = delete;

    const std::filesystem::path &path() const { return path_; }
    std::filesystem::path operator/(const std::string &name) const { return path_ / name; }
    std::filesystem::path write(const std::string &name, const std::string &text) const; // creates folders on the way

private:
    std::filesystem::path path_;
};

// The text of a file; fails the test where it cannot be read.
std::string read_text(const std::filesystem::path &file);

struct Outcome {
    int exit_code = -1;
    std::string out, err;
};
// Runs a shell command and keeps what it says.
Outcome run_shell(const std::string &command);

} // namespace opal::test
