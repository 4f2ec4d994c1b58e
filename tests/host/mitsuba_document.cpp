// The format of Mitsuba's files, against what Mitsuba 3.9.1 was measured to do with them.
#include "base/log.h"
#include "read/mitsuba/object.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>

using namespace opal;
using namespace opal::mitsuba;
using opal::test::error_of;

namespace {

struct DocumentFixture {
    test::ScratchFolder scratch;
    FileHashes hashes;

    std::string file() const { return (scratch / "a.xml").string(); }

    // Reads a file; `use` gets its root. Throws all mistakes.
    template <class Use>
    MitsubaScene read_text(const std::string &text, Use use, const Definitions &definitions = {},
                           bool lenient = false) {
        Mistakes mistakes;
        hashes = {};
        const ParseContext context{
            .folder = scratch.path(), .lenient = lenient, .mistakes = &mistakes, .hashes = &hashes};
        const MitsubaScene scene = read_document(scratch.write("a.xml", text), definitions, context);
        use(*scene.root);
        mistakes.throw_all();
        return scene;
    }
    template <class Use>
    MitsubaScene read(const std::string &body, Use use, const Definitions &definitions = {},
                      const std::string &version = "3.0.0") {
        return read_text("<scene version='" + version + "'>\n" + body + "</scene>", use, definitions);
    }
    // The mistakes, each after the main file's name. An object's properties are asked for by nobody.
    std::string mistakes_in(const std::string &body, const Definitions &definitions = {},
                            const std::string &version = "3.0.0") {
        return without_name(error_of([&] {
            read(
                body, [](Object &) {}, definitions, version);
        }));
    }
    template <class Use> std::string mistakes_of(const std::string &body, Use use) {
        return without_name(error_of([&] { read(body, use); }));
    }
    std::string without_name(std::string text) const {
        for (size_t at; (at = text.find(file())) != text.npos;)
            text.erase(at, file().size());
        return text;
    }
    // The property `p` of a shape.
    template <class Get> auto value(const std::string &property, Get get, const Definitions &definitions = {}) {
        decltype(get(std::declval<Object &>())) result;
        read(
            "<shape type='sphere'>" + property + "</shape>",
            [&](Object &root) { result = get(*root.children("shape").at(0)); }, definitions);
        return result;
    }
    std::string value_error(const std::string &property) {
        return mistakes_in("<shape type='sphere'>" + property + "</shape>");
    }
    std::string warning_of(const std::string &body) {
        const size_t before = warnings().size();
        read(body, [](Object &) {});
        return warnings().size() == before ? "" : without_name(warnings().at(before));
    }
    Transform transform(const std::string &operations) {
        return *value("<transform name='p'>" + operations + "</transform>",
                      [](Object &shape) { return shape.transform("p"); });
    }
};

const auto number = [](Object &object) { return object.number("p"); };
const auto integer = [](Object &object) { return object.integer("p"); };
const auto text = [](Object &object) { return object.string("p"); };

using Rows = std::array<std::array<double, 4>, 4>;

void check_rows(const Transform &transform, const Rows &expected) {
    for (size_t i = 0; i < 4; i++)
        for (size_t j = 0; j < 4; j++) {
            INFO(i << ", " << j);
            CHECK(transform.rows[i][j] == Approx(expected[i][j]).margin(1e-6));
        }
}

} // namespace

TEST_CASE_METHOD(DocumentFixture, "a version has three parts", "[mitsuba_document][mitsuba]") {
    for (const char *version : {"3.0.0", "4.0.0", "0.6.0", "1.9.9", " 2.1.0 "})
        CHECK(mistakes_in("", {}, version).empty());
    for (const char *version : {"3.0", "", "3", "3.0.0.1", "a.b.c", "3.0.x", "3..0", "1,2.3.4"})
        CHECK(mistakes_in("", {}, version) ==
              fmt::format(":1:1: '{}' is no version: it has three numbers, as in version=\"3.0.0\"", version));
    CHECK(without_name(error_of([&] { read_text("<scene/>", [](Object &) {}); })) ==
          ":1:1: <scene> lacks the attribute 'version', as in version=\"3.0.0\"");
    CHECK(read("", [](Object &) {}).version == "3.0.0");
}

TEST_CASE_METHOD(DocumentFixture, "objects, properties and their names", "[mitsuba_document][mitsuba]") {
    const MitsubaScene scene = read("<shape type='sphere' id='ball' name='x'><float name='radius' value='2'/>\n"
                                    "<bsdf type='diffuse'/><texture type='bitmap' name='reflectance'/></shape>",
                                    [](Object &root) {
                                        CHECK(root.tag() == "scene");
                                        CHECK(root.type().empty());
                                        const auto shapes = root.children("shape");
                                        REQUIRE(shapes.size() == 1);
                                        Object &shape = *shapes[0];
                                        CHECK(shape.tag() == "shape");
                                        CHECK(shape.type() == "sphere");
                                        CHECK(shape.id() == "ball");
                                        CHECK(shape.name() == "x");
                                        CHECK(shape.place().line == 2);
                                        CHECK(shape.has("radius"));
                                        CHECK(shape.has("reflectance"));
                                        CHECK_FALSE(shape.has("to_world"));
                                        CHECK(shape.number("radius") == 2);
                                        CHECK_FALSE(shape.number("height"));
                                        CHECK(shape.children("bsdf").at(0)->type() == "diffuse");
                                        CHECK(shape.child_named("reflectance")->type() == "bitmap");
                                        CHECK(shape.child_named("opacity") == nullptr);
                                        CHECK(shape.place_of("reflectance").line == 3);
                                        CHECK(shape.place_of("none").line == 2);
                                        shape.finish();
                                        root.finish();
                                    });
    CHECK(scene.root->children("shape").at(0)->number("radius") == 2); // the tree outlives the reading
}

TEST_CASE_METHOD(DocumentFixture, "types of properties", "[mitsuba_document][mitsuba]") {
    CHECK(value("<integer name='p' value=' -5 '/>", integer) == -5);
    CHECK(value("<float name='p' value='1e3 '/>", number) == 1000);
    CHECK(value("<integer name='p' value='3'/>", number) == 3);
    CHECK(value("<string name='p' value='a b'/>", text) == "a b");
    const auto boolean = [](Object &object) { return object.boolean("p"); };
    CHECK(value("<boolean name='p' value='True'/>", boolean) == true);
    CHECK(value("<boolean name='p' value='false'/>", boolean) == false);
    const auto error = [&](const std::string &property, auto get) {
        return mistakes_of("<shape type='sphere'>" + property + "</shape>",
                           [&](Object &root) { get(*root.children("shape").at(0)); });
    };
    CHECK(error("<float name='p' value='3'/>", integer) ==
          ":2:22: property 'p' is a <float> here, but must be a <integer>");
    CHECK(error("<string name='p' value='3'/>", number) ==
          ":2:22: property 'p' is a <string> here, but must be a <float> or <integer>");
    CHECK(error("<texture type='bitmap' name='p'/>", number) ==
          ":2:22: property 'p' is a <texture> here, but must be a <float> or <integer>");
    CHECK(error("<float name='p' value='3'/>", [](Object &object) { object.child_named("p"); }) ==
          ":2:22: property 'p' is a <float> here, but must be an object");
    CHECK(error("<integer name='p' value='3.0'/>", integer) == ":2:22: property 'p': '3.0' is not an integer");
    CHECK(value_error("<float name='p' value='1/2'/>") == ":2:22: property 'p': '1/2' is not a number");
    CHECK(value_error("<float name='p' value='1abc'/>") == ":2:22: property 'p': '1abc' is not a number");
    CHECK(value_error("<boolean name='p' value='1'/>") ==
          ":2:22: property 'p': '1' is not a boolean; available: true, false");
    CHECK(value_error("<float name='p'/>") == ":2:22: <float> lacks the attribute 'value'");
    CHECK(value_error("<float value='1'/>") == ":2:22: <float> lacks the attribute 'name'");
    CHECK(value_error("<rgb name='p' value='1'><float name='q' value='1'/></rgb>") == ":2:46: <rgb> holds nothing");
    CHECK(value_error("<float name='p' value='1'/>\n<integer name='p' value='1'/>") ==
          ":3:1: property 'p' is repeated; it stands first at :2:22");
    CHECK(value_error("<rgb name='p' value='1'/>\n<texture type='bitmap' name='p'/>") ==
          ":3:1: property 'p' is repeated; it stands first at :2:22");
}

TEST_CASE_METHOD(DocumentFixture, "points and vectors", "[mitsuba_document][mitsuba]") {
    const auto point = [](Object &object) { return object.point("p"); };
    const auto is = [&](const std::string &property, Vec3 expected) {
        INFO(property);
        const std::optional<Vec3> found = value(property, point);
        REQUIRE(found);
        CHECK(length(*found - expected) == 0);
    };
    is("<point name='p' value='1,2,3'/>", {1, 2, 3});
    is("<point name='p' value='1 2 3'/>", {1, 2, 3});
    is("<vector name='p' x='1' y='2' z='3'/>", {1, 2, 3});
    is("<vector name='p' value='2'/>", {2, 2, 2});
    CHECK_THAT(value_error("<point name='p' x='1'/>"),
               Catch::Contains("lacks the attribute 'y'") && Catch::Contains("lacks the attribute 'z'"));
    CHECK(value_error("<point name='p' value='1 2'/>") == ":2:22: '1 2' holds 2 numbers, not 3");
    CHECK_THAT(value_error("<point name='p' value='1' x='1'/>"), Catch::Contains("unknown attribute 'x'"));
}

TEST_CASE_METHOD(DocumentFixture, "what is not finite is a mistake anywhere", "[mitsuba_document][mitsuba]") {
    for (const char *bad : {"nan", "inf", "-inf", "1e39"})
        for (const char *form : {"<float name='p' value='{}'/>", "<rgb name='p' value='{}'/>",
                                 "<spectrum name='p' value='{}'/>", "<spectrum name='p' value='400:1,500:{}'/>",
                                 "<spectrum name='p' value='400:1,{}:2'/>", "<point name='p' x='1' y='1' z='{}'/>",
                                 "<vector name='p' value='1 {} 1'/>", "<transform name='p'><scale x='{}'/></transform>",
                                 "<transform name='p'><rotate x='1' angle='{}'/></transform>",
                                 "<transform name='p'><matrix value='1 0 0 0 {} 0 0 0 1'/></transform>",
                                 "<transform name='p'><lookat origin='0 0 {}' target='1 1 1'/></transform>"}) {
            const std::string property = fmt::format(fmt::runtime(form), bad);
            INFO(property);
            CHECK_THAT(value_error(property), Catch::StartsWith(":2:") && Catch::Contains("is not a finite number"));
        }
    const std::string huge = "<scale value='1e38'/>";
    std::string operations;
    for (int i = 0; i < 9; i++)
        operations += huge;
    CHECK(value_error("<transform name='p'>" + operations + "</transform>") ==
          ":2:22: the numbers of the transform overflow");
}

TEST_CASE_METHOD(DocumentFixture, "properties that nobody asks for", "[mitsuba_document][mitsuba]") {
    const auto use = [](Object &root) {
        root.finish();
        for (const auto &shape : root.children("shape")) {
            shape->number("radius");
            shape->children("bsdf");
            shape->ignore("material");
            shape->finish();
            shape->finish(); // says nothing twice
        }
    };
    const std::string body = "<shape type='sphere'>\n<float name='raduis' value='1'/>\n<emitter type='area'/>\n"
                             "<bsdf type='x'/><string name='material' value=''/></shape>";
    const std::string shapes = ":2:1: no <shape> may stand in <scene>; available: none";
    CHECK(mistakes_of(body, use) ==
          shapes + "\n:3:1: unknown property 'raduis' of shape 'sphere'; did you mean 'radius'? available: radius, "
                   "material\n:4:1: no <emitter> may stand in <shape>; available: bsdf");
    const size_t before = warnings().size();
    read_text("<scene version='3.0.0'>\n" + body + "</scene>", use, {}, true);
    REQUIRE(warnings().size() == before + 3);
    CHECK_THAT(without_name(warnings()[before + 1]),
               Catch::StartsWith(":3:1: unknown property 'raduis'") && Catch::EndsWith("; it is left out"));
    CHECK(mistakes_of(body, [](Object &root) {
              for (const auto &shape : root.children("shape")) {
                  shape->ignore_all();
                  shape->finish();
              }
              root.finish();
          }).empty());
}

TEST_CASE_METHOD(DocumentFixture, "mistakes of readers have the property's place", "[mitsuba_document][mitsuba]") {
    CHECK(mistakes_of("<shape type='sphere'>\n<float name='radius' value='-1'/></shape>", [](Object &root) {
              Object &shape = *root.children("shape").at(0);
              shape.check(true, "radius", "is told");
              shape.check(false, "radius", "must be positive");
              shape.check(false, "height", "is needed");
              shape.mistake("is bad");
          }) == ":2:1: property 'height': is needed\n:2:1: is bad\n:3:1: property 'radius': must be positive");
    CHECK(mistakes_of("<shape type='sphere'>\n<float name='radius' value='x'/></shape>", [](Object &root) {
              Object &shape = *root.children("shape").at(0);
              CHECK_FALSE(shape.number("radius"));
              shape.mistake_at("radius", "is told once");
              shape.finish();
          }) == ":3:1: property 'radius': 'x' is not a number");
}

TEST_CASE_METHOD(DocumentFixture, "unknown tags and attributes", "[mitsuba_document][mitsuba]") {
    CHECK_THAT(mistakes_in("<shap type='x'/>"), Catch::StartsWith(":2:1: unknown tag 'shap'; did you mean 'shape'?"));
    CHECK_THAT(mistakes_in("<blackbody name='x'/>"), Catch::StartsWith(":2:1: unknown tag 'blackbody'"));
    CHECK_THAT(mistakes_in("<shape type='x' bla='3'/>"), Catch::StartsWith(":2:1: unknown attribute 'bla'"));
    CHECK(mistakes_in("<shape id='s'/>") == ":2:1: <shape> lacks the attribute 'type'");
    CHECK_THAT(mistakes_in("words"), Catch::StartsWith(":2:1: text between the tags"));
    CHECK_THAT(mistakes_in("<translate x='1'/>"), Catch::StartsWith(":2:1: unknown tag 'translate'"));
    CHECK_THAT(without_name(error_of([&] { read_text("<scen version='3.0.0'/>", [](Object &) {}); })),
               Catch::StartsWith(":1:1: unknown root 'scen'; did you mean 'scene'?"));
    CHECK_THAT(error_of([&] { read_text("<scene version='3.0.0'>", [](Object &) {}); }),
               Catch::Contains("not well-formed XML"));
}

TEST_CASE_METHOD(DocumentFixture, "names stand for values", "[mitsuba_document][mitsuba]") {
    const std::string x = "<default name='x' value='3'/>";
    CHECK(value(x + "<integer name='p' value='$x'/>", integer) == 3);
    CHECK(value(x + "<integer name='p' value='1$x'/>", integer) == 13);
    CHECK(value(x + "<integer name='p' value='$x'/>", integer, {{"x", "4"}}) == 4);
    CHECK(value(x + "<default name='x' value='5'/><integer name='p' value='$x'/>", integer) == 3);
    CHECK(value(x + "<default name='y' value='$x$x'/><integer name='p' value='$y'/>", integer) == 33);
    CHECK(value(x + "<default name='xy' value='7'/><string name='p' value='$xyz $x-$xz'/>", text) == "7z 3-3z");
    CHECK(value(x + "<string name='p' value='\\$x'/>", text) == "$x");
    CHECK(value("<string name='p' value='$x'/>", text, {{"x", "$x <"}}) == "$x <"); // the value is not looked at again
    // in all attributes
    read("<default name='t' value='sphere'/><default name='n' value='p'/><shape type='$t' id='$n'>"
         "<float name='$n' value='1'/><transform name='to_$n'><translate x='$one'/></transform></shape>",
         [](Object &root) {
             Object &shape = *root.children("shape").at(0);
             CHECK(shape.type() == "sphere");
             CHECK(shape.id() == "p");
             CHECK(shape.number("p") == 1);
             CHECK(shape.transform("to_p")->rows[0][3] == 1);
         },
         {{"one", "1"}});
    CHECK(mistakes_in("<string name='p' value='$x'/>" + x) ==
          ":2:1: $x has no value: -D x=VALUE gives one, or <default name=\"x\" value=\"...\"/> in <scene>");
    CHECK_THAT(mistakes_in("<default name='depth' value='3'/><string name='p' value='$deptj'/>"),
               Catch::Contains("did you mean '$depth'?"));
    CHECK(mistakes_in("<string name='p' value='$'/>") == ":2:1: a '$' without a name; '\\$' stands for a dollar sign");
    CHECK_THAT(mistakes_in("<default name='1 x' value='3'/>"), Catch::StartsWith(":2:1: '1 x' is no name"));
}

TEST_CASE_METHOD(DocumentFixture, "a definition that no file uses is an error", "[mitsuba_document][mitsuba]") {
    CHECK_THROWS_AS(read("", [](Object &) {}, {{"x", "1"}}), UsageError);
    CHECK_THAT(
        mistakes_in("<default name='depth' value='$x'/><string name='p' value='$depth'/>", {{"x", "1"}, {"dept", "1"}}),
        Catch::Contains("unknown name of -D 'dept'; did you mean 'depth'?") &&
            Catch::EndsWith("no attribute holds $dept"));
    const MitsubaScene scene = read("<default name='x' value='1'/><default name='y' value='2'/>"
                                    "<string name='p' value='$x'/>",
                                    [](Object &) {}, {{"x", "4"}});
    CHECK(scene.definitions == Definitions{{"x", "4"}}); // what was used
}

TEST_CASE_METHOD(DocumentFixture, "versions before 2.0.0 have other names", "[mitsuba_document][mitsuba]") {
    for (const char *version : {"0.5.0", "1.9.9"})
        read(
            "<sensor type='perspective'><float name='nearClip' value='1'/><transform name='toWorld'/></sensor>"
            "<bsdf type='diffuse' id='old'><rgb name='diffuseReflectance' value='0.25'/></bsdf>"
            "<bsdf type='plastic'><rgb name='diffuseReflectance' value='0.5'/><float name='intIOR' value='1.5'/>"
            "<texture type='bitmap' name='specularReflectance'/><ref id='old' name='nestedBsdf'/></bsdf>",
            [](Object &root) {
                Object &sensor = *root.children("sensor").at(0);
                CHECK(sensor.number("near_clip") == 1);
                CHECK(sensor.transform("to_world"));
                CHECK(root.children("bsdf").at(0)->color("reflectance", SpectrumUse::reflectance) ==
                      Color{0.25, 0.25, 0.25});
                Object &plastic = *root.children("bsdf").at(1);
                CHECK(plastic.color("diffuse_reflectance", SpectrumUse::reflectance) == Color{0.5, 0.5, 0.5});
                CHECK(plastic.number("int_ior") == 1.5);
                CHECK(plastic.child_named("specular_reflectance")->name() == "specular_reflectance");
                CHECK(plastic.child_named("nested_bsdf")->id() == "old");
                plastic.finish();
            },
            {}, version);
    read("<bsdf type='diffuse'><rgb name='diffuseReflectance' value='0.25'/></bsdf>",
         [](Object &root) { CHECK_FALSE(root.children("bsdf").at(0)->has("reflectance")); });
    CHECK_THAT(mistakes_in("<sensor type='x'><float name='nearClip' value='1'/><float name='near_clip' value='1'/>"
                           "</sensor>",
                           {}, "0.6.0"),
               Catch::Contains("property 'near_clip' is repeated"));
}

TEST_CASE_METHOD(DocumentFixture, "old scales and offsets of textures are to_uv", "[mitsuba_document][mitsuba]") {
    read(
        "<texture type='bitmap'><float name='uscale' value='2'/><integer name='voffset' value='3'/>"
        "<float name='vscale' value='4'/></texture>",
        [](Object &root) {
            Object &texture = *root.children("texture").at(0);
            // the offset is added first
            check_rows(*texture.transform("to_uv"), Rows{{{2, 0, 0, 0}, {0, 4, 0, 12}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
            texture.finish();
        },
        {}, "0.6.0");
    CHECK_THAT(mistakes_in("<texture type='bitmap'><string name='uscale' value='2'/></texture>", {}, "0.6.0"),
               Catch::Contains("must be a <float>"));
}

TEST_CASE_METHOD(DocumentFixture, "includes", "[mitsuba_document][mitsuba]") {
    // beside the including file first, then beside the main file
    scratch.write("materials/wall.xml", "<bsdf version='3.0.0' type='diffuse' id='wall'/>");
    scratch.write("wall.xml", "<bsdf version='3.0.0' type='rough' id='wall'/>");
    scratch.write("only_here.xml", "<scene version='3.0.0'><bsdf type='$kind' id='here'/>\n"
                                   "<default name='later' value='5'/></scene>");
    scratch.write("materials/all.xml", "<scene version='3.0.0'><include filename='wall.xml'/>\n"
                                       "<include filename='only_here.xml'/><ref id='ball'/></scene>");
    const std::string body =
        "<default name='kind' value='plastic'/><include filename='materials/all.xml'/>\n"
        "<shape id='ball' type='sphere'><ref id='wall'/><integer name='p' value='$later'/></shape>";
    read(body, [](Object &root) {
        const auto bsdfs = root.children("bsdf");
        REQUIRE(bsdfs.size() == 2);
        CHECK(bsdfs[0]->type() == "diffuse");
        CHECK(bsdfs[1]->type() == "plastic"); // names cross both ways
        CHECK_THAT(bsdfs[0]->place().text(), Catch::EndsWith("materials/wall.xml:1:1"));
        const auto shapes = root.children("shape");
        REQUIRE(shapes.size() == 2); // and ids
        CHECK(shapes[0].get() == shapes[1].get());
        CHECK(shapes[0]->integer("p") == 5);
        CHECK(shapes[0]->children("bsdf").at(0).get() == bsdfs[0].get());
    });
    const std::string first = hashes.value();
    scratch.write("only_here.xml", "<scene version='3.0.0'><bsdf type='$kind' id='here'/>\n\n"
                                   "<default name='later' value='5'/></scene>");
    read(body, [](Object &) {});
    CHECK(hashes.value() != first); // each file counts
    // An object of any kind gets the name of the <include>; each file has the names of its version.
    scratch.write("old.xml", "<bsdf version='0.6.0' type='diffuse' name='is not looked at'>\n"
                             "<rgb name='diffuseReflectance' value='0.5'/></bsdf>");
    read("<bsdf type='twosided'><include filename='old.xml' name='nested'/></bsdf>", [](Object &root) {
        const auto nested = root.children("bsdf").at(0)->child_named("nested");
        REQUIRE(nested);
        CHECK(nested->name() == "nested");
        CHECK(nested->has("reflectance"));
    });
}

TEST_CASE_METHOD(DocumentFixture, "mistakes in and of includes have their places", "[mitsuba_document][mitsuba]") {
    const std::string include = "<include filename='b.xml'/>";
    CHECK_THAT(mistakes_in(include),
               Catch::StartsWith(":2:1: there is no file 'b.xml' in: " + scratch.path().string()));
    const auto error_with = [&](const std::string &included) {
        scratch.write("b.xml", included);
        std::string error = error_of([&] { read("<string name='a' value='$bad'/>" + include, [](Object &) {}); });
        const size_t line = error.find('\n'); // the main file's mistakes come first
        REQUIRE(line != error.npos);
        CHECK_THAT(error, Catch::StartsWith(file() + ":2:1: $bad has no value"));
        return error.substr(line + 1);
    };
    const std::string b = (scratch / "b.xml").string();
    CHECK_THAT(error_with("<scene version='3.0'/>"), Catch::StartsWith(b + ":1:1: '3.0' is no version"));
    CHECK_THAT(error_with("<scene/>"), Catch::StartsWith(b + ":1:1: <scene> lacks the attribute 'version'"));
    CHECK_THAT(error_with("<scene version='3.0.0'>\n<shape/></scene>"), Catch::StartsWith(b + ":2:1: <shape> lacks"));
    CHECK_THAT(error_with("<scene"), Catch::StartsWith(b + ":1:") && Catch::Contains("not well-formed"));
    CHECK_THAT(error_with("<float version='3.0.0' name='x' value='1'/>"), Catch::StartsWith(b + ":1:1: unknown root"));
    CHECK_THAT(error_with("ply\n"), Catch::StartsWith(file() + ":2:32: " + b + ": is a PLY mesh, not a scene"));
    CHECK_THAT(error_with("<scene version='3.0.0'>" + include + "</scene>"),
               Catch::StartsWith(b + ":1:24: the file includes itself: " + b + " -> " + b));
    scratch.write("c.xml", "<scene version='3.0.0'><include filename='a.xml'/></scene>");
    CHECK_THAT(error_with("<scene version='3.0.0'><include filename='c.xml'/></scene>"),
               Catch::Contains("the file includes itself: ") && Catch::Contains("c.xml -> ") &&
                   Catch::EndsWith("a.xml"));
    CHECK_THAT(mistakes_in("<include filename='.'/>"), Catch::StartsWith(":2:1: there is no file '.'"));
    CHECK_THAT(mistakes_in("<include filename=''/>"), Catch::StartsWith(":2:1: there is no file ''"));
}

TEST_CASE_METHOD(DocumentFixture, "few files cannot include each other without end", "[mitsuba_document][mitsuba]") {
    for (int i = 0; i < 14; i++)
        scratch.write(fmt::format("level_{}.xml", i),
                      fmt::format("<scene version='3.0.0'><include filename='level_{0}.xml'/>"
                                  "<include filename='level_{0}.xml'/></scene>",
                                  i + 1));
    scratch.write("level_14.xml", "<scene version='3.0.0'/>");
    CHECK_THAT(error_of([&] { read("<include filename='level_4.xml'/>", [](Object &) {}); }),
               Catch::Contains("more than 1000 files are included") && !Catch::Contains("\n"));
    CHECK_THAT(error_of([&] { read("<include filename='level_0.xml'/>", [](Object &) {}); }),
               Catch::Contains("more than 15 files include each other"));
    read("<include filename='level_6.xml'/>", [](Object &) {}); // 511 files
}

TEST_CASE_METHOD(DocumentFixture, "references, forwards too", "[mitsuba_document][mitsuba]") {
    read("<shape type='sphere'><ref id='late'/><ref id='t' name='radiance'/></shape>"
         "<bsdf type='twosided' id='late'><bsdf type='diffuse'/></bsdf><texture type='bitmap' id='t'/>"
         "<alias id='late' as='other'/><shape type='cube'><ref id='other'/></shape>",
         [](Object &root) {
             const auto shapes = root.children("shape");
             const auto bsdf = shapes.at(0)->children("bsdf").at(0);
             CHECK(bsdf->type() == "twosided");
             CHECK(bsdf.get() == shapes.at(1)->children("bsdf").at(0).get());
             CHECK(bsdf.get() == root.children("bsdf").at(0).get());
             CHECK(shapes.at(0)->child_named("radiance")->id() == "t");
         });
    CHECK(mistakes_in("<shape type='sphere'>\n<ref id='wal'/></shape><bsdf type='diffuse' id='wall'/>") ==
          ":3:1: no object has the id 'wal'; did you mean 'wall'?");
    CHECK(mistakes_in("<bsdf type='diffuse' id='a'/>\n<shape type='cube' id='a'/>") ==
          ":3:1: a second object with the id 'a'; the first stands at :2:1");
    CHECK(mistakes_in("<alias id='a' as='b'/><bsdf type='diffuse' id='a'/>") ==
          ":2:1: no object before this <alias> has the id 'a'");
    CHECK_THAT(mistakes_in("<bsdf type='diffuse' id='a'/><alias id='a' as='b'/>\n<bsdf type='diffuse' id='b'/>"),
               Catch::StartsWith(":3:1: a second object with the id 'b'"));
    CHECK(mistakes_in("<bsdf type='diffuse' id=''/><bsdf type='diffuse' id=''/>").empty()); // no ids
}

TEST_CASE_METHOD(DocumentFixture, "references in circles are mistakes", "[mitsuba_document][mitsuba]") {
    CHECK(mistakes_in("<bsdf type='twosided' id='a'>\n<ref id='a'/></bsdf>") ==
          ":3:1: the reference to 'a' is within what it refers to");
    CHECK(mistakes_in("<bsdf type='twosided' id='a'>\n<ref id='b'/></bsdf>\n<bsdf type='mask' id='b'>\n"
                      "<bsdf type='twosided'>\n<ref id='a'/></bsdf></bsdf>") ==
          ":6:1: the reference to 'a' is within what it refers to");
    CHECK(mistakes_in("<ref id='s'/><shape type='cube' id='s'/>").empty());
}

TEST_CASE_METHOD(DocumentFixture, "references do not unfold to deep or huge trees", "[mitsuba_document][mitsuba]") {
    const auto chain = [](int count, int references) {
        std::string body;
        for (int i = 0; i < count; i++) {
            body += fmt::format("<bsdf type='blendbsdf' id='m{}'>", i);
            for (int k = 0; k < references; k++)
                body += fmt::format("<ref id='m{}'/>", i + 1);
            body += "</bsdf>\n";
        }
        return body + fmt::format("<bsdf type='diffuse' id='m{}'/>", count);
    };
    CHECK(mistakes_in(chain(50, 1)).empty());
    CHECK_THAT(mistakes_in(chain(100000, 1)), Catch::Contains("more than 64 objects lie within each other"));
    CHECK(mistakes_in(chain(10, 2)).empty());
    CHECK(mistakes_in(chain(40, 2)) == ":1:1: with a copy for each reference, there are more than 10000000 objects");
}

TEST_CASE_METHOD(DocumentFixture, "folders of <path> are looked in first, for names before it, too",
                 "[mitsuba_document][mitsuba]") {
    scratch.write("x.obj", "");
    scratch.write("models/x.obj", "");
    scratch.write("models/y.obj", "");
    scratch.write("sub/z.obj", "");
    scratch.write("sub/shapes.xml",
                  "<shape version='3.0.0' type='obj'><string name='filename' value='z.obj'/></shape>");
    const auto file_of = [](const std::shared_ptr<Object> &shape) { return shape->file("filename"); };
    const std::string x = "<shape type='obj'><string name='filename' value='x.obj'/></shape>\n";
    read(x, [&](Object &root) { CHECK(file_of(root.children("shape").at(0)) == scratch / "x.obj"); });
    const std::string y = "<shape type='obj'><string name='filename' value='y.obj'/></shape>";
    read(x + y + "<path value='models'/>", [&](Object &root) {
        CHECK(file_of(root.children("shape").at(0)) == scratch / "models/x.obj");
        CHECK(file_of(root.children("shape").at(1)) == scratch / "models/y.obj");
    });
    const std::string absolute = (scratch / "models/y.obj").string();
    read("<shape type='obj'><string name='filename' value='" + absolute + "'/></shape>",
         [&](Object &root) { CHECK(file_of(root.children("shape").at(0)) == absolute); });
    CHECK(mistakes_in("<path value='none'/>") == ":2:1: there is no folder 'none'");
    CHECK(mistakes_in("<path value='x.obj'/>") == ":2:1: there is no folder 'x.obj'");
    CHECK(mistakes_in("<shape type='obj'><path value='models'/></shape>") ==
          ":2:19: <path> stands within the root of a file");
    // never in the folder of an included file
    const std::string error = mistakes_of("<include filename='sub/shapes.xml'/>",
                                          [&](Object &root) { file_of(root.children("shape").at(0)); });
    CHECK_THAT(error, Catch::Contains("shapes.xml:1:") &&
                          Catch::Contains("property 'filename': there is no file 'z.obj' in: " +
                                          scratch.path().string() + ", the working folder"));
}

TEST_CASE_METHOD(DocumentFixture, "transforms", "[mitsuba_document][mitsuba]") {
    check_rows(transform("<translate x='1' z='3'/>"), {{{1, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 3}, {0, 0, 0, 1}}});
    check_rows(transform("<translate value='1, 2, 3'/>"), {{{1, 0, 0, 1}, {0, 1, 0, 2}, {0, 0, 1, 3}, {0, 0, 0, 1}}});
    check_rows(transform("<scale x='3'/>"), {{{3, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    check_rows(transform("<scale value='2'/>"), {{{2, 0, 0, 0}, {0, 2, 0, 0}, {0, 0, 2, 0}, {0, 0, 0, 1}}});
    check_rows(transform("<rotate z='1' angle='90'/>"), {{{0, -1, 0, 0}, {1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    // an axis that is not normalised: c I + s [a]x + (1 - c) a a^T with a as written
    check_rows(transform("<rotate x='1' y='1' angle='90'/>"),
               {{{1, 1, 1, 0}, {1, 1, -1, 0}, {-1, 1, 0, 0}, {0, 0, 0, 1}}});
    check_rows(transform("<rotate value='0 0 2' angle='90'/>"),
               {{{0, -2, 0, 0}, {2, 0, 0, 0}, {0, 0, 4, 0}, {0, 0, 0, 1}}});
    check_rows(transform("<lookat origin='0 0 5' target='0 0 0' up='0 1 0'/>"),
               {{{-1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, -1, 5}, {0, 0, 0, 1}}});
    const Rows without_up = {{{0, 1, 0, 0}, {1, 0, 0, 0}, {0, 0, -1, 5}, {0, 0, 0, 1}}};
    check_rows(transform("<lookat origin='0 0 5' target='0 0 0'/>"), without_up);
    check_rows(transform("<lookat origin='0 0 5' target='0 0 0' up='0 0 0'/>"), without_up);
    check_rows(transform("<matrix value='1 2 3 4 0 1 2 5 0 0 1 6 0 0 0 1'/>"),
               {{{1, 2, 3, 4}, {0, 1, 2, 5}, {0, 0, 1, 6}, {0, 0, 0, 1}}});
    check_rows(transform("<matrix value='1 2 3  0 1 2  0 0 1'/>"),
               {{{1, 2, 3, 0}, {0, 1, 2, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    check_rows(transform("<scale x='3'/><translate x='1'/>"),
               {{{3, 0, 0, 1}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
    check_rows(transform(""), {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}});
}

TEST_CASE_METHOD(DocumentFixture, "an axis that stretches is warned of", "[mitsuba_document][mitsuba]") {
    const auto rotate = [](const std::string &axis) {
        return "<shape type='cube'><transform name='p'><rotate " + axis + " angle='90'/></transform></shape>";
    };
    CHECK_THAT(warning_of(rotate("x='1' y='1'")),
               Catch::StartsWith(":2:40: the axis of this <rotate> has length 1.414"));
    CHECK(warning_of(rotate("x='0.577' y='0.577' z='0.577'")).empty());
    CHECK(warning_of(rotate("y='-1'")).empty());
}

TEST_CASE_METHOD(DocumentFixture, "transforms that are none are mistakes", "[mitsuba_document][mitsuba]") {
    const auto error = [&](const std::string &operation) {
        return value_error("<transform name='p'>\n" + operation + "</transform>");
    };
    CHECK(error("<rotate angle='3'/>") == ":3:1: the axis of a rotation must not be 0 0 0");
    CHECK(error("<rotate x='1'/>") == ":3:1: <rotate> lacks the attribute 'angle'");
    CHECK(error("<scale value='1 2'/>") == ":3:1: '1 2' holds 2 numbers, not 3");
    CHECK(error("<scale value='1' x='2'/>") == ":3:1: <scale> has both value and x, y or z");
    CHECK(error("<matrix value='1 2 3'/>") == ":3:1: '1 2 3' holds 3 numbers, not 16 or 9");
    CHECK(error("<matrix value='1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1'/>") ==
          ":3:1: the last row of a <matrix> must be 0 0 0 1");
    CHECK_THAT(error("<lookat origin='0 0 0' target='0 1 0' up='0 2 0'/>"), Catch::StartsWith(":3:1: up of a lookat"));
    CHECK(error("<lookat origin='0 0 0' target='0 0 0'/>") == ":3:1: origin and target of a lookat must differ");
    CHECK_THAT(error("<skew x='1'/>"), Catch::StartsWith(":3:1: unknown operation 'skew'"));
    CHECK_THAT(error("<scale x='0'/>"), Catch::StartsWith(":2:22: the transform is singular"));
    CHECK_THAT(error("<scale x='1'><float name='x' value='1'/></scale>"), Catch::EndsWith("<scale> holds nothing"));
    // lookAt is of Mitsuba 0.x. Mitsuba 3 knows only lookat; here both are one.
    read(
        "<shape type='cube'><transform name='toWorld'><lookAt origin='0 0 5' target='0 0 0'/></transform></shape>",
        [](Object &root) { CHECK(root.children("shape").at(0)->transform("to_world")->rows[2][3] == 5); }, {}, "0.6.0");
}

namespace {

struct SpectrumRow {
    std::string text;
    Color reflectance, radiance; // by Mitsuba 3.9.1
};

const std::vector<SpectrumRow> spectra = {
    {"1", {1, 1, 1}, {1.204794, 0.948291, 0.9089161}},
    {"0.5", {0.5, 0.5, 0.5}, {0.602397, 0.4741455, 0.454458}},
    {"400:0.1,500:0.3,600:0.8,700:0.9", {0.931798, 0.5094967, 0.1605877}, {1.080135, 0.4881109, 0.13739}},
    {"400:0.1,450:0.2,500:0.3,550:0.5,600:0.8,650:0.9,700:0.9",
     {0.9489667, 0.4779578, 0.1635431},
     {1.099692, 0.4574062, 0.140235}},
    {"400:1,700:1", {0.995342, 0.9997564, 0.9949091}, {1.199694, 0.9495203, 0.9034433}},
    {"360:1,830:1", {0.9989852, 0.9988737, 0.9988016}, {1.204884, 0.9482282, 0.9092668}},
    {"300:0.5,900:0.5", {0.4994926, 0.4994368, 0.4994008}, {0.6024418, 0.4741141, 0.4546334}},
    {"500:0.3,600:0.8", {0.2602829, 0.5292922, 0}, {0.2990422, 0.5161645, 0}},
    {"400:0.9,500:0.7,600:0.2,700:0.1", {0.0635439, 0.4902597, 0.8343214}, {0.1195591, 0.4614095, 0.7660533}},
    {"400:0,490:0,500:0.9,590:0.9,600:0,700:0", {0.06885269, 0.9363676, 0}, {0.1182802, 0.9009274, 0}},
    {"400:0.2,700:0.2", {0.1990684, 0.1999513, 0.1989818}, {0.2399387, 0.1899041, 0.1806887}},
    {"380:0.04,420:0.05,460:0.06,500:0.1,540:0.2,580:0.4,620:0.6,660:0.65,700:0.66",
     {0.6678769, 0.2232925, 0.03315746},
     {0.7665746, 0.2139793, 0.02578335}},
    {"400:0.2 700:0.2", {0.1990684, 0.1999513, 0.1989818}, {0.2399387, 0.1899041, 0.1806887}},
};

struct BlackBodyRow {
    double kelvin;
    Color radiance; // by Mitsuba 3.9.1's spectral mode, a sum over 1 nm
};
const std::vector<BlackBodyRow> black_bodies = {{2000, {16.01432, 4.111888, 0.1304031}},
                                                {2856, {499.2189, 223.5595, 63.19566}},
                                                {5000, {15263.02, 12082.56, 9592.535}},
                                                {6500, {43918.56, 41407.2, 43582.59}}};

constexpr double accuracy = 2e-6; // Mitsuba's numbers are single ones, of seven digits

void check_color(const std::optional<Color> &color, const Color &expected, double relative = accuracy) {
    REQUIRE(color);
    for (size_t i = 0; i < 3; i++) {
        INFO("channel " << i);
        CHECK((*color)[i] == Approx(expected[i]).epsilon(relative).margin(1e-7));
    }
}

} // namespace

TEST_CASE_METHOD(DocumentFixture, "spectra become the linear RGB that Mitsuba gives them",
                 "[mitsuba_document][mitsuba]") {
    for (const SpectrumRow &row : spectra) {
        const std::string property = "<spectrum name='p' value='" + row.text + "'/>";
        INFO(property);
        const auto of = [&](SpectrumUse use) {
            return value(property, [&](Object &object) { return object.color("p", use); });
        };
        check_color(of(SpectrumUse::reflectance), row.reflectance);
        check_color(of(SpectrumUse::radiance), row.radiance);
        check_color(of(SpectrumUse::index), row.reflectance);
    }
    const auto index = [](Object &object) { return object.color("p", SpectrumUse::index); };
    // an index may be above 1
    check_color(value("<spectrum name='p' value='360:2,830:2'/>", index), {1.9979704, 1.9977474, 1.9976032});
}

TEST_CASE_METHOD(DocumentFixture, "what a curve has outside of what can be is clamped, with a warning",
                 "[mitsuba_document][mitsuba]") {
    const auto shape = [](const std::string &curve) {
        return "<shape type='cube'><spectrum name='p' value='" + curve + "'/></shape>";
    };
    const auto warning_for = [&](const std::string &curve, SpectrumUse use) {
        const size_t before = warnings().size();
        read(shape(curve), [&](Object &root) { root.children("shape").at(0)->color("p", use); });
        return warnings().size() == before ? "" : without_name(warnings().at(before));
    };
    CHECK_THAT(warning_for("500:0.3,600:0.8", SpectrumUse::radiance),
               Catch::StartsWith(":2:20: this spectrum has the linear RGB 0.299, 0.5162, -0.0") &&
                   Catch::EndsWith("it is clamped to 0 and more"));
    CHECK_THAT(warning_for("360:2,830:2", SpectrumUse::reflectance), Catch::EndsWith("it is clamped to 0 to 1"));
    CHECK(warning_for("360:2,830:2", SpectrumUse::index).empty());
    CHECK(warning_for("400:0.1,500:0.3,600:0.8,700:0.9", SpectrumUse::reflectance).empty());
}

TEST_CASE_METHOD(DocumentFixture, "malformed spectra", "[mitsuba_document][mitsuba]") {
    const auto error = [&](const std::string &curve) {
        return value_error("<spectrum name='p' value='" + curve + "'/>");
    };
    CHECK(error("500:1,400:2") == ":2:22: property 'p': the wavelengths must rise, but 400 follows 500");
    CHECK_THAT(error("500:1 500:2"), Catch::Contains("must rise"));
    CHECK_THAT(error("500:1"), Catch::Contains("at least two pairs"));
    CHECK_THAT(error(""), Catch::Contains("at least two pairs"));
    CHECK_THAT(error("0.1 0.2 0.3"), Catch::EndsWith("'0.1' is not a pair wavelength:value"));
    CHECK_THAT(error("400: 0.5, 500:0.6"), Catch::Contains("'' is not a number"));
    CHECK_THAT(error("400:1:2, 500:0.6"), Catch::Contains("'1:2' is not a number"));
    CHECK_THAT(value_error("<spectrum name='p' filename='a.spd'/>"), Catch::Contains("spectra in files are not read"));
}

TEST_CASE_METHOD(DocumentFixture, "rgb is linear as it stands; hex and srgb are encoded",
                 "[mitsuba_document][mitsuba]") {
    const auto color = [&](const std::string &property, SpectrumUse use = SpectrumUse::reflectance) {
        return value(property, [&](Object &object) { return object.color("p", use); });
    };
    CHECK(color("<rgb name='p' value='0.5'/>") == Color{0.5, 0.5, 0.5});
    CHECK(color("<rgb name='p' value='0.1, 0.2, 0.3'/>") == Color{0.1, 0.2, 0.3});
    CHECK(color("<rgb name='p' value='0.1 0.2 0.3'/>") == Color{0.1, 0.2, 0.3});
    CHECK(color("<rgb name='p' value='3 -2 1'/>", SpectrumUse::radiance) == Color{3, -2, 1});
    CHECK(color("<rgb name='p' value='3'/>", SpectrumUse::index) == Color{3, 3, 3});
    CHECK(color("<float name='p' value='0.25'/>") == Color{0.25, 0.25, 0.25});
    CHECK(color("<float name='p' value='2'/>", SpectrumUse::radiance) == Color{2, 2, 2});
    CHECK(color("<integer name='p' value='1'/>") == Color{1, 1, 1});
    CHECK_FALSE(color("<float name='q' value='1'/>"));
    // stated extensions
    check_color(color("<rgb name='p' value='#ff8000'/>"), {1, 0.21586050, 0});
    check_color(color("<srgb name='p' value='0.5 0.04 1'/>"), {0.21404114, 0.0030959752, 1});
    for (const char *bad : {"0.1,0.2", "0.1;0.2;0.3", "#f80", "#ff80g0", "#", "", "red"})
        CHECK_THAT(value_error("<rgb name='p' value='" + std::string(bad) + "'/>"),
                   Catch::StartsWith(":2:22: property 'p': "));
    const auto error = [&](const std::string &rgb) {
        return mistakes_of("<bsdf type='diffuse'><rgb name='p' value='" + rgb + "'/></bsdf>",
                           [](Object &root) { root.children("bsdf").at(0)->color("p", SpectrumUse::reflectance); });
    };
    CHECK(error("1.5,0.2,0.3") == ":2:22: property 'p': 1.5, 0.2, 0.3 is no reflectance, which is 0 to 1");
    CHECK(error("-0.1") == ":2:22: property 'p': -0.1, -0.1, -0.1 is no reflectance, which is 0 to 1");
    read("<bsdf type='diffuse'><texture type='bitmap' name='p'/></bsdf>", [](Object &root) {
        Object &bsdf = *root.children("bsdf").at(0);
        CHECK_FALSE(bsdf.color("p", SpectrumUse::reflectance));
        CHECK(bsdf.child_named("p"));
    });
}

TEST_CASE_METHOD(DocumentFixture, "spectra with a type", "[mitsuba_document][mitsuba]") {
    const auto color = [&](const std::string &type, const std::string &within,
                           SpectrumUse use = SpectrumUse::radiance) {
        return value("<spectrum name='p' type='" + type + "'>" + within + "</spectrum>",
                     [&](Object &object) { return object.color("p", use); });
    };
    CHECK(color("d65", "") == Color{1, 1, 1});
    CHECK(color("d65", "", SpectrumUse::reflectance) == Color{1, 1, 1});
    CHECK(color("d65", "<float name='scale' value='2'/>") == Color{2, 2, 2});
    CHECK(color("d65", "<rgb name='color' value='3 0.25 0.5'/><float name='scale' value='2'/>") == Color{6, 0.5, 1});
    CHECK(color("uniform", "<float name='value' value='0.25'/>") == Color{0.25, 0.25, 0.25});
    CHECK(color("srgb", "<rgb name='color' value='0.1 0.2 0.3'/>") == Color{0.1, 0.2, 0.3});
    for (const BlackBodyRow &row : black_bodies) {
        INFO(row.kelvin);
        check_color(color("blackbody", fmt::format("<float name='temperature' value='{}'/>", row.kelvin)), row.radiance,
                    1e-4);
    }
    const auto error = [&](const std::string &spectrum, SpectrumUse use) {
        return mistakes_of("<shape type='cube'>" + spectrum + "</shape>",
                           [&](Object &root) { root.children("shape").at(0)->color("p", use); });
    };
    CHECK(error("<spectrum type='d65' name='p'><float name='scal' value='2'/></spectrum>", SpectrumUse::radiance) ==
          ":2:50: unknown property 'scal' of spectrum 'd65'; did you mean 'scale'? available: scale, color");
    CHECK(error("<spectrum type='irregular' name='p'><float name='x' value='2'/></spectrum>", SpectrumUse::radiance) ==
          ":2:20: unknown spectrum type 'irregular'; available: d65, srgb, uniform, blackbody");
    CHECK_THAT(error("<spectrum type='blackbody' name='p'/>", SpectrumUse::reflectance),
               Catch::Contains("unknown spectrum type"));
    CHECK_THAT(error("<spectrum type='blackbody' name='p'/>", SpectrumUse::radiance), Catch::Contains("lacks"));
    CHECK_THAT(error("<spectrum type='blackbody' name='p'><float name='temperature' value='0'/></spectrum>",
                     SpectrumUse::radiance),
               Catch::EndsWith("property 'temperature': must be greater than 0"));
    CHECK_THAT(error("<bsdf type='diffuse' name='p'/>", SpectrumUse::radiance), Catch::Contains("is a <bsdf> here"));
}

TEST_CASE_METHOD(DocumentFixture, "hostile files give one message", "[mitsuba_document][mitsuba]") {
    std::string nested;
    for (int i = 0; i < 100000; i++)
        nested += "<bsdf type='twosided'>";
    CHECK_THAT(mistakes_in(nested), Catch::Contains("not well-formed") && !Catch::Contains("\n"));
    for (int i = 0; i < 100000; i++)
        nested += "</bsdf>";
    CHECK_THAT(mistakes_in(nested), Catch::Contains("more than 64 tags within each other") && !Catch::Contains("\n"));
    std::string attributes = "<bsdf type='diffuse'";
    for (int i = 0; i < 100000; i++)
        attributes += fmt::format(" a{}='$'", i);
    CHECK_THAT(mistakes_in(attributes + "/>"), Catch::Contains("<bsdf> has more than 1000 attributes"));
    const std::string x = "<default name='x0' value='" + std::string(100000, 'x') + "'/>";
    std::string doubled = x;
    for (int i = 0; i < 30; i++)
        doubled += fmt::format("<default name='x{}' value='$x{}$x{}'/>\n", i + 1, i, i);
    CHECK_THAT(mistakes_in(doubled), Catch::Contains("the values of $names fill more than 64 MiB"));
}

TEST_CASE_METHOD(DocumentFixture, "many objects and properties take linear time", "[mitsuba_document][mitsuba]") {
    std::string body;
    for (int i = 0; i < 50000; i++)
        body +=
            fmt::format("<shape type='sphere' id='s{0}'><float name='radius' value='{0}'/><ref id='b'/></shape>\n", i);
    body += "<bsdf type='diffuse' id='b'>";
    for (int i = 0; i < 50000; i++)
        body += fmt::format("<float name='p{0}' value='{0}'/>", i);
    body += "</bsdf>";
    read(body, [](Object &root) {
        const auto shapes = root.children("shape");
        REQUIRE(shapes.size() == 50000);
        CHECK(shapes.back()->number("radius") == 49999);
        CHECK(root.children("bsdf").at(0)->number("p49999") == 49999);
    });
}
