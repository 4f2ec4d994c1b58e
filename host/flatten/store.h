// Vectors and colours in double, stored as the floats of a record.
#pragma once

#include "base/color.h"
#include "base/math.h"

namespace opal {

inline void store(Vec3 from, float (&to)[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = float(from[i]);
}
inline void store(const Color &from, double factor, float (&to)[3]) {
    for (int i = 0; i < 3; i++)
        to[i] = float(from[i] * factor);
}

} // namespace opal
