// Parsers of the camera and of its reconstruction filter.
#include "read/nori/parsers.h"
#include "scene/filter.h"

#include <fmt/format.h>

namespace opal {

namespace {

void parse_box(Properties &, Filter &filter) { filter.radius = 0.5; }

void parse_tent(Properties &, Filter &filter) { filter.radius = 1; }

void parse_gaussian(Properties &properties, Filter &filter) {
    filter.radius = properties.number("radius").value_or(2);
    filter.stddev = properties.number("stddev").value_or(0.5);
}

void parse_mitchell(Properties &properties, Filter &filter) {
    filter.radius = properties.number("radius").value_or(2);
    filter.b = properties.number("B").value_or(1.0 / 3);
    filter.c = properties.number("C").value_or(1.0 / 3);
}

void parse_lanczos(Properties &properties, Filter &filter) { filter.radius = properties.number("radius").value_or(3); }

// Catmull and Rom's spline: Mitchell's filter of B 0, C 0.5.
void parse_catmullrom(Properties &properties, Filter &filter) {
    filter.radius = properties.number("radius").value_or(2);
    filter.b = 0;
    filter.c = 0.5;
}

struct FilterType {
    std::string name;
    int kind;
    void (*parse)(Properties &, Filter &);
};

#define OPAL_FILTER_TYPE(name) {#name, FILTER_##name, parse_##name},
const std::vector<FilterType> filter_types = {
    OPAL_FILTERS(OPAL_FILTER_TYPE){"catmullrom", FILTER_mitchell, parse_catmullrom}};

struct CameraType {
    std::string name;
    uint kind;
    void (*parse)(Properties &, Camera &); // the parameters of the kind
};

// Reads a number if it is given.
void read_number(Properties &properties, const char *name, ValueRange range, const char *meaning, double &number) {
    number = properties.number(name).value_or(number);
    properties.check(range.holds(number), name, fmt::format("must be {}: {}", text_of(range), meaning));
}

#define OPAL_READ_NUMBER(type, name, xml, initial, range, meaning)                                                     \
    read_number(properties, xml, range, meaning, own.name);
#define OPAL_CAMERA_TYPE(name, record, traits)                                                                         \
    {#name, CAMERA_##name, []([[maybe_unused]] Properties &properties, [[maybe_unused]] Camera &camera) {              \
         [[maybe_unused]] auto &own = camera.name;                                                                     \
         OPAL_CAMERA_##name(OPAL_READ_NUMBER)                                                                          \
     }},
// thin_lens: a public fork of Nori.
const std::vector<CameraType> camera_types = [] {
    std::vector<CameraType> types = {OPAL_CAMERAS(OPAL_CAMERA_TYPE)};
    types.push_back({"thin_lens", CAMERA_thinlens, types[CAMERA_thinlens].parse});
    return types;
}();

// Public forks of Nori gave their perspective camera a lens. With a radius above 0 it is a thinlens.
void read_lens_of_perspective(Properties &properties, Camera &camera) {
    const double radius = properties.number("lensRadius").value_or(0);
    const auto focus = properties.number("focalDistance");
    properties.check(radius >= 0, "lensRadius", "must be 0 or more: radius of the lens");
    if (!properties.boolean("DoF").value_or(true) || !(radius > 0))
        return;
    camera.kind = CAMERA_thinlens;
    camera.thinlens = {camera.perspective.fov, radius, properties.required(focus, "focalDistance")};
    properties.check(*focus > 0, "focalDistance", "must be above 0: depth of the plane that is seen sharply");
    for (const char *name : {"principalPointX", "principalPointY"})
        properties.check(!properties.has(name), name, "is of a pinhole alone, but this camera has a lens");
}

} // namespace

Filter parse_filter(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    const FilterType *type = properties.row_of_type(filter_types, "the default filter stands in for it");
    Filter filter;
    if (!type)
        return filter;
    filter.kind = type->kind;
    filter.given = true;
    filter.place = node.place();
    type->parse(properties, filter);
    if (const std::string problem = filter_problem(filter); !problem.empty())
        properties.mistake(problem);
    properties.finish();
    return filter;
}

Camera parse_camera(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    const CameraType *type = properties.row_of_type(camera_types, "a perspective one stands in for it");
    if (!type)
        type = &camera_types[CAMERA_perspective];
    Camera camera;
    camera.kind = type->kind;
    camera.place = node.place();
    camera.to_world = properties.transform("toWorld").value_or(Transform());
    camera.width = properties.integer("width").value_or(camera.width);
    camera.height = properties.integer("height").value_or(camera.height);
    type->parse(properties, camera);
    if (camera.kind == CAMERA_perspective)
        context.attempt(node, [&] { read_lens_of_perspective(properties, camera); });
    camera.near_clip = properties.number("nearClip").value_or(camera.near_clip);
    camera.far_clip = properties.number("farClip").value_or(camera.far_clip);
    properties.check(camera.width >= 1, "width", "must be at least 1 pixel");
    properties.check(camera.height >= 1, "height", "must be at least 1 pixel");
    properties.check(camera.near_clip >= 0, "nearClip", "must not be negative");
    properties.check(camera.far_clip > camera.near_clip, "farClip", "must be larger than nearClip");
    if (auto filter = properties.child("rfilter"))
        context.attempt(*filter, [&] { camera.filter = parse_filter(*filter, context); });
    properties.finish();
    return camera;
}

} // namespace opal
