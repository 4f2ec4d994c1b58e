// Parsers of films and of their reconstruction filters.
#include "base/log.h"
#include "read/mitsuba/parsers.h"
#include "scene/filter.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal::mitsuba {

namespace {

void set_gaussian(Filter &filter, double stddev) {
    filter.kind = FILTER_gaussian;
    filter.stddev = stddev;
    filter.radius = 4 * stddev;
}

void set_cubic(Filter &filter, double b, double c) { // Mitchell and Netravali 1988
    filter.kind = FILTER_mitchell;
    filter.radius = 2;
    filter.b = b;
    filter.c = c;
}

void parse_box(Object &, Filter &filter) {
    filter.kind = FILTER_box;
    filter.radius = 0.5;
}

void parse_tent(Object &object, Filter &filter) {
    filter.kind = FILTER_tent;
    filter.radius = object.number("radius").value_or(1);
}

void parse_gaussian(Object &object, Filter &filter) { set_gaussian(filter, object.number("stddev").value_or(0.5)); }

void parse_mitchell(Object &object, Filter &filter) {
    set_cubic(filter, object.number("B").value_or(1.0 / 3), object.number("C").value_or(1.0 / 3));
}

void parse_catmullrom(Object &, Filter &filter) { set_cubic(filter, 0, 0.5); }

void parse_lanczos(Object &object, Filter &filter) {
    filter.kind = FILTER_lanczos;
    filter.radius = object.integer("lobes").value_or(3);
}

const std::vector<Plugin<void (*)(Object &, Filter &)>> filter_types = {
    {"box", "box", parse_box},
    {"tent", "tent", parse_tent},
    {"gaussian", "gaussian", parse_gaussian},
    {"mitchell", "mitchell", parse_mitchell},
    {"catmullrom", "mitchell with B 0, C 1/2", parse_catmullrom},
    {"lanczos", "lanczos", parse_lanczos},
};

} // namespace

void parse_filter(Importer &importer, Object &object, Filter &filter) {
    const auto *type = importer.row_of_type(object, filter_types, "a gaussian one stands in for it");
    if (!type)
        return;
    filter.given = true;
    filter.place = object.place();
    type->parse(object, filter);
    if (const std::string problem = filter_problem(filter); !problem.empty())
        object.mistake(problem);
    object.finish();
}

namespace {

// A property with a choice of names that say how Mitsuba writes the file. `own`: as Opal does it.
void parse_format(Object &object, const char *name, const std::vector<std::string> &names, const std::string &own,
                  const char *does) {
    std::string text = object.string(name).value_or(own);
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    if (std::ranges::find(names, text) == names.end())
        object.mistake_at(name, unknown_name("format", text, names));
    else if (text != own)
        note(fmt::format("{}: {} {}: {}", object.place_of(name).text(), name, text, does));
}

// After the size, which must be good.
void parse_crop(Object &object, Camera &camera) {
    const int x = object.integer("crop_offset_x").value_or(0), y = object.integer("crop_offset_y").value_or(0);
    const int width = object.integer("crop_width").value_or(camera.width);
    const int height = object.integer("crop_height").value_or(camera.height);
    if (x < 0 || y < 0 || width < 1 || height < 1 || width > camera.width - x || height > camera.height - y)
        object.mistake(fmt::format("a crop of {} x {} pixels at {}, {} is no part of the film of {} x {}", width,
                                   height, x, y, camera.width, camera.height));
    const Crop crop{x, y, width, height, camera.width, camera.height};
    camera.crop = crop.is_whole() ? Crop{} : crop;
}

void parse_hdrfilm(Importer &importer, Object &object, Camera &camera) {
    camera.width = object.integer("width").value_or(camera.width);
    camera.height = object.integer("height").value_or(camera.height);
    object.check(camera.width >= 1, "width", "must be at least 1 pixel");
    object.check(camera.height >= 1, "height", "must be at least 1 pixel");
    if (camera.width >= 1 && camera.height >= 1)
        parse_crop(object, camera);
    parse_format(object, "file_format", {"openexr", "rgbe", "pfm"}, "openexr", "Opal writes OpenEXR");
    parse_format(object, "pixel_format", {"rgb", "rgba", "luminance", "luminance_alpha", "xyz", "xyza"}, "rgb",
                 "Opal writes R, G and B");
    parse_format(object, "component_format", {"float32", "float16", "uint32"}, "float32", "Opal writes float32");
    for (const char *name : {"banner", "compensate", "sample_border"}) // nothing that the image shows
        object.ignore(name);
    if (const auto filter = only_child(object, "rfilter"))
        importer.context().attempt(*filter, [&] { parse_filter(importer, *filter, camera.filter); });
}

const std::vector<Plugin<void (*)(Importer &, Object &, Camera &)>> film_types = {
    {"hdrfilm", "the image, in float32", parse_hdrfilm}};

} // namespace

void set_default_film(Camera &camera) {
    camera.width = 768;
    camera.height = 576;
    camera.crop = {};
    camera.filter = {};
    set_gaussian(camera.filter, 0.5);
}

void parse_film(Importer &importer, Object &object, Camera &camera) {
    const auto *type = importer.row_of_type(object, film_types, "an hdrfilm of 768 x 576 pixels stands in for it");
    if (!type)
        return;
    type->parse(importer, object, camera);
    object.finish();
}

} // namespace opal::mitsuba
