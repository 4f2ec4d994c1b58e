// Parsers of BSDFs. Their manuals are in cl/bsdfs/NAME.cl.
#include "read/nori/parsers.h"

#include <algorithm>

namespace opal {

namespace {

// A reflectance: not negative. Values above 1 are allowed.
Color reflectance(Properties &properties, const std::string &name) {
    Color color = properties.color(name).value_or(Color{0.5, 0.5, 0.5});
    properties.check(*std::min_element(color.begin(), color.end()) >= 0, name, "must not be negative");
    return color;
}

float ior(Properties &properties, const std::string &name, double otherwise) {
    double value = properties.number(name).value_or(otherwise);
    properties.check(value > 0, name, "must be a positive index of refraction");
    return static_cast<float>(value);
}

void store(const Color &color, float (&to)[3]) { std::copy(color.begin(), color.end(), to); }

void parse_diffuse(Properties &properties, BsdfRecord &record) {
    store(reflectance(properties, "albedo"), record.u.diffuse.albedo);
    record.u.diffuse.use_cosine = properties.boolean("use_cosine").value_or(false);
}

void parse_mirror(Properties &, BsdfRecord &) {}

void parse_dielectric(Properties &properties, BsdfRecord &record) {
    record.u.dielectric.int_ior = ior(properties, "intIOR", 1.5046);
    record.u.dielectric.ext_ior = ior(properties, "extIOR", 1.000277);
}

void parse_microfacet(Properties &properties, BsdfRecord &record) {
    MicrofacetParams &microfacet = record.u.microfacet;
    Color kd = reflectance(properties, "kd");
    double largest = *std::max_element(kd.begin(), kd.end());
    properties.check(largest <= 1, "kd", "must not exceed 1: the specular part is 1 - max(kd)");
    double alpha = properties.number("alpha").value_or(0.1);
    properties.check(alpha > 0, "alpha", "must be a positive roughness");
    store(kd, microfacet.kd);
    microfacet.alpha = static_cast<float>(alpha);
    microfacet.ks = static_cast<float>(1 - largest);
    microfacet.int_ior = ior(properties, "intIOR", 1.5046);
    microfacet.ext_ior = ior(properties, "extIOR", 1.000277);
}

void parse_phong(Properties &properties, BsdfRecord &record) {
    PhongParams &phong = record.u.phong;
    store(reflectance(properties, "kd"), phong.kd);
    store(reflectance(properties, "ks"), phong.ks);
    double pd = properties.number("pd").value_or(0.5), n = properties.number("n").value_or(20);
    properties.check(pd >= 0 && pd <= 1, "pd", "must be a probability, 0 to 1");
    properties.check(n >= 0, "n", "must be an exponent, 0 or more");
    phong.pd = static_cast<float>(pd);
    phong.n = static_cast<float>(n);
}

struct BsdfType {
    std::string name;
    int kind;
    void (*parse)(Properties &, BsdfRecord &);
};

#define OPAL_BSDF_TYPE(name) {#name, BSDF_##name, parse_##name},
const std::vector<BsdfType> bsdf_types = {OPAL_BSDFS(OPAL_BSDF_TYPE)};

} // namespace

Bsdf parse_bsdf(const XmlNode &node, const ParseContext &context) {
    const BsdfType &type = row_of_type(node, bsdf_types);
    Properties properties(node, context);
    Bsdf bsdf;
    bsdf.place = node.place();
    bsdf.record.kind = static_cast<uint>(type.kind);
    type.parse(properties, bsdf.record);
    properties.ignore("use_cosine"); // exporters write it for every material
    properties.finish();
    return bsdf;
}

Bsdf default_bsdf() {
    Bsdf bsdf;
    bsdf.record.kind = BSDF_diffuse;
    store({0.5, 0.5, 0.5}, bsdf.record.u.diffuse.albedo);
    return bsdf;
}

} // namespace opal
