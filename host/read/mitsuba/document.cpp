#include "read/mitsuba/document.h"

#include "base/printable.h"
#include "base/values.h"
#include "read/file_kind.h"
#include "read/mitsuba/transform.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>

namespace opal::mitsuba {

namespace fs = std::filesystem;

namespace {

const std::vector<std::string> object_tags = {"scene",  "bsdf",    "shape",   "emitter",    "sensor",
                                              "film",   "sampler", "rfilter", "integrator", "texture",
                                              "medium", "phase",   "volume",  "field"};
const std::vector<std::string> property_tags = {"boolean", "integer",  "float", "string", "rgb",
                                                "srgb",    "spectrum", "point", "vector", "transform"};
const std::vector<std::string> other_tags = {"default", "include", "path", "alias", "ref"};

constexpr size_t most_includes = 1000, most_levels_of_includes = 15;
constexpr size_t most_levels = 64; // of objects within each other, references followed
constexpr size_t most_bytes_of_values = size_t(1) << 26;
constexpr size_t longest_default_name = 200;
constexpr double most_unfolded = 1e7; // objects, where each reference counts as a copy

bool contains(const std::vector<std::string> &names, const std::string &name) {
    return std::ranges::find(names, name) != names.end();
}

bool is_object(const XmlNode &node) {
    return contains(object_tags, node.tag()) || (node.tag() == "spectrum" && node.has_attribute("type"));
}

bool is_lower(char c) { return std::islower(static_cast<unsigned char>(c)) != 0; }
bool is_upper(char c) { return std::isupper(static_cast<unsigned char>(c)) != 0; }

// "maxDepth" as "max_depth", "intIOR" as "int_ior".
std::string snake_case(const std::string &name) {
    std::string result;
    bool in_capitals = false;
    for (size_t i = 0; i < name.size(); i++) {
        const bool begins = i > 0 && is_lower(name[i - 1]) && is_upper(name[i]);
        in_capitals = begins || (in_capitals && is_upper(name[i]));
        if (begins)
            result += '_';
        result += in_capitals ? char(std::tolower(static_cast<unsigned char>(name[i]))) : name[i];
    }
    return result;
}

using Version = std::array<int, 3>;

// Three whole numbers: "3.0.0".
std::optional<Version> parse_version(std::string text) {
    if (std::ranges::count(text, '.') != 2 || text.find(',') != text.npos)
        return std::nullopt;
    std::ranges::replace(text, '.', ' ');
    const std::vector<std::string_view> parts = split(text);
    Version version{};
    if (parts.size() != version.size())
        return std::nullopt;
    try {
        std::ranges::transform(parts, version.begin(), parse_integer);
    } catch (const Error &) {
        return std::nullopt;
    }
    return version;
}

bool is_name_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

// What `make` returns. An Error without a place gets that of the node, and the prefix.
template <class Make> auto with_place(const XmlNode &node, const std::string &prefix, Make make) {
    try {
        return make();
    } catch (const XmlError &) {
        throw;
    } catch (const Error &error) {
        node.fail(prefix + error.what());
    }
}

} // namespace

struct Document::File {
    XmlNode root;
    fs::path name;
    bool is_old;                   // of a version below 2.0.0, which has other names
    std::vector<fs::path> folders; // where included files are looked for
    Object *root_object = nullptr; // in which its <path>s stand
    const File *includer = nullptr;
    size_t level = 0; // of includes
};

std::optional<fs::path> find_file(const fs::path &name, std::span<const fs::path> folders) {
    const auto is_there = [](const fs::path &file) {
        std::error_code ignored;
        return fs::exists(file, ignored) && !fs::is_directory(file, ignored);
    };
    if (name.empty())
        return std::nullopt;
    for (const fs::path &folder : folders)
        if (const fs::path file = folder / name; is_there(file))
            return file; // the name itself where it is absolute
    return std::nullopt;
}

std::string no_file_text(const std::string &name, std::span<const fs::path> folders) {
    if (fs::path(name).is_absolute())
        return fmt::format("there is no file {}", opal::quoted(name));
    std::vector<std::string> looked;
    for (const fs::path &folder : folders)
        if (const std::string text = folder.empty() ? "the working folder" : folder.string(); !contains(looked, text))
            looked.push_back(text);
    return fmt::format("there is no file {} in: {}", opal::quoted(name), joined(looked));
}

// Opens the file and looks at its version. Throws Error.
Document::File Document::open(const fs::path &file) {
    files_.emplace_back(file, read_text_file(file, FileKind::mitsuba_scene, context_.hashes));
    const XmlNode root = files_.back().root();
    replace_names(root);
    const std::string version = root.attribute("version");
    const std::optional<Version> parsed = parse_version(version);
    if (!root.has_attribute("version"))
        root.fail(fmt::format("<{}> lacks the attribute 'version', as in version=\"3.0.0\"", root.tag()));
    if (!parsed)
        root.fail(
            fmt::format("{} is no version: it has three numbers, as in version=\"3.0.0\"", opal::quoted(version)));
    if (!is_object(root))
        root.fail(unknown_name("root", root.tag(), object_tags));
    return {.root = root, .name = file, .is_old = *parsed < Version{2, 0, 0}, .folders = {file.parent_path()}};
}

MitsubaScene Document::read(const fs::path &file, const Definitions &given) {
    for (const auto &[name, value] : given) {
        values_.emplace(name, value);
        longest_name_ = std::max(longest_name_, name.size());
    }
    const size_t mistakes_before = context_.mistakes ? context_.mistakes->count() : 0;
    File main = open(file);
    main.folders = {context_.folder, fs::path()};
    Object &root = add_object(main, main.root, "");
    folders_ = main.folders;
    // Mitsuba does not look for meshes in the <path>s of included files at all.
    folders_.insert(folders_.end(), folders_of_includes_.begin(), folders_of_includes_.end());
    resolve_references();
    check_graph(root);
    if (!context_.mistakes || context_.mistakes->count() == mistakes_before)
        check_definitions(given, main.root.place());
    return {shared(&root), used_, main.root.attribute("version")};
}

void Document::check_definitions(const Definitions &given, const SourcePlace &place) const {
    std::vector<std::string> known;
    for (const auto &[name, value] : used_)
        known.push_back(name);
    for (const auto &[name, value] : given)
        if (!used_.contains(name) && names_without_value_ == 0)
            throw UsageError(fmt::format("{}: {}: no attribute holds ${}", place.text(),
                                         unknown_name("name of -D", name, known), name));
}

// Whether each name has a value; if not, that is told.
bool Document::replace_names(const XmlNode &node) {
    const size_t before = names_without_value_;
    node.edit_attributes([&](const std::string &text) { return replaced(node, text); });
    return names_without_value_ == before;
}

void Document::tell_no_value(const XmlNode &node, const std::string &name) {
    std::vector<std::string> known;
    if (names_without_value_++ == 0) // the nearest name is looked for once, as there may be many
        for (const auto &[other, value] : values_)
            known.push_back(other);
    context_.mistake(node, name.empty() ? "a '$' without a name; '\\$' stands for a dollar sign"
                                        : no_value_text(name, known));
}

// The text with values in the place of names: the longest that has one, so that $ab may be $a followed by b. "\$" is a
// dollar sign.
std::string Document::replaced(const XmlNode &node, const std::string &text) {
    std::string result;
    for (size_t i = 0; i < text.size();) {
        if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] == '$') {
            result += '$';
            i += 2;
            continue;
        }
        if (text[i] != '$') {
            result += text[i++];
            continue;
        }
        const auto begin = text.begin() + ptrdiff_t(i) + 1;
        const std::string name(begin, std::find_if_not(begin, text.end(), is_name_letter));
        auto value = values_.end();
        size_t length = std::min(name.size(), longest_name_) + 1;
        while (value == values_.end() && --length > 0)
            value = values_.find(name.substr(0, length));
        if (value != values_.end()) {
            result += value->second;
            used_.insert(*value);
            bytes_of_values_ += value->second.size();
            if (bytes_of_values_ > most_bytes_of_values)
                node.fail(fmt::format("the values of $names fill more than {} MiB", most_bytes_of_values >> 20));
            i += 1 + length;
            continue;
        }
        tell_no_value(node, name);
        i += 1 + name.size();
    }
    return result;
}

bool Document::add_id(const XmlNode &node, const std::string &id, Object &object) {
    const auto [first, is_new] = ids_.emplace(id, &object);
    if (!is_new)
        context_.mistake(node, fmt::format("a second object with the id {}; the first stands at {}", opal::quoted(id),
                                           first->second->place().text()));
    return is_new;
}

// Adds the object at the node, whose names are replaced, and all within it.
Object &Document::add_object(File &file, const XmlNode &node, const std::string &name) {
    Object &object = objects_.emplace_back(*this, objects_.size(), node, file.is_old ? snake_case(name) : name);
    const bool is_root = !file.root_object;
    if (is_root)
        file.root_object = &object;
    const bool may_lack_type = is_root && node.tag() == "scene";
    if (may_lack_type)
        context_.require_attributes(node, {"version"}, {"type", "id", "name"});
    else if (is_root)
        context_.require_attributes(node, {"version", "type"}, {"id", "name"});
    else
        context_.require_attributes(node, {"type"}, {"id", "name"});
    if (!object.id_.empty())
        add_id(node, object.id_, object);
    read_children(file, node, object);
    if (file.is_old)
        upgrade(object);
    check_repeated(object);
    return object;
}

void Document::read_children(File &file, const XmlNode &node, Object &object) {
    for (const XmlNode &child : node.children(context_.handler()))
        context_.attempt(child, [&] { read_child(file, child, object); });
}

void Document::read_child(File &file, const XmlNode &node, Object &parent) {
    const std::string tag = node.tag();
    const bool is_known = replace_names(node);
    if (is_object(node)) {
        const std::string name = node.attribute("name");
        Object &child = add_object(file, node, name);
        parent.properties_.push_back({node, child.name_, &child});
    } else if (contains(property_tags, tag)) {
        read_property(file, node, parent, is_known);
    } else if (contains(other_tags, tag)) {
        node.require_empty();
        if (tag == "default")
            read_default(node);
        else if (!is_known)
            return;
        else if (tag == "include")
            read_include(file, node, parent);
        else if (tag == "path")
            read_path(file, node, parent);
        else if (tag == "alias")
            read_alias(node);
        else
            read_reference(file, node, parent);
    } else {
        std::vector<std::string> tags = object_tags;
        tags.insert(tags.end(), property_tags.begin(), property_tags.end());
        tags.insert(tags.end(), other_tags.begin(), other_tags.end());
        context_.unknown(node, unknown_name("tag", tag, tags));
    }
}

// The value of a property. Throws NoObject after a mistake that is told.
Object::Value Document::read_value(const XmlNode &node) {
    const std::string tag = node.tag();
    const auto require = [&](std::initializer_list<const char *> names) {
        if (!context_.require_attributes(node, names))
            throw NoObject{};
    };
    if (tag == "transform") {
        require({"name"});
        bool is_known = true;
        for (const XmlNode &operation : node.children(context_.handler()))
            is_known = replace_names(operation) && is_known;
        if (!is_known)
            throw NoObject{};
        return std::make_unique<Transform>(parse_transform(node, context_));
    }
    const bool has_parts = (tag == "point" || tag == "vector") && !node.has_attribute("value");
    if (has_parts)
        require({"name", "x", "y", "z"});
    else if (tag == "spectrum" && node.has_attribute("filename")) {
        context_.unknown(node, "spectra in files are not read; value=\"400:0.1, 500:0.3\" gives wavelengths in nm and "
                               "values");
        throw NoObject{};
    } else
        require({"name", "value"});
    node.require_empty();
    if (tag == "point" || tag == "vector")
        return parse_xyz(node, 0);
    const std::string text = node.attribute("value");
    if (tag == "boolean")
        return parse_boolean(text);
    if (tag == "integer")
        return parse_integer(text);
    if (tag == "float")
        return parse_number(text);
    if (tag == "spectrum")
        return parse_spectrum(text);
    if (tag == "rgb" || tag == "srgb")
        return parse_rgb(text, tag == "srgb");
    return text;
}

void Document::read_property(File &file, const XmlNode &node, Object &parent, bool is_known) {
    const std::string name = node.attribute("name");
    Object::Value value;
    if (is_known)
        context_.attempt(node, [&] {
            value = with_place(node, fmt::format("property '{}': ", name), [&] { return read_value(node); });
        });
    if (node.has_attribute("name")) // else that is told
        parent.properties_.push_back({node, file.is_old ? snake_case(name) : name, std::move(value)});
}

void Document::read_default(const XmlNode &node) {
    if (!context_.require_attributes(node, {"name", "value"}))
        return;
    const std::string name = node.attribute("name");
    if (!is_definable(name) || name.size() > longest_default_name)
        node.fail(fmt::format("{} is no name: at most {} letters, digits and '_', no digit first", opal::quoted(name),
                              longest_default_name));
    values_.emplace(name, node.attribute("value")); // the first one counts, and that of the command line
    longest_name_ = std::max(longest_name_, name.size());
}

void Document::read_include(File &file, const XmlNode &node, Object &parent) {
    if (!context_.require_attributes(node, {"filename"}, {"name"}))
        return;
    const std::string wanted = node.attribute("filename");
    const std::optional<fs::path> found = find_file(wanted, file.folders);
    if (!found)
        node.fail(no_file_text(wanted, file.folders));
    std::error_code ignored;
    std::string circle = found->string();
    for (const File *including = &file; including; including = including->includer) {
        circle = including->name.string() + " -> " + circle;
        if (fs::equivalent(including->name, *found, ignored))
            node.fail("the file includes itself: " + circle);
    }
    if (file.level + 1 >= most_levels_of_includes)
        node.fail(fmt::format("more than {} files include each other", most_levels_of_includes));
    if (++count_of_includes_ > most_includes) {
        if (count_of_includes_ == most_includes + 1)
            node.fail(fmt::format("more than {} files are included", most_includes));
        return;
    }
    if (!fs::is_regular_file(*found, ignored))
        node.fail(fmt::format("{} is no file", opal::quoted(found->string())));
    File included = with_place(node, "", [&] { return open(*found); });
    included.folders.insert(included.folders.end(), file.folders.begin(), file.folders.end());
    included.includer = &file;
    included.level = file.level + 1;
    if (included.root.tag() == "scene") { // what it holds stands in the place of the <include>
        included.root_object = &parent;
        context_.require_attributes(included.root, {"version"}, {"type", "id", "name"});
        read_children(included, included.root, parent);
    } else {
        const std::string name = node.attribute("name");
        Object &object = add_object(included, included.root, file.is_old ? snake_case(name) : name);
        parent.properties_.push_back({node, object.name_, &object});
    }
}

// Acts on all names of files, also of those before it.
void Document::read_path(File &file, const XmlNode &node, const Object &parent) {
    if (!context_.require_attributes(node, {"value"}))
        return;
    if (&parent != file.root_object)
        node.fail("<path> stands within the root of a file");
    const fs::path wanted = node.attribute("value");
    std::error_code ignored;
    for (const fs::path &folder : file.folders)
        if (const fs::path found = folder / wanted; !wanted.empty() && fs::is_directory(found, ignored)) {
            file.folders.insert(file.folders.begin(), found);
            if (file.includer)
                folders_of_includes_.push_back(found);
            return;
        }
    node.fail(fmt::format("there is no folder {}", opal::quoted(wanted.string())));
}

void Document::read_alias(const XmlNode &node) {
    if (!context_.require_attributes(node, {"id", "as"}))
        return;
    const std::string id = node.attribute("id");
    const auto object = ids_.find(id);
    if (object == ids_.end())
        node.fail(fmt::format("no object before this <alias> has the id {}", opal::quoted(id)));
    add_id(node, node.attribute("as"), *object->second);
}

void Document::read_reference(File &file, const XmlNode &node, Object &parent) {
    if (!context_.require_attributes(node, {"id"}, {"name"}))
        return;
    const std::string name = node.attribute("name");
    references_.push_back({&parent, parent.properties_.size()});
    parent.properties_.push_back({node, file.is_old ? snake_case(name) : name, {}});
}

// As Mitsuba 3 reads objects of its versions before 2.0.0.
void Document::upgrade(Object &object) {
    std::vector<Object::Property> &properties = object.properties_;
    if (object.tag_ == "bsdf" && object.type_ == "diffuse")
        for (Object::Property &property : properties)
            if (property.name == "diffuse_reflectance")
                property.name = "reflectance";
    Vec3 scale{1, 1, 1}, offset;
    const std::pair<const char *, double *> parts[] = {
        {"uscale", &scale.x}, {"vscale", &scale.y}, {"uoffset", &offset.x}, {"voffset", &offset.y}};
    std::optional<XmlNode> first;
    for (const auto &[name, part] : parts)
        if (object.has(name)) {
            *part = object.number(name).value_or(*part);
            first = first ? first : object.look(name)->node;
        }
    if (!first)
        return;
    for (Object::Property &property : properties) // they keep their places, which references know
        if (std::ranges::any_of(parts, [&](const auto &part) { return property.name == part.first; })) {
            property.name.clear();
            property.value = std::monostate();
        }
    object.known_properties_.clear();
    properties.push_back(
        {*first, "to_uv", std::make_unique<Transform>(Transform::scale(scale) * Transform::translate(offset))});
}

// Names of properties and children that stand for one are there once.
void Document::check_repeated(Object &object) const {
    std::vector<Object::Property *> named;
    for (Object::Property &property : object.properties_)
        if (!property.name.empty())
            named.push_back(&property);
    std::ranges::stable_sort(named, {}, &Object::Property::name);
    for (size_t i = 1, first = 0; i < named.size(); i++) {
        if (named[i]->name != named[first]->name) {
            first = i;
            continue;
        }
        context_.mistake(named[i]->node, fmt::format("property '{}' is repeated; it stands first at {}", named[i]->name,
                                                     named[first]->node.place().text()));
        named[i]->asked = true; // finish() says no more of it
    }
}

void Document::resolve_references() {
    std::vector<std::string> known; // for the nearest one, told a few times, as it takes the time of all ids
    constexpr size_t most_hints = 20;
    size_t unknown = 0;
    for (const Reference &reference : references_) {
        Object::Property &property = reference.owner->properties_[reference.property];
        const std::string id = property.node.attribute("id");
        if (const auto found = ids_.find(id); found != ids_.end()) {
            property.value = found->second;
            continue;
        }
        if (unknown++ == 0) {
            for (const auto &[other, object] : ids_)
                known.push_back(other);
            std::ranges::sort(known);
        }
        const std::string nearest = unknown <= most_hints ? nearest_name(id, known) : "";
        context_.mistake(property.node,
                         fmt::format("no object has the id {}{}", opal::quoted(id),
                                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
}

// Refuses references in circles, and those by which a small file unfolds to a deep or a huge scene.
void Document::check_graph(Object &root) {
    enum class State { unseen, open, done };
    struct Mark {
        State state = State::unseen;
        size_t levels = 1;   // of objects within it
        double unfolded = 1; // objects within it, where each reference counts as a copy
    };
    struct Step {
        Object *object;
        size_t next; // property
    };
    std::vector<Mark> marks(objects_.size());
    std::vector<Step> path = {{&root, 0}};
    while (!path.empty()) {
        auto &[object, next] = path.back();
        Mark &mark = marks[object->index_];
        mark.state = State::open;
        if (next == object->properties_.size()) {
            mark.state = State::done;
            path.pop_back();
            continue;
        }
        Object::Property &property = object->properties_[next];
        Object *const *child = std::get_if<Object *>(&property.value);
        const Mark within = child ? marks[(*child)->index_] : Mark{State::done};
        if (within.state == State::unseen) { // this property is met again when it is done
            path.push_back({*child, 0});
            continue;
        }
        next++;
        if (within.state == State::open) {
            context_.mistake(property.node, fmt::format("the reference to {} is within what it refers to",
                                                        opal::quoted(property.node.attribute("id"))));
            property.value = std::monostate();
        } else if (child) {
            mark.levels = std::max(mark.levels, within.levels + 1);
            mark.unfolded += within.unfolded;
            if (mark.levels > most_levels)
                property.node.fail(fmt::format("more than {} objects lie within each other", most_levels));
        }
    }
    if (marks[root.index_].unfolded > most_unfolded + 10 * double(objects_.size()))
        root.node_.fail(fmt::format("with a copy for each reference, there are more than {} objects", most_unfolded));
}

MitsubaScene read_document(const fs::path &file, const Definitions &definitions, const ParseContext &context) {
    return std::make_shared<Document>(context)->read(file, definitions);
}

bool is_mitsuba(const std::string &text) { return kind_of(text).kind == FileKind::mitsuba_scene; }

} // namespace opal::mitsuba
