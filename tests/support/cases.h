// The materials and lights of tests/cases: every XML file in a folder is a case.
#pragma once

#include "selftest/checks.h"

#include <filesystem>

namespace opal::test {

// The <bsdf> of each file, by name. Error: a file that is not one.
std::vector<Material> bsdf_cases(const std::filesystem::path &folder = OPAL_SOURCE_DIR "/tests/cases/bsdfs");

struct LightCase {
    std::string name;
    std::variant<Mesh, Light> emitter;
};
// The <mesh> with an area emitter, or the <emitter> of a scene, of each file, by name. Error: a file that is neither,
// or a mesh outside of the unit square of the plane z = 0, where its samples are counted.
std::vector<LightCase> emitter_cases(const std::filesystem::path &folder = OPAL_SOURCE_DIR "/tests/cases/emitters");

} // namespace opal::test
