#include "base/table.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

#include <ctime>

using namespace opal;
using opal::test::error_of;

namespace {
struct Row {
    std::string name;
    int value;
};
const std::vector<Row> rows = {{"diffuse", 1}, {"mirror", 2}, {"dielectric", 3}};
} // namespace

TEST_CASE("a known name gives its row", "[table]") { CHECK(find_row(rows, "bsdf", "mirror").value == 2); }

TEST_CASE("an unknown name lists what was possible, and the nearest where it is near", "[table]") {
    CHECK(error_of([] { find_row(rows, "bsdf", "difuse"); }) ==
          "unknown bsdf 'difuse'; did you mean 'diffuse'? available: diffuse, mirror, dielectric");
    CHECK(error_of([] { find_row(rows, "bsdf", "xyzzy"); }) ==
          "unknown bsdf 'xyzzy'; available: diffuse, mirror, dielectric");
    CHECK(unknown_name("child", "bsdf", {}) == "unknown child 'bsdf'; available: none");
}

TEST_CASE("the nearest name is found by edits of any kind, whatever the case", "[table]") {
    std::vector<std::string> known = {"nearClip", "farClip", "fov"};
    CHECK(nearest_name("nearclip", known) == "nearClip");
    CHECK(nearest_name("faClip", known) == "farClip");
    CHECK(nearest_name("fovv", known) == "fov");
    CHECK(nearest_name("fox", known) == "fov");
    CHECK(nearest_name("width", known).empty());
    CHECK(nearest_name("", known).empty());
}

TEST_CASE("a name of many megabytes is near none, which takes no time to tell", "[table]") {
    const std::vector<std::string> known(20, "emitter-choice");
    const std::clock_t start = std::clock();
    CHECK(nearest_name(std::string(20'000'000, 'e'), known).empty());
    CHECK(double(std::clock() - start) / CLOCKS_PER_SEC < 1); // to compare its letters took 14 s
}
