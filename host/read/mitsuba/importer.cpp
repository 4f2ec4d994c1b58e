#include "base/log.h"
#include "read/mitsuba/parsers.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

namespace opal::mitsuba {

namespace {

Vec3 column(const Transform &t, int i) { return {t.rows[0][i], t.rows[1][i], t.rows[2][i]}; }

} // namespace

void Importer::count_use(const Object &object, const std::string &becomes) {
    if (!counted_.insert(&object).second)
        return;
    auto use = std::ranges::find_if(uses_, [&](const PluginUse &known) {
        return known.tag == object.tag() && known.type == object.type() && known.becomes == becomes;
    });
    if (use == uses_.end())
        use = uses_.insert(use, {object.tag(), object.type(), becomes});
    use->count++;
}

void Importer::count_unknown(Object &object, const std::vector<std::string> &known, const std::string &instead) {
    if (object.type().empty()) { // told before, as its $name lacks a value
        object.ignore_all();
        return;
    }
    if (counted_.contains(&object))
        return;
    if (!context_.lenient) { // so that all that is unknown is told in one run
        for (const auto &child : object.children("bsdf"))
            bsdf(*child);
        for (const auto &child : object.children("texture"))
            texture(*child);
    }
    object.ignore_all();
    if (context_.lenient)
        count_use(object, instead);
    counted_.insert(&object);
    auto unknown = std::ranges::find_if(
        unknown_, [&](const Unknown &other) { return other.tag == object.tag() && other.type == object.type(); });
    if (unknown == unknown_.end())
        unknown = unknown_.insert(unknown, {object.place(), object.tag(), object.type(), known, instead});
    unknown->count++;
    const SourcePlace place = object.place(), &first = unknown->first;
    if (place.file == first.file && std::tie(place.line, place.column) < std::tie(first.line, first.column))
        unknown->first = place;
}

void Importer::finish() {
    context_.pictures->finish();
    for (const Unknown &unknown : unknown_) {
        const std::string times = unknown.count == 1 ? "" : fmt::format(" ({} in the scene)", unknown.count);
        const std::string message = unknown_name(unknown.tag + " type", unknown.type, unknown.known, times);
        if (context_.lenient)
            warn(fmt::format("{}: {}; {}", unknown.first.text(), message, unknown.instead));
        else
            context_.mistake(unknown.first, message);
    }
}

void Importer::lacks(Object &object, const std::string &name, const std::string &message,
                     const std::string &instead) const {
    object.ignore(name);
    if (context_.lenient)
        warn(fmt::format("{}: property '{}': {}; {}", object.place_of(name).text(), name, message, instead));
    else
        object.mistake_at(name, message);
}

const Bsdf &Importer::bsdf(Object &object) {
    const auto known = bsdfs_.find(&object);
    if (known != bsdfs_.end())
        return known->second;
    Bsdf made;
    made.place = object.place();
    parse_bsdf(*this, object, made);
    return bsdfs_.emplace(&object, std::move(made)).first->second;
}

const std::optional<Texture> &Importer::texture(Object &object) {
    const auto known = textures_.find(&object);
    return known != textures_.end() ? known->second
                                    : textures_.emplace(&object, parse_texture(*this, object)).first->second;
}

std::optional<Texture> Importer::texture(Object &object, const std::string &name) {
    const auto child = object.has(name) ? object.child_named(name) : nullptr;
    return child && child->tag() == "texture" ? texture(*child) : std::nullopt;
}

Color Importer::color(Object &object, const std::string &name, SpectrumUse use, const Color &otherwise) {
    if (const std::optional<Color> color = object.color(name, use))
        return *color;
    const auto child = object.has(name) ? object.child_named(name) : nullptr;
    if (!child || child->tag() != "texture")
        return otherwise;
    Color mean{0.5, 0.5, 0.5};
    if (const auto &read = texture(*child); read)
        if (const auto *squares = std::get_if<CheckerboardTexture>(&*read))
            for (size_t i = 0; i < mean.size(); i++)
                mean[i] = (squares->color0[i] + squares->color1[i]) / 2;
    lacks(object, name, "Opal has no texture here yet",
          fmt::format("{:.4g} {:.4g} {:.4g} stands in for it", mean[0], mean[1], mean[2]));
    return mean;
}

std::shared_ptr<Object> only_child(Object &object, const std::string &tag) {
    const std::vector<std::shared_ptr<Object>> children = object.children(tag);
    if (children.empty())
        return nullptr;
    if (children.size() > 1)
        children[1]->mistake(fmt::format("a second <{}> in the <{}>, which has one at most", tag, object.tag()));
    return children.front();
}

bool keeps_lengths(const Transform &transform) {
    for (int i = 0; i < 3; i++)
        if (const Vec3 axis = column(transform, i); !(std::abs(dot(axis, axis) - 1) <= most_scale_error))
            return false;
    return why_no_sphere(transform).empty();
}

} // namespace opal::mitsuba
