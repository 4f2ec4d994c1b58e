// Picks the command. The only place that prints an error and exits.
#include "base/command_line.h"
#include "base/error.h"
#include "base/log.h"
#include "commands/commands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <new>
#include <sstream>

namespace opal {
namespace {

struct Command {
    const char *name;
    const char *help;
    RunCommand (*setup)(CLI::App &app);
};

constexpr const char *hidden = ""; // no help: not listed

const Command commands[] = {
    {"render", "Render a scene to an EXR and a PNG", setup_render},
    {"devices", "List every OpenCL platform and device, and which one `render` takes", setup_devices},
    {"inspect", "Show what a scene holds, and what its kernel will be compiled with and why", setup_inspect},
    {"sweep", "Measure error against time of several strategies on a scene, as one HTML page", setup_sweep},
    {"bench", "Measure the speed of a scene: its rays alone, or the whole render", setup_bench},
    {"compare", "Hold an image against another: errors, and whether both can have one mean", setup_compare},
    {"verify", "Hold all unbiased strategies against each other on a scene", setup_verify},
    {"test", "Run Nori's tests: means against references, samples against densities", setup_test},
    {"warp", "Draw samples of a warp, a BSDF or a light and hold them against their density", setup_warp},
    {"extremes", "Stretch scenes over many decades and hold single against double precision", setup_extremes},
    {"selftest", "Check that a device and its driver compute right", setup_selftest},
    {"selftest-group", hidden, setup_selftest_group},
    {"probe-platform", hidden, setup_probe_platform},
};

bool is_command(const std::string &word) {
    return std::any_of(std::begin(commands), std::end(commands), [&](const Command &c) { return word == c.name; });
}

[[noreturn]] void refuse_command(const std::string &word) {
    std::vector<std::string> names;
    for (const Command &command : commands)
        if (command.help != hidden)
            names.push_back(command.name);
    const std::string what = word.empty() ? "no command given" : fmt::format("unknown command '{}'", word);
    throw Error(fmt::format("{}; available: {}, or a scene's .xml file", what, fmt::join(names, ", ")));
}

// `opal SCENE.xml ...` is `opal render SCENE.xml ...`. Returned in reverse, as CLI11 wants it.
std::vector<std::string> arguments(int argc, char **argv) {
    std::vector<std::string> words(argv + 1, argv + argc);
    const auto names_scene = [](const std::string &word) {
        return std::filesystem::path(word).extension() == ".xml" || std::filesystem::is_regular_file(word);
    };
    if (!words.empty() && !is_command(words[0]) && std::any_of(words.begin(), words.end(), names_scene))
        words.insert(words.begin(), "render");
    else if (words.empty() || (!is_command(words[0]) && !words[0].starts_with('-')))
        refuse_command(words.empty() ? std::string() : words[0]);
    std::reverse(words.begin(), words.end());
    return words;
}

int run(int argc, char **argv) {
    CLI::App app("Opal " OPAL_VERSION ": a portable, physically based path tracer in OpenCL.\n"
                 "`opal SCENE.xml` is `opal render SCENE.xml`.",
                 "opal");
    app.set_version_flag("--version", "opal " OPAL_VERSION);
    app.set_help_flag("-h,--help", "Print this and exit");
    app.require_subcommand(1);
    app.option_defaults()->always_capture_default();

    std::map<const CLI::App *, RunCommand> runs;
    for (const Command &command : commands) {
        CLI::App *sub = app.add_subcommand(command.name, command.help);
        if (command.help == hidden)
            sub->group("");
        runs[sub] = command.setup(*sub);
    }
    try {
        app.parse(arguments(argc, argv));
    } catch (const CLI::Success &asked) { // --help, --version
        std::ostringstream text;
        const int code = app.exit(asked, text, text);
        print_text(text.str());
        return code;
    } catch (const CLI::ParseError &error) {
        throw Error(fmt::format("{} (opal --help, or opal COMMAND --help, lists what there is)", error.what()));
    }
    return runs.at(app.get_subcommands().front())();
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
    } catch (const std::exception &error) {
        opal::tell_error(error.what());
    }
    return opal::exit_code_after_output(code);
}
