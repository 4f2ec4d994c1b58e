#include "read/mtl.h"

#include "base/error.h"
#include "base/log.h"
#include "base/values.h"
#include "read/file_kind.h"
#include "read/xml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <utility>

namespace opal {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front()))
        text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back()))
        text.remove_suffix(1);
    return text;
}

// A comment begins with '#' at the line's start or behind a blank: names may hold one.
std::string_view without_comment(std::string_view line) {
    for (size_t at = line.find('#'); at != line.npos; at = line.find('#', at + 1))
        if (at == 0 || is_blank(line[at - 1]))
            return line.substr(0, at);
    return line;
}

std::string lower_case(std::string_view text) {
    std::string lower(text);
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](char c) { return char(std::tolower(static_cast<unsigned char>(c))); });
    return lower;
}

// Linear RGB with the primaries of sRGB from CIE XYZ (IEC 61966-2-1).
Color rgb_of_xyz(const Color &xyz) {
    const auto [x, y, z] = xyz;
    return {3.2404542 * x - 1.5371385 * y - 0.4985314 * z, -0.9692660 * x + 1.8760108 * y + 0.0415560 * z,
            0.0556434 * x - 0.2040259 * y + 1.0572252 * z};
}

const std::vector<std::string> color_statements = {"ka", "kd", "ke", "ks", "tf"};
const std::vector<std::string> number_statements = {"ns", "ni", "d",   "tr",    "illum",  "pr",       "pm",
                                                    "ps", "pc", "pcr", "aniso", "anisor", "sharpness"};

// How many words follow an option of a texture: at least, and at most as long as they are numbers.
struct TextureOption {
    std::string name;
    int least, most;
};
const std::vector<TextureOption> texture_options = {
    {"-s", 1, 3},     {"-o", 1, 3},      {"-t", 1, 3},      {"-mm", 2, 2}, {"-bm", 1, 1},
    {"-clamp", 1, 1}, {"-blendu", 1, 1}, {"-blendv", 1, 1}, {"-cc", 1, 1}, {"-imfchan", 1, 1},
    {"-boost", 1, 1}, {"-texres", 1, 1}, {"-type", 1, 1}};

bool is_number(std::string_view word) {
    try {
        parse_number(word);
        return true;
    } catch (const Error &) {
        return false;
    }
}

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

class MtlReader {
public:
    MtlReader(std::string name, std::string_view text) : text_(text), lines_(std::move(name), text) {}

    std::vector<MtlMaterial> run() {
        const std::string_view first = text_.substr(0, text_.find('\n'));
        by_blender_ = first.find("Blender") != first.npos && first.find("MTL") != first.npos;
        for (size_t at = 0; at < text_.size();) {
            const size_t end = std::min(text_.find('\n', at), text_.size());
            read_line(text_.substr(at, end - at));
            at = end + 1;
        }
        end_material();
        if (unknown_count_ > 0)
            note(fmt::format("{}: unknown statement '{}'{}", unknown_place_, unknown_,
                             unknown_count_ > 1 ? fmt::format(" and {} more", unknown_count_ - 1) : ""));
        return std::move(materials_);
    }

private:
    std::string_view text_;
    TextLines lines_;
    std::string_view reading_; // the word that an error is about
    bool by_blender_ = false, in_material_ = false;
    std::optional<double> tr_; // 1 - d as the current material's Tr says it
    MtlMaterial material_;
    std::vector<MtlMaterial> materials_;
    std::unordered_map<std::string, size_t> index_; // in materials_, by name
    size_t unknown_count_ = 0;
    std::string unknown_, unknown_place_;

    SourcePlace place_of(std::string_view word) const { return lines_.place(word.data() - text_.data()); }
    [[noreturn]] void fail(const std::string &message) const {
        throw Error(place_of(reading_).text() + ": " + message);
    }
    void warn_here(const std::string &message) const { warn(place_of(reading_).text() + ": " + message); }

    void end_material() {
        if (!in_material_)
            return;
        if (tr_) {
            const auto [d, is_new] = material_.numbers.try_emplace("d", 1 - *tr_);
            if (!is_new && std::abs(d->second - (1 - *tr_)) > 1e-6)
                warn(fmt::format("{}: material '{}': d {:g} and Tr {:g} contradict each other: d counts",
                                 material_.place.text(), material_.name, d->second, *tr_));
        }
        const auto [same, is_new] = index_.try_emplace(material_.name, materials_.size());
        if (is_new)
            materials_.push_back(std::move(material_));
        else
            warn(fmt::format("{}: a second material '{}': the first, at {}, counts", material_.place.text(),
                             material_.name, materials_[same->second].place.text()));
    }

    void read_line(std::string_view line) {
        const std::string_view whole = trimmed(line), clean = trimmed(without_comment(line));
        if (clean.empty())
            return;
        const auto word_end = std::find_if(whole.begin(), whole.end(), is_blank);
        reading_ = whole.substr(0, size_t(word_end - whole.begin()));
        const std::string statement = lower_case(reading_);
        if (statement == "newmtl")
            return begin_material(trimmed(whole.substr(reading_.size()))); // a name may hold a '#'
        const std::string_view rest = trimmed(clean.substr(std::min(reading_.size(), clean.size())));
        const bool is_texture = statement.starts_with("map_") || statement == "bump" || statement == "disp" ||
                                statement == "decal" || statement == "refl" || statement == "norm";
        const bool is_color = contains(color_statements, statement);
        if (!is_texture && !is_color && !contains(number_statements, statement))
            return add_unknown();
        if (!in_material_)
            fail(fmt::format("'{}' before the first newmtl", reading_));
        if (is_texture)
            read_texture(statement, rest);
        else if (is_color)
            read_color(statement, blank_separated(rest));
        else
            read_number(statement, blank_separated(rest));
    }

    void add_unknown() {
        if (unknown_count_++ > 0)
            return;
        unknown_ = reading_;
        unknown_place_ = place_of(reading_).text();
    }

    void begin_material(std::string_view name) {
        end_material();
        material_ = {};
        material_.name = name;
        material_.place = place_of(reading_);
        material_.by_blender = by_blender_;
        tr_.reset();
        in_material_ = true;
    }

    double number(std::string_view word) {
        const std::string_view statement = std::exchange(reading_, word);
        try {
            const double value = parse_number(word);
            reading_ = statement;
            return value;
        } catch (const Error &error) {
            fail(error.what());
        }
    }

    // Numbers from the words; those that are left out are the first.
    Color triple(const std::vector<std::string_view> &words, size_t at) {
        if (at >= words.size())
            fail(fmt::format("'{}' needs a number", reading_));
        Color color;
        color.fill(number(words[at]));
        for (size_t i = 1; i < 3 && at + i < words.size(); i++)
            color[i] = number(words[at + i]);
        if (words.size() > at + 3)
            warn_here(fmt::format("'{}' has more than three numbers: the rest is ignored", reading_));
        return color;
    }

    void read_color(const std::string &statement, const std::vector<std::string_view> &words) {
        const std::string form = words.empty() ? "" : lower_case(words[0]);
        if (form == "spectral")
            return warn_here(fmt::format("'{} spectral' is ignored: Opal's colours are RGB", reading_));
        const Color color = form == "xyz" ? rgb_of_xyz(triple(words, 1)) : triple(words, 0);
        if (form != "xyz" && *std::min_element(color.begin(), color.end()) < 0)
            fail(fmt::format("'{}' must not be negative", reading_));
        material_.colors[statement] = color;
        for (double &channel : material_.colors[statement])
            channel = std::max(channel, 0.0); // colours of XYZ outside sRGB's triangle
    }

    void read_number(const std::string &statement, const std::vector<std::string_view> &words) {
        const bool is_halo = statement == "d" && !words.empty() && lower_case(words[0]) == "-halo";
        if (words.size() <= size_t(is_halo))
            fail(fmt::format("'{}' needs a number", reading_));
        const double value = number(words[is_halo]);
        if ((statement == "d" || statement == "tr") && !(value >= 0 && value <= 1))
            fail(fmt::format("'{}' must be between 0 and 1", reading_));
        if (value < 0 && statement != "anisor" && statement != "aniso")
            fail(fmt::format("'{}' must not be negative", reading_));
        if (statement == "ni" && static_cast<float>(value) == 0)
            return warn_here("'Ni' 0 is no index of refraction: it is ignored");
        if (statement == "tr")
            tr_ = value;
        else
            material_.numbers[statement] = value;
    }

    // Options may stand before and behind the name, which is all the rest: it may hold blanks.
    void read_texture(const std::string &statement, std::string_view rest) {
        MtlTexture texture;
        texture.statement = reading_;
        texture.place = place_of(reading_);
        std::vector<std::string_view> words = blank_separated(rest);
        const char *name_begin = nullptr, *name_end = nullptr;
        for (size_t i = 0; i < words.size();) {
            const std::string option = lower_case(words[i]);
            const auto row = std::find_if(texture_options.begin(), texture_options.end(),
                                          [&](const TextureOption &o) { return o.name == option; });
            if (row != texture_options.end()) {
                i += read_texture_option(*row, words, i, texture);
                continue;
            }
            if (option.size() > 1 && option[0] == '-' && std::isalpha(static_cast<unsigned char>(option[1])) &&
                i + 1 < words.size()) { // an unknown option has one value, if a number follows
                warn_here(fmt::format("unknown option '{}' of a texture is ignored", words[i]));
                i += i + 2 < words.size() && is_number(words[i + 1]) ? 2 : 1;
                continue;
            }
            if (!name_begin)
                name_begin = words[i].data();
            name_end = words[i].data() + words[i].size();
            i++;
        }
        std::string_view name = name_begin ? std::string_view(name_begin, size_t(name_end - name_begin)) : "";
        if (name.size() >= 2 && name.front() == '"' && name.back() == '"')
            name = name.substr(1, name.size() - 2);
        if (name.empty())
            return warn_here(fmt::format("'{}' names no file: it is ignored", reading_));
        texture.file = name;
        std::replace(texture.file.begin(), texture.file.end(), '\\', '/');
        if (texture.file.starts_with("./"))
            texture.file.erase(0, 2);
        material_.textures[statement] = std::move(texture);
    }

    // Returns how many words it took.
    size_t read_texture_option(const TextureOption &option, const std::vector<std::string_view> &words, size_t at,
                               MtlTexture &texture) {
        std::vector<std::string_view> values;
        for (size_t i = at + 1; i < words.size() && std::ssize(values) < option.most; i++) {
            if (std::ssize(values) >= option.least && !is_number(words[i]))
                break;
            values.push_back(words[i]);
        }
        if (std::ssize(values) < option.least)
            fail(fmt::format("option '{}' of '{}' lacks its value", option.name, reading_));
        if (option.name == "-s" || option.name == "-o") {
            std::array<double, 2> &pair = option.name == "-s" ? texture.scale : texture.offset;
            for (size_t i = 0; i < 2 && i < values.size(); i++)
                pair[i] = number(values[i]);
        } else if (option.name == "-bm")
            texture.strength = number(values[0]);
        else if (option.name == "-clamp")
            texture.clamp = lower_case(values[0]) == "on";
        else if ((option.name == "-mm" && (number(values[0]) != 0 || number(values[1]) != 1)) ||
                 (option.name == "-t" && std::ranges::any_of(values, [&](auto value) { return number(value) != 0; })))
            warn_here(fmt::format("option '{}' of a texture is ignored", option.name));
        return 1 + values.size();
    }
};

} // namespace

std::vector<std::string_view> blank_separated(std::string_view text) {
    std::vector<std::string_view> words;
    while (!(text = trimmed(text)).empty()) {
        const auto end = std::find_if(text.begin(), text.end(), is_blank);
        words.push_back(text.substr(0, size_t(end - text.begin())));
        text.remove_prefix(words.back().size());
    }
    return words;
}

std::vector<MtlMaterial> read_mtl(const std::filesystem::path &file, FileHashes *hashes) {
    const std::string text = read_text_file(file, FileKind::mtl, hashes);
    return MtlReader(file.string(), text).run();
}

} // namespace opal
