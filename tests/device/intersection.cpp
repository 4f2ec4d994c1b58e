// Closest and any hit.
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("The tree finds what trying every triangle finds", "[intersection]") {
    require_all_pass(check_tree(Sources::embedded(), test_seed(110)));
}
TEST_CASE("So does a small scene without a tree", "[intersection]") {
    require_all_pass(check_tiny(Sources::embedded(), test_seed(111)));
}
TEST_CASE("Spheres are found as trying every one finds them, and no ray that leaves one meets it", "[intersection]") {
    require_all_pass(check_spheres(Sources::embedded(), test_seed(113)));
}
TEST_CASE("No ray leaks through edges and vertices of closed meshes", "[intersection]") {
    require_all_pass(check_watertight(Sources::embedded(), test_seed(112)));
}
