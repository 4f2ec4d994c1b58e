// Parsers of sensors.
#include "read/mitsuba/parsers.h"

#include "base/values.h"

#include <fmt/format.h>

#include <numbers>

namespace opal::mitsuba {

namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double film_width_35mm = 36, film_height_35mm = 24; // millimetres, of small-format film
constexpr double initial_focal_length = 50;                   // millimetres

// The angle across the image's width of a camera whose angle along another line of the image is `fov`, all in degrees.
// lengths: of the image's width and of that line.
double angle_across_width(double fov, double width, double line) {
    return 2 * std::atan(std::tan(fov / 2 * degree) * width / line) / degree;
}

// The length of the line that `fov` is measured along, in pixels.
double line_of_axis(Object &object, const std::string &axis, double width, double height) {
    if (axis == "x")
        return width;
    if (axis == "y")
        return height;
    if (axis == "diagonal")
        return std::hypot(width, height);
    if (axis == "smaller")
        return std::min(width, height);
    if (axis == "larger")
        return std::max(width, height);
    object.mistake_at("fov_axis", fmt::format("unknown axis '{}'; available: x, y, diagonal, smaller, larger", axis));
    return width;
}

// "50mm", or "50"
double parse_focal_length(Object &object, std::string text) {
    if (text.ends_with("mm"))
        text.resize(text.size() - 2);
    double millimetres = 0;
    try {
        millimetres = parse_number(text);
    } catch (const Error &) { // told below
    }
    object.check(millimetres > 0, "focal_length", "must be a length in millimetres, above 0, as 50mm");
    return millimetres > 0 ? millimetres : initial_focal_length;
}

// That of a lens before small-format film, whose diagonal stands for that of the image.
double fov_of_focal_length(double millimetres, double width, double height) {
    const double half = std::hypot(film_width_35mm, film_height_35mm) / 2;
    return angle_across_width(2 * std::atan(half / millimetres) / degree, width, std::hypot(width, height));
}

void require_rigid(Object &object, const Camera &camera) {
    object.check(keeps_lengths(camera.to_world), "to_world", fmt::format("must not scale a {} camera", object.type()));
}

void parse_perspective(Object &object, Camera &camera) {
    require_rigid(object, camera);
    camera.kind = CAMERA_perspective;
    camera.perspective.fov = parse_fov(object, camera.width, camera.height);
    // The film is moved there, and the axis here.
    camera.perspective.principal_point_x = 0 - object.number("principal_point_offset_x").value_or(0);
    camera.perspective.principal_point_y = 0 - object.number("principal_point_offset_y").value_or(0);
}

void parse_thinlens(Object &object, Camera &camera) {
    require_rigid(object, camera);
    camera.kind = CAMERA_thinlens;
    camera.thinlens.fov = parse_fov(object, camera.width, camera.height);
    const auto radius = object.number("aperture_radius");
    if (!object.has("aperture_radius"))
        object.mistake("the camera lacks its aperture_radius: <float name=\"aperture_radius\" value=\"0.1\"/>");
    camera.thinlens.aperture_radius = radius.value_or(0);
    camera.thinlens.focus_distance = object.number("focus_distance").value_or(camera.far_clip);
    object.check(camera.thinlens.aperture_radius >= 0, "aperture_radius", "must not be negative");
    object.check(camera.thinlens.focus_distance > 0, "focus_distance", "must be above 0");
}

// to_world scales the depth of the near plane, and not what lies between it and the far one.
void parse_orthographic(Object &, Camera &camera) {
    camera.kind = CAMERA_orthographic;
    const double depth = length(camera.to_world.vector({0, 0, 1}));
    camera.far_clip = camera.near_clip + (camera.far_clip - camera.near_clip) / depth;
}

const std::vector<Plugin<void (*)(Object &, Camera &)>> sensor_types = {
    {"perspective", "perspective", parse_perspective},
    {"thinlens", "thinlens", parse_thinlens},
    {"orthographic", "orthographic", parse_orthographic},
};

void set_default_clip(Camera &camera) {
    camera.near_clip = 0.01;
    camera.far_clip = 1e4;
}

} // namespace

double parse_fov(Object &object, double width, double height) {
    const std::optional<double> fov = object.number("fov");
    const std::optional<std::string> focal_length = object.string("focal_length");
    if (fov && focal_length)
        object.mistake_at("focal_length", "stands beside fov, which says it, too: give one of both");
    if (fov) {
        object.check(*fov > 0 && *fov < 180, "fov", "must be above 0 and below 180 degrees");
        const std::string axis = object.string("fov_axis").value_or("x");
        return angle_across_width(*fov, width, line_of_axis(object, axis, width, height));
    }
    object.check(!object.has("fov_axis"), "fov_axis", "means nothing without fov");
    object.ignore("fov_axis");
    return fov_of_focal_length(focal_length ? parse_focal_length(object, *focal_length) : initial_focal_length, width,
                               height);
}

Sensor default_sensor() {
    Sensor sensor;
    set_default_clip(sensor.camera);
    set_default_film(sensor.camera);
    set_default_sampler(sensor);
    sensor.camera.perspective.fov =
        fov_of_focal_length(initial_focal_length, sensor.camera.width, sensor.camera.height);
    return sensor;
}

Sensor parse_sensor(Importer &importer, Object &object) {
    const ParseContext &context = importer.context();
    Sensor sensor = default_sensor();
    sensor.id = object.id();
    sensor.sampler_place = object.place();
    const auto *type = importer.row_of_type(object, sensor_types, "a perspective one stands in for it");
    Camera &camera = sensor.camera;
    if (const auto film = only_child(object, "film"))
        context.attempt(*film, [&] { parse_film(importer, *film, camera); });
    if (const auto sampler = only_child(object, "sampler"))
        context.attempt(*sampler, [&] { parse_sampler(importer, *sampler, sensor); });
    if (!type)
        return sensor;
    camera.place = object.place();
    camera.to_world = object.transform("to_world").value_or(Transform());
    camera.near_clip = object.number("near_clip").value_or(camera.near_clip);
    camera.far_clip = object.number("far_clip").value_or(camera.far_clip);
    object.check(camera.near_clip > 0, "near_clip", "must be above 0");
    object.check(camera.far_clip > camera.near_clip, "far_clip", "must be larger than near_clip");
    for (const char *name : {"shutter_open", "shutter_close"}) // nothing moves
        object.ignore(name);
    for (const auto &medium : object.children("medium"))
        importer.refuse(*medium, "it is left out");
    type->parse(object, camera);
    object.finish();
    return sensor;
}

} // namespace opal::mitsuba
