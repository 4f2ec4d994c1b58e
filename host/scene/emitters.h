// The emitters of scenes, each with the parameters that cl/emitters/list.h names, in world units and double precision.
#pragma once

#include "base/color.h"
#include "base/math.h"
#include "emitters/list.h"
#include "scene/environment.h"
#include "scene/parameters.h"
#include "scene/place.h"
#include "scene/textures.h"

#include <optional>
#include <variant>

namespace opal {

const char *emitter_name(unsigned kind); // "mesh", "point"; kind: EMITTER_*
unsigned emitter_traits(unsigned kind);  // OPAL_DELTA and so on, as bits
inline bool can_be_met(unsigned kind) { return OPAL_CAN_BE_MET(emitter_traits(kind)); } // by a BSDF sample
inline bool is_infinite(unsigned kind) { return (emitter_traits(kind) & OPAL_INFINITE) != 0; }
inline bool is_environment(unsigned kind) { return OPAL_IS_ENVIRONMENT(emitter_traits(kind)); }

// A parameter's value in C++; `initial` in all channels or coordinates.
#define OPAL_VALUE_COLOR(initial)                                                                                      \
    Color { initial, initial, initial }
#define OPAL_VALUE_NUMBER(initial) double(initial)
#define OPAL_VALUE_FLAG(initial) bool(initial)
#define OPAL_VALUE_POINT(initial)                                                                                      \
    Vec3 { initial, initial, initial }
#define OPAL_VALUE_VECTOR(initial)                                                                                     \
    Vec3 { initial, initial, initial }
#define OPAL_VALUE_IMAGE(initial) std::shared_ptr<const EnvironmentMap>()
#define OPAL_VALUE_TRANSFORM(initial) Transform()

// The parameters of a kind, as `emitter_point`, and visit_parameters, which calls visit(Parameter, value) for each.
#define OPAL_VALUE_MEMBER(type, name, xml, initial, range, meaning)                                                    \
    decltype(OPAL_VALUE_##type(initial)) name = OPAL_VALUE_##type(initial);
#define OPAL_VISIT_MEMBER(type, name, xml, initial, range, meaning) visit(*row++, parameters.name);
#define OPAL_EMITTER_STRUCT(name, traits)                                                                              \
    struct emitter_##name {                                                                                            \
        static constexpr uint kind = EMITTER_##name;                                                                   \
        OPAL_EMITTER_##name(OPAL_VALUE_MEMBER)                                                                         \
    };                                                                                                                 \
    template <class Visit> void visit_parameters(emitter_##name &parameters, Visit visit) {                            \
        auto row = emitter_parameters(EMITTER_##name).begin();                                                         \
        OPAL_EMITTER_##name(OPAL_VISIT_MEMBER)                                                                         \
    }
OPAL_SCENE_EMITTERS(OPAL_EMITTER_STRUCT)

template <class Unused, class... Kinds> using VariantOf = std::variant<Kinds...>;
#define OPAL_EMITTER_ALTERNATIVE(name, traits) , emitter_##name
using EmitterParameters = VariantOf<void OPAL_SCENE_EMITTERS(OPAL_EMITTER_ALTERNATIVE)>;

// A texture that multiplies the intensity of a spot or a projector. Its u grows along x, its v along y, which are unit
// vectors across the light's direction; its unit square is what the circle of the cutoff angle touches, or the image.
struct LightTexture {
    Texture texture;
    Vec3 x, y;
};

struct Light {
    EmitterParameters parameters;
    SourcePlace place;
    std::optional<LightTexture> texture{}; // of a spot or a projector

    uint kind() const { // EMITTER_*
        return std::visit([](const auto &own) { return own.kind; }, parameters);
    }
    template <class Visit> void visit(Visit visit) {
        std::visit([&](auto &own) { visit_parameters(own, visit); }, parameters);
    }
};

} // namespace opal
