// SceneDescription: a scene as its file describes it, with all defaults filled in, in world units and double precision.
#pragma once

#include "base/color.h"
#include "base/crop.h"
#include "base/math.h"
#include "cameras/list.h"
#include "scene/emitters.h"
#include "scene/parameters.h"
#include "scene/place.h"
#include "scene/shapes.h"
#include "scene/strategy.h"
#include "scene/textures.h"
#include "shared/types.h"

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace opal {

// What a scene's file is written for: a fork of Nori, or Mitsuba. The forks differ in the default filter (the 2022
// course has a box, the others a Gaussian) and in the camera: its +x points to the image's left, with ETH's course and
// the Nori of 2012 to the right.
enum class Dialect { upstream, course, eth, mitsuba };
struct DialectRow {
    std::string name;
};
std::span<const DialectRow> dialects(); // index = Dialect
inline const std::string &name_of(Dialect dialect) { return dialects()[static_cast<std::size_t>(dialect)].name; }

// Names of kinds, as the XML gives them: "diffuse".
const char *bsdf_name(unsigned kind); // kind: BSDF_*
unsigned bsdf_traits(unsigned kind);  // OPAL_SMOOTH and so on, as bits; of a kind that leads to others its own
// Those of the record whose first word is words[at]: what numbers of 0 take away is not among them.
unsigned traits_of_record(std::span<const uint> words, size_t at);
const char *camera_name(unsigned kind); // kind: CAMERA_*

// The most BSDFs of a material. One that two references name counts twice: few lines could make a million. At most 15
// blends lead to one then (BlendLeaf of cl/bsdfs/interface.cl can count 31).
constexpr size_t most_bsdfs = 32;

// A material: the record of its kind, ready for the device but for the places of the BSDFs that it leads to. By default
// a grey diffuse one.
struct Bsdf {
    std::vector<uint> words;            // of a bsdf_NAME_record
    std::vector<Bsdf> children;         // of its parameters of type BSDF, in order; one stands for both of twosided
    std::map<size_t, Texture> textures; // what multiplies parameters, by Parameter::texture_word
    SourcePlace place;

    Bsdf() : Bsdf(bsdf_diffuse_record{}) {}
    template <class Record> Bsdf(const Record &record) : words(words_of(record)) {}

    uint kind() const { return words[0]; } // BSDF_*
    unsigned traits() const;               // OPAL_SMOOTH and so on, as bits; those of its children where it has some
    bool leads_to(uint kind) const;        // is of that kind, or a BSDF within it is
    size_t count() const;                  // itself and the BSDFs within it
    void check_count() const;              // Error at its place if there are more than most_bsdfs
    bool is_textured() const;              // or a BSDF within it is
    template <class Record> bool is() const { return kind() == Record{}.kind; }
    template <class Record> Record as() const { return record_of<Record>(words); } // is<Record>() must hold
};

struct Mesh {
    std::string name; // file name or given name
    Shape shape;
    Bsdf bsdf;
    std::optional<Color> radiance;    // emitted by its area emitter, W / (m^2 sr)
    std::optional<Texture> texture;   // what multiplies it
    bool emits_on_both_sides = false; // else on the side of its shading normals
    SourcePlace place;
};

struct Filter {
    int kind = FILTER_box;
    double radius = 0.5, stddev = 0.5, b = 1.0 / 3, c = 1.0 / 3;
    bool given = false; // false: the default of the dialect
    SourcePlace place{};
};

struct Camera {
    uint kind = CAMERA_perspective;
    // The parameters of each kind, as `perspective.fov`, with the defaults of cl/cameras/list.h.
#define OPAL_CAMERA_NUMBER(type, name, xml, initial, range, meaning) double name = initial;
#define OPAL_CAMERA_NUMBERS(name, record, traits)                                                                      \
    struct {                                                                                                           \
        OPAL_CAMERA_##name(OPAL_CAMERA_NUMBER)                                                                         \
    } name;
    OPAL_CAMERAS(OPAL_CAMERA_NUMBERS)
#undef OPAL_CAMERA_NUMBERS
#undef OPAL_CAMERA_NUMBER
    Transform to_world;
    int width = 1280, height = 720;
    double near_clip = 1e-4, far_clip = 1e4; // planar, camera space
    Filter filter;
    Crop crop{}; // --crop; all 0: the whole image
    SourcePlace place;

    Crop window() const { return crop == Crop{} ? Crop{0, 0, width, height, width, height} : crop; }
};
std::string camera_text(const Camera &camera); // its kind and parameters: "perspective, fov 30"

// A plug-in that a file of Mitsuba uses.
struct PluginUse {
    std::string tag, type; // "bsdf", "diffuse"
    std::string becomes;   // what Opal makes of it
    size_t count = 0;      // of the objects
};

struct SimpleLight { // the one light of integrator `simple`
    Vec3 position;
    Color energy{};
};

struct SceneDescription {
    std::filesystem::path file;
    std::string hash; // of all files that were read (FileHashes): the scene's, then OBJ files, each with its libraries
    Camera camera;
    std::vector<Mesh> meshes;
    std::vector<Light> lights;                // beside the meshes that emit
    std::string integrator_type = "path_mis"; // as written, e.g. path_tracer_recursive; path_mis where there is none
    Dialect dialect = Dialect::upstream;
    std::map<std::string, std::string> definitions; // the values that stand for $name in the file
    Strategy strategy;
    bool hides_emitters = false; // rays of the camera pass emitters, and see no environment
    bool lights_reflect = false; // direct_lighting: surfaces that emit show the light that they reflect, too
    bool wants_variance = false; // the EXR gets the layers of --layers variance
    bool normals_signed = false;
    SimpleLight simple_light;
    double visibility_length = 1; // integrator av: how far it looks
    unsigned spp = 1;
    bool sample_count_given = false;
    SourcePlace place;              // of the <scene>
    SourcePlace sampler_place;      // of the <sampler>, else of the <scene>
    std::vector<PluginUse> plugins; // of a file of Mitsuba, in the order of their first use
};

bool has_light(const SceneDescription &scene); // an emitter of any kind
bool needs_uv(const SceneDescription &scene);  // do textures or tangents on surfaces need texture coordinates?

// The first light that no BSDF sample can hit, or null.
const Light *light_missed_by_bsdfs(const SceneDescription &scene);

} // namespace opal
