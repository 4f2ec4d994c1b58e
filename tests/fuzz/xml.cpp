// Scenes and tests in XML, of each dialect, with the meshes that they name; then all that is done before rendering.
#include "base/error.h"
#include "flatten/precision_warnings.h"
#include "flatten/scene_warnings.h"
#include "fuzz/harness.h"
#include "fuzz/mutate.h"
#include "fuzz/oracles.h"
#include "read/nori/tests.h"
#include "strategies/check.h"

namespace opal::fuzz {

namespace {

// The last byte of an input says how it is read: in files of this repository it is the end of the last line.
struct Reading {
    LoadOptions load;
    int lanes;
};

Reading reading_of(unsigned char byte) {
    Reading reading{{.lenient = (byte & 1) != 0}, byte & 2 ? 16 : 1};
    if (const size_t dialect = (byte >> 2) % (dialects().size() + 1); dialect < dialects().size())
        reading.load.dialect = dialects()[dialect].name;
    if (byte & 64)
        reading.load.definitions = {{"a", "2"}, {"b", "1 $a <"}};
    return reading;
}

void check_scene(SceneDescription scene, int lanes) {
    check_strategy(scene);
    for (const Mesh &mesh : scene.meshes)
        if (const auto *triangles = std::get_if<TriangleMesh>(&mesh.shape))
            check(*triangles);
    const FlatScene flat = flatten(scene, lanes);
    check(flat);
    require(!precision_warnings(scene, flat).empty() || has_finite_lights(flat), "what is not finite is warned of");
    scene_warnings(scene);
    scene_notes(scene, false);
}

const TextFormat format = {.words = quoted,
                           .replacements = {"0 0 0", "1 1 1", "1e38 1e38 1e38", "1e-30,1e-30,1e-30", "1 2",
                                            "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1", "1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 0",
                                            "1e38 0 0 0 0 1e-38 0 0 0 0 1 0 0 0 0 1e-30", "true", "false", "$a", "$b$a",
                                            "meshes/cube.obj", "meshes/cbox_red.obj", "meshes/brilliant.obj",
                                            "meshes/slivers.obj"},
                           .piece = '<'};

} // namespace

void try_input(std::string_view input) {
    static ServedFile file("scene.xml");
    if (input.empty())
        return;
    const Reading reading = reading_of(static_cast<unsigned char>(input.back()));
    file.write(input.substr(0, input.size() - 1));
    try {
        if (input.find("<test") == input.npos)
            return check_scene(load_scene(file.path(), reading.load), reading.lanes);
        for (const SceneDescription &scene : load_test(file.path(), reading.load).scenes)
            check_scene(scene, reading.lanes);
    } catch (const Error &) {
    }
}

} // namespace opal::fuzz

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t max_size, unsigned seed) {
    return opal::fuzz::mutate(opal::fuzz::format, data, size, max_size, seed);
}
