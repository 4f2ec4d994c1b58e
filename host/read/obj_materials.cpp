#include "read/obj_materials.h"

#include "base/error.h"
#include "base/log.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <unordered_map>

namespace opal {

namespace fs = std::filesystem;

namespace {

// Materials by their names, and the names by themselves without what seems to be a comment at their ends.
struct Materials {
    std::unordered_map<std::string, MtlMaterial> by_name;
    std::unordered_map<std::string, std::string> full_names;
};

fs::path beside(const fs::path &obj, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    return obj.parent_path() / name;
}

bool is_file(const fs::path &path) {
    std::error_code ignored;
    return fs::is_regular_file(path, ignored);
}

// A '#' behind a blank seems to begin a comment; names may hold one.
std::string without_comment(const std::string &name) {
    for (size_t at = name.find('#', 1); at != std::string::npos; at = name.find('#', at + 1))
        if (name[at - 1] == ' ' || name[at - 1] == '\t')
            return name.substr(0, name.find_last_not_of(" \t", at - 1) + 1);
    return name;
}

std::string without_quotes(const std::string &name) {
    return name.size() > 2 && name.front() == '"' && name.back() == '"' ? name.substr(1, name.size() - 2) : name;
}

// The files of a statement `mtllib`: its whole rest is one name, which may hold blanks; where there is no such file,
// its words are names.
std::vector<fs::path> files_of(const ObjLibrary &library, const fs::path &obj) {
    const std::string names = without_comment(library.names);
    for (const std::string &name : {library.names, names})
        if (const fs::path whole = beside(obj, without_quotes(name)); is_file(whole))
            return {whole};
    std::vector<fs::path> files;
    for (std::string_view word : blank_separated(names))
        if (const fs::path file = beside(obj, without_quotes(std::string(word))); is_file(file))
            files.push_back(file);
        else
            warn(fmt::format("{}: no such material library: {}", library.place.text(), file.string()));
    return files;
}

Materials read_libraries(const ObjFile &obj, const fs::path &file, FileHashes *hashes) {
    Materials materials;
    std::set<fs::path> known; // a library may be named before each object
    for (const ObjLibrary &library : obj.libraries)
        for (const fs::path &path : files_of(library, file))
            if (known.insert(path).second)
                for (MtlMaterial &material : read_mtl(path, hashes)) {
                    materials.full_names.try_emplace(without_comment(material.name), material.name);
                    materials.by_name.try_emplace(material.name, material);
                }
    return materials;
}

// The material of that name, or without the comment that one of the two names seems to end with; null if there is none.
const MtlMaterial *find_material(const Materials &materials, const std::string &name) {
    for (std::string tried = name;;) {
        if (const auto found = materials.by_name.find(tried); found != materials.by_name.end())
            return &found->second;
        const size_t comment = tried.rfind(" #");
        if (comment == std::string::npos)
            break;
        tried.erase(std::min(tried.find_last_not_of(' ', comment) + 1, comment));
    }
    const auto found = materials.full_names.find(name);
    return found == materials.full_names.end() ? nullptr : &materials.by_name.at(found->second);
}

// The triangles of each material, by index, in the order of the materials' first use. OPAL_NONE: of those before the
// first `usemtl`.
struct Parts {
    std::vector<unsigned> materials;
    std::vector<std::vector<size_t>> triangles; // of each of `materials`
};

Parts parts_of(const ObjFile &obj) {
    Parts parts;
    std::map<unsigned, size_t> part_of; // by material
    for (size_t i = 0; i < obj.material_runs.size(); i++) {
        const ObjMaterialRun run = obj.material_runs[i];
        const size_t end =
            i + 1 < obj.material_runs.size() ? obj.material_runs[i + 1].first : obj.mesh.triangles.size();
        if (run.first == end)
            continue;
        const auto [part, is_new] = part_of.try_emplace(run.material, parts.materials.size());
        if (is_new) {
            parts.materials.push_back(run.material);
            parts.triangles.emplace_back();
        }
        for (size_t triangle = run.first; triangle < end; triangle++)
            parts.triangles[part->second].push_back(triangle);
    }
    return parts;
}

// The image of a statement, whose v grows upwards. It is looked for beside the library.
std::optional<Texture> texture_of(const MtlTexture &image, const std::string &instead, PictureLoader &pictures,
                                  FileHashes *hashes) {
    BitmapTexture texture;
    texture.wrap = image.clamp ? WRAP_clamp : WRAP_repeat;
    const auto [scale_u, scale_v] = image.scale;
    const auto [offset_u, offset_v] = image.offset;
    texture.to_uv = {{{scale_u, 0, offset_u}, {0, -scale_v, 1 - offset_v}}};
    try {
        const fs::path file = beside(image.place.file, image.file);
        if (!is_file(file))
            throw Error("no such file: " + file.string());
        texture.picture = pictures.load_now(file, hashes);
    } catch (const Error &error) {
        warn(fmt::format("{}: {}: {}; {}", image.place.text(), image.statement, error.what(), instead));
        return std::nullopt;
    }
    return texture;
}

void add_surface(const MtlMaterial &material, const ObjMaterialOptions &options, const TextureReader &read, Mesh &mesh,
                 bool &visible) {
    const SurfaceOfMaterial surface = surface_of(material, options.own_bsdf ? TextureReader() : read);
    if (!material.colors.contains("kd") && !material.textures.contains("map_kd") && !options.own_bsdf)
        note(fmt::format("{}: material '{}' has no Kd: 0.8 is taken", material.place.text(), material.name));
    if (!surface.lacking.empty() && !options.own_bsdf)
        warn(fmt::format("{}: material '{}': Opal does not render {}", material.place.text(), material.name,
                         fmt::join(surface.lacking, ", ")));
    visible = !surface.is_invisible || options.own_bsdf;
    if (!options.own_bsdf)
        mesh.bsdf = surface.bsdf;
    if (!options.own_emitter && surface.radiance) {
        mesh.radiance = surface.radiance;
        mesh.emits_on_both_sides = true;
    }
}

} // namespace

std::vector<Mesh> meshes_by_material(ObjFile &&obj, const fs::path &file, const Mesh &mesh, ObjMaterialOptions options,
                                     FileHashes *hashes, const std::shared_ptr<PictureLoader> &pictures) {
    std::vector<Mesh> meshes;
    const Parts parts = parts_of(obj);
    if (parts.materials.empty()) { // no `usemtl`
        meshes.push_back(mesh);
        meshes.back().shape = std::move(obj.mesh);
        return meshes;
    }
    const Materials materials = read_libraries(obj, file, hashes);
    const TextureReader read = [&](const MtlTexture &image, const std::string &instead) {
        return texture_of(image, instead, *pictures, hashes);
    };
    std::vector<TriangleMesh> shapes;
    if (parts.materials.size() == 1)
        shapes.push_back(std::move(obj.mesh));
    else
        shapes = obj.mesh.parts(parts.triangles);
    for (size_t i = 0; i < shapes.size(); i++) {
        Mesh own = mesh;
        bool visible = true;
        if (parts.materials[i] != OPAL_NONE) {
            const ObjMaterial &used = obj.materials[parts.materials[i]];
            own.name += ": " + used.name;
            if (const MtlMaterial *material = find_material(materials, used.name))
                add_surface(*material, options, read, own, visible);
            else if (!options.own_bsdf)
                warn(fmt::format("{}: no material '{}' in the libraries: its triangles are grey, diffuse ({})",
                                 used.place.text(), used.name, shapes[i].triangles.size()));
        }
        if (!visible)
            continue;
        own.shape = std::move(shapes[i]);
        meshes.push_back(std::move(own));
    }
    return meshes;
}

void warn_of_unused_materials(const ObjFile &obj, const fs::path &file) {
    if (obj.materials.empty())
        return;
    warn(
        fmt::format("{}: {} material{} not used, as Nori ignores them; <boolean name=\"materials\" value=\"true\"/> in "
                    "the <mesh> turns them on",
                    file.string(), obj.materials.size(), obj.materials.size() == 1 ? " is" : "s are"));
}

} // namespace opal
