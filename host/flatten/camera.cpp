#include "flatten/camera.h"

#include <algorithm>
#include <limits>

namespace opal {

namespace {

// A distance as a float; one beyond the range of floats becomes the largest float.
float to_distance(double d) { return float(std::min(d, double(std::numeric_limits<float>::max()))); }

} // namespace

// Directions in camera space are left x + up y + forward, with x and y at depth 1. These vectors are the columns of
// toWorld divided by the length of the third one, `depth`: a point at depth z in camera space lies z * depth times that
// direction away.
CameraRecord flatten_camera(const Camera &camera, const Flattening &flattening) {
    const auto &rows = camera.to_world.rows;
    const auto column = [&rows](int i) { return Vec3{rows[0][i], rows[1][i], rows[2][i]}; };
    const double depth = length(column(2)), scale = depth * flattening.scale;
    CameraRecord record{};
    record.kind = camera.kind;
    store((camera.to_world.point({}) - flattening.center) * flattening.scale, record.origin);
    store(column(0) * (1 / depth), record.left);
    store(column(1) * (1 / depth), record.up);
    store(column(2) * (1 / depth), record.forward);
    record.near_clip = to_distance(camera.near_clip * depth * flattening.scale);
    record.far_clip = to_distance(camera.far_clip * depth * flattening.scale);
    switch (camera.kind) {
#define OPAL_FILL_CAMERA(name, record_type, traits)                                                                    \
    case CAMERA_##name:                                                                                                \
        fill_##name(camera, scale, record.own.name);                                                                   \
        break;
        OPAL_CAMERAS(OPAL_FILL_CAMERA)
#undef OPAL_FILL_CAMERA
    }
    return record;
}

} // namespace opal
