// opal cache: the compiled kernels that PoCL keeps on disk.
#include "base/json.h"
#include "base/log.h"
#include "base/table.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "flatten/flat_scene.h"
#include "render/renderer.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <chrono>
#include <cstdlib>
#include <memory>

namespace opal {

namespace {

namespace fs = std::filesystem;

struct Options {
    DeviceOptions device;
    std::string math = "precise", json;
    bool warm = false;
};

std::string variable(const char *name) {
    const char *value = std::getenv(name);
    return value ? value : "";
}

// Where PoCL 3 keeps compiled kernels; empty: it knows no place. Drivers of other makers have caches of their own.
fs::path pocl_cache() {
    if (const std::string folder = variable("POCL_CACHE_DIR"); !folder.empty())
        return folder;
    if (const std::string folder = variable("XDG_CACHE_HOME"); !folder.empty())
        return fs::path(folder) / "pocl/kcache";
    const std::string home = variable("HOME");
    return home.empty() ? fs::path() : fs::path(home) / ".cache/pocl/kcache";
}

struct Contents {
    size_t kernels = 0;
    unsigned long long bytes = 0;
};

Contents contents_of(const fs::path &folder) {
    Contents contents;
    std::error_code error, of_file; // a file may go meanwhile, as PoCL renames some
    for (fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
         !error && at != end; at.increment(error)) {
        const std::uintmax_t bytes = at->is_regular_file(of_file) ? at->file_size(of_file) : 0;
        if (of_file || bytes == 0)
            continue;
        contents.bytes += bytes;
        contents.kernels += at->path().extension() == ".so";
    }
    return contents;
}

// Compiles what every scene on a CPU starts with: the general kernel, and those of the film. Returns the seconds.
double warm(const Options &o, const DevicePick &pick) {
    const auto start = std::chrono::steady_clock::now();
    SceneDescription nothing;
    nothing.camera.width = nothing.camera.height = 8;
    nothing.camera.filter = {.kind = FILTER_gaussian, .radius = 2}; // wide filters have a kernel of their own
    nothing.strategy.specialise = Specialise::off;
    override_strategy(nothing.strategy, {{"math", o.math}});
    const int lanes = lanes_for(pick.info, 0, nothing.strategy.math);
    Renderer renderer(open_device(pick.info), flatten(nothing, lanes),
                      {.build = {.lanes = lanes, .math = nothing.strategy.math}});
    renderer.render(1);
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

int run(const Options &o) {
    prepare_json(o.json);
    nlohmann::json report = nlohmann::json::object();
    if (o.warm) {
        const DevicePick pick = choose_device(o.device);
        const double seconds = warm(o, pick);
        print("compiled       the general kernel, math {}, for {} in {:.3g} s\n", o.math, pick.info.name, seconds);
        report.update(object({{"device", pick.info.name}, {"math", o.math}, {"seconds", {{"compile", seconds}}}}));
    }
    const fs::path folder = pocl_cache();
    const Contents contents = contents_of(folder);
    print("PoCL's cache   {}: {} kernels, {}\n", folder.empty() ? "none, as HOME is not set" : folder.string(),
          contents.kernels, bytes_text(contents.bytes));
    report.update(object({{"folder", folder.string()}, {"kernels", contents.kernels}, {"bytes", contents.bytes}}));
    write_json(o.json, "cache", report);
    return 0;
}

} // namespace

Command cache_command() {
    auto o = std::make_shared<Options>();
    return {.name = "cache",
            .help = "Show PoCL's cache of compiled kernels, or compile ahead what every scene starts with",
            .options = {{.flags = "--warm",
                         .target = &o->warm,
                         .help = "Compile the general kernel, which renders small pictures of all scenes (--specialise "
                                 "auto), so that the first one starts at once"},
                        device_row(o->device),
                        {.flags = "--math",
                         .target = &o->math,
                         .help = "With --warm: the kernel's arithmetic",
                         .check = OneOf<std::string>{names_of(math_modes())}},
                        json_row(o->json, "the cache's folder and size")},
            .examples = {"opal cache", "opal cache --warm"},
            .run = [o] { return run(*o); }};
}

} // namespace opal
