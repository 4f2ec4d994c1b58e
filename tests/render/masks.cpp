// Surfaces that light passes through unchanged (mask, null), and emitters that the camera does not see.
#include "support/checks.h"
#include "support/pictures.h"
#include "support/plain_scenes.h"
#include "support/seeds.h"

#include <catch2/catch.hpp>

using namespace opal;
using namespace opal::test;

TEST_CASE("What is behind masks and null is found in every strategy", "[masks][stat]") {
    require_all_pass(check_masks(Sources::embedded(), test_seed(310)));
}
TEST_CASE("Kernels of one scene find what is behind masks and null", "[masks][stat]") {
    require_all_pass(check_masks_specialised(test_seed(311)));
}
TEST_CASE("The camera looks through hidden emitters, which light the scene all the same", "[masks][stat]") {
    require_all_pass(check_hidden_emitters(Sources::embedded(), test_seed(312)));
}
TEST_CASE("Kernels of one scene hide its emitters", "[masks][stat]") {
    require_all_pass(check_hidden_emitters_specialised(test_seed(313)));
}

TEST_CASE("A wall of null counts as a segment of the path", "[masks]") {
    SceneDescription scene = scene_of({made_of(Parallelogram{{-1, -1, 1}, {2, 0, 0}, {0, 2, 0}}, bsdf_null_record{})});
    scene.lights = {{emitter_constant{{2, 2, 2}}, {}}};
    scene.camera.width = scene.camera.height = 4;
    scene.camera.perspective.fov = 10;
    scene.strategy.max_depth = 1;
    CHECK(sample_of(render(scene, 4, 1)).mean == 0);
    scene.strategy.max_depth = 2;
    CHECK(sample_of(render(scene, 4, 1)).mean == Approx(2));
}
