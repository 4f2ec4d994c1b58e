// opal render: scenes to EXRs and PNGs.
#include "base/command_line.h"
#include "base/error.h"
#include "base/exit_code.h"
#include "base/file_use.h"
#include "base/json.h"
#include "base/log.h"
#include "base/progress.h"
#include "base/signals.h"
#include "base/units.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "commands/options.h"
#include "flatten/flat_scene.h"
#include "flatten/scene_warnings.h"
#include "render/kernel_choice.h"
#include "render/render_film.h"
#include "render/report.h"
#include "scene/options.h"
#include "selftest/selftest.h"
#include "strategies/combinations.h"
#include "sweep/auto.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <future>

namespace opal {

namespace {

struct Options {
    SceneOptions scene;
    std::vector<std::string> scenes;
    DeviceOptions device;
    std::string out, crop, json, layers, time, time_limit, target_error, strategy, tonemap = "srgb";
    unsigned spp = 0, width = 0, height = 0; // 0: the scene's
    unsigned seed = 0;
    double exposure = 0; // EV
    bool no_png = false, quiet = false, verbose = false;
};

class Stopwatch {
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

void tell_what_runs(const SceneDescription &scene, const FlatScene &flat, const DevicePick &pick, int lanes,
                    unsigned seed) {
    std::string strategy;
    for (int axis : acting_axes(scene))
        strategy += fmt::format("{}{} {}", axis ? ", " : "", axes()[axis].name,
                                axis == AXIS_integrator ? integrator_name(scene)
                                                        : axes()[axis].choices[scene.strategy[axis]].name);
    const auto count = [](size_t n, const char *what) { return fmt::format("{} {}{}", n, what, n == 1 ? "" : "s"); };
    info(fmt::format("scene   {}: {}, {}, {}, {} pixels, {} spp, seed {}", scene.file.string(),
                     scene.meshes.size() == 1 ? "1 mesh" : fmt::format("{} meshes", scene.meshes.size()),
                     count(flat.triangles.size(), "triangle"), count(flat.emitters.size(), "emitter"),
                     text_of(scene.camera.window()), scene.spp, seed));
    info("how     " + strategy);
    info(fmt::format("device  {}, {} lane{}, math {}, {}", text_of(pick), lanes, lanes == 1 ? "" : "s",
                     name_of(scene.strategy.math),
                     scene.strategy.is_general() ? "the general kernel" : "a kernel for this scene"));
}

StopRule stop_rule(const Options &o) {
    StopRule rule;
    if (!o.time.empty())
        rule.seconds = parse_seconds(o.time);
    if (!o.time_limit.empty())
        rule.wall_seconds = parse_seconds(o.time_limit);
    if (!o.target_error.empty())
        rule.relative_error = parse_fraction(o.target_error);
    return rule;
}

// Warns if the driver's relaxed functions are too coarse: some keep 11 bits. They are measured, because no list knows
// the next driver. The kernel is the same for all scenes, so that most drivers have it in their cache.
void warn_of_fast_functions(const Device &device, const BuildOptions &build, const Sources &sources) {
    std::vector<std::string> wrong;
    for (const Finding &f : check_functions(device, build, sources))
        if (!f.passed)
            wrong.push_back(fmt::format("{} {:.3g} (at most {:g} is harmless)", f.check, f.figure, f.limit));
    if (!wrong.empty())
        warn(fmt::format("--math fast: {} (driver {}) computes functions too coarsely, and the image shows it: {}; "
                         "take --math precise",
                         device.info.name, device.info.driver, fmt::join(wrong, "; ")));
}

// Where a render's image goes. Empty: not written.
struct ImageFiles {
    std::filesystem::path exr, png;
    std::string text() const { return exr.string() + (exr.empty() || png.empty() ? "" : " and ") + png.string(); }
};

// What is written of an image.
struct WrittenImage {
    std::vector<std::string> files, errors;
    bool interrupted = false; // while it waited for a reader
};

bool names_folder(const std::string &out) {
    std::error_code ignored; // what is wrong with the name is told by check_output
    return out != "-" && (out.ends_with('/') || std::filesystem::is_directory(out, ignored));
}

// The files that -o asks for. Throws UsageError if it names no format that Opal writes.
ImageFiles image_files(const Options &o, const std::filesystem::path &scene) {
    std::filesystem::path file = path_of(o.out);
    if (o.out.empty() || names_folder(o.out))
        file = file / (scene.stem().string() + ".exr");
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (ending == ".png")
        return {.exr = {}, .png = file};
    const std::filesystem::path beside = png_beside(file);
    if (beside.empty()) // /dev/null, /dev/stdout
        return {.exr = file, .png = {}};
    if (ending != ".exr")
        throw UsageError(
            fmt::format("-o {}: the ending {}; possible: FILE.exr (an EXR and a PNG beside it), FILE.png (only a "
                        "PNG), FOLDER/, - (an EXR to stdout)",
                        o.out, ending.empty() ? "is missing" : "'" + ending + "' names no format of Opal's"));
    return {.exr = file, .png = o.no_png ? std::filesystem::path() : beside};
}

// Throws UsageError if options that say what is written contradict each other.
void check_output_options(const Options &o, const ImageFiles &files) {
    if (names_stdout(o.out) && names_stdout(o.json))
        throw UsageError(fmt::format("-o {} and --json {}: stdout takes one of them", o.out, o.json));
    if (files.exr.empty()) {
        if (o.no_png)
            throw UsageError(fmt::format("-o {} and --no-png: nothing would be written", o.out));
        if (!o.layers.empty())
            throw UsageError(fmt::format("--layers {}: a PNG holds no layers; give -o FILE.exr", o.layers));
    }
    if (files.png.empty() && (o.exposure != 0 || o.tonemap != "srgb"))
        throw UsageError("--exposure and --tonemap: they shape the PNG, and none is written");
}

// Throws Error if a file of the image cannot hold its size.
void check_image_size(const ImageFiles &files, const Crop &window, bool variance) {
    try {
        if (!files.png.empty())
            check_png_size(window.width, window.height);
    } catch (const Error &error) {
        throw Error(
            fmt::format("{}: {}{}", files.png.string(), error.what(), files.exr.empty() ? "" : "; give --no-png"));
    }
    if (!files.exr.empty())
        check_exr_size(window.width, variance ? 6 : 3);
}

// The request of a render, checked before a device is opened.
struct Request {
    SceneDescription scene;
    StopRule rule;
    unsigned spp; // 0: the rule alone decides
    ImageFiles files;
    Display display;  // of the PNG
    std::string json; // for write_json
    bool variance;    // layers of the EXR: --layers, or the scene
    double load_seconds;
};

Request prepare(const Options &o) {
    Request request;
    request.rule = stop_rule(o);
    request.files = image_files(o, o.scene.file);
    check_output_options(o, request.files);
    request.display = {.exposure = o.exposure, .tonemap = o.tonemap == "aces" ? Tonemap::aces : Tonemap::srgb};
    const Stopwatch load;
    SceneDescription &scene = request.scene = load_scene(o.scene);
    set_size(scene.camera, o.width, o.height);
    set_crop(scene.camera, o.crop);
    if (o.spp)
        scene.spp = o.spp;
    request.spp = request.rule.given() && !o.spp ? 0 : scene.spp;
    request.json = o.json;
    prepare_json(o.json);
    if (names_folder(o.out))
        make_folder(o.out);
    for (const std::filesystem::path &file : {request.files.exr, request.files.png}) {
        if (file.empty())
            continue;
        check_writable(file);
        if (o.scenes.size() == 1) // else check_several has noted them all
            note_output(file);
    }
    request.variance = o.layers == "variance" || scene.wants_variance;
    check_image_size(request.files, scene.camera.window(), request.variance);
    request.load_seconds = load.seconds();
    constexpr size_t most_faces = 300'000; // 0.03 s; `opal inspect` looks at all
    for (const std::string &line : scene_warnings(scene, most_faces))
        warn(line);
    for (const std::string &line : scene_notes(scene, o.spp || request.rule.given()))
        note(line);
    return request;
}

// Writes one file of an image, and notes how that went.
template <class Write> void try_to_write(WrittenImage &written, const std::filesystem::path &file, Write write) {
    try {
        write();
        written.files.push_back(file.string());
    } catch (const InterruptedWait &error) {
        written.interrupted = true;
        written.errors.emplace_back(error.what());
    } catch (const std::bad_alloc &) {
        written.errors.push_back(file.string() + ": cannot be written: out of memory on the host");
    } catch (const std::exception &error) {
        written.errors.emplace_back(error.what());
    }
}

// Writes the files side by side. If one fails, the other is written all the same.
WrittenImage write_image(const Image &image, const ImageFiles &files, const Display &display) {
    const RunningProgress progress("writing");
    WrittenImage png, written;
    const auto write = [&] { try_to_write(png, files.png, [&] { write_png(image, files.png, display); }); };
    std::future<void> other;
    if (!files.png.empty()) {
        try {
            other = std::async(std::launch::async, write);
        } catch (const std::system_error &) { // a limit on threads: the PNG is written after the EXR
            other = std::async(std::launch::deferred, write);
        }
    }
    if (!files.exr.empty())
        try_to_write(written, files.exr, [&] { write_exr(image, files.exr); });
    if (other.valid())
        other.get();
    written.files.insert(written.files.end(), png.files.begin(), png.files.end());
    written.errors.insert(written.errors.end(), png.errors.begin(), png.errors.end());
    written.interrupted |= png.interrupted;
    return written;
}

// Writes the image with the report in its header, and tells the result. Returns the exit code.
int report(const Request &request, RenderedFilm &rendered, const RenderReport &render,
           const std::optional<AutoChoice> &choice, bool variance) {
    for (const std::string &line : film_warnings(render))
        warn(line);
    Image image = take_image(rendered.film, variance);
    const ImageFault fault = find_fault(image, render.statistics);
    if (fault)
        warn(fault.text());
    nlohmann::json json = render.json();
    json["invalid_pixels"] = fault.invalid_pixels;
    json["samples_lost"] = fault.samples_lost;
    const StopReport stop = report_stop(request.rule, rendered.stopped, render);
    if (choice)
        json["auto"] = choice->json();
    if (request.rule.given())
        json["stop"] = stop.json();
    json["interrupted"] = !rendered.stopped.complete;
    if (request.spp > 0 || !rendered.stopped.complete) // else the rule alone decides
        json["asked_spp"] = rendered.stopped.spp;
    add_metadata(image, json, command_line());
    const Stopwatch write;
    WrittenImage written = write_image(image, request.files, request.display);
    json["seconds"]["write"] = write.seconds();
    const std::vector<std::string> images = written.files;
    try_to_write(written, request.json, [&] { write_json(request.json, "render", json); });

    info(render.text());
    if (request.rule.given()) {
        info(stop.text());
        if (!stop.met)
            warn(stop.warning());
    }
    if (!images.empty())
        info(fmt::format("wrote   {}", fmt::join(images, " and ")));
    for (const std::string &line : written.errors)
        tell_error(line.c_str());
    if (written.interrupted)
        return interrupt_exit_code();
    if (!written.errors.empty())
        return exit_failed;
    const bool empty = render.statistics.samples + render.statistics.invalid == 0;
    if (rendered.stopped.complete && (fault || empty)) {
        tell_error(fault ? fault.text().c_str() // again, so that the last line says why
                         : "no sample was finished in the time: the image shows nothing");
        return exit_failed;
    }
    if (rendered.stopped.complete)
        return exit_done;
    warn(fmt::format("interrupted: the image holds {:.4g} of {} samples a pixel", render.spp(), rendered.stopped.spp));
    return interrupt_exit_code();
}

// The paths that are asked at the most, for suits_general_kernel; a goal for the error alone sets no bound.
double paths_asked(const Request &request, const DeviceInfo &device) {
    const Crop window = request.scene.camera.window();
    const double pixels = double(window.width) * window.height;
    double paths = request.spp ? pixels * request.spp : INFINITY;
    for (const double seconds : {request.rule.seconds, request.rule.wall_seconds})
        if (seconds > 0)
            paths = std::min(paths, paths_in(device, seconds));
    return paths;
}

int render_scene(const Options &o) {
    Request request = prepare(o);
    SceneDescription &scene = request.scene;
    const auto [pick, build] = choose_kernel(o.device, scene);
    const Device device = open_device(pick.info);
    const Sources sources = load_sources(o.scene.cl_dir);
    std::optional<AutoChoice> choice;
    if (!o.strategy.empty()) {
        choice = choose_strategy(scene, device, sources, o.seed);
        info(choice->text());
        scene.strategy = choice->strategy;
    }
    scene.strategy.few_paths = suits_general_kernel(pick.info, paths_asked(request, pick.info), scene);
    const Stopwatch bvh;
    FlatScene flat = flatten_and_free(scene, build.lanes);
    const double bvh_seconds = bvh.seconds();
    tell_what_runs(scene, flat, pick, build.lanes, o.seed);
    if (build.math == MathMode::fast)
        warn_of_fast_functions(device, build, sources);
    RenderedFilm rendered =
        render_film(device, std::move(flat), {.build = build, .sources = &sources}, request.rule, o.seed, request.spp);
    const RenderSeconds seconds = {.load = request.load_seconds,
                                   .bvh = bvh_seconds,
                                   .compile = rendered.compile_seconds,
                                   .render = rendered.kernel_seconds};
    return report(request, rendered, {scene, rendered.film, pick.info, build.lanes, o.seed, seconds}, choice,
                  request.variance);
}

// Throws UsageError if the images of several scenes cannot go to files of their own, or one is a scene. All are noted
// before the first render, which would else write over a scene that comes later.
void check_several(const Options &o) {
    if (!names_folder(o.out))
        throw UsageError(fmt::format("{} scenes: their images need a folder, -o FOLDER/", o.scenes.size()));
    if (!o.json.empty())
        throw UsageError(
            fmt::format("--json {}: holds one render, and there are {} scenes; the header of each EXR has the "
                        "same statistics",
                        o.json, o.scenes.size()));
    std::map<std::string, std::string> scene_of;
    for (const std::string &scene : o.scenes)
        if (const auto [other, is_new] = scene_of.try_emplace(image_files(o, scene).text(), scene); !is_new)
            throw UsageError(fmt::format("{} and {}: both images would be {}", other->second, scene, other->first));
    for (const std::string &scene : o.scenes)
        note_input(scene);
    for (const std::string &scene : o.scenes) {
        const ImageFiles files = image_files(o, scene);
        for (const std::filesystem::path &file : {files.exr, files.png})
            if (!file.empty())
                note_output(file);
    }
}

// Renders one scene after the other. One that fails does not stop the others.
int render_scenes(Options o) {
    check_several(o);
    std::vector<std::string> failed;
    for (const std::string &scene : o.scenes) {
        forget_warnings();
        o.scene.file = scene;
        try {
            if (const int code = render_scene(o); code == exit_failed)
                failed.push_back(scene);
            else if (code != exit_done)
                return code; // interrupted
        } catch (const std::exception &error) {
            tell_error(error);
            failed.push_back(scene);
        }
    }
    if (failed.empty())
        return 0;
    throw Error(fmt::format("{} of {} scenes failed: {}", failed.size(), o.scenes.size(), fmt::join(failed, ", ")));
}

int run(Options &o) {
    set_quiet(o.quiet);
    set_verbose(o.verbose);
    if (o.scenes.size() > 1)
        return render_scenes(o);
    o.scene.file = o.scenes.front();
    return render_scene(o);
}

} // namespace

Command render_command() {
    auto o = std::make_shared<Options>();
    return {
        .name = "render",
        .help = "Render scenes to EXRs and PNGs",
        .options = append(
            append({{.flags = "SCENE.xml",
                     .target = &o->scenes,
                     .help = "The scene, in the format of Nori or of Mitsuba; several need -o FOLDER/, and one that "
                             "fails does not stop the others",
                     .type = "",
                     .required = true,
                     .many_words = true}},
                   strategy_rows(o->scene)),
            {device_row(o->device),
             threads_row(o->device),
             {.flags = "-o,--output",
              .target = &o->out,
              .help = "FILE.exr: an EXR, and a PNG beside it; FILE.png: only a PNG; FOLDER/: both, by the scene's "
                      "name; -: an EXR to stdout [the scene's name, in the current folder]",
              .type = "FILE"},
             {.flags = "--no-png", .target = &o->no_png, .help = "Write no PNG"},
             {.flags = "--exposure",
              .target = &o->exposure,
              .help = "Multiplies the PNG's radiance by 2^EV; the EXR stays as it is",
              .check = Range{-64.0, 64.0},
              .type = "EV"},
             {.flags = "--tonemap",
              .target = &o->tonemap,
              .help = "How the PNG shows a radiance x (after --exposure): srgb clamps it to 0 to 1; aces takes "
                      "x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14), Narkowicz's fit of the ACES film curve "
                      "(2015); the sRGB curve follows",
              .check = OneOf<std::string>{{"srgb", "aces"}}},
             {.flags = "--spp",
              .target = &o->spp,
              .help = "Samples per pixel [the scene's]",
              .check = Range{1u, 0xffffffffu}},
             {.flags = "--time",
              .target = &o->time,
              .help = "Stop after this much kernel time (30s, 2min); --spp is then the most",
              .check = Accepts{parse_seconds},
              .type = "TIME"},
             {.flags = "--target-error",
              .target = &o->target_error,
              .help = "Stop when the relative standard error of the image's mean luminance is below this (1%)\n"
                      "  A pilot of other samples decides how many, so that the image stays unbiased",
              .check = Accepts{parse_fraction},
              .type = "ERROR",
              .excludes = "--time"},
             {.flags = "--time-limit",
              .target = &o->time_limit,
              .help = "Stop rendering this long after the start of the process, by the wall clock: loading and "
                      "compiling count, writing comes after; --spp is then the most",
              .check = Accepts{parse_seconds},
              .type = "TIME",
              .excludes = "--target-error"},
             {.flags = "--strategy",
              .target = &o->strategy,
              .help = "auto: short pilots find which way to sample light costs least on this scene and device",
              .check = OneOf<std::string>{{"auto"}}},
             {.flags = "--width",
              .target = &o->width,
              .help = "Pixels; one of both keeps the aspect [the scene's]",
              .check = Range{1, 65535}},
             {.flags = "--height", .target = &o->height, .help = "Pixels [the scene's]", .check = Range{1, 65535}},
             crop_row(o->crop),
             {.flags = "--seed",
              .target = &o->seed,
              .help = "Seed of the random numbers; the same seed gives the same image"},
             json_row(o->json, "the statistics of the render"),
             {.flags = "--layers",
              .target = &o->layers,
              .help = "More layers for the EXR: variance (of each pixel's mean)",
              .check = OneOf<std::string>{{"variance"}}},
             {.flags = "--quiet", .target = &o->quiet, .help = "Print nothing but warnings and errors"},
             {.flags = "--verbose",
              .target = &o->verbose,
              .help = "Print what the driver remarks on the kernels, too",
              .excludes = "--quiet"}}),
        .examples = {"opal render scenes/cbox_mis.xml --spp 64 -o box.exr",
                     "opal scenes/mixed_room.xml --time 30s --width 400"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
