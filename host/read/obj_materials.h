// The materials of OBJ files: `mtllib` and `usemtl`.
#pragma once

#include "read/mtl.h"
#include "read/obj.h"
#include "read/picture_loader.h"

namespace opal {

// What a mesh in the scene file says itself overrides the materials.
struct ObjMaterialOptions {
    bool own_bsdf = false, own_emitter = false;
};

// A mesh for each material that the file's triangles use, in the order of first use, with its BSDF and light; all else
// is that of `mesh`. Libraries are looked for beside the OBJ file, images beside the library. Warns of libraries,
// materials and images that are missing and, a line a material, of what Opal does not render.
std::vector<Mesh>
meshes_by_material(ObjFile &&obj, const std::filesystem::path &file, const Mesh &mesh, ObjMaterialOptions options,
                   FileHashes *hashes = nullptr,
                   const std::shared_ptr<PictureLoader> &pictures = std::make_shared<PictureLoader>());

// Warns where a file has materials: Nori ignores them. Counts what is unused.
void warn_of_unused_materials(const ObjFile &obj, const std::filesystem::path &file);

} // namespace opal
