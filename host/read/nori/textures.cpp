// The parser of textures. Upstream Nori has none: the types are those that public forks of it have, with their meaning.
#include "base/log.h"
#include "read/nori/names.h"
#include "read/nori/parsers.h"
#include "read/picture.h"
#include "read/texture_values.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace opal {

namespace {

// What a texture gives a parameter: factor, times the texture if there is one.
struct Factor {
    Color factor{1, 1, 1};
    std::optional<Texture> texture{};
};

// Numbers of a texture's coordinates along u and v; one number stands for both.
using Pair = std::array<double, 2>;

std::optional<Pair> pair(Properties &properties, const std::string &name) {
    if (const std::optional<double> number = properties.number_if(name))
        return Pair{*number, *number};
    const std::optional<Vec3> vector = properties.point_if(name) ? properties.point(name) : properties.vector(name);
    return vector ? std::optional(Pair{vector->x, vector->y}) : std::nullopt;
}

void require_not_zero(const Properties &properties, const std::string &name, const Pair &scale) {
    if (scale[0] == 0 || scale[1] == 0)
        properties.fail_at(name, "must not be 0");
}

// u scale[0] + offset[0], v scale[1] + offset[1]
UvTransform scaled_uv(const Pair &scale, const Pair &offset) {
    return {{{scale[0], 0, offset[0]}, {0, scale[1], offset[1]}}};
}

// Coordinates of a picture, whose v grows downwards, from ones whose v grows upwards.
UvTransform upside_down(UvTransform uv) {
    uv[1] = {-uv[1][0], -uv[1][1], 1 - uv[1][2]};
    return uv;
}

// The picture of the first of these properties of type string that is given; if lenient, nothing where it cannot be
// read, of which is warned.
std::shared_ptr<const Picture> picture_of(Properties &properties, std::initializer_list<const char *> names) {
    const char *property = nullptr;
    std::optional<std::string> name;
    for (const char *other : names)
        if (const auto given = properties.string(other); given && !name) {
            property = other;
            name = given;
        }
    if (!name)
        properties.required(name, *names.begin());
    const ParseContext &context = properties.context();
    try {
        return context.pictures->load_now(find_file(properties, property, *name, "0.5 stands in for the texture"),
                                          context.hashes);
    } catch (const Error &error) {
        if (!context.lenient)
            properties.fail_at(property, error.what());
        warn(fmt::format("{}: {}; 0.5 stands in for the texture", properties.place_of(property).text(), error.what()));
        throw NoObject{};
    }
}

bool is_chosen(Properties &properties, const char *name, const std::vector<std::string> &choices, size_t choice) {
    const std::string text = properties.string(name).value_or(choices.front());
    properties.check(std::ranges::find(choices, text) != choices.end(), name, unknown_name("value", text, choices));
    return text == choices[choice];
}

// checkerboard_color: value1 where floor(u / scale - delta) of both coordinates are both even or both odd.
Factor parse_checkerboard(Properties &properties) {
    CheckerboardTexture texture;
    texture.color0 = properties.color("value1").value_or(Color{0, 0, 0});
    texture.color1 = properties.color("value2").value_or(Color{1, 1, 1});
    const Pair scale = pair(properties, "scale").value_or(Pair{1, 1});
    const Pair delta = pair(properties, "delta").value_or(Pair{0, 0});
    require_not_zero(properties, "scale", scale);
    texture.to_uv = scaled_uv({1 / (2 * scale[0]), 1 / (2 * scale[1])}, {-delta[0] / 2, -delta[1] / 2});
    return {.texture = texture};
}

// checker: color1 where floor(u scalex) and floor(v scaley) are both even or both odd.
Factor parse_checker(Properties &properties) {
    CheckerboardTexture texture;
    const std::optional<Color> both = properties.color("color");
    texture.color0 = properties.color("color1").value_or(both.value_or(Color{0.9, 0.9, 0.9}));
    texture.color1 = properties.color("color2").value_or(both.value_or(Color{0.1, 0.1, 0.1}));
    const auto x = properties.integer("scalex"), y = properties.integer("scaley");
    texture.to_uv = scaled_uv({x.value_or(1) / 2.0, y.value_or(1) / 2.0}, {0, 0});
    return {.texture = texture};
}

Factor parse_constant(Properties &properties) {
    const std::optional<Color> value = properties.color("value");
    return {.factor = properties.required(value, "value")};
}

// image_texture: a vector `scale` multiplies the coordinates, a number divides them. delta moves them, shift moves the
// picture's, whose v grows downwards.
Factor parse_image_texture(Properties &properties) {
    BitmapTexture texture;
    const bool divides = properties.number_if("scale").has_value();
    Pair scale = pair(properties, "scale").value_or(Pair{1, 1});
    const auto delta = pair(properties, "delta"), shift = pair(properties, "shift");
    texture.raw = !properties.boolean("linear_rgb").value_or(true);
    texture.nearest = is_chosen(properties, "interpolation", {"bilinear", "nearest"}, 1);
    const bool clamps = is_chosen(properties, "extension", {"repeat", "clamp"}, 1);
    texture.wrap = clamps || is_chosen(properties, "wrap", {"repeat", "clamp"}, 1) ? WRAP_clamp : WRAP_repeat;
    if (divides) {
        require_not_zero(properties, "scale", scale);
        scale = {1 / scale[0], 1 / scale[1]};
    }
    if (delta && shift)
        properties.mistake_at("shift", "stands beside 'delta', which moves the texture, too");
    texture.to_uv = upside_down(scaled_uv(scale, delta.value_or(Pair{0, 0})));
    if (shift) {
        texture.to_uv[0][2] = (*shift)[0];
        texture.to_uv[1][2] = scale[1] + (*shift)[1];
    }
    texture.picture = picture_of(properties, {"filename", "path"});
    return {.texture = texture};
}

// imagetexture: its first row is at v = 0, in all forks that were seen.
Factor parse_imagetexture(Properties &properties) {
    BitmapTexture texture;
    const Pair scale = pair(properties, "scale").value_or(Pair{1, 1});
    require_not_zero(properties, "scale", scale);
    texture.to_uv = scaled_uv({1 / scale[0], 1 / scale[1]}, {0, 0});
    texture.picture = picture_of(properties, {"filename", "fileName", "texture_path", "path"});
    return {.texture = texture};
}

Factor parse_png_texture(Properties &properties) {
    BitmapTexture texture;
    const auto number = [&](const char *name, double otherwise) { return properties.number(name).value_or(otherwise); };
    const Pair scale = {number("scaleU", 1), number("scaleV", 1)};
    const Pair offset = {number("offsetU", 0), number("offsetV", 0)};
    texture.raw = !properties.boolean("sRGB").value_or(true);
    texture.to_uv = upside_down(scaled_uv(scale, {offset[0] * scale[0], offset[1] * scale[1]}));
    texture.picture = picture_of(properties, {"filename", "path"});
    return {.texture = texture};
}

Factor parse_color_texture(Properties &properties) {
    BitmapTexture texture;
    const double scale = properties.number("scale").value_or(1), strength = properties.number("strength").value_or(1);
    require_not_zero(properties, "scale", {scale, scale});
    properties.check(strength >= 0, "strength", "must not be negative");
    texture.to_uv = upside_down(scaled_uv({1 / scale, 1 / scale}, {0, 0}));
    texture.picture = picture_of(properties, {"texture_path", "filename", "path"});
    return {.factor = {strength, strength, strength}, .texture = texture};
}

struct TextureType {
    std::string name;
    Factor (*parse)(Properties &);
};

const std::vector<TextureType> texture_types = {
    {"checkerboard_color", parse_checkerboard}, {"checker", parse_checker},
    {"constant_color", parse_constant},         {"image_texture", parse_image_texture},
    {"imagetexture", parse_imagetexture},       {"png_texture", parse_png_texture},
    {"color_texture", parse_color_texture},
};

constexpr double stand_in = 0.5; // in the place of a texture that cannot be read, if lenient

const Factor grey = {.factor = {stand_in, stand_in, stand_in}};

// Multiplies a parameter, which is 1 before.
void set_factor(const Factor &factor, const Parameter &parameter, Bsdf &bsdf) {
    const bool is_color = parameter.type == ParameterType::COLOR;
    for (size_t i = 0; i < (is_color ? 3 : 1); i++)
        bsdf.words[parameter.word + i] =
            std::bit_cast<uint>(float(is_color ? factor.factor[i] : luminance(factor.factor)));
    bsdf.textures.erase(parameter.texture_word);
    if (factor.texture)
        bsdf.textures.emplace(parameter.texture_word, *factor.texture);
}

// The colours that a texture has by itself must be such as the parameter may have.
void check_colors(const Properties &properties, const Factor &factor, const Parameter &parameter) {
    const auto check = [&](const Color &color) {
        for (double channel : color)
            if (!parameter.range.holds(channel))
                properties.mistake(fmt::format("the texture has colours that '{}' may not have, which must be {}",
                                               parameter.xml_name, text_of(parameter)));
    };
    check(factor.factor);
    if (factor.texture)
        if (const auto *squares = std::get_if<CheckerboardTexture>(&*factor.texture)) {
            check(squares->color0);
            check(squares->color1);
        }
}

// The parameter of that name, or without a name the first colour, of the material or of the first within it that has
// one; null if there is none. found: gets the material that has it.
const Parameter *find_parameter(Bsdf &bsdf, const std::string &name, Bsdf *&found) {
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (parameter.texture_word &&
            (name.empty() ? parameter.type == ParameterType::COLOR : parameter.xml_name == name)) {
            found = &bsdf;
            return &parameter;
        }
    for (Bsdf &child : bsdf.children)
        if (const Parameter *parameter = find_parameter(child, name, found))
            return parameter;
    return nullptr;
}

void add_names(const Bsdf &bsdf, std::vector<std::string> &names) {
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        if (parameter.texture_word)
            names.push_back(parameter.xml_name);
    for (const Bsdf &child : bsdf.children)
        add_names(child, names);
}

} // namespace

void apply_texture(const XmlNode &node, const ParseContext &context, const XmlNode &material, Bsdf &bsdf) {
    Properties properties(node, context);
    const TextureType *type = properties.row_of_type(texture_types, "0.5 stands in for it");
    const std::string name = known_property(material, node.attribute("name"));
    Bsdf *owner = nullptr;
    const Parameter *parameter = find_parameter(bsdf, name, owner);
    if (!parameter) {
        std::vector<std::string> names;
        add_names(bsdf, names);
        const std::string of = fmt::format(" of bsdf '{}'", bsdf_name(bsdf.kind()));
        return context.unknown(node, name.empty() ? "no parameter" + of + " is a colour"
                                                  : unknown_name("parameter", name, names, of));
    }
    Factor factor = grey;
    if (type)
        context.attempt(node, [&] { factor = type->parse(properties); });
    check_colors(properties, factor, *parameter);
    if (factor.texture)
        warn_of_values(node.place(), *parameter, *factor.texture, std::ranges::max(factor.factor));
    set_factor(factor, *parameter, *owner);
    properties.finish();
}

void apply_picture(Properties &properties, Bsdf &bsdf) {
    Bsdf *owner = nullptr;
    const Parameter *const parameter = find_parameter(bsdf, "", owner);
    if (!parameter)
        return;
    for (const char *name : {"texturemap", "texture_filename"}) {
        const std::optional<std::string> file = properties.string(name);
        if (!file || file->empty()) // forks take an empty name for none
            continue;
        Factor factor = grey;
        properties.context().attempt(properties.object(), [&] {
            factor = {.texture =
                          BitmapTexture{.picture = picture_of(properties, {name}), .to_uv = upside_down(identity_uv)}};
        });
        set_factor(factor, *parameter, *owner);
    }
}

} // namespace opal
