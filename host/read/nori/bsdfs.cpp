// The parser of BSDFs: their parameters are those of cl/bsdfs/NAME.h, by their names in the XML.
#include "read/nori/parsers.h"
#include "scene/bsdf_rules.h"
#include "scene/index_of_refraction.h"
#include "scene/metals.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace opal {

namespace {

uint checked_word(const Properties &properties, const Parameter &parameter, double value) {
    check_range(properties, parameter, value);
    return std::bit_cast<uint>(static_cast<float>(value));
}

// A number; of an index of refraction the name of the medium, too.
std::optional<double> number_or_medium(Properties &properties, const Parameter &parameter) {
    if (parameter.name.ends_with("_ior"))
        if (const auto name = properties.string_if(parameter.xml_name)) {
            const auto index = index_of_refraction(*name);
            if (!index)
                properties.mistake_at(parameter.xml_name, unknown_name("medium", *name, names_of(media())));
            return index;
        }
    return properties.number(parameter.xml_name);
}

// What metals have by name in place of eta and k.
void read_metal(Properties &properties, Bsdf &bsdf) {
    if (!bsdf_parameter(bsdf.kind(), "k"))
        return;
    const std::optional<std::string> name = properties.string("material");
    if (!name || (*name == "none" && (properties.has("eta") || properties.has("k"))))
        return;
    for (const char *index : {"eta", "k"})
        properties.check(!properties.has(index), index, "a metal has either a material, or eta and k");
    const Metal *const metal = find_metal(*name);
    if (!metal)
        return properties.mistake_at("material", unknown_name("material", *name, names_of(metals())));
    set_color(bsdf, "eta", metal->eta);
    set_color(bsdf, "k", metal->k);
}

// What facets of two roughnesses have by another name: alpha, of both directions.
void read_roughness(Properties &properties, Bsdf &bsdf) {
    const Parameter *const u = bsdf_parameter(bsdf.kind(), "alpha_u"), *const v =
                                                                           bsdf_parameter(bsdf.kind(), "alpha_v");
    if (!u || !v)
        return;
    if (const std::optional<double> alpha = properties.number("alpha")) {
        for (const char *other : {"alpha_u", "alpha_v"})
            properties.check(!properties.has(other), other, "there is either alpha, or alpha_u and alpha_v");
        properties.check(u->range.holds(*alpha), "alpha", "must be " + text_of(u->range));
        bsdf.words[u->word] = bsdf.words[v->word] = std::bit_cast<uint>(float(*alpha));
    } else if (properties.has("alpha_u") != properties.has("alpha_v")) {
        properties.mistake("alpha_u and alpha_v must be given together");
    }
}

// The distribution of facets by its name.
void read_distribution(Properties &properties, Bsdf &bsdf) {
    const Parameter *const ggx = bsdf_parameter(bsdf.kind(), "ggx");
    if (!ggx)
        return;
    if (const std::optional<std::string> name = properties.string("distribution")) {
        properties.check(*name == "ggx" || *name == "beckmann", "distribution",
                         unknown_name("distribution", *name, {"beckmann", "ggx"}));
        bsdf.words[ggx->word] = *name == "ggx";
    }
}

struct BsdfType {
    std::string name;
    std::vector<uint> words; // its record with all defaults
};

// disney, orenNayar: public forks.
#define OPAL_BSDF_TYPE(name, traits) {#name, words_of(bsdf_##name##_record{})},
const std::vector<BsdfType> bsdf_types = {OPAL_ALL_BSDFS(OPAL_BSDF_TYPE){"disney", words_of(bsdf_principled_record{})},
                                          {"orenNayar", words_of(bsdf_oren_nayar_record{})}};

// Sets the words of a parameter that the object has. A BSDF is no property: add_children reads it.
void read_parameter(Properties &properties, const Parameter &parameter, std::span<uint> words) {
    switch (parameter.type) {
    case ParameterType::BSDF:
    case ParameterType::POINT:
    case ParameterType::VECTOR:
    case ParameterType::IMAGE:
    case ParameterType::TRANSFORM:
    case ParameterType::CURVE:
        break;
    case ParameterType::COLOR:
        if (const auto color = properties.color(parameter.xml_name))
            for (size_t i = 0; i < 3; i++)
                words[parameter.word + i] = checked_word(properties, parameter, (*color)[i]);
        break;
    case ParameterType::NUMBER:
        if (const auto number = number_or_medium(properties, parameter))
            words[parameter.word] = checked_word(properties, parameter, *number);
        break;
    case ParameterType::FLAG:
        if (const auto flag = properties.boolean(parameter.xml_name))
            words[parameter.word] = *flag;
        break;
    }
}

// principled: `specular` stands for eta.
void read_specular(Properties &properties, Bsdf &bsdf) {
    auto record = bsdf.as<bsdf_principled_record>();
    const auto specular = properties.number("specular");
    properties.check(!specular || !properties.has("eta"), "specular", "stands for eta, which is given too");
    properties.check(!specular || BETWEEN(0, 1).holds(*specular), "specular", "must be " + text_of(BETWEEN(0, 1)));
    const auto eta = properties.has("eta") ? std::optional<double>(record.eta.value) : std::nullopt;
    record.eta = principled_index(eta, specular, record.spec_trans.value > 0);
    bsdf.words = words_of(record);
}

// Reads the BSDFs within a BSDF, as many as it has parameters of that type.
void add_children(Properties &properties, const BsdfType &type, Bsdf &bsdf) {
    const auto parameters = bsdf_parameters(bsdf.kind());
    const auto wanted = std::count_if(parameters.begin(), parameters.end(),
                                      [](const Parameter &p) { return p.type == ParameterType::BSDF; });
    if (wanted == 0)
        return;
    const std::vector<XmlNode> nodes = properties.children("bsdf");
    for (const XmlNode &node : nodes)
        properties.context().attempt(node, [&] {
            const Bsdf &child = bsdf.children.emplace_back(parse_bsdf(node, properties.context()));
            if (bsdf_traits(bsdf.kind()) & OPAL_HOLDS_OPAQUE && child.traits() & OPAL_TRANSMITS)
                node.fail(fmt::format("a {} cannot hold a BSDF that light passes through", type.name));
        });
    const bool is_both_sides = bsdf.kind() == BSDF_twosided && nodes.size() == 1;
    if (std::ssize(nodes) != wanted && !is_both_sides)
        properties.mistake(fmt::format("a {} has {} <bsdf> within it, not {}", type.name,
                                       bsdf.kind() == BSDF_twosided ? "1 or 2" : std::to_string(wanted), nodes.size()));
}

} // namespace

Bsdf parse_bsdf(const XmlNode &node, const ParseContext &context) {
    Properties properties(node, context);
    Bsdf bsdf;
    bsdf.place = node.place();
    const BsdfType *type = properties.row_of_type(bsdf_types, "a diffuse one of albedo 0.5 stands in for it");
    if (!type)
        return bsdf;
    bsdf.words = type->words;
    for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
        read_parameter(properties, parameter, bsdf.words);
    if (bsdf.is<bsdf_principled_record>())
        read_specular(properties, bsdf);
    read_metal(properties, bsdf);
    read_roughness(properties, bsdf);
    read_distribution(properties, bsdf);
    properties.check(!has_equal_indices(bsdf), "intIOR", "must differ from extIOR");
    bsdf = without_facets(bsdf);
    properties.check(!is_too_dense(bsdf), "intIOR", too_dense_text("extIOR"));
    add_children(properties, *type, bsdf);
    bsdf.check_count();
    for (const XmlNode &texture : properties.children("texture"))
        context.attempt(texture, [&] { apply_texture(texture, context, node, bsdf); });
    apply_picture(properties, bsdf);
    properties.ignore("use_cosine"); // exporters write it for every material
    properties.finish();
    return bsdf;
}

} // namespace opal
