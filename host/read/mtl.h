// The reader of Wavefront's material libraries (MTL), and what Opal makes of their materials. The library keeps no
// record of absent statements, which decide here; so tinyobjloader's own reader of MTL is not used.
#pragma once

#include "base/hash.h"
#include "scene/scene.h"

#include <array>
#include <functional>
#include <map>

namespace opal {

// An image that a statement such as `map_Kd -s 2 2 wood.png` names.
struct MtlTexture {
    std::string statement;                           // as written: "map_Kd"
    std::string file;                                // as written, with forward slashes
    std::array<double, 2> scale{1, 1}, offset{0, 0}; // -s and -o: uv times scale, plus offset
    bool clamp = false;                              // -clamp on
    double strength = 1;                             // -bm, of a bump or normal map
    SourcePlace place;
};

// The statements of one material, by their names in lower case; what is not written is not there.
struct MtlMaterial {
    std::string name;
    SourcePlace place;                     // of its newmtl
    bool by_blender = false;               // the file's first line says so: then Ns and Ka have meanings of their own
    std::map<std::string, Color> colors;   // ka kd ke ks tf, linear RGB
    std::map<std::string, double> numbers; // ns ni d illum pr pm ps pc pcr aniso anisor; `Tr` is kept as d
    std::map<std::string, MtlTexture> textures; // map_kd, map_bump, ...
};

std::vector<std::string_view> blank_separated(std::string_view text); // those between blanks

// Reads all materials of a file in its order; of two with one name the first counts, with a warning. Throws Error
// "file:line:col: ..." for a malformed number, and for a file that is no MTL.
std::vector<MtlMaterial> read_mtl(const std::filesystem::path &file, FileHashes *hashes = nullptr);

// A material in the words of Blender's Principled BSDF, from which both Blender's exporter and the rules of other
// programs can be told. Absent statements have the defaults that readers agree on best (scenes/README.md).
struct PrincipledMaterial {
    Color base{0.8, 0.8, 0.8};
    std::optional<Texture> base_texture; // what multiplies it; set by surface_of
    double roughness = 1;                // 0 to 1; the microfacets' alpha is its square
    double metallic = 0;
    double ior = 1.5;
    double f0 = 0;             // reflectance of the clear layer over the base at normal incidence; 0: there is none
    Color phong{};             // colour of a Phong lobe beside the base, of files that are not Blender's
    double phong_exponent = 0; // of that lobe
    double opacity = 1;        // below 1: that share of the light meets the surface, the rest passes
    double transmission = 0;   // 1: glass
    double sheen = 0, coat = 0, anisotropic = 0;
    double coat_roughness = 0.03; // its alpha is the square
    Color emission{};             // radiance on both sides, W / (m^2 sr)
};
PrincipledMaterial principled_of(const MtlMaterial &material);

// What Opal renders in the place of a material.
struct SurfaceOfMaterial {
    Bsdf bsdf;
    std::optional<Color> radiance;    // emitted on both sides
    bool is_invisible = false;        // d 0: its faces are left out
    std::vector<std::string> lacking; // what the material says and Opal does not render: "map_Kd wood.png"
};

// Makes a texture of an image that a statement names; nothing, and a warning that says what stands in for it, if it
// cannot be read.
using TextureReader = std::function<std::optional<Texture>(const MtlTexture &image, const std::string &instead)>;

// Of the images, those of map_Kd and map_d are rendered; an empty `read` leaves them out, too.
SurfaceOfMaterial surface_of(const MtlMaterial &material, const TextureReader &read = {});

} // namespace opal
