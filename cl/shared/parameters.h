// The parameters of a kind of BSDF (of anything that a record of words describes), each named once.
//
// A kind lists its parameters in a macro, OPAL_BSDF_phong(PARAMETER), a row each:
//   PARAMETER(NUMBER, n, "n", 20, AT_LEAST(0), "exponent of the lobe")
// The columns are type, name, name in the XML, default (one number for all channels), range, meaning. The types:
//   COLOR    linear RGB; the range holds for each channel
//   NUMBER   a number
//   FLAG     true or false
//   BSDF     another BSDF, by the first word of its record
//   CURVE    numbers that the host computes from the other ones, which no texture changes then; it has no name in the
//            XML. By the first of its words, which lie among the records
//   POINT, VECTOR   a position, a direction with its length, in world space; of emitters, whose records the host makes
//   IMAGE, TRANSFORM   the file of a picture, a matrix; likewise
// A range is AT_LEAST(x), ABOVE(x), BETWEEN(x, y) with both ends, INSIDE(x, y) without them, or ANY. REQUIRED in place
// of a default, of emitters: the file must say it.
// From the list come the record that host and device share (below), the lanes' struct and its reader
// (parameters.cl), and on the host the reading of XML, the options of `opal warp`, and the manual
// (host/scene/parameters.h).
#ifndef OPAL_PARAMETERS_H
#define OPAL_PARAMETERS_H

#include "shared/glue.h"

#ifdef __cplusplus
namespace opal {

#define OPAL_INITIALLY(value) = value
#else
#define OPAL_INITIALLY(value)
#endif

#define OPAL_UNTEXTURED 0xffffffffu

// A colour as a record holds it: a constant, and the record of the texture that multiplies it.
typedef struct ColorParameter {
    float value[3];
    uint texture;
#ifdef __cplusplus
    ColorParameter(double grey) : ColorParameter(grey, grey, grey) {}
    ColorParameter(double r, double g, double b) : value{float(r), float(g), float(b)}, texture(OPAL_UNTEXTURED) {}
#endif
} ColorParameter;

// A number likewise.
typedef struct NumberParameter {
    float value;
    uint texture;
#ifdef __cplusplus
    NumberParameter(double number) : value(float(number)), texture(OPAL_UNTEXTURED) {}
#endif
} NumberParameter;

#ifdef __cplusplus
}
#endif

// The members of a record, as OPAL_BSDF_phong(OPAL_MEMBER). In C++ they begin with the list's defaults.
#define OPAL_MEMBER(type, name, xml, initial, range, meaning) OPAL_MEMBER_##type name OPAL_INITIALLY(initial);
#define OPAL_MEMBER_COLOR ColorParameter
#define OPAL_MEMBER_NUMBER NumberParameter
#define OPAL_MEMBER_FLAG uint
#define OPAL_MEMBER_BSDF uint
#define OPAL_MEMBER_CURVE uint

#endif
