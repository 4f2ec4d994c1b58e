// Values of textures that a parameter may not have.
#pragma once

#include "scene/place.h"
#include "scene/scene.h"

namespace opal {

// Warns where a texture has values outside 0 to 1 and its parameter is a reflectance or a share: surfaces may then shed
// more light than meets them, or less than none. They are rendered as they stand. place: of the texture. factor: what
// multiplies it. Of a mesh attribute that is not known yet it says nothing.
void warn_of_values(const SourcePlace &place, const Parameter &parameter, const Texture &texture, double factor = 1);

} // namespace opal
