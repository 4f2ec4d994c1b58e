// Parsers of meshes: triangles of an OBJ or PLY file, parallelograms and spheres.
#include "base/error.h"
#include "base/log.h"
#include "read/nori/parsers.h"
#include "read/obj_materials.h"
#include "read/ply.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

// What a mesh has but for its shape.
struct MeshStart {
    Mesh mesh;
    Transform to_world;
    ObjMaterialOptions own;
};

// The meshes that `read` makes of a file, which an error in it names first.
template <class Read>
std::vector<Mesh> parse_file(Properties &properties, MeshStart &start, const std::optional<std::string> &filename,
                             Read read) {
    std::string name = properties.required(filename, "filename");
    if (start.mesh.name.empty())
        start.mesh.name = name;
    const std::filesystem::path file = find_file(properties, "filename", name, "the mesh is left out");
    try {
        return read(file);
    } catch (const Error &error) {
        throw Error(std::string(error.what()) + " (the mesh at " + start.mesh.place.text() + ")");
    } catch (const std::bad_alloc &) {
        throw Error(start.mesh.place.text() + ": out of memory while " + file.string() + " is read");
    }
}

std::vector<Mesh> parse_obj(Properties &properties, MeshStart start) {
    // Properties are fetched before one is required: none of them is unknown where another is missing.
    const auto filename = properties.string("filename");
    const bool with_materials = properties.boolean("materials").value_or(false);
    FileHashes *const hashes = properties.context().hashes;
    return parse_file(properties, start, filename, [&](const std::filesystem::path &file) -> std::vector<Mesh> {
        ObjFile obj = read_obj(file, start.to_world, hashes);
        if (with_materials)
            return meshes_by_material(std::move(obj), file, start.mesh, start.own, hashes,
                                      properties.context().pictures);
        if (!start.own.own_bsdf)
            warn_of_unused_materials(obj, file);
        start.mesh.shape = std::move(obj.mesh);
        return {std::move(start.mesh)};
    });
}

std::vector<Mesh> parse_ply(Properties &properties, MeshStart start) {
    const auto filename = properties.string("filename");
    return parse_file(properties, start, filename, [&](const std::filesystem::path &file) -> std::vector<Mesh> {
        start.mesh.shape = read_ply(file, start.to_world, properties.context().hashes);
        return {std::move(start.mesh)};
    });
}

std::vector<Mesh> parse_parallelogram(Properties &properties, MeshStart start) {
    const auto origin = properties.point("origin");
    const auto u = properties.vector("u"), v = properties.vector("v");
    const Parallelogram shape =
        Parallelogram{properties.required(origin, "origin"), properties.required(u, "u"), properties.required(v, "v")}
            .moved(start.to_world);
    if (!(length(cross(shape.u, shape.v)) > 1e-12 * length(shape.u) * length(shape.v)))
        properties.mistake("the parallelogram has no area: u and v are zero or parallel");
    start.mesh.shape = shape;
    return {std::move(start.mesh)};
}

std::vector<Mesh> parse_sphere(Properties &properties, MeshStart start) {
    Sphere sphere;
    sphere.center = properties.point("center").value_or(sphere.center);
    sphere.radius = properties.number("radius").value_or(sphere.radius);
    properties.check(sphere.radius > 0 && std::isfinite(sphere.radius), "radius", "must be above 0");
    const std::string fault = why_no_sphere(start.to_world);
    properties.check(fault.empty(), "toWorld", fault);
    start.mesh.shape = sphere.moved(start.to_world);
    return {std::move(start.mesh)};
}

// Whether the transform turns the normals round: those of faces, which follow from the order of the corners. Normals of
// corners stay on their side.
bool is_turned_by(const Transform &to_world, const Shape &shape) {
    const auto *mesh = std::get_if<TriangleMesh>(&shape);
    return to_world.determinant() < 0 && (!mesh || mesh->normals.empty());
}

struct ShapeType {
    std::string name;
    std::vector<Mesh> (*parse)(Properties &, MeshStart);
};

const std::vector<ShapeType> shape_types = {
    {"obj", parse_obj}, {"ply", parse_ply}, {"parallelogram", parse_parallelogram}, {"sphere", parse_sphere}};

} // namespace

std::filesystem::path find_file(const Properties &properties, const std::string &property, std::string name,
                                const std::string &instead) {
    std::replace(name.begin(), name.end(), '\\', '/');
    const std::filesystem::path beside = properties.context().folder / name;
    std::error_code ignored;
    for (const std::filesystem::path &candidate : {beside, std::filesystem::path(name)})
        if (std::filesystem::exists(candidate, ignored))
            return candidate;
    const std::string message = fmt::format("no such file: {}, nor {} in the current folder", beside.string(), name);
    if (!properties.context().lenient)
        properties.fail_at(property, message);
    warn(fmt::format("{}: property '{}': {}; {}", properties.place_of(property).text(), property, message, instead));
    throw NoObject{};
}

std::vector<Mesh> parse_meshes(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    const ShapeType *type = properties.row_of_type(shape_types, "the shape is left out");
    if (!type && context.lenient)
        throw NoObject{};
    MeshStart start;
    Mesh &mesh = start.mesh;
    mesh.place = node.place();
    mesh.name = properties.string("name").value_or("");
    const Transform to_world = start.to_world = properties.transform("toWorld").value_or(Transform());
    const auto bsdf = properties.child("bsdf");
    if (bsdf) {
        context.attempt(*bsdf, [&] { mesh.bsdf = parse_bsdf(*bsdf, context); });
        start.own.own_bsdf = true;
    }
    for (const XmlNode &texture : properties.children("texture")) {
        context.attempt(texture, [&] { apply_texture(texture, context, bsdf.value_or(texture), mesh.bsdf); });
        mesh.bsdf.place = bsdf.value_or(texture).place();
        start.own.own_bsdf = true;
    }
    if (auto emitter = properties.child("emitter")) {
        context.attempt(*emitter, [&] { parse_area_emitter(*emitter, context, mesh); });
        start.own.own_emitter = true;
    }
    if (!type)
        throw NoObject{};
    std::vector<Mesh> meshes;
    context.attempt(node, [&] { meshes = type->parse(properties, std::move(start)); });
    properties.finish();
    const auto is_turned = [&](const Mesh &made) {
        return made.radiance && !made.emits_on_both_sides && is_turned_by(to_world, made.shape);
    };
    if (std::any_of(meshes.begin(), meshes.end(), is_turned))
        warn(node.place().text() + ": toWorld mirrors this light, so that it shines on the other side");
    return meshes;
}

} // namespace opal
