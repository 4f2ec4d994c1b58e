#include "commands/json_file.h"

#include "base/command_line.h"
#include "base/json.h"
#include "base/log.h"
#include "image/image.h"

namespace opal {

OptionRow json_row(std::string &file, const std::string &what) {
    return {.flags = "--json",
            .target = &file,
            .help = "JSON of " + what + "; - prints it to stdout, and all else to stderr",
            .type = "FILE|-"};
}

void prepare_json(const std::string &file) {
    if (file == "-")
        free_stdout();
    else if (!file.empty())
        check_writable(file);
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
    if (file == "-")
        print_data(text);
    else
        write_safely(file, text);
}

} // namespace opal
