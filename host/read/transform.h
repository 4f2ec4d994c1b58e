// What <transform>s of all formats share.
#pragma once

#include "base/math.h"
#include "read/context.h"

#include <span>
#include <string>

namespace opal {

// An element within <transform>, as <translate>. parse throws Error, or NoObject after a mistake that is gathered.
struct TransformOperation {
    std::string name;
    Transform (*parse)(const XmlNode &, const ParseContext &);
};

// The operations within the node, applied to points in document order. It is a mistake if one is unknown or malformed,
// or if the transform is not invertible. Throws NoObject after a mistake that the context gathers.
Transform parse_transform(const XmlNode &node, const ParseContext &context,
                          std::span<const TransformOperation> operations);

// As Transform::look_at. Throws XmlError at the node where that is none.
Transform look_at(const XmlNode &node, Vec3 origin, Vec3 target, Vec3 up);

} // namespace opal
