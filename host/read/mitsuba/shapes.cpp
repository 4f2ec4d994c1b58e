// Parsers of shapes.
#include "base/error.h"
#include "base/log.h"
#include "read/mitsuba/meshes.h"
#include "read/mitsuba/parsers.h"
#include "read/obj.h"
#include "read/ply.h"

#include <fmt/format.h>

namespace opal::mitsuba {

namespace {

// The Error of a file or of a transform gets the place of the shape.
template <class Make> auto at_shape(const Object &object, Make make) {
    try {
        return make();
    } catch (const XmlError &) {
        throw;
    } catch (const Error &error) {
        throw Error(fmt::format("{} (the shape at {})", error.what(), object.place().text()));
    } catch (const std::bad_alloc &) {
        throw Error(fmt::format("{}: out of memory while this shape is made", object.place().text()));
    }
}

// The triangles of the file that the shape names. read: (file, to_world, hashes) -> TriangleMesh.
template <class Read>
Shape parse_mesh(Object &object, const Transform &to_world, bool flips_tex_coords, bool flip_normals, Read read) {
    const MeshOptions options = {
        .face_normals = object.boolean("face_normals").value_or(false),
        .flip_normals = flip_normals,
        .flip_tex_coords = object.boolean("flip_tex_coords").value_or(flips_tex_coords),
    };
    const auto file = object.file("filename");
    if (!object.has("filename"))
        object.mistake(
            fmt::format("the shape lacks its filename: <string name=\"filename\" value=\"a.{}\"/>", object.type()));
    if (!file)
        throw NoObject{};
    return at_shape(object, [&] { return finished_mesh(read(*file, to_world, object.context().hashes), options); });
}

Shape parse_obj(Object &object, const Transform &to_world, bool flip_normals) {
    return parse_mesh(object, to_world, true, flip_normals,
                      [](const auto &...arguments) { return read_obj(arguments...).mesh; });
}

Shape parse_ply(Object &object, const Transform &to_world, bool flip_normals) {
    return parse_mesh(object, to_world, false, flip_normals, read_ply);
}

Shape parse_sphere(Object &object, const Transform &to_world, bool flip_normals) {
    const Vec3 center = object.point("center").value_or(Vec3{});
    const double radius = object.number("radius").value_or(1);
    object.check(radius > 0, "radius", "must be above 0");
    object.check(keeps_angles(to_world), "to_world",
                 "a sphere must be scaled alike along all axes: Opal has no ellipsoid");
    return Sphere{center, radius, flip_normals}.moved(to_world);
}

Shape parse_rectangle(Object &object, const Transform &to_world, bool flip_normals) {
    return at_shape(object, [&] { return rectangle(to_world, flip_normals); });
}

Shape parse_cube(Object &object, const Transform &to_world, bool flip_normals) {
    return at_shape(object, [&] { return cube(to_world, flip_normals); });
}

const std::vector<Plugin<Shape (*)(Object &, const Transform &, bool)>> shape_types = {
    {"obj", "triangles", parse_obj},    {"ply", "triangles", parse_ply},
    {"sphere", "sphere", parse_sphere}, {"rectangle", "parallelogram", parse_rectangle},
    {"cube", "triangles", parse_cube},
};

} // namespace

void parse_shape(Importer &importer, Object &object, SceneDescription &scene) {
    const auto *type = importer.row_of_type(object, shape_types, "the shape is left out");
    if (!type)
        return;
    Mesh mesh;
    mesh.place = object.place();
    mesh.name = object.id();
    if (mesh.name.empty()) {
        const bool is_file = type->parse == parse_obj || type->parse == parse_ply;
        mesh.name = (is_file ? object.string("filename") : std::nullopt).value_or(object.type());
    }
    const Transform to_world = object.transform("to_world").value_or(Transform());
    const bool flip_normals = object.boolean("flip_normals").value_or(false);
    object.ignore("silhouette_sampling_weight"); // of differentiable rendering
    const auto bsdf = only_child(object, "bsdf"), emitter = only_child(object, "emitter");
    if (bsdf) {
        mesh.bsdf = importer.bsdf(*bsdf);
    } else if (emitter) { // a lamp reflects nothing
        mesh.bsdf = bsdf_diffuse_record{.albedo = 0};
        mesh.bsdf.place = mesh.place;
    }
    if (emitter)
        importer.context().attempt(*emitter, [&] { parse_area_emitter(importer, *emitter, mesh); });
    for (const char *tag : {"medium", "sensor"})
        for (const auto &child : object.children(tag))
            importer.refuse(*child, "it is left out");
    bool is_made = false;
    importer.context().attempt(object, [&] {
        mesh.shape = type->parse(object, to_world, flip_normals);
        is_made = true;
    });
    object.finish();
    if (is_made)
        scene.meshes.push_back(std::move(mesh));
}

} // namespace opal::mitsuba
