#include "support/cases.h"

#include "read/nori/parsers.h"

#include <algorithm>

namespace opal::test {

namespace {

std::vector<std::filesystem::path> xml_files(const std::filesystem::path &folder) {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".xml")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

bool in_unit_square(Vec3 p) { return p.z == 0 && std::min(p.x, p.y) >= 0 && std::max(p.x, p.y) <= 1; }
bool in_unit_square(const TriangleMesh &mesh) {
    return std::all_of(mesh.positions.begin(), mesh.positions.end(), [](Vec3 p) { return in_unit_square(p); });
}
bool in_unit_square(const Parallelogram &p) {
    return in_unit_square(p.origin) && in_unit_square(p.origin + p.u) && in_unit_square(p.origin + p.v) &&
           in_unit_square(p.origin + p.u + p.v);
}
bool in_unit_square(const Sphere &) { return true; } // its directions are counted

} // namespace

std::vector<Material> bsdf_cases(const std::filesystem::path &folder) {
    std::vector<Material> cases;
    for (const std::filesystem::path &file : xml_files(folder)) {
        const XmlDocument document(file);
        if (document.root().tag() != "bsdf")
            document.root().fail("a case of this folder is a <bsdf>");
        cases.push_back({file.stem().string(), parse_bsdf(document.root(), {folder})});
    }
    return cases;
}

std::vector<LightCase> emitter_cases(const std::filesystem::path &folder) {
    std::vector<LightCase> cases;
    for (const std::filesystem::path &file : xml_files(folder)) {
        const XmlDocument document(file);
        if (document.root().tag() == "emitter") {
            cases.push_back({file.stem().string(), parse_scene_emitter(document.root(), {folder})});
            continue;
        }
        if (document.root().tag() != "mesh")
            document.root().fail("a case of this folder is a <mesh> with an area emitter, or an <emitter> of a scene");
        const Mesh mesh = parse_meshes(document.root(), {folder}).at(0);
        if (!mesh.radiance)
            document.root().fail("this mesh has no emitter");
        if (!std::visit([](const auto &shape) { return in_unit_square(shape); }, mesh.shape))
            document.root().fail("this light does not lie in the unit square of the plane z = 0");
        cases.push_back({file.stem().string(), mesh});
    }
    return cases;
}

} // namespace opal::test
