// Picks the command. The only place that prints an error and exits.
#include "base/command_line.h"
#include "base/error.h"
#include "base/log.h"
#include "commands/commands.h"
#include "commands/parse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <new>

namespace opal {
namespace {

[[noreturn]] void refuse_command(const std::vector<Command> &commands, const std::string &word) {
    std::vector<std::string> names;
    for (const Command &command : commands)
        if (!command.help.empty())
            names.push_back(command.name);
    const std::string what = word.empty() ? "no command given" : fmt::format("unknown command '{}'", word);
    throw Error(fmt::format("{}; available: {}, or a scene's .xml file", what, fmt::join(names, ", ")));
}

// `opal SCENE.xml ...` is `opal render SCENE.xml ...`.
std::vector<std::string> with_command(const std::vector<Command> &commands, std::vector<std::string> words) {
    const auto names_scene = [](const std::string &word) {
        return std::filesystem::path(word).extension() == ".xml" || std::filesystem::is_regular_file(word);
    };
    const auto names_file = [](const std::string &word) { // a scene or mesh, perhaps misspelt: reading it says so
        return !word.starts_with('-') && std::filesystem::path(word).has_extension();
    };
    const auto is_command = [&](const std::string &word) {
        return std::any_of(commands.begin(), commands.end(), [&](const Command &c) { return word == c.name; });
    };
    if (!words.empty() && !is_command(words[0]) &&
        (names_file(words[0]) || std::any_of(words.begin(), words.end(), names_scene)))
        words.insert(words.begin(), "render");
    else if (words.empty() || (!is_command(words[0]) && !words[0].starts_with('-')))
        refuse_command(commands, words.empty() ? std::string() : words[0]);
    return words;
}

int run(int argc, char **argv) {
    const std::vector<Command> commands = all_commands();
    return parse(commands, with_command(commands, {argv + 1, argv + argc}))();
}

// A result that stdout did not take is an error; one that nobody read to its end (| head) needs no words.
int exit_code_after_output(int code) {
    const int error = output_error();
    if (error && error != EPIPE)
        tell_error(fmt::format("stdout: cannot be written: {}", std::strerror(error)).c_str());
    return error && code == 0 ? 1 : code;
}

} // namespace
} // namespace opal

int main(int argc, char **argv) {
    opal::prepare_streams();
    opal::set_command_line(argc, argv);
    int code = 1;
    try {
        code = opal::run(argc, argv);
    } catch (const std::bad_alloc &) {
        opal::tell_error("out of memory on the host");
    } catch (const opal::ErrorList &errors) {
        for (const std::string &line : errors.lines())
            opal::tell_error(line.c_str());
    } catch (const std::exception &error) {
        opal::tell_error(error.what());
    }
    return opal::exit_code_after_output(code);
}
