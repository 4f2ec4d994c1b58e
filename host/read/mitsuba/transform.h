// <transform> of Mitsuba's files: translate, scale, rotate, lookat and matrix, applied to points in document order.
#pragma once

#include "base/math.h"
#include "read/context.h"

namespace opal::mitsuba {

// It is a mistake if an operation is malformed, or if the transform is not invertible. Throws NoObject after a mistake
// that the context gathers. An axis of <rotate> that is not of length 1 stretches, as in Mitsuba, and is warned of.
Transform parse_transform(const XmlNode &node, const ParseContext &context);

// The attributes value, or x, y and z, of a <point>, <translate>, ...; one number is that of all three. fallback: that
// of x, y or z where it is not there. Throws XmlError at the node.
Vec3 parse_xyz(const XmlNode &node, double fallback);

} // namespace opal::mitsuba
