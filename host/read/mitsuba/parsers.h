// Parsers of the objects of Mitsuba's files, one a kind; the plug-in picks a row of the kind's table. All fill in
// Mitsuba's defaults. Mistakes go to the context; an object that cannot be made throws NoObject.
#pragma once

#include "read/mitsuba/object.h"

#include <set>
#include <unordered_map>

namespace opal::mitsuba {

// A row of a kind's table: a plug-in that Opal has.
template <class Parse> struct Plugin {
    std::string name;
    std::string becomes; // what Opal makes of it, for `opal inspect`
    Parse parse;
};

// What the parsers of a scene share: which plug-ins it uses, and what was made of objects that several others refer to.
class Importer {
public:
    explicit Importer(const ParseContext &context) : context_(context) {}

    // The row of a table whose name is the object's plug-in; null where there is none, which finish() tells. The
    // properties of such an object are not looked at. instead: what is done if lenient.
    template <class Rows>
    auto row_of_type(Object &object, const Rows &rows, const std::string &instead) -> decltype(&*rows.begin()) {
        for (const auto &row : rows)
            if (row.name == object.type()) {
                count_use(object, row.becomes);
                return &row;
            }
        count_unknown(object, names_of(rows), instead);
        return nullptr;
    }
    // An object of a kind that Opal does not have at all, as <medium>: likewise.
    void refuse(Object &object, const std::string &instead) { count_unknown(object, {}, instead); }

    // What a property asks and Opal does not have: a mistake at it, or if lenient a warning that says what is done
    // instead.
    void lacks(Object &object, const std::string &name, const std::string &message, const std::string &instead) const;

    // The material of a <bsdf>, which is read once however many objects refer to it.
    const Bsdf &bsdf(Object &object);

    // The <texture> that a property is, if it is one and can be read; read once likewise.
    std::optional<Texture> texture(Object &object, const std::string &name);
    const std::optional<Texture> &texture(Object &object);

    // The colour of a property where Opal has no textures: one is a mistake, or if lenient its mean.
    Color color(Object &object, const std::string &name, SpectrumUse use, const Color &otherwise);

    // Area lights that shapes refer to may stand in the scene.
    void add_area_light(const Object &emitter) { area_lights_.insert(&emitter); }
    bool is_area_light_of_shape(const Object &emitter) const { return area_lights_.contains(&emitter); }

    bool has_met(const Object &object) const { return counted_.contains(&object); } // was its plug-in looked at?

    // Waits for the pictures. One mistake for each picture that is damaged, and one for each plug-in that Opal does not
    // have; if lenient, warnings.
    void finish();
    std::vector<PluginUse> uses() const { return uses_; }
    const ParseContext &context() const { return context_; }

private:
    struct Unknown {
        SourcePlace first;
        std::string tag, type;
        std::vector<std::string> known;
        std::string instead;
        size_t count = 0;
    };

    void count_use(const Object &object, const std::string &becomes);
    void count_unknown(Object &object, const std::vector<std::string> &known, const std::string &instead);

    ParseContext context_;
    std::set<const Object *> counted_, area_lights_;
    std::vector<PluginUse> uses_;
    std::vector<Unknown> unknown_;
    std::unordered_map<const Object *, Bsdf> bsdfs_;
    std::unordered_map<const Object *, std::optional<Texture>> textures_;
};

// At most one child of that tag; a second one is a mistake.
std::shared_ptr<Object> only_child(Object &object, const std::string &tag);

// Whether lengths and angles stay: a rotation, a mirroring. To the share that files with few digits reach.
bool keeps_lengths(const Transform &transform);

std::optional<Texture> parse_texture(Importer &importer, Object &object); // nothing if there is a mistake in it
void parse_bsdf(Importer &importer, Object &object, Bsdf &bsdf);

// Adds the meshes of a <shape>.
void parse_shape(Importer &importer, Object &object, SceneDescription &scene);

void parse_area_emitter(Importer &importer, Object &object, Mesh &mesh); // a child of a shape
Light parse_scene_emitter(Importer &importer, Object &object);           // a child of the scene

// What a <sensor> says.
struct Sensor {
    std::string id;
    Camera camera;
    int sampler = 0; // CHOICE_sampler_*
    unsigned spp = 0;
    bool sample_count_given = false;
    SourcePlace sampler_place;
};
Sensor parse_sensor(Importer &importer, Object &object);
Sensor default_sensor(); // what Mitsuba's perspective camera is without any property

// The angle across the width of an image, in degrees, of a camera or a projector; width, height: of the image.
double parse_fov(Object &object, double width, double height);

void parse_film(Importer &importer, Object &object, Camera &camera);
void parse_filter(Importer &importer, Object &object, Filter &filter);
void set_default_film(Camera &camera); // 768 x 576 pixels, a Gaussian filter

// The sampler's choice, and the samples a pixel.
void parse_sampler(Importer &importer, Object &object, Sensor &sensor);
void set_default_sampler(Sensor &sensor); // independent, 4 samples

// Sets the integrator's type and the strategy.
void parse_integrator(Importer &importer, Object &object, SceneDescription &scene);
void set_default_strategy(SceneDescription &scene); // that of Mitsuba's `path`; lights are chosen by power

} // namespace opal::mitsuba
