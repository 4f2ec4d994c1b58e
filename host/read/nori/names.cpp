#include "read/nori/names.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace opal {

namespace {

struct OtherName {
    std::string other, known;
};

// luminaire: Nori of 2012. shape, diffusemap: some forks.
const std::vector<OtherName> other_tags = {{"luminaire", "emitter"}, {"shape", "mesh"}, {"diffusemap", "texture"}};

struct OtherProperty {
    std::string tag, type; // of the object; no type: all
    std::string other, known;
};

// reflectance: Nori of 2012. Others: public forks, whose focalLength is the depth of the plane that is seen sharply,
// whose directional light has the irradiance as `power` or `radiance`, and whose environments have many names for a
// file.
const std::vector<OtherProperty> other_properties = {
    {"bsdf", "", "reflectance", "albedo"},
    {"bsdf", "disney", "subsurface", "flatness"},
    {"camera", "", "radius", "lensRadius"},
    {"camera", "", "apertureRadius", "lensRadius"},
    {"camera", "", "aperture", "lensRadius"},
    {"camera", "", "focusDistance", "focalDistance"},
    {"camera", "", "focalLength", "focalDistance"},
    {"emitter", "directional", "power", "irradiance"},
    {"emitter", "directional", "radiance", "irradiance"},
    {"emitter", "", "exr_path", "filename"},
    {"emitter", "", "envMapPath", "filename"},
    {"emitter", "", "mapname", "filename"},
    {"emitter", "", "OpenEXR", "filename"},
    {"emitter", "", "strength", "scale"},
};

// What public forks register. Zaragoza's course has ETH's names direct_* with upstream's camera; its pointlight, which
// has a radiance, tells it. parallelogram does not tell the course of 2022: Opal's own scenes have it with any
// integrator.
const std::vector<DialectName> names_of_dialects = {
    {Dialect::upstream, "emitter", "pointlight", "radiance"},
    {Dialect::course, "integrator", "direct_lighting"},
    {Dialect::course, "integrator", "path_tracer_recursive"},
    {Dialect::eth, "integrator", "direct"},
    {Dialect::eth, "integrator", "direct_ems"},
    {Dialect::eth, "integrator", "direct_mats"},
    {Dialect::eth, "integrator", "direct_mis"},
    {Dialect::eth, "integrator", "direct_whitted"},
    {Dialect::eth, "emitter", "pointlight", "power"},
    {Dialect::eth, "integrator", "av"},
    {Dialect::eth, "integrator", "mipath"},
    {Dialect::eth, "luminaire", ""},
    {Dialect::eth, "color", "reflectance"},
};

// The first name of each dialect, in document order.
using FirstNames = std::array<std::string, 3>;

std::vector<XmlNode> children_of(const XmlNode &node) {
    return node.children([](const SourcePlace &, const std::string &) {}); // mistakes are told by the parsers
}

bool has_property(const XmlNode &object, const std::string &name) {
    const std::vector<XmlNode> children = children_of(object);
    return std::any_of(children.begin(), children.end(),
                       [&](const XmlNode &child) { return child.attribute("name") == name; });
}

// Whether the node bears that name. A property does in a diffuse bsdf alone: other materials differ more than by names.
bool bears(const DialectName &row, const XmlNode &node, const XmlNode &parent) {
    if (node.tag() != row.tag)
        return false;
    if (row.is_property())
        return parent.tag() == "bsdf" && parent.attribute("type") == "diffuse" && node.attribute("name") == row.name;
    return (row.name.empty() || node.attribute("type") == row.name) &&
           (row.with.empty() || has_property(node, row.with));
}

std::string text_of(const DialectName &row) {
    if (row.is_property())
        return fmt::format("property '{}'", row.name);
    if (row.name.empty())
        return fmt::format("tag <{}>", row.tag);
    const std::string with = row.with.empty() ? "" : fmt::format(" with a '{}'", row.with);
    return fmt::format("{} '{}'{}", row.tag, row.name, with);
}

void find_names(const XmlNode &parent, FirstNames &found) {
    for (const XmlNode &node : children_of(parent)) {
        for (const DialectName &row : names_of_dialects) {
            std::string &first = found[size_t(row.dialect)];
            if (first.empty() && bears(row, node, parent))
                first = fmt::format("{} at {}", text_of(row), node.place().text());
        }
        find_names(node, found);
    }
}

bool matches(const std::string &pattern, const std::string &name) {
    return pattern.ends_with('*') ? name.starts_with(pattern.substr(0, pattern.size() - 1)) : name == pattern;
}

// What 455 public scenes hold. A property that the object's parser asks for is no leftover, whatever stands here.
const std::vector<Leftover> all_leftovers = {
    {"bsdf", "microfacet", "albedo"},
    {"bsdf", "mirror", "albedo", "", 1},
    {"bsdf", "diffuse", "intIOR"},
    {"bsdf", "diffuse", "extIOR"},
    {"bsdf", "mirror", "intIOR"},
    {"bsdf", "mirror", "extIOR"},
    {"bsdf", "diffuse", "kd"},
    {"bsdf", "diffuse", "alpha"},
    {"bsdf", "mirror", "kd"},
    {"bsdf", "mirror", "alpha"},
    {"bsdf", "dielectric", "kd"},
    {"bsdf", "dielectric", "alpha"},
    {"bsdf", "diffuse", "roughness"},
    {"bsdf", "microfacet", "roughness"},
    {"bsdf", "dielectric", "roughness"},
    {"integrator", "normals", "myProperty"},
    {"integrator", "whitted", "position"},
    {"integrator", "whitted", "energy"},
    {"integrator", "path_mis", "position"},
    {"integrator", "path_mis", "energy"},
    {"integrator", "ao", "length"},
    {"integrator", "", "sigma_*"},
    {"integrator", "", "g"},
    {"sampler", "", "nPasses"},
    {"sampler", "", "seed"},
    {"scene", "", "*", "boolean"},
};

} // namespace

std::string known_tag(const std::string &tag) {
    for (const OtherName &row : other_tags)
        if (row.other == tag)
            return row.known;
    return tag;
}

std::string known_property(const XmlNode &object, const std::string &name) {
    const std::string tag = known_tag(object.tag());
    for (const OtherProperty &row : other_properties)
        if (row.other == name && row.tag == tag && (row.type.empty() || row.type == object.attribute("type")))
            return row.known;
    return name;
}

std::span<const DialectName> dialect_names() { return names_of_dialects; }

DialectChoice dialect_of(const XmlNode &scene) {
    FirstNames found;
    find_names(scene, found);
    DialectChoice choice;
    for (size_t i = 0; i < found.size(); i++) {
        if (found[i].empty())
            continue;
        if (choice.reason.empty())
            choice = {Dialect(i), found[i], ""};
        else if (choice.against.empty())
            choice.against = found[i];
    }
    return choice;
}

std::span<const Leftover> leftovers() { return all_leftovers; }

const Leftover *find_leftover(const XmlNode &object, const std::string &property_tag, const std::string &name) {
    const std::string tag = known_tag(object.tag()), type = object.attribute("type");
    for (const Leftover &row : all_leftovers)
        if (row.tag == tag && (row.type.empty() || row.type == type) && matches(row.name, name) &&
            (row.property_tag.empty() || row.property_tag == property_tag))
            return &row;
    return nullptr;
}

bool is_leftover_attribute(const XmlNode &node, const std::string &name) {
    if (node.tag() == "scene")
        return name == "version";
    return node.has_attribute("type") && (name == "id" || name == "name");
}

} // namespace opal
