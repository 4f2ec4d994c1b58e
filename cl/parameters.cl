// parameters: reading of the parameters that a record holds (shared/parameters.h), each lane of its own record.
#include "core/lanes.cl"
#include "core/math.cl"
#include "core/rows.cl"
#include "scene.cl"
#include "shared/parameters.h"
#include "textures/dispatch.cl"
#include "textures/interface.cl"

// The parameters of the records that begin at word `at` of the table in which `parameter` lies in the first record.
static v3 color_parameter(global const ColorParameter *parameter, uints at) {
    global const float *value = parameter->value;
    return v3_of(GATHER_WORD(real, value, at), GATHER_WORD(real, (value + 1), at), GATHER_WORD(real, (value + 2), at));
}
static real number_parameter(global const NumberParameter *parameter, uints at) {
    return GATHER_WORD(real, &parameter->value, at);
}
static mask flag_parameter(global const uint *parameter, uints at) {
    return to_mask(GATHER_WORD(uints, parameter, at) != 0);
}
static uints bsdf_parameter(global const uint *parameter, uints at) { return GATHER_WORD(uints, parameter, at); }

// Numbers that the host computed, from word `first` of the table on.
typedef struct {
    global const float *table;
    uints first;
} Curve;

// In lanes that are not active it is the table's beginning.
static Curve curve_parameter(global const uint *table, global const uint *parameter, uints at, mask active) {
    Curve c = {(global const float *)table, uints_pick(active, GATHER_WORD(uints, parameter, at), (uints)(0))};
    return c;
}
static real curve_number(Curve c, uints i) { return GATHER_WORD(real, c.table, c.first + i); }

// The function of x, from 0 to 1, that numbers i to i + count - 1 give at even steps, linear in between.
static real curve_at(Curve c, uint i, uint count, real x) {
    real place = x * (real)(count - 1);
    uints before = min(to_uints(real_max(place, (real)(0))), (uints)(count - 2));
    real low = curve_number(c, i + before), high = curve_number(c, i + before + 1);
    return mul_add(place - to_real(before), high - low, low);
}

// The same times what the records' textures say at `point`.
static v3 textured_color(const Scene *scene, global const ColorParameter *parameter, uints at, TexturePoint point,
                         mask active) {
    FourWords words = four_words((global const uint *)parameter, at);
    v3 value = v3_of(reals_of_words(words.a), reals_of_words(words.b), reals_of_words(words.c));
    return v3_mul(value, texture_color(scene, words.d, point, active));
}
static real textured_number(const Scene *scene, global const NumberParameter *parameter, uints at, TexturePoint point,
                            mask active) {
    v3 factor = texture_color(scene, GATHER_WORD(uints, &parameter->texture, at), point, active);
    return number_parameter(parameter, at) * luminance(factor);
}

// The derivatives over u and v of what textured_number reads; 0 where there is no texture.
static v2 number_gradient(const Scene *scene, global const NumberParameter *parameter, uints at, TexturePoint point,
                          mask active) {
    v2 gradient = texture_gradient(scene, GATHER_WORD(uints, &parameter->texture, at), point, active);
    real factor = number_parameter(parameter, at);
    return v2_of(factor * gradient.x, factor * gradient.y);
}

// A list of parameters as members of the lanes' struct: OPAL_BSDF_phong(LANES_MEMBER).
#define LANES_MEMBER(type, name, xml, initial, range, meaning) LANES_MEMBER_##type name;
#define LANES_MEMBER_COLOR v3
#define LANES_MEMBER_NUMBER real
#define LANES_MEMBER_FLAG mask
#define LANES_MEMBER_BSDF uints
#define LANES_MEMBER_CURVE Curve

// The places of parameters in their list: a bit each of OPAL_TEXTURED_*.
#define PARAMETER_PLACE(type, name, xml, initial, range, meaning) PLACE_##name,

// Statements that read a list of parameters into the members of `lanes`, from `record` at `at`. `textured`, a constant,
// has the bits of the parameters that have a texture in the kernel's scene, and `nonzero` lacks those of numbers that
// are 0 in all of its materials.
#define READ_PARAMETER(type, name, xml, initial, range, meaning) READ_##type(name)
#define READ_COLOR(name) \
    if (textured >> PLACE_##name & 1) lanes.name = textured_color(scene, &record->name, at, point, active); \
    else lanes.name = color_parameter(&record->name, at);
#define READ_NUMBER(name) \
    if (!(nonzero >> PLACE_##name & 1)) lanes.name = 0; \
    else if (textured >> PLACE_##name & 1) lanes.name = textured_number(scene, &record->name, at, point, active); \
    else lanes.name = number_parameter(&record->name, at);
#define READ_FLAG(name) lanes.name = flag_parameter(&record->name, at);
#define READ_BSDF(name) lanes.name = bsdf_parameter(&record->name, at);
#define READ_CURVE(name) lanes.name = curve_parameter(scene->bsdfs, &record->name, at, active);
