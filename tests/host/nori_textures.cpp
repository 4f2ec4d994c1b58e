// Textures in Nori's scenes: the forms of public forks, and what each means.
#include "base/log.h"
#include "image/image.h"
#include "read/load.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace opal;
using opal::test::error_of;

namespace {

const std::string camera = "<camera type='perspective'/>\n";
const std::string square =
    "<point name='origin' value='0 0 0'/><vector name='u' value='1 0 0'/><vector name='v' value='0 2 0'/>";

struct TextureFixture {
    test::ScratchFolder scratch;
    TextureFixture() {
        Image image;
        image.width = 2;
        image.height = 1;
        image.layers = {{"R", {0.5f, 1}}, {"G", {0.25f, 1}}, {"B", {0, 1}}};
        write_exr(image, scratch / "a.exr");
    }
    // The scene of a mesh that holds `body`, on line 3.
    SceneDescription load(const std::string &body, const LoadOptions &options = {}) const {
        return load_scene(scratch.write("a.xml", "<scene>\n" + camera + "<mesh type='parallelogram'>" + square + body +
                                                     "</mesh></scene>"),
                          options);
    }
    Bsdf bsdf(const std::string &type, const std::string &body, const LoadOptions &options = {}) const {
        return load(fmt::format("<bsdf type='{}'>{}</bsdf>", type, body), options).meshes.at(0).bsdf;
    }
    // The texture of such a type on the albedo of a diffuse one.
    Texture texture(const std::string &type, const std::string &body = "") const {
        const Bsdf made = bsdf("diffuse", fmt::format("<texture type='{}' name='albedo'>{}</texture>", type, body));
        REQUIRE(made.textures.size() == 1);
        CHECK(made.textures.begin()->first == bsdf_parameters(BSDF_diffuse)[0].texture_word);
        return made.textures.begin()->second;
    }
    BitmapTexture bitmap(const std::string &type, const std::string &body) const {
        return std::get<BitmapTexture>(texture(type, body));
    }
    std::string error_in(const std::string &body) const {
        const std::string error = error_of([&] { load(body); }), file = (scratch / "a.xml").string();
        return error.starts_with(file) ? error.substr(file.size()) : error;
    }
};

const std::string file = "<string name='filename' value='a.exr'/>";

} // namespace

TEST_CASE_METHOD(TextureFixture, "checkerboards of Nori's forks", "[nori_textures]") {
    const auto plain = std::get<CheckerboardTexture>(texture("checkerboard_color"));
    CHECK(plain.color0 == Color{0, 0, 0});
    CHECK(plain.color1 == Color{1, 1, 1});
    CHECK(plain.to_uv == UvTransform{{{0.5, 0, 0}, {0, 0.5, 0}}}); // squares of 1 x 1
    const auto board = std::get<CheckerboardTexture>(texture(
        "checkerboard_color", "<point name='delta' value='0.5, 1'/><vector name='scale' value='0.25, 0.5'/>"
                              "<color name='value1' value='0.1 0.2 0.3'/><color name='value2' value='0.5 0.5 1'/>"));
    CHECK(board.color0 == Color{0.1, 0.2, 0.3});
    CHECK(board.color1 == Color{0.5, 0.5, 1});
    // floor(u / 0.25 - 0.5), where the texture asks for the half of it
    CHECK(board.to_uv == UvTransform{{{2, 0, -0.25}, {0, 1, -0.5}}});
    const auto checker = std::get<CheckerboardTexture>(
        texture("checker", "<integer name='scalex' value='4'/><integer name='scaley' value='8'/>"
                           "<color name='color2' value='0.25 0.5 1'/>"));
    CHECK(checker.color0 == Color{0.9, 0.9, 0.9});
    CHECK(checker.color1 == Color{0.25, 0.5, 1});
    CHECK(checker.to_uv == UvTransform{{{2, 0, 0}, {0, 4, 0}}});
    CHECK_THAT(error_in("<bsdf type='diffuse'><texture type='checkerboard_color' name='albedo'><vector name='scale' "
                        "value='0 1'/></texture></bsdf>"),
               Catch::Contains("property 'scale': must not be 0"));
}

TEST_CASE_METHOD(TextureFixture, "constant colours of Nori's forks", "[nori_textures]") {
    const Bsdf made = bsdf("diffuse", "<texture type='constant_color' name='albedo'><color name='value' "
                                      "value='0.25 0.5 1'/></texture>");
    CHECK(made.textures.empty());
    CHECK(made.as<bsdf_diffuse_record>().albedo.value[0] == 0.25f);
    CHECK(made.as<bsdf_diffuse_record>().albedo.value[2] == 1);
    CHECK_THAT(error_in("<bsdf type='diffuse'><texture type='constant_color' name='albedo'/></bsdf>"),
               Catch::EndsWith("<texture> lacks its property 'value'"));
    CHECK_THAT(error_in("<bsdf type='microfacet'><texture type='constant_color' name='kd'><color name='value' "
                        "value='2 0 0'/></texture></bsdf>"),
               Catch::Contains("the texture has colours that 'kd' may not have, which must be 0 to 1"));
}

TEST_CASE_METHOD(TextureFixture, "pictures of Nori's forks: how coordinates become those of a picture",
                 "[nori_textures]") {
    const UvTransform upwards = {{{1, 0, 0}, {0, -1, 1}}};
    const BitmapTexture plain = bitmap("image_texture", file);
    CHECK(plain.picture->width == 2);
    CHECK(plain.to_uv == upwards);
    CHECK(plain.wrap == WRAP_repeat);
    CHECK_FALSE(plain.raw);
    CHECK_FALSE(plain.nearest);
    CHECK(bitmap("image_texture", "<string name='path' value='a.exr'/>").to_uv == upwards);
    const BitmapTexture other =
        bitmap("image_texture", file + "<boolean name='linear_rgb' value='false'/><string name='interpolation' "
                                       "value='nearest'/><string name='extension' value='clamp'/>");
    CHECK(other.raw);
    CHECK(other.nearest);
    CHECK(other.wrap == WRAP_clamp);
    CHECK(bitmap("image_texture", file + "<string name='wrap' value='clamp'/>").wrap == WRAP_clamp);
    // a vector multiplies, a number divides
    CHECK(bitmap("image_texture", file + "<vector name='scale' value='2 4'/>").to_uv ==
          UvTransform{{{2, 0, 0}, {0, -4, 1}}});
    CHECK(bitmap("image_texture", file + "<float name='scale' value='0.25'/>").to_uv ==
          UvTransform{{{4, 0, 0}, {0, -4, 1}}});
    CHECK(bitmap("image_texture", file + "<vector name='scale' value='2 4'/><point name='delta' value='0.5 0.25'/>")
              .to_uv == UvTransform{{{2, 0, 0.5}, {0, -4, 0.75}}});
    // (1 - v) scale + shift
    CHECK(bitmap("image_texture", file + "<vector name='scale' value='2 4'/><vector name='shift' value='0.5 0.25'/>")
              .to_uv == UvTransform{{{2, 0, 0.5}, {0, -4, 4.25}}});
    // the first row is at v = 0
    CHECK(bitmap("imagetexture", file).to_uv == identity_uv);
    CHECK(bitmap("imagetexture", "<string name='fileName' value='a.exr'/><vector name='scale' value='0.5 0.25'/>")
              .to_uv == UvTransform{{{2, 0, 0}, {0, 4, 0}}});
    CHECK(bitmap("imagetexture", "<string name='texture_path' value='a.exr'/>").to_uv == identity_uv);
    // (uv + offset) scale
    const BitmapTexture png =
        bitmap("png_texture", file + "<float name='scaleU' value='2'/><float name='scaleV' value='4'/>"
                                     "<float name='offsetU' value='0.25'/><float name='offsetV' "
                                     "value='0.5'/><boolean name='sRGB' value='false'/>");
    CHECK(png.to_uv == UvTransform{{{2, 0, 0.5}, {0, -4, -1}}});
    CHECK(png.raw);
    CHECK_FALSE(bitmap("png_texture", file).raw);
    const Bsdf colors = bsdf("diffuse", "<texture type='color_texture' name='albedo'><string name='texture_path' "
                                        "value='a.exr'/><float name='scale' value='0.5'/><float name='strength' "
                                        "value='0.25'/></texture>");
    CHECK(colors.as<bsdf_diffuse_record>().albedo.value[1] == 0.25f);
    CHECK(std::get<BitmapTexture>(colors.textures.begin()->second).to_uv == UvTransform{{{2, 0, 0}, {0, -2, 1}}});
}

TEST_CASE_METHOD(TextureFixture, "pictures that properties and other tags name", "[nori_textures]") {
    for (const char *name : {"texturemap", "texture_filename"}) {
        const Bsdf made = bsdf("diffuse", fmt::format("<string name='{}' value='a.exr'/>", name));
        CHECK(made.as<bsdf_diffuse_record>().albedo.value[0] == 1);
        CHECK(std::get<BitmapTexture>(made.textures.at(bsdf_parameters(BSDF_diffuse)[0].texture_word)).to_uv ==
              UvTransform{{{1, 0, 0}, {0, -1, 1}}});
        CHECK(bsdf("diffuse", fmt::format("<string name='{}' value=''/>", name)).textures.empty());
        CHECK_THAT(error_in(fmt::format("<bsdf type='mirror'><string name='{}' value='a.exr'/></bsdf>", name)),
                   Catch::Contains(fmt::format("unknown property '{}' of bsdf 'mirror'", name)));
    }
    CHECK(bsdf("diffuse", "<diffusemap type='image_texture'>" + file + "</diffusemap>").textures.size() == 1);
    // of a mesh: its material's
    CHECK(load("<texture type='imagetexture'>" + file + "</texture>").meshes.at(0).bsdf.textures.size() == 1);
    CHECK(load("<texture type='imagetexture'>" + file + "</texture><bsdf type='phong'/>")
              .meshes.at(0)
              .bsdf.textures.size() == 1);
    for (const char *name : {"normal_filename", "graymap"}) // they mean no colour
        CHECK_THAT(error_in(fmt::format("<bsdf type='diffuse'><string name='{}' value='a.exr'/></bsdf>", name)),
                   Catch::Contains(fmt::format("unknown property '{}' of bsdf 'diffuse'", name)));
}

TEST_CASE_METHOD(TextureFixture, "a texture is on the parameter that it names", "[nori_textures]") {
    const auto on = [&](const std::string &type, const std::string &name) {
        const Bsdf made = bsdf(type, "<texture type='checkerboard_color' " + name + "/>");
        REQUIRE(made.textures.size() == 1);
        for (const Parameter &parameter : bsdf_parameters(made.kind()))
            if (parameter.texture_word == made.textures.begin()->first)
                return parameter.xml_name;
        return std::string();
    };
    CHECK(on("diffuse", "name='reflectance'") == "albedo");
    CHECK(on("diffuse", "") == "albedo");
    CHECK(on("phong", "name='ks'") == "ks");
    CHECK(on("phong", "") == "kd");
    CHECK(on("microfacet", "name='alpha'") == "alpha");
    const Bsdf both = bsdf("twosided", "<bsdf type='diffuse'/><texture type='checkerboard_color'/>");
    CHECK(both.children.at(0).textures.size() == 1);
    CHECK_THAT(error_in("<bsdf type='phong'>\n<texture type='checkerboard_color' name='kt'/></bsdf>"),
               Catch::StartsWith(":4:1: unknown parameter 'kt' of bsdf 'phong'; did you mean 'k"));
    CHECK_THAT(error_in("<bsdf type='mirror'>\n<texture type='checkerboard_color'/></bsdf>"),
               Catch::StartsWith(":4:1: no parameter of bsdf 'mirror' is a colour"));
    CHECK_THAT(error_in("<bsdf type='diffuse'>\n<texture type='noise' name='albedo'/></bsdf>"),
               Catch::StartsWith(":4:1: unknown texture type 'noise'; available: checkerboard_color, checker, "
                                 "constant_color, image_texture, imagetexture, png_texture, color_texture"));
}

TEST_CASE_METHOD(TextureFixture, "a picture that is missing is an error, or lenient a warning", "[nori_textures]") {
    const std::string body = "<bsdf type='diffuse'>\n<texture type='png_texture' name='albedo'>\n<string "
                             "name='filename' value='b.png'/></texture></bsdf>";
    CHECK_THAT(error_in(body), Catch::StartsWith(":5:1: property 'filename': no such file: "));
    CHECK_THAT(error_in("<bsdf type='diffuse'>\n<texture type='png_texture' name='albedo'/></bsdf>"),
               Catch::EndsWith(":4:1: <texture> lacks its property 'filename'"));
    const size_t before = warnings().size();
    const Bsdf grey = load(body, {.lenient = true}).meshes.at(0).bsdf;
    CHECK(grey.textures.empty());
    CHECK(grey.as<bsdf_diffuse_record>().albedo.value[2] == 0.5f);
    CHECK_THAT(warnings().at(before), Catch::Contains("a.xml:5:1: property 'filename': no such file: ") &&
                                          Catch::EndsWith("; 0.5 stands in for the texture"));
    // a mesh likewise
    const std::string text =
        "<scene>" + camera + "<mesh type='obj'><string name='filename' value='b.obj'/></mesh></scene>";
    CHECK_THAT(error_of([&] { load_scene(scratch.write("b.xml", text)); }), Catch::Contains("no such file"));
    const size_t then = warnings().size();
    CHECK(load_scene(scratch.write("b.xml", text), {.lenient = true}).meshes.empty());
    CHECK_THAT(warnings().at(then), Catch::EndsWith("in the current folder; the mesh is left out"));
    forget_warnings();
}

TEST_CASE_METHOD(TextureFixture, "a picture that two textures name is read once", "[nori_textures]") {
    const std::string texture = "<texture type='image_texture'>" + file + "</texture>";
    const Bsdf two =
        bsdf("twosided", "<bsdf type='diffuse'>" + texture + "</bsdf><bsdf type='phong'>" + texture + "</bsdf>");
    const auto picture = [](const Bsdf &of) { return std::get<BitmapTexture>(of.textures.begin()->second).picture; };
    CHECK(picture(two.children.at(0)) == picture(two.children.at(1)));
}

TEST_CASE_METHOD(TextureFixture, "values outside 0 to 1 of a reflectance are warned of", "[nori_textures]") {
    Image image;
    image.width = image.height = 1;
    image.layers = {{"R", {-0.5f}}, {"G", {12}}, {"B", {0}}};
    write_exr(image, scratch / "b.exr");
    const size_t before = warnings().size();
    bsdf("diffuse", "<texture type='image_texture'><string name='filename' value='b.exr'/></texture>");
    REQUIRE(warnings().size() > before);
    CHECK_THAT(warnings().at(before),
               Catch::Contains("a.xml:3:") &&
                   Catch::Contains("the texture has values from -0.5 to 12 where 0 to 1 are meant"));
    const size_t then = warnings().size();
    bsdf("diffuse", "<texture type='image_texture'>" + file + "</texture>");
    for (size_t i = then; i < warnings().size(); ++i)
        CHECK_THAT(warnings()[i], !Catch::Contains("the texture has values"));
    forget_warnings();
}
