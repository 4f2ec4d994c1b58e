// Functions with a formula in double.
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("Reflectance and refraction follow Fresnel and Snell", "[optics]") {
    require_all_pass(check_refraction(Sources::embedded(), 0));
}
TEST_CASE("Sine and cosine of a turn", "[optics][stat]") {
    require_all_pass(check_trigonometry(Sources::embedded(), test_seed(130)));
}
TEST_CASE("Cameras send the rays of Mitsuba's", "[optics]") { require_all_pass(check_cameras(Sources::embedded(), 0)); }
TEST_CASE("Spots and directional lights shine as Mitsuba's do", "[optics]") {
    require_all_pass(check_delta_lights(Sources::embedded(), 0));
}
