#include "read/nori/transforms.h"
#include "base/math.h"
#include "read/nori/properties.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

using namespace opal;
using opal::test::error_of;

namespace {

Transform parse(const std::string &operations) {
    XmlDocument document("a.xml", "<transform name='toWorld'>\n" + operations + "\n</transform>");
    return parse_transform(document.root());
}

std::string error_in(const std::string &operations) {
    return error_of([&] { parse(operations); });
}

void check_near(Vec3 a, Vec3 b) {
    INFO("(" << a.x << ", " << a.y << ", " << a.z << ") against (" << b.x << ", " << b.y << ", " << b.z << ")");
    CHECK(length(a - b) <= 1e-14 * (1 + length(b)));
}

} // namespace

TEST_CASE("an empty transform is the identity", "[transforms]") { check_near(parse("").point({1, 2, 3}), {1, 2, 3}); }

TEST_CASE("operations apply to a point in document order", "[transforms]") {
    std::string scale = "<scale value='2, 3, 4'/>", translate = "<translate value='1 1 1'/>";
    check_near(parse(scale + translate).point({1, 1, 1}), {3, 4, 5});
    check_near(parse(translate + scale).point({1, 1, 1}), {4, 6, 8});
    check_near(parse(translate + scale).vector({1, 1, 1}), {2, 3, 4});
}

TEST_CASE("rotations are right-handed, in degrees, about an axis of any length", "[transforms]") {
    check_near(parse("<rotate axis='0,0,7' angle='90'/>").point({1, 0, 0}), {0, 1, 0});
    check_near(parse("<rotate axis='1,0,0' angle='90'/>").point({0, 1, 0}), {0, 0, 1});
    check_near(parse("<rotate axis='0,1,0' angle='-90'/>").point({1, 0, 0}), {0, 0, 1});
    check_near(parse("<rotate axis='1,1,1' angle='120'/>").point({1, 2, 3}), {3, 1, 2});
}

TEST_CASE("a matrix is row-major with its translation in the fourth column", "[transforms]") {
    check_near(parse("<matrix value='0 -1 0 10, 1 0 0 20, 0 0 1 30, 0 0 0 1'/>").point({1, 2, 3}), {8, 21, 33});
    check_near(parse("<matrix value='2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 2'/>").point({1, 2, 3}), {1, 2, 3});
}

TEST_CASE("lookat: +z to the target, +x to the left, +y up", "[transforms]") {
    Transform camera = parse("<lookat origin='0,0,5' target='0,0,0' up='0,2,0'/>");
    check_near(camera.point({0, 0, 1}), {0, 0, 4});
    check_near(camera.vector({0, 1, 0}), {0, 1, 0});
    check_near(camera.vector({1, 0, 0}), {-1, 0, 0}); // norm(up) x direction
    Transform tilted = parse("<lookat origin='1,2,3' target='4,6,3' up='0,0,1'/>");
    check_near(tilted.vector({0, 0, 1}), {0.6, 0.8, 0});
    check_near(tilted.vector({1, 0, 0}), {-0.8, 0.6, 0});
    check_near(tilted.vector({0, 1, 0}), {0, 0, 1});
    CHECK(tilted.determinant() == Approx(1));
}

TEST_CASE("normals stay normal to what was transformed, on the same side", "[transforms]") {
    for (const char *operations :
         {"<scale value='1 5 0.2'/><rotate axis='3 1 2' angle='40'/>", "<scale value='-1 2 3'/>",
          "<rotate axis='0 1 1' angle='70'/><scale value='1 1 -4'/>", "<scale value='1e-4 1e-4 1e-4'/>"}) {
        Transform t = parse(operations);
        Vec3 a{1, 2, -1}, b{0.5, -1, 2}, outside{3, 1, 0.25};
        Vec3 n = cross(a, b), transformed = normalize(t.normal(n));
        INFO(operations);
        CHECK(std::abs(dot(transformed, normalize(t.vector(a)))) < 1e-14);
        CHECK(std::abs(dot(transformed, normalize(t.vector(b)))) < 1e-14);
        CHECK((dot(transformed, t.vector(outside)) > 0) == (dot(n, outside) > 0));
    }
}

TEST_CASE("malformed operations fail at their place", "[transforms]") {
    CHECK(error_in("  <scale value='2'/>") == "a.xml:2:3: '2' holds 1 numbers, not 3");
    CHECK(error_in("<translate value='1 2 3 4'/>") == "a.xml:2:1: '1 2 3 4' holds 4 numbers, not 3");
    CHECK(error_in("<matrix value='1 2 3'/>") == "a.xml:2:1: '1 2 3' holds 3 numbers, not 16");
    CHECK(error_in("<rotate axis='1 0 0'/>") == "a.xml:2:1: <rotate> lacks the attribute 'angle'");
    CHECK(error_in("<rotate axis='1 0 0' angle='90deg'/>") == "a.xml:2:1: '90deg' is not a number");
    CHECK(error_in("<rotate axis='0 0 0' angle='9'/>") == "a.xml:2:1: the axis of a rotation must not be 0 0 0");
    CHECK_THAT(error_in("<lookat origin='1 1 1' target='1 1 1' up='0 1 0'/>"), Catch::Contains("must differ"));
    CHECK_THAT(error_in("<lookat origin='0 0 0' target='0 1 0' up='0 -3 0'/>"), Catch::Contains("parallel"));
    CHECK_THAT(error_in("<lookat origin='0 0 0' target='0 1 0' up='0 0 0'/>"), Catch::Contains("up of a lookat"));
    CHECK(error_in("\n <scal value='1 1 1'/>") == "a.xml:3:2: unknown operation 'scal'; did you mean "
                                                  "'scale'? available: translate, scale, rotate, matrix, lookat");
    CHECK_THAT(error_in("<scale value='1 1 1'><scale value='1 1 1'/></scale>"), Catch::StartsWith("a.xml:2:22: "));
}

TEST_CASE("a singular transform is refused, a tiny or a huge one is not", "[transforms]") {
    CHECK_THAT(error_in("<scale value='1 0 1'/>"), Catch::StartsWith("a.xml:1:1: the transform is singular"));
    CHECK_THAT(error_in("<matrix value='1 2 3 0 4 5 6 0 7 8 9 0 0 0 0 1'/>"), Catch::Contains("singular"));
    CHECK(error_in("<scale value='1e-12 1e12 1e-12'/>").empty());
}
