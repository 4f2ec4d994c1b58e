#include "commands/json_file.h"

#include "base/command_line.h"
#include "base/error.h"
#include "base/file_use.h"
#include "base/json.h"
#include "base/log.h"
#include "image/image.h"

#include <fmt/format.h>

#include <algorithm>

#include <unistd.h>

namespace opal {

namespace {

bool is_one_of(const OwnFiles &own, const std::filesystem::path &file) {
    const std::string name = file.filename().string();
    if (std::ranges::none_of(own.beginnings, [&](const std::string &start) { return name.starts_with(start); }))
        return false;
    const std::filesystem::path folder = std::filesystem::weakly_canonical(folder_of(file));
    const std::filesystem::path whole = std::filesystem::weakly_canonical(folder_of(own.folder / name));
    return folder == whole || folder.parent_path() == whole;
}

} // namespace

OptionRow json_row(std::string &file, const std::string &what) {
    return {.flags = "--json",
            .target = &file,
            .help = "JSON of " + what + "; - prints it to stdout, and all else to stderr",
            .type = "FILE|-"};
}

bool names_stdout(const std::string &file) { return !file.empty() && descriptor_of(path_of(file)) == STDOUT_FILENO; }

std::filesystem::path path_of(const std::string &file) { return file == "-" ? "/dev/stdout" : file; }

void prepare_json(const std::string &file, const OwnFiles &own) {
    if (file.empty())
        return;
    if (is_one_of(own, target_of(path_of(file))))
        throw UsageError(fmt::format("--json {}: the command writes this file itself, with other contents", file));
    if (names_stdout(file))
        free_stdout();
    check_output(path_of(file));
}

void write_json(const std::string &file, const std::string &command, nlohmann::json report) {
    if (file.empty())
        return;
    report["opal"] = OPAL_VERSION;
    report["command"] = command;
    report["command_line"] = command_line();
    report["seconds"]["wall"] = seconds_since_start();
    report["warnings"] = warnings();
    const std::string text = dump(report, 2) + "\n";
    if (names_stdout(file))
        print_data(text);
    else
        write_safely(file, text);
}

} // namespace opal
