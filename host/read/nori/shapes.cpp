// Parsers of meshes: triangles of an OBJ file, and parallelograms.
#include "base/error.h"
#include "read/nori/parsers.h"
#include "read/obj.h"

#include <algorithm>

namespace opal {

namespace {

// Finds a file beside the XML file, else in the current folder. Backslashes separate folders, too.
std::filesystem::path find_file(Properties &properties, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    std::filesystem::path beside = properties.context().folder / name;
    std::error_code ignored;
    for (const std::filesystem::path &candidate : {beside, std::filesystem::path(name)})
        if (std::filesystem::exists(candidate, ignored))
            return candidate;
    properties.fail_at("filename", "no such file: " + beside.string() + ", nor " + name + " in the current folder");
}

void parse_obj(Properties &properties, const Transform &to_world, Mesh &mesh) {
    std::string name = properties.required(properties.string("filename"), "filename");
    if (mesh.name.empty())
        mesh.name = name;
    std::filesystem::path file = find_file(properties, name);
    try {
        mesh.shape = read_obj(file, to_world).mesh;
    } catch (const Error &error) { // the place in the OBJ file comes first
        throw Error(std::string(error.what()) + " (the mesh at " + mesh.place.text() + ")");
    }
}

void parse_parallelogram(Properties &properties, const Transform &to_world, Mesh &mesh) {
    Parallelogram shape;
    shape.origin = properties.required(properties.point("origin"), "origin");
    shape.u = properties.required(properties.vector("u"), "u");
    shape.v = properties.required(properties.vector("v"), "v");
    shape = shape.moved(to_world);
    if (!(length(cross(shape.u, shape.v)) > 1e-12 * length(shape.u) * length(shape.v)))
        properties.fail("the parallelogram has no area: u and v are zero or parallel");
    mesh.shape = shape;
}

struct ShapeType {
    std::string name;
    void (*parse)(Properties &, const Transform &, Mesh &);
};

const std::vector<ShapeType> shape_types = {{"obj", parse_obj}, {"parallelogram", parse_parallelogram}};

} // namespace

Mesh parse_mesh(const XmlNode &node, const ParseContext &context) {
    const ShapeType &type = row_of_type(node, shape_types);
    Properties properties(node, context);
    Mesh mesh;
    mesh.place = node.place();
    mesh.name = properties.string("name").value_or("");
    Transform to_world = properties.transform("toWorld").value_or(Transform());
    if (auto bsdf = properties.child("bsdf"))
        mesh.bsdf = parse_bsdf(*bsdf, context);
    if (auto emitter = properties.child("emitter"))
        mesh.radiance = parse_area_emitter(*emitter, context);
    type.parse(properties, to_world, mesh);
    properties.finish();
    return mesh;
}

} // namespace opal
