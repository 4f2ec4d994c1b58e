// Which kernel renders under --specialise auto: one compiled for this scene, or the one for all scenes.
#pragma once

#include "device/context.h"
#include "scene/scene.h"

namespace opal {

// On a CPU compiling a scene's own kernel costs 1.7 to 3.6 CPU seconds, and saves 0.03 to 0.04 CPU microseconds a path:
// from 41 M paths on it pays for one of five scenes, from 98 M on for all (scripts/README.md). This is the power of two
// below the least of these.
constexpr double paths_that_pay = 1 << 25;

// Are the paths so few that the general kernel is done sooner, as it need not be compiled for the scene? The answer
// depends on device and request, never on a cache or a clock, so that a command always gives the same bits.
// GPUs' compilers take longer for the general kernel than for a scene's own.
// paths: pixels times samples; infinite where only an error is asked for.
bool suits_general_kernel(const DeviceInfo &device, double paths);
// The same for one render of this scene. A general kernel that is not the one of all scenes takes longer to compile
// than a kernel of this scene, and saves later scenes nothing (shares_general_kernel).
bool suits_general_kernel(const DeviceInfo &device, double paths, const SceneDescription &scene);

// The paths that a render of so many seconds is taken to have on that device.
double paths_in(const DeviceInfo &device, double seconds);

} // namespace opal
