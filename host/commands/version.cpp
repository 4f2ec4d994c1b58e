// opal version: what this binary was built of, and the OpenCL drivers that are installed.
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "device/ask_driver.h"
#include "image/image.h"

#include <OpenEXR/OpenEXRConfig.h>
#include <fmt/format.h>
#include <memory>

#include <cstdio> // jpeglib.h needs FILE
#include <jpeglib.h>
#include <png.h>
#include <pugixml.hpp>
#include <xxhash.h>

namespace opal {

namespace {

struct Part {
    std::string name, version;
};

std::string compiler() {
#ifdef __clang__
    return __VERSION__; // "Clang 14.0.6"
#else
    return "GCC " __VERSION__;
#endif
}

std::vector<Part> libraries() {
    return {
        {"OpenEXR", OPENEXR_VERSION_STRING},
        {"libpng", png_get_libpng_ver(nullptr)},
        {"libjpeg-turbo", fmt::format("{}.{}.{}", LIBJPEG_TURBO_VERSION_NUMBER / 1000000,
                                      LIBJPEG_TURBO_VERSION_NUMBER / 1000 % 1000, LIBJPEG_TURBO_VERSION_NUMBER % 1000)},
        {"pugixml", fmt::format("{}.{}", PUGIXML_VERSION / 1000, PUGIXML_VERSION % 1000 / 10)},
        {"fmt", fmt::format("{}.{}.{}", FMT_VERSION / 10000, FMT_VERSION / 100 % 100, FMT_VERSION % 100)},
        {"nlohmann_json", fmt::format("{}.{}.{}", NLOHMANN_JSON_VERSION_MAJOR, NLOHMANN_JSON_VERSION_MINOR,
                                      NLOHMANN_JSON_VERSION_PATCH)},
        {"xxHash", fmt::format("{}.{}.{}", XXH_VERSION_MAJOR, XXH_VERSION_MINOR, XXH_VERSION_RELEASE)}};
}

int run(const std::string &json) {
    prepare_json(json);
    nlohmann::json report = nlohmann::json::object();
    print("opal {}\n", OPAL_VERSION);
    const auto row = [&](const std::string &name, const std::string &value) {
        print("{:<15}{}\n", name, value);
        report["parts"].push_back(object({{"name", name}, {"version", value}}));
    };
    row("commit", OPAL_COMMIT);
    row("compiler", compiler());
    for (const Part &part : libraries())
        row(part.name, part.version);
    row("OpenCL loader", loader_path());
    for (const Driver &driver : find_drivers()) // none is opened: `opal devices` asks them
        row("OpenCL driver", driver.name.empty()             ? "none is installed"
                             : driver.library.empty()        ? driver.name + ": " + driver.problem
                             : driver.library == driver.name ? driver.name
                                                             : driver.name + ", " + driver.library);
    write_json(json, "version", report);
    return exit_done;
}

} // namespace

Command version_command() {
    const auto json = std::make_shared<std::string>();
    return {.name = "version",
            .help = "Print version, commit, compiler, libraries, and the OpenCL drivers that are installed",
            .options = {json_row(*json, "the same")},
            .examples = {"opal version", "opal version --json -"},
            .run = [json] { return run(*json); }};
}

} // namespace opal
