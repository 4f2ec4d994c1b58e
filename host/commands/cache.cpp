// opal cache: the compiled kernels that are kept on disk.
#include "base/json.h"
#include "base/log.h"
#include "base/table.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "device/kernel_cache.h"
#include "flatten/flat_scene.h"
#include "render/renderer.h"
#include "scene/options.h"

#include <fmt/format.h>

#include <chrono>
#include <memory>

namespace opal {

namespace {

struct Options {
    DeviceOptions device;
    std::string math = "precise", json;
    bool warm = false, clear = false;
};

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
    const CacheFolder &cache = cache_folder();
    if (o.clear)
        clear_cache(cache.path);
    if (o.warm) {
        const DevicePick pick = choose_device(o.device);
        const double seconds = warm(o, pick);
        print("compiled       the general kernel, math {}, for {} in {:.3g} s\n", o.math, pick.info.name, seconds);
        report.update(object({{"device", pick.info.name}, {"math", o.math}, {"seconds", {{"compile", seconds}}}}));
    }
    const CacheContents contents = cache_contents(cache.path);
    if (cache.path.empty())
        print("cache          none ({})\n", cache.problem);
    else
        print("cache          {}: {} program{}, {} (at most {}){}\n", cache.path.string(), contents.programs,
              contents.programs == 1 ? "" : "s", bytes_text(contents.bytes), bytes_text(most_cache_bytes),
              cache.problem.empty() ? "" : "; nothing can be added: " + cache.problem);
    report.update(object({{"folder", cache.path.string()},
                          {"programs", contents.programs},
                          {"bytes", contents.bytes},
                          {"most_bytes", most_cache_bytes},
                          {"problem", cache.problem}}));
    write_json(o.json, "cache", report);
    return 0;
}

} // namespace

Command cache_command() {
    auto o = std::make_shared<Options>();
    return {.name = "cache",
            .help = "Show the cache of compiled kernels, empty it, or compile ahead what every scene starts with",
            .options = {{.flags = "--warm",
                         .target = &o->warm,
                         .help = "Compile the general kernel, which renders small pictures of all scenes (--specialise "
                                 "auto), so that the first one starts at once"},
                        {.flags = "--clear", .target = &o->clear, .help = "Empty the cache first"},
                        device_row(o->device),
                        {.flags = "--math",
                         .target = &o->math,
                         .help = "With --warm: the kernel's arithmetic",
                         .check = OneOf<std::string>{names_of(math_modes())}},
                        json_row(o->json, "the cache's folder and size")},
            .examples = {"opal cache --clear", "opal cache --warm"},
            .run = [o] { return run(*o); }};
}

} // namespace opal
