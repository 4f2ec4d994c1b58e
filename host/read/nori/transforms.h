// <transform>: translate, scale, rotate, matrix and lookat, applied to a point in document order.
#pragma once

#include "base/math.h"
#include "read/xml.h"

namespace opal {

// Throws Error at the operation that is malformed, or at the transform where it is not invertible.
Transform parse_transform(const XmlNode &node);

} // namespace opal
