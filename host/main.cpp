// Picks the command. The only place that prints an error and exits.
#include "base/command_line.h"
#include "base/error.h"
#include "base/exit_code.h"
#include "base/large_vector.h"
#include "base/log.h"
#include "base/process.h"
#include "base/signals.h"
#include "commands/commands.h"
#include "commands/help.h"
#include "commands/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

#include <unistd.h>

namespace opal {
namespace {

// `opal SCENE.xml ...` is `opal render SCENE.xml ...`, also with flags before the scene.
std::vector<std::string> with_command(const std::vector<Command> &commands, std::vector<std::string> words) {
    const auto names_scene = [](const std::string &word) {
        std::error_code ignored;
        const std::filesystem::file_status status = std::filesystem::status(word, ignored); // a file or a pipe
        return std::filesystem::path(word).extension() == ".xml" ||
               (std::filesystem::exists(status) && !std::filesystem::is_directory(status));
    };
    const auto names_file = [](const std::string &word) { // a scene or mesh, perhaps misspelt: reading it says so
        return !word.starts_with('-') && std::filesystem::path(word).has_extension();
    };
    const bool is_command =
        std::any_of(commands.begin(), commands.end(), [&](const Command &c) { return words[0] == c.name; });
    const bool is_stdin = words[0] == "-", is_flag = !is_stdin && words[0].starts_with('-');
    if (!is_command && (is_stdin || names_file(words[0]) || names_scene(words[0]) ||
                        (is_flag && std::any_of(words.begin(), words.end(), names_scene))))
        words.insert(words.begin(), "render");
    return words;
}

int run(int argc, char **argv) {
    const std::vector<Command> commands = all_commands();
    if (argc < 2) { // a script whose variable is empty should not go on
        show(short_help());
        return exit_usage;
    }
    return parse(commands, with_command(commands, {argv + 1, argv + argc}))();
}

// A result that stdout did not take is an error; one that nobody read to its end (| head) needs no words.
int exit_code_after_output(int code) {
    const int error = output_error();
    if (error && error != EPIPE)
        tell_error(fmt::format("stdout: cannot be written: {}", std::strerror(error)).c_str());
    return error && code == exit_done ? exit_failed : code;
}

} // namespace
} // namespace opal

int main(int argc, char **argv) {
    opal::return_large_blocks();
    opal::prepare_streams();
    opal::keep_hangup_ignored();
    opal::clean_search_paths(argv);
    opal::set_command_line(argc, argv);
    int code = opal::exit_failed;
    try {
        code = opal::run(argc, argv);
    } catch (const opal::UsageError &error) {
        opal::tell_error(error);
        code = opal::exit_usage;
    } catch (const opal::InterruptedWait &error) {
        opal::tell_error(error);
        code = opal::interrupt_exit_code();
    } catch (const std::exception &error) {
        opal::tell_error(error);
    }
    code = opal::exit_code_after_output(code);
    dup2(STDERR_FILENO, STDOUT_FILENO); // drivers may print at the end of the process, too
    return code;
}
