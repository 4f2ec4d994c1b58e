#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cstdlib>
#include <fstream>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace opal::test {

ScratchFolder::ScratchFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "opal-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
}

ScratchFolder::~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path ScratchFolder::write(const std::string &name, const std::string &text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
}

std::string read_text(const std::filesystem::path &file) {
    std::ifstream stream(file, std::ios::binary);
    INFO(file.string());
    REQUIRE(stream.good());
    std::ostringstream text;
    text << stream.rdbuf();
    return text.str();
}

Outcome run_shell(const std::string &command) {
    const ScratchFolder scratch;
    const std::string out = scratch / "out", err = scratch / "err";
    const int status = std::system(("( " + command + " ) >" + out + " 2>" + err).c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), read_text(out), read_text(err)};
}

double peak_bytes_of_opal(const std::vector<std::string> &arguments) {
    std::vector<char *> words{const_cast<char *>(OPAL_BINARY)}; // execv writes to none of them
    for (const std::string &argument : arguments)
        words.push_back(const_cast<char *>(argument.c_str()));
    words.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        execv(OPAL_BINARY, words.data());
        _exit(127);
    }
    int status = 0;
    rusage used{};
    REQUIRE(wait4(child, &status, 0, &used) == child);
    REQUIRE((WIFEXITED(status) && WEXITSTATUS(status) == 0));
    return 1024.0 * double(used.ru_maxrss);
}

std::string wanted_device() {
    const char *wanted = std::getenv("OPAL_TEST_DEVICE");
    return wanted ? wanted : "cpu";
}

} // namespace opal::test
