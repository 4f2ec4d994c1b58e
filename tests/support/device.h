// The device that tests run on, opened once a process: $OPAL_TEST_DEVICE (as --device takes it), else the first CPU.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "flatten/flat_scene.h"

#include <catch2/catch.hpp>

#include <map>
#include <string>

namespace opal::test {

const Device &device();

// The widths of every kernel test: 1 and the device's own.
std::vector<int> tested_lanes();

// All features on but those `without` (FEATURE_*), every axis decided at run time.
Features all_features(const std::vector<unsigned> &without = {});

// Opal's own sources with those below tests/device/ as "tests/NAME.cl" among them.
const Sources &sources();

} // namespace opal::test
