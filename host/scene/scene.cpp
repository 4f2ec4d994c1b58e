#include "scene/scene.h"

#include "base/error.h"
#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

std::string SourcePlace::text() const {
    if (line == 0)
        return file;
    return column == 0 ? fmt::format("{}:{}", file, line) : fmt::format("{}:{}:{}", file, line, column);
}

std::span<const DialectRow> dialects() {
    static const DialectRow table[] = {{"upstream"}, {"course"}, {"eth"}, {"mitsuba"}};
    return table;
}

const char *bsdf_name(unsigned kind) {
#define OPAL_BSDF_NAME(name, traits) #name,
    static const char *const names[] = {OPAL_ALL_BSDFS(OPAL_BSDF_NAME)};
    return names[kind];
}

unsigned bsdf_traits(unsigned kind) {
#define OPAL_BSDF_TRAITS(name, traits) traits,
    static const unsigned all[] = {OPAL_ALL_BSDFS(OPAL_BSDF_TRAITS)};
    return all[kind];
}

unsigned traits_of_record(std::span<const uint> words, size_t at) {
    unsigned traits = bsdf_traits(words[at]);
    const auto without = [&](const NumberParameter &number, unsigned trait) {
        if (number.value == 0)
            traits &= ~trait;
    };
    if (words[at] == BSDF_principled) {
        const auto principled = record_of<bsdf_principled_record>(words, at);
        without(principled.spec_trans, OPAL_TRANSMITS);
        without(principled.anisotropic, OPAL_TANGENTS);
    } else if (words[at] == BSDF_principledthin)
        without(record_of<bsdf_principledthin_record>(words, at).anisotropic, OPAL_TANGENTS);
    return traits;
}

unsigned Bsdf::traits() const {
    unsigned traits = traits_of_record(words, 0) & ~OPAL_HOLDS_OPAQUE;
    if (is_anisotropic(words))
        traits |= OPAL_TANGENTS;
    for (const Bsdf &child : children)
        traits |= child.traits();
    return traits;
}

const char *emitter_name(unsigned kind) {
#define OPAL_EMITTER_NAME(name, traits) #name,
    static const char *const names[] = {OPAL_EMITTERS(OPAL_EMITTER_NAME)};
    return names[kind];
}

unsigned emitter_traits(unsigned kind) {
#define OPAL_EMITTER_TRAITS(name, traits) traits,
    static const unsigned all[] = {OPAL_EMITTERS(OPAL_EMITTER_TRAITS)};
    return all[kind];
}

bool Bsdf::leads_to(uint wanted) const {
    return kind() == wanted ||
           std::any_of(children.begin(), children.end(), [&](const Bsdf &child) { return child.leads_to(wanted); });
}

size_t Bsdf::count() const {
    size_t count = 1;
    for (const Bsdf &child : children)
        count += child.count();
    return count;
}

void Bsdf::check_count() const {
    if (count() > most_bsdfs)
        throw Error(fmt::format("{}: this {} and what is within it are {} BSDFs; possible: {}", place.text(),
                                bsdf_name(kind()), count(), most_bsdfs));
}

bool Bsdf::is_textured() const {
    return !textures.empty() || std::ranges::any_of(children, [](const Bsdf &child) { return child.is_textured(); });
}

const char *camera_name(unsigned kind) {
#define OPAL_CAMERA_NAME(name, record, traits) #name,
    static const char *const names[] = {OPAL_CAMERAS(OPAL_CAMERA_NAME)};
#undef OPAL_CAMERA_NAME
    return names[kind];
}

std::string camera_text(const Camera &camera) {
    std::string text = camera_name(camera.kind);
    switch (camera.kind) {
#define OPAL_NUMBER_TEXT(type, name, xml, initial, range, meaning)                                                     \
    if (own.name != 0 || initial != 0) /* else nothing is shifted, or no lens is there */                              \
        text += fmt::format(", " xml " {:g}", own.name);
#define OPAL_CAMERA_TEXT(name, record, traits)                                                                         \
    case CAMERA_##name: {                                                                                              \
        [[maybe_unused]] const auto &own = camera.name;                                                                \
        OPAL_CAMERA_##name(OPAL_NUMBER_TEXT) break;                                                                    \
    }
        OPAL_CAMERAS(OPAL_CAMERA_TEXT)
#undef OPAL_CAMERA_TEXT
#undef OPAL_NUMBER_TEXT
    }
    return text;
}

bool has_light(const SceneDescription &scene) {
    return !scene.lights.empty() ||
           std::any_of(scene.meshes.begin(), scene.meshes.end(), [](const Mesh &mesh) { return mesh.radiance; });
}

bool needs_uv(const SceneDescription &scene) {
    return std::ranges::any_of(scene.meshes, [](const Mesh &mesh) {
        return mesh.texture || mesh.bsdf.is_textured() || (mesh.bsdf.traits() & OPAL_TANGENTS) != 0;
    });
}

const Light *light_missed_by_bsdfs(const SceneDescription &scene) {
    for (const Light &light : scene.lights)
        if (!can_be_met(light.kind()))
            return &light;
    return nullptr;
}

} // namespace opal
