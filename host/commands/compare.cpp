// opal compare: errors of an image against a reference, and a test of their means.
#include "base/color.h"
#include "base/error.h"
#include "base/exit_code.h"
#include "base/json.h"
#include "base/log.h"
#include "commands/commands.h"
#include "commands/json_file.h"
#include "compare/evidence.h"
#include "image/metrics.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace opal {

namespace {

struct Options {
    std::string image, reference, out, json;
    double significance = 1e-3;
    double limit = -1; // of relMSE; below 0: none
    bool quiet = false;
};

bool is_variance(const std::string &layer) { return layer.starts_with("variance."); }

bool is_color(const std::string &layer) { return layer == "R" || layer == "G" || layer == "B"; }

std::string names_of(const Image &image) {
    std::vector<std::string> names;
    for (const Layer &layer : image.layers)
        names.push_back(layer.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

// Drops the layers that are not compared: all but R, G, B and the variances, without which there is no test.
void keep_colors(const std::string &file, Image &image) {
    std::vector<std::string> dropped;
    std::erase_if(image.layers, [&](const Layer &layer) {
        const bool drops = !is_color(layer.name) && !is_variance(layer.name);
        if (drops)
            dropped.push_back(layer.name);
        return drops;
    });
    if (!dropped.empty())
        note(fmt::format("{}: holds {}, which is left out", file, fmt::join(dropped, ", ")));
}

// Makes R, G and B the luminance (ITU-R BT.709). That of the variances does not follow from them.
void to_luminance(Image &image) {
    std::vector<float> values(image.get("R").values.size());
    for (size_t i = 0; i < values.size(); i++)
        values[i] = float(luminance({image.get("R").values[i], image.get("G").values[i], image.get("B").values[i]}));
    std::erase_if(image.layers, [](const Layer &layer) { return is_variance(layer.name); });
    for (Layer &layer : image.layers)
        layer.values = values;
}

// Leaves in both images what they share: R, G, B, or luminance where one holds nothing else. Returns what it is.
const char *share_layers(const Options &o, Image &image, Image &reference) {
    for (const auto &[file, read] : {std::pair(o.image, &image), std::pair(o.reference, &reference)})
        for (const char *name : {"R", "G", "B"})
            if (!read->find(name))
                throw Error(
                    fmt::format("{}: has no layer {}, which is compared; it holds {}", file, name, names_of(*read)));
    keep_colors(o.image, image);
    keep_colors(o.reference, reference);
    if (image.is_luminance == reference.is_luminance)
        return image.is_luminance ? "luminance" : "R, G, B";
    to_luminance(image.is_luminance ? reference : image);
    return "luminance";
}

// Cuts the image that holds the other one to its part. Throws Error if they are not of one whole image, or neither
// holds the other.
void align(const Options &o, Image &image, Image &reference) {
    const Crop a = image.place(), b = reference.place();
    Crop both = a;
    both.x = std::max(a.x, b.x);
    both.y = std::max(a.y, b.y);
    both.width = std::min(a.x + a.width, b.x + b.width) - both.x;
    both.height = std::min(a.y + a.height, b.y + b.height) - both.y;
    const bool one_size = a.of_width == b.of_width && a.of_height == b.of_height;
    if (!one_size || (both != a && both != b))
        throw Error(fmt::format("the {} differ: {} has {} pixels, {} has {}", one_size ? "windows" : "sizes", o.image,
                                text_of(a), o.reference, text_of(b)));
    if (a == b)
        return;
    note(fmt::format("the part of {} x {} pixels at ({}, {}), which both hold, is compared", both.width, both.height,
                     both.x, both.y));
    image = cropped(image, both);
    reference = cropped(reference, both);
}

// The error of pixels that are not finite; empty if there are none.
std::string invalid_text(const std::string &file, const InvalidPixels &invalid, const Crop &place) {
    if (invalid.count == 0)
        return "";
    return fmt::format("{}: {} pixels are NaN or infinite, the first at ({}, {}); the figures leave them out", file,
                       invalid.count, place.x + invalid.x, place.y + invalid.y);
}

// The samples a pixel that opal render noted in the header; 0 if there is no note.
double samples_of(const Image &image) { return image.number("opal.spp"); }
double empty_pixels(const Image &image) { return image.number("opal.empty_pixels"); }

// The reason why the means cannot be tested; empty if they can.
std::string why_untested(const std::string &file, const Image &image) {
    for (const char *name : {"variance.R", "variance.G", "variance.B"})
        if (!image.find(name))
            return fmt::format("{} holds no layer {} (opal render --layers variance)", file, name);
    if (const double empty = empty_pixels(image))
        return fmt::format("{} has {} pixels without a sample", file, empty);
    for (const Layer &layer : image.layers)
        if ((is_variance(layer.name) || layer.name.size() == 1) &&
            !std::ranges::all_of(layer.values, [](float value) { return std::isfinite(value); }))
            return fmt::format("{} has pixels in {} that are NaN or infinite", file, layer.name);
    if (const double samples = samples_of(image); samples > 0 && samples < 2)
        return fmt::format("{} has one sample a pixel and so no variance", file);
    if (const double single = image.number("opal.single_sample_pixels"))
        return fmt::format("{} has {} pixels with one sample and so no variance", file, single);
    return "";
}

stats::Estimate estimated(const Image &image) {
    const double samples = samples_of(image);
    return estimate_of(image, samples, samples > 0 ? samples - 1 : std::numeric_limits<double>::infinity());
}

void write_map(const std::filesystem::path &exr, const Image &image, const Image &reference,
               const stats::TileTest *test) {
    Image d = difference(image, reference);
    d.crop = image.crop;
    const Image colours = difference_colours(d);
    if (test)
        for (Layer &layer : tile_map(*test, test->z, d.width, d.height).layers)
            d.layers.push_back({"z." + layer.name, std::move(layer.values)});
    write_exr(d, exr);
    if (const std::filesystem::path png = png_beside(exr); !png.empty())
        write_png(colours, png);
}

nlohmann::json json_of(const Metrics &m) {
    return object({{"mse", m.mse},
                   {"rmse", m.rmse},
                   {"rel_mse", m.rel_mse},
                   {"rel_mse_denominator", "reference^2 + rel_mse_floor"},
                   {"rel_mse_floor", m.rel_mse_floor},
                   {"mae", m.mae},
                   {"smape", m.smape},
                   {"smape_denominator", "(|image| + |reference|) / 2"},
                   {"psnr_db", m.psnr}, // infinite (equal images) is written as null
                   {"mean_difference", m.mean_difference},
                   {"max_difference", m.max_difference},
                   {"max_x", m.max_x},
                   {"max_y", m.max_y},
                   {"invalid_pixels", m.invalid}});
}

nlohmann::json json_of(const stats::TileTest &t, double significance) {
    nlohmann::json j = object({{"p_value", t.p_value},
                               {"significance", significance},
                               {"differ", t.rejected(significance)},
                               {"tile_size", t.size},
                               {"columns", t.columns},
                               {"rows", t.rows},
                               {"z", t.z}});
    for (const stats::TestResult &whole : t.whole)
        j["whole_image_p"].push_back(whole.p_value);
    const stats::Region &r = t.region;
    if (r.tiles > 0)
        j["region"] = object({{"channel", std::string(1, "RGB"[r.channel])},
                              {"tiles", r.tiles},
                              {"x", r.box.x},
                              {"y", r.box.y},
                              {"width", r.box.width},
                              {"height", r.box.height},
                              {"z", r.statistic},
                              {"mean_image", r.mean_a},
                              {"mean_reference", r.mean_b}});
    return j;
}

std::string text_of(const Metrics &m) {
    const auto line = [](const char *name, double value, const std::string &what) {
        return fmt::format("{:<8}{:<13.6g}{}\n", name, value, what);
    };
    return line("MSE", m.mse, "mean of d^2, d = A - B, over pixels and R, G, B") + line("RMSE", m.rmse, "its root") +
           line("relMSE", m.rel_mse,
                fmt::format("mean of d^2 / (B^2 + {:.3g}), the floor being (1 % of B's mean)^2", m.rel_mse_floor)) +
           line("MAE", m.mae, "mean of |d|") + line("SMAPE", m.smape, "mean of |d| / ((|A| + |B|) / 2), from 0 to 2") +
           line("PSNR", m.psnr, "dB, of the images as the PNGs show them (sRGB curve, clamped to 0 to 1), peak 1") +
           line("mean d", m.mean_difference, "") +
           line("max |d|", m.max_difference, fmt::format("at pixel ({}, {})", m.max_x, m.max_y));
}

std::string text_of(const stats::TileTest &t, double significance) {
    return fmt::format(
        "Welch, tiles of {0} x {0} pixels and the whole image, Sidak over all: {1}\n{2} at the level {3:g}\n", t.size,
        describe(t), t.rejected(significance) ? "The means differ" : "No difference of the means was found",
        significance);
}

int run(const Options &o) {
    set_quiet(o.quiet);
    if (!o.out.empty()) {
        if (std::filesystem::path(o.out).extension() == ".png")
            throw Error(fmt::format("--output {}: names the EXR file; the PNG goes beside it", o.out));
        check_output(o.out);
        if (const std::filesystem::path png = png_beside(o.out); !png.empty())
            check_output(png);
    }
    prepare_json(o.json);
    Image image = read_exr(o.image), reference = read_exr(o.reference);
    const std::string shared = share_layers(o, image, reference);
    align(o, image, reference);
    if (const std::string a = image.text("opal.scene_hash"), b = reference.text("opal.scene_hash");
        !a.empty() && !b.empty() && a != b)
        note(fmt::format("{} and {} are of different scene files, by opal.scene_hash in their headers", o.image,
                         o.reference));
    const Crop place = image.place();
    for (const auto &[file, read] : {std::pair(o.image, &image), std::pair(o.reference, &reference)})
        if (const double empty = empty_pixels(*read))
            warn(fmt::format("{}: {} pixels without a sample; the figures take them for black", file, empty));

    std::vector<std::string> invalid;
    for (const auto &[file, read] : {std::pair(o.image, &image), std::pair(o.reference, &reference)})
        if (std::string line = invalid_text(file, invalid_pixels(*read), place); !line.empty())
            invalid.push_back(std::move(line));
    Metrics metrics = compare_images(image, reference);
    metrics.max_x += place.x;
    metrics.max_y += place.y;
    nlohmann::json report = json_of(metrics);
    report.update(object({{"image", o.image}, {"reference", o.reference}, {"compared", shared}}));
    const bool limited = o.limit >= 0, black = metrics.rel_mse_floor == 0; // black: relMSE leaves those pixels out
    const bool within_limit = metrics.rel_mse <= o.limit && (!black || metrics.mse == 0) && invalid.empty();
    if (limited)
        report.update(object({{"limit", o.limit}, {"within_limit", within_limit}}));
    if (!o.quiet)
        print_text(fmt::format("Compared: {}\n", shared) + text_of(metrics));
    std::string untested =
        image.is_luminance != reference.is_luminance
            ? "the images share luminance alone, whose variance does not follow from those of R, G, B"
            : why_untested(o.image, image);
    if (untested.empty())
        untested = why_untested(o.reference, reference);
    std::optional<stats::TileTest> test;
    if (untested.empty()) {
        test = stats::tile_test(estimated(image), estimated(reference));
        for (stats::PixelBox *box : {&test->region.box, &test->worst_tile}) {
            box->x += place.x;
            box->y += place.y;
        }
        report["test"] = json_of(*test, o.significance);
        if (!o.quiet)
            print_text(text_of(*test, o.significance));
    } else {
        report["untested"] = untested;
        if (!o.quiet)
            print("No test of the means: {}\n", untested);
    }
    if (!o.out.empty())
        write_map(o.out, image, reference, test ? &*test : nullptr);
    write_json(o.json, "compare", report);
    if (!invalid.empty())
        throw ErrorList(invalid);
    if (!limited)
        return exit_done;
    print("relMSE {:.6g} is {} the limit of {:g}{}\n", metrics.rel_mse, within_limit ? "within" : "not within", o.limit,
          black && !within_limit ? ": the reference is black, and the image is not" : "");
    return within_limit ? exit_done : exit_check_failed;
}

} // namespace

Command compare_command() {
    auto o = std::make_shared<Options>();
    return {
        .name = "compare",
        .help = "Compare two images: errors, and a test whether their means agree",
        .options = {{.flags = "A.exr", .target = &o->image, .help = "The image", .type = "", .required = true},
                    {.flags = "B.exr", .target = &o->reference, .help = "The reference", .type = "", .required = true},
                    {.flags = "-o,--output",
                     .target = &o->out,
                     .help = "EXR for the difference A - B (and z.R, z.G, z.B of its tiles); a PNG goes beside it, "
                             "red where A is brighter, blue where B is",
                     .type = "FILE"},
                    json_row(o->json, "the figures"),
                    {.flags = "--significance",
                     .target = &o->significance,
                     .help = "Level of the test whether their means agree",
                     .check = Range{1e-12, 0.5}},
                    {.flags = "--fail",
                     .target = &o->limit,
                     .help = "Exit with 3 if relMSE is above this; 0: if any pixel differs",
                     .check = Range{0.0, 1e6},
                     .type = "LIMIT"},
                    {.flags = "--quiet",
                     .target = &o->quiet,
                     .help = "Print nothing but the verdict of --fail, warnings and errors"}},
        .examples = {"opal compare a.exr b.exr --fail 1e-3",
                     "opal compare a.exr b.exr -o difference.exr --json figures.json"},
        .run = [o] { return run(*o); }};
}

} // namespace opal
