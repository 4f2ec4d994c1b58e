#include "read/xml.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

using namespace opal;
using opal::test::error_of;

namespace {

// The error of reading `text` as a.xml, with the children of its root.
std::string error_in(const std::string &text) {
    return error_of([&] { XmlDocument("a.xml", text).root().children(); });
}

} // namespace

TEST_CASE("nodes know the line and column of their '<', in characters", "[xml]") {
    XmlDocument document(
        "a.xml", "<?xml version=\"1.0\"?>\r\n<!-- \xc3\xa9 -->\n<scene>\n  <mesh/> <!-- \xc3\xa9 --><bsdf a=\"1\"\n "
                 "b=\"2\"/>\n\t<x/>\n</scene>");
    XmlNode root = document.root();
    CHECK(root.tag() == "scene");
    CHECK(root.place().text() == "a.xml:3:1");
    std::vector<XmlNode> children = root.children();
    REQUIRE(children.size() == 3);
    CHECK(children[0].place().text() == "a.xml:4:3");
    CHECK(children[1].place().text() == "a.xml:4:21");
    CHECK(children[1].attribute("b") == "2");
    CHECK(children[2].place().text() == "a.xml:6:2");
}

TEST_CASE("a byte order mark shifts no column", "[xml]") {
    CHECK(XmlDocument("a.xml", "\xef\xbb\xbf<scene/>").root().place().text() == "a.xml:1:1");
}

TEST_CASE("entities are decoded without shifting the nodes after them", "[xml]") {
    XmlDocument document("a.xml", "<scene a=\"&lt;&amp;&gt;\"><mesh/></scene>");
    CHECK(document.root().attribute("a") == "<&>");
    CHECK(document.root().children()[0].place().column == 26);
}

TEST_CASE("the five entities of XML and references to characters are decoded", "[xml]") {
    const XmlDocument document("a.xml", "<scene a=\"&lt;&gt;&amp;&quot;&apos;\" b=\"&#65;&#x42;&#xe9;&#8364;\"/>");
    CHECK(document.root().attribute("a") == "<>&\"'");
    CHECK(document.root().attribute("b") == "AB\xc3\xa9\xe2\x82\xac");
}

TEST_CASE("malformed XML fails at its place", "[xml]") {
    CHECK_THAT(error_in("<scene>\n  <mesh>\n</scene>"), Catch::StartsWith("a.xml:3:3: not well-formed XML: "));
    CHECK_THAT(error_in("<scene>\n  <mesh type=obj/>\n</scene>"),
               Catch::StartsWith("a.xml:2:14: not well-formed XML: "));
    CHECK_THAT(error_in("<scene"), Catch::StartsWith("a.xml:1:"));
    CHECK_THAT(error_in("<scene>"), Catch::StartsWith("a.xml:1:"));
    CHECK_THAT(error_in("<scene>\n<!-- "), Catch::StartsWith("a.xml:2:"));
}

TEST_CASE("tags within each other are counted", "[xml]") {
    const auto nested = [](int levels) {
        std::string text;
        for (int i = 0; i < levels; i++)
            text += "<a>";
        for (int i = 0; i < levels; i++)
            text += "</a>";
        return text;
    };
    CHECK(error_in(nested(64)).empty());
    CHECK(error_in(nested(65)) == "a.xml:1:193: more than 64 tags within each other");
    CHECK(error_in(nested(1000000)) == "a.xml:1:193: more than 64 tags within each other");
}

TEST_CASE("one root and nothing beside it", "[xml]") {
    CHECK(error_in("") == "a.xml:1:1: holds no <scene>");
    CHECK(error_in("<!-- nothing -->") == "a.xml:1:1: holds no <scene>");
    CHECK(error_in("\n1 2 3\n") == "a.xml:2:1: is no XML: it holds no tags");
    CHECK(error_in("<scene/>\n<scene/>") == "a.xml:2:1: a second root <scene>; a file holds one");
    CHECK_THAT(error_in("<scene/>\n junk"), Catch::StartsWith("a.xml:2:2: text between the tags"));
    CHECK(error_in("<scene/>\n<!-- fine --> \n").empty());
}

TEST_CASE("text between tags is an error where it begins", "[xml]") {
    CHECK_THAT(error_in("<scene>\n  junk <mesh/>\n</scene>"), Catch::StartsWith("a.xml:2:3: text between the tags"));
    CHECK_THAT(error_in("<scene><mesh/>\n\n x</scene>"), Catch::StartsWith("a.xml:3:2: text"));
    CHECK_THAT(error_in("<scene><![CDATA[x]]></scene>"), Catch::Contains("text"));
    CHECK(error_in("<scene>\n <!-- text --> \n</scene>").empty());
}

TEST_CASE("attributes are exactly the wanted ones, each once", "[xml]") {
    auto check = [](const std::string &attributes) {
        XmlDocument document("a.xml", "<float " + attributes + "/>");
        return error_of([&] { document.root().require_attributes({"name", "value"}); });
    };
    CHECK(check("value='1' name='x'").empty());
    CHECK(check("name='x'") == "a.xml:1:1: <float> lacks the attribute 'value'");
    CHECK(check("name='x' value='1' vlue='2'") ==
          "a.xml:1:1: unknown attribute 'vlue' of <float>; did you mean 'value'? available: name, value");
    CHECK(check("name='x' value='1' name='y'") == "a.xml:1:1: <float> has the attribute 'name' twice");
}

TEST_CASE("files that cannot be read are named", "[xml]") {
    test::ScratchFolder scratch;
    CHECK_THAT(error_of([&] { XmlDocument document(scratch / "none.xml"); }),
               Catch::StartsWith((scratch / "none.xml").string() + ": cannot read: "));
    CHECK(error_of([&] { XmlDocument document(scratch.path()); }) ==
          scratch.path().string() + ": is a folder, not a file");
}
