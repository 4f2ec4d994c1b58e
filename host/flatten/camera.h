// The camera's record, as the device sees it.
#pragma once

#include "flatten/geometry.h"
#include "flatten/store.h"

namespace opal {

CameraRecord flatten_camera(const Camera &camera, const Flattening &flattening);

// Fill what a kind has of its own, in record.own.NAME: host/flatten/camera_NAME.cpp. The rest of the record is
// complete. scale: units of the flattened scene in a unit of depth of camera space.
#define OPAL_FILL_CAMERA(name, record, traits) void fill_##name(const Camera &camera, double scale, record &own);
OPAL_CAMERAS(OPAL_FILL_CAMERA)
#undef OPAL_FILL_CAMERA

} // namespace opal
