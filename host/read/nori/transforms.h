// The parser of <transform>: translate, scale, rotate, matrix and lookat, applied to points in document order.
#pragma once

#include "base/math.h"
#include "read/context.h"

namespace opal {

// It is a mistake if an operation is malformed, or if the transform is not invertible. Throws NoObject after a mistake
// that the context gathers.
Transform parse_transform(const XmlNode &node, const ParseContext &context = {});

} // namespace opal
