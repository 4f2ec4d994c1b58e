#include "read/nori/properties.h"
#include "base/log.h"
#include "base/values.h"
#include "support/error_of.h"

#include <catch2/catch.hpp>

using namespace opal;
using opal::test::error_of;

namespace {

// Runs `use` on the properties of <camera type="perspective"> around `body`, which starts at line 2.
template <class Use> std::string error_in(const std::string &body, Use use, bool lenient = false) {
    XmlDocument document("a.xml", "<camera type='perspective'>\n" + body + "\n</camera>");
    return error_of([&] {
        Properties properties(document.root(), {"", lenient});
        use(properties);
        properties.finish();
    });
}

std::string error_in(const std::string &body) {
    return error_in(body, [](Properties &) {});
}

std::string value_error(const std::string &tag, const std::string &value) {
    return error_in("<" + tag + " name='p' value='" + value + "'/>",
                    [](Properties &properties) { properties.ignore("p"); });
}

} // namespace

TEST_CASE("every type of property is read", "[properties]") {
    std::string body =
        "<boolean name='b' value='TRUE'/><integer name='i' value='-42'/><float name='f' value='+1.5e-3'/>"
        "<string name='s' value='a b'/><point name='p' value='1,2 , 3'/><vector name='v' value=' 1 2 3 '/>"
        "<color name='c' value='0.1,0.2,3'/><transform name='t'><translate value='1 2 3'/></transform>";
    CHECK(error_in(body, [](Properties &p) {
              CHECK(p.boolean("b") == true);
              CHECK(p.integer("i") == -42);
              CHECK(p.number("f") == 1.5e-3);
              CHECK(p.string("s") == "a b");
              CHECK(p.point("p")->y == 2);
              CHECK(p.vector("v")->z == 3);
              CHECK(p.color("c") == Color{0.1, 0.2, 3});
              CHECK(p.transform("t")->rows[2][3] == 3);
              CHECK_FALSE(p.number("missing"));
          }).empty());
}

TEST_CASE("a property nobody asks for fails with the nearest known name, or warns if lenient", "[properties]") {
    auto use = [](Properties &p) {
        p.integer("width");
        p.number("fov");
    };
    std::string message =
        "a.xml:2:3: unknown property 'fovv' of camera 'perspective'; did you mean 'fov'? available: width, fov";
    std::string body = "  <float name='fovv' value='30'/>";
    CHECK(error_in(body, use) == message);
    size_t before = warnings().size();
    CHECK(error_in(body, use, true).empty());
    REQUIRE(warnings().size() == before + 1);
    CHECK(warnings().back() == message);
    CHECK(error_in(body, [](Properties &p) { p.ignore("fovv"); }).empty());
}

TEST_CASE("the wrong type of a known property is an error, lenient or not", "[properties]") {
    auto use = [](Properties &p) { p.number("fov"); };
    std::string message = "a.xml:2:1: property 'fov' is a <integer> here, but must be a <float>";
    CHECK(error_in("<integer name='fov' value='30'/>", use) == message);
    CHECK(error_in("<integer name='fov' value='30'/>", use, true) == message);
    CHECK(error_in("<vector name='o' value='1 2 3'/>", [](Properties &p) { p.point("o"); }) ==
          "a.xml:2:1: property 'o' is a <vector> here, but must be a <point>");
}

TEST_CASE("a repeated name is an error that says where the first is", "[properties]") {
    CHECK(error_in("<float name='fov' value='30'/>\n<integer name='fov' value='30'/>") ==
          "a.xml:3:1: property 'fov' is repeated; it stands first at a.xml:2:1");
}

TEST_CASE("malformed values fail at their place, even of unknown properties", "[properties]") {
    CHECK(value_error("integer", "12a") == "a.xml:2:1: property 'p': '12a' is not an integer");
    CHECK(value_error("integer", "1.5") == "a.xml:2:1: property 'p': '1.5' is not an integer");
    CHECK(value_error("integer", "") == "a.xml:2:1: property 'p': '' is not an integer");
    CHECK(value_error("integer", "3000000000") == "a.xml:2:1: property 'p': '3000000000' is too large for an integer");
    CHECK(value_error("float", "1.0x") == "a.xml:2:1: property 'p': '1.0x' is not a number");
    CHECK(value_error("float", "1 2") == "a.xml:2:1: property 'p': '1 2' is not a number");
    CHECK(value_error("float", "+-1") == "a.xml:2:1: property 'p': '+-1' is not a number");
    CHECK(value_error("boolean", "yes") == "a.xml:2:1: property 'p': 'yes' is not a boolean; available: true, false");
    CHECK(value_error("color", "1 2") == "a.xml:2:1: property 'p': '1 2' holds 2 numbers, not 3");
    CHECK(value_error("point", "1 2 3 4") == "a.xml:2:1: property 'p': '1 2 3 4' holds 4 numbers, not 3");
    CHECK(value_error("vector", "1 2 z") == "a.xml:2:1: property 'p': 'z' is not a number");
    CHECK_THAT(error_in("<float name='unheard' value='x'/>"), Catch::Contains("'x' is not a number"));
}

TEST_CASE("NaN, infinity and what single precision cannot hold are errors", "[properties]") {
    for (const char *text : {"nan", "NaN", "inf", "-inf", "infinity", "1e39", "-1e400"})
        CHECK(value_error("float", text) ==
              "a.xml:2:1: property 'p': '" + std::string(text) + "' is not a finite number in single precision");
    CHECK(value_error("color", "1 nan 1") ==
          "a.xml:2:1: property 'p': 'nan' is not a finite number in single precision");
    CHECK(value_error("float", "3.4e38").empty());
    CHECK(value_error("float", "1e-40").empty());
    CHECK(value_error("float", "1e-400").empty()); // 0, as in C
    for (const char *text : {"1e-400", " -1e-400\n", "+1e-99999999999", "0.0e400"})
        CHECK(parse_number(text) == 0);
}

TEST_CASE("attributes and contents of properties are checked", "[properties]") {
    CHECK(error_in("<float name='fov'/>") == "a.xml:2:1: <float> lacks the attribute 'value'");
    CHECK(error_in("<float value='1'/>") == "a.xml:2:1: <float> lacks the attribute 'name'");
    CHECK_THAT(error_in("<float name='fov' value='1' unit='deg'/>"),
               Catch::StartsWith("a.xml:2:1: unknown attribute 'unit' of <float>"));
    CHECK_THAT(error_in("<transform name='t' value='1'/>"),
               Catch::StartsWith("a.xml:2:1: unknown attribute 'value' of <transform>"));
    CHECK(error_in("<float name='fov' value='1'>\n <x/></float>") == "a.xml:3:2: <float> holds nothing");
    CHECK_THAT(error_in("<float name='fov' value='1'>x</float>"), Catch::StartsWith("a.xml:2:29: text"));
}

TEST_CASE("objects carry a type and nothing else", "[properties]") {
    auto error_of_object = [](const std::string &text) {
        XmlDocument document("a.xml", text);
        return error_of([&] { Properties(document.root(), {}); });
    };
    CHECK(error_of_object("<mesh/>") == "a.xml:1:1: <mesh> lacks the attribute 'type'");
    CHECK(error_of_object("<mesh type='obj' class='1'/>") ==
          "a.xml:1:1: unknown attribute 'class' of <mesh>; available: type");
}

TEST_CASE("children are only those that were asked for", "[properties]") {
    CHECK(error_in("<rfliter type='box'/>").starts_with("a.xml:2:1: unknown tag 'rfliter'; did you mean 'rfilter'? "));
    auto use = [](Properties &p) { p.child("rfilter"); };
    CHECK(error_in("<mesh type='obj'/>", use) == "a.xml:2:1: no <mesh> may stand in <camera>; available: rfilter");
    CHECK(error_in("<rfilter type='box'/>\n<rfilter type='box'/>", use) ==
          "a.xml:3:1: a second <rfilter> in <camera>; the first stands at a.xml:2:1");
    CHECK(error_in("<rfilter type='box'/>", use).empty());
}

TEST_CASE("required values and checks fail where they belong", "[properties]") {
    CHECK(error_in("", [](Properties &p) { p.required(p.point("origin"), "origin"); }) ==
          "a.xml:1:1: <camera> lacks its property 'origin'");
    auto check = [](Properties &p) { p.check(p.integer("width").value_or(0) > 0, "width", "must be positive"); };
    CHECK(error_in("\n <integer name='width' value='-1'/>", check) == "a.xml:3:2: property 'width': must be positive");
    CHECK(error_in("", check) == "a.xml:1:1: property 'width': must be positive");
}

TEST_CASE("a name with two types in two dialects gives either", "[properties]") {
    auto use = [](Properties &p) {
        CHECK_FALSE(p.boolean_if("mis"));
        CHECK(p.text("string", "mis") == "power");
    };
    CHECK(error_in("<string name='mis' value='power'/>", use).empty());
    auto as_boolean = [](Properties &p) {
        CHECK(p.boolean_if("mis") == true);
        CHECK_FALSE(p.text("string", "mis"));
    };
    CHECK(error_in("<boolean name='mis' value='true'/>", as_boolean).empty());
    CHECK(error_in("<float name='mis' value='1'/>", [](Properties &p) { p.text("string", "mis"); }) ==
          "a.xml:2:1: property 'mis' is a <float> here, but must be a <string>");
}
