// A folder for a test's files, and shell commands.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

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

// Runs `opal` with these arguments, without a shell; fails the test unless it ends with 0. Returns the most bytes of
// memory that the process had at once.
double peak_bytes_of_opal(const std::vector<std::string> &arguments);

// The device that tests run on, as --device takes it: $OPAL_TEST_DEVICE, else "cpu".
std::string wanted_device();

} // namespace opal::test
