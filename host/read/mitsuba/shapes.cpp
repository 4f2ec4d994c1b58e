// Parsers of shapes.
#include "base/error.h"
#include "base/log.h"
#include "read/mitsuba/meshes.h"
#include "read/mitsuba/parsers.h"
#include "read/obj.h"
#include "read/ply.h"
#include "read/texture_values.h"

#include <fmt/format.h>

#include <set>

namespace opal::mitsuba {

namespace {

// What all shapes have.
struct Start {
    Transform to_world;
    bool flip_normals;
    std::vector<std::string> attributes; // those of the mesh that textures name
};

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
template <class Read> Shape parse_mesh(Object &object, const Start &start, bool flips_tex_coords, Read read) {
    const MeshOptions options = {
        .face_normals = object.boolean("face_normals").value_or(false),
        .flip_normals = start.flip_normals,
        .flip_tex_coords = object.boolean("flip_tex_coords").value_or(flips_tex_coords),
    };
    const auto file = object.file("filename", "the shape is left out");
    if (!object.has("filename"))
        object.mistake(
            fmt::format("the shape lacks its filename: <string name=\"filename\" value=\"a.{}\"/>", object.type()));
    if (!file)
        throw NoObject{};
    return at_shape(object,
                    [&] { return finished_mesh(read(*file, start.to_world, object.context().hashes), options); });
}

Shape parse_obj(Object &object, const Start &start) {
    return parse_mesh(object, start, true, [](const auto &...arguments) { return read_obj(arguments...).mesh; });
}

Shape parse_ply(Object &object, const Start &start) {
    return parse_mesh(object, start, false,
                      [&](const auto &...arguments) { return read_ply(arguments..., start.attributes); });
}

Shape parse_sphere(Object &object, const Start &start) {
    const Vec3 center = object.point("center").value_or(Vec3{});
    const double radius = object.number("radius").value_or(1);
    object.check(radius > 0, "radius", "must be above 0");
    const std::string fault = why_no_sphere(start.to_world);
    object.check(fault.empty(), "to_world", fault);
    return Sphere{center, radius, start.flip_normals}.moved(start.to_world);
}

Shape parse_rectangle(Object &object, const Start &start) {
    return at_shape(object, [&] { return rectangle(start.to_world, start.flip_normals); });
}

Shape parse_cube(Object &object, const Start &start) {
    return at_shape(object, [&] { return cube(start.to_world, start.flip_normals); });
}

// Calls visit(parameter, texture) for each texture of a mesh attribute on the material.
template <class Visit> void each_attribute(Bsdf &bsdf, const Visit &visit) {
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (const auto found = bsdf.textures.find(parameter.texture_word);
            found != bsdf.textures.end() && std::holds_alternative<MeshAttributeTexture>(found->second))
            visit(&parameter, found->second);
    for (Bsdf &child : bsdf.children)
        each_attribute(child, visit);
}

// The same of a mesh; that of its light is of no parameter.
template <class Visit> void each_attribute(Mesh &mesh, const Visit &visit) {
    each_attribute(mesh.bsdf, visit);
    if (mesh.texture && std::holds_alternative<MeshAttributeTexture>(*mesh.texture))
        visit(nullptr, *mesh.texture);
}

// The names of the attributes that textures of the mesh want, each once.
std::vector<std::string> attribute_names(Mesh &mesh) {
    std::set<std::string> names;
    each_attribute(mesh, [&](const Parameter *, const Texture &texture) {
        names.insert(std::get<MeshAttributeTexture>(texture).name);
    });
    return {names.begin(), names.end()};
}

// Gives those textures the attributes of the mesh.
void bind_attributes(const Object &object, Mesh &mesh) {
    const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape);
    each_attribute(mesh, [&](const Parameter *parameter, Texture &texture) {
        auto &own = std::get<MeshAttributeTexture>(texture);
        if (triangles)
            for (const auto &attribute : triangles->attributes)
                if (attribute->name == own.name)
                    own.attribute = attribute;
        if (own.attribute) {
            if (parameter)
                warn_of_values(object.place(), *parameter, texture);
            return;
        }
        const std::string message = fmt::format(
            "the shape has no attribute '{}', which a texture of its material or light names; files of the shape "
            "ply have some: vertex_color by the properties red, green and blue of their vertices",
            own.name);
        if (!object.context().lenient)
            return object.mistake(message);
        warn(fmt::format("{}: {}; 0.5 stands in for it", object.place().text(), message));
        texture = CheckerboardTexture{{0.5, 0.5, 0.5}, {0.5, 0.5, 0.5}};
    });
}

const std::vector<Plugin<Shape (*)(Object &, const Start &)>> shape_types = {
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
        mesh.shape = type->parse(object, {to_world, flip_normals, attribute_names(mesh)});
        bind_attributes(object, mesh);
        is_made = true;
    });
    object.finish();
    if (is_made)
        scene.meshes.push_back(std::move(mesh));
}

} // namespace opal::mitsuba
