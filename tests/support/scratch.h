// A folder for a test's files, and shell commands.
#pragma once

#include <filesystem>
#include <string>

namespace opal::test {

// Empty at first, removed with the object.
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
// Runs a shell command and keeps what it prints.
Outcome run_shell(const std::string &command);

// The device that tests run on, as --device takes it: $OPAL_TEST_DEVICE, else "cpu".
std::string wanted_device();

} // namespace opal::test
