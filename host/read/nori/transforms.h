// The parser of <transform>: translate, scale, rotate, matrix and lookat, applied to points in document order.
#pragma once

#include "base/math.h"
#include "read/xml.h"

namespace opal {

// Error at an operation that is malformed, or at the transform if it is not invertible.
Transform parse_transform(const XmlNode &node);

} // namespace opal
