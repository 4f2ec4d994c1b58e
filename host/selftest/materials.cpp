#include "read/nori/parsers.h"
#include "selftest/checks.h"

#include <fmt/format.h>

#include <algorithm>

namespace opal {

namespace {

Material parse_material(const std::string &name, const std::string &xml) {
    const XmlDocument document("a material of opal selftest", xml);
    return {name, parse_bsdf(document.root(), {})};
}

// A kind with its defaults; one that leads to others leads to a diffuse one.
Material default_material(uint kind) {
    std::string children;
    for (const Parameter &parameter : bsdf_parameters(kind))
        if (parameter.type == ParameterType::BSDF)
            children += R"(<bsdf type="diffuse"/>)";
    return parse_material(bsdf_name(kind), fmt::format(R"(<bsdf type="{}">{}</bsdf>)", bsdf_name(kind), children));
}

// Values that are harder than the defaults.
std::vector<Material> hard_materials() {
    return {parse_material("diffuse", R"(<bsdf type="diffuse"><color name="albedo" value="0.9 0.5 0.1"/></bsdf>)"),
            parse_material("diffuse, by cosine", R"(<bsdf type="diffuse"><color name="albedo" value="0.9 0.5 0.1"/>
                                                  <boolean name="use_cosine" value="true"/></bsdf>)"),
            parse_material("microfacet 0.1", R"(<bsdf type="microfacet"><float name="alpha" value="0.1"/>
                                              <color name="kd" value="0.3 0.15 0.075"/></bsdf>)"),
            parse_material("microfacet 0.5", R"(<bsdf type="microfacet"><float name="alpha" value="0.5"/>
                                              <color name="kd" value="0 0 0"/></bsdf>)"),
            parse_material("phong 20", R"(<bsdf type="phong"><color name="kd" value="0.5 0.4 0.3"/>
                                        <color name="ks" value="0.5 0.4 0.9"/></bsdf>)"),
            parse_material("phong 300",
                           R"(<bsdf type="phong"><color name="kd" value="0.5 0.4 0.3"/>
                            <color name="ks" value="0.5 0.4 0.9"/><float name="pd" value="0.1"/>
                            <float name="n" value="300"/></bsdf>)"),
            parse_material("microfacet 0", R"(<bsdf type="microfacet"><float name="alpha" value="0"/>
                                            <color name="kd" value="0.3 0.15 0.075"/></bsdf>)")};
}

} // namespace

const std::vector<Material> &selftest_materials() {
    static const std::vector<Material> materials = [] {
        std::vector<Material> all = hard_materials();
        for (uint kind = 0; kind < BSDF_COUNT; kind++)
            if (std::none_of(all.begin(), all.end(), [&](const Material &m) { return m.bsdf.kind() == kind; }))
                all.push_back(default_material(kind));
        return all;
    }();
    return materials;
}

FlatScene scene_of_materials(const std::vector<Material> &materials) {
    std::vector<Bsdf> bsdfs;
    for (const Material &material : materials)
        bsdfs.push_back(material.bsdf);
    return scene_of_bsdfs(bsdfs);
}

} // namespace opal
