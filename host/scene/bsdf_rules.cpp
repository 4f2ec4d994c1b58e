#include "scene/bsdf_rules.h"

#include "scene/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace opal {

namespace {

// Whether a parameter is 0 everywhere.
bool is_zero(const Bsdf &bsdf, std::string_view name) {
    const Parameter &parameter = *bsdf_parameter(bsdf.kind(), name);
    return bsdf.words[parameter.word] == 0 && !bsdf.textures.contains(parameter.texture_word);
}

// The BSDF of that record, whose members are the first ones of the given one.
template <class Record> Bsdf first_part(const Bsdf &bsdf) {
    Bsdf part = Record{};
    std::copy_n(bsdf.words.begin() + 1, part.words.size() - 1, part.words.begin() + 1);
    for (const auto &[word, texture] : bsdf.textures)
        if (word < part.words.size())
            part.textures[word] = texture;
    part.place = bsdf.place;
    return part;
}

} // namespace

void set_color(Bsdf &bsdf, std::string_view name, const Color &color) {
    const Parameter &parameter = *bsdf_parameter(bsdf.kind(), name);
    for (size_t i = 0; i < color.size(); i++)
        bsdf.words[parameter.word + i] = std::bit_cast<uint>(float(color[i]));
}

bool has_equal_indices(const Bsdf &bsdf) {
    if (!bsdf.is<bsdf_roughdielectric_record>() && !bsdf.is<bsdf_roughplastic_record>())
        return false;
    return bsdf.words[bsdf_parameter(bsdf.kind(), "int_ior")->word] ==
           bsdf.words[bsdf_parameter(bsdf.kind(), "ext_ior")->word];
}

Bsdf without_facets(const Bsdf &bsdf) {
    switch (bsdf.kind()) {
    case BSDF_roughplastic:
        return is_zero(bsdf, "alpha") ? first_part<bsdf_plastic_record>(bsdf) : bsdf;
    case BSDF_roughconductor:
    case BSDF_roughdielectric:
        if (!is_zero(bsdf, "alpha_u") || !is_zero(bsdf, "alpha_v"))
            return bsdf;
        return bsdf.is<bsdf_roughconductor_record>() ? first_part<bsdf_conductor_record>(bsdf)
                                                     : first_part<bsdf_dielectric_record>(bsdf);
    default:
        return bsdf;
    }
}

bool is_too_dense(const Bsdf &bsdf) {
    if (!bsdf.is<bsdf_plastic_record>())
        return false;
    const auto plastic = bsdf.as<bsdf_plastic_record>();
    return plastic.int_ior.value > densest_plastic * plastic.ext_ior.value;
}

std::string too_dense_text(const std::string &outside) {
    return fmt::format("must be at most {:g} times {}", densest_plastic, outside);
}

} // namespace opal
