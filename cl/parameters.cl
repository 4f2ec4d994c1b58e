// parameters: reading of the parameters that a record holds (shared/parameters.h), each lane of its own record.
#include "core/lanes.cl"
#include "core/math.cl"
#include "scene.cl"
#include "shared/parameters.h"
#include "textures/dispatch.cl"

// The parameter of the records that begin at word `at` of the table in which `parameter` lies in the first record. uv:
// where textures are asked; textured: whether the kernel's scene has a texture there; active: lanes that are meant.
static v3 color_parameter(const Scene *scene, global const ColorParameter *parameter, uints at, v2 uv, int textured,
                          mask active) {
    global const float *value = parameter->value;
    v3 color = v3_of(GATHER_WORD(real, value, at), GATHER_WORD(real, (value + 1), at),
                     GATHER_WORD(real, (value + 2), at));
    if (textured) color = v3_mul(color, texture_color(scene, GATHER_WORD(uints, &parameter->texture, at), uv, active));
    return color;
}

static real number_parameter(const Scene *scene, global const NumberParameter *parameter, uints at, v2 uv, int textured,
                             mask active) {
    real number = GATHER_WORD(real, &parameter->value, at);
    if (textured) {
        v3 factor = texture_color(scene, GATHER_WORD(uints, &parameter->texture, at), uv, active);
        number = number * luminance(factor);
    }
    return number;
}

static mask flag_parameter(const Scene *scene, global const uint *parameter, uints at, v2 uv, int textured,
                          mask active) {
    return to_mask(GATHER_WORD(uints, parameter, at) != 0);
}

static uints bsdf_parameter(const Scene *scene, global const uint *parameter, uints at, v2 uv, int textured,
                          mask active) {
    return GATHER_WORD(uints, parameter, at);
}

// A list of parameters as members of the lanes' struct: OPAL_BSDF_phong(LANES_MEMBER).
#define LANES_MEMBER(type, name, xml, initial, range, meaning) LANES_MEMBER_##type name;
#define LANES_MEMBER_COLOR v3
#define LANES_MEMBER_NUMBER real
#define LANES_MEMBER_FLAG mask
#define LANES_MEMBER_BSDF uints

// The places of parameters in their list: a bit each of OPAL_TEXTURED_*.
#define PARAMETER_PLACE(type, name, xml, initial, range, meaning) PLACE_##name,

// Statements that read a list of parameters into the members of `lanes`, from `record` at `at`.
#define READ_PARAMETER(type, name, xml, initial, range, meaning) \
    lanes.name = READ_PARAMETER_##type(scene, &record->name, at, uv, textured >> PLACE_##name & 1, active);
#define READ_PARAMETER_COLOR color_parameter
#define READ_PARAMETER_NUMBER number_parameter
#define READ_PARAMETER_FLAG flag_parameter
#define READ_PARAMETER_BSDF bsdf_parameter
