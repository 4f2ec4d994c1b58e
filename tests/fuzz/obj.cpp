// OBJ files and their material libraries, then flatten. An input is an OBJ file, and behind a line `#mtl` an MTL file.
#include "base/error.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "fuzz/oracles.h"
#include "read/obj_materials.h"

namespace opal::fuzz {

namespace {

constexpr std::string_view marker = "#mtl\n";

void check_meshes(std::vector<Mesh> meshes, int lanes) {
    SceneDescription scene;
    scene.meshes = std::move(meshes);
    for (const Mesh &mesh : scene.meshes)
        check(std::get<TriangleMesh>(mesh.shape));
    check(flatten(scene, lanes));
}

// The last byte says how the mesh is used: in files of this repository it is the end of the last line.
void read(const ServedFile &file, unsigned char use, bool has_library) {
    const Transform to_world = use & 1 ? Transform::scale({1e3, -1, 1e-3}) : Transform();
    Mesh mesh;
    if (use & 4)
        mesh.radiance = Color{1, 1, 1};
    ObjFile obj = read_obj(file.path(), to_world);
    check(obj.mesh);
    size_t first = 0;
    for (const ObjMaterialRun &run : obj.material_runs) {
        require(run.first >= first && run.first <= obj.mesh.triangles.size(), "runs of materials follow each other");
        require(run.material == OPAL_NONE || run.material < obj.materials.size(), "a run's material is one");
        first = run.first;
    }
    warn_of_unused_materials(obj, file.path());
    if (has_library)
        obj.libraries.push_back({"mesh.mtl", {}});
    const ObjMaterialOptions own{(use & 8) != 0, (use & 16) != 0};
    check_meshes(meshes_by_material(std::move(obj), file.path(), mesh, own), use & 2 ? 16 : 1);
}

const TextFormat format = {.words = [](std::string_view text) { return separated(text, " \t\r\n/"); },
                           .replacements = {"v",     "vn",     "vt",   "f",     "usemtl", "mtllib", "newmtl",   "Kd",
                                            "Ke",    "Ks",     "Ns",   "Ni",    "illum",  "d",      "Tr",       "Pr",
                                            "Pm",    "map_Kd", "a",    "1/1/1", "1//1",   "-1",     "1/2",      "-1/-1",
                                            "1 1 1", "#",      "\\\n", "\r\n",  "#mtl\n", "xyz",    "-s",       "-o",
                                            "-bm",   "a.png",  "l",    "p",     "s",      "o",      "spectral", "\t"}};

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("mesh.obj"), library("mesh.mtl");
    if (input.empty())
        return;
    const size_t end = input.find(marker);
    const bool has_library = end != input.npos;
    file.write(input.substr(0, end));
    if (has_library) {
        library.write(input.substr(end + marker.size()));
        try {
            for (const MtlMaterial &material : read_mtl(library.path()))
                surface_of(material);
        } catch (const Error &) {
        }
    }
    try {
        read(file, static_cast<unsigned char>(input.back()), has_library);
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
