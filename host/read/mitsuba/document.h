// Reads Mitsuba's files into a tree of Objects (object.h).
#pragma once

#include "read/mitsuba/object.h"

#include <deque>
#include <span>
#include <unordered_map>

namespace opal::mitsuba {

// The first of the folders that has such a file; an absolute name is looked for as it is. An empty folder is the
// working folder.
std::optional<std::filesystem::path> find_file(const std::filesystem::path &name,
                                               std::span<const std::filesystem::path> folders);
std::string no_file_text(const std::string &name, std::span<const std::filesystem::path> folders);

// Owns all Objects of a scene, and the XML that they point into.
class Document : public std::enable_shared_from_this<Document> {
public:
    explicit Document(const ParseContext &context) : context_(context) {}
    Document(const Document &) = delete;
    Document &operator=(const Document &) = delete;

    MitsubaScene read(const std::filesystem::path &file, const Definitions &given);

    const ParseContext &context() const { return context_; }
    const std::vector<std::filesystem::path> &folders() const { return folders_; } // of meshes and images
    // The object, by a pointer that keeps all of them.
    std::shared_ptr<Object> shared(Object *object) { return {shared_from_this(), object}; }

private:
    struct File; // an XML file that is being read
    struct Reference {
        Object *owner;
        size_t property;
    };

    File open(const std::filesystem::path &file);
    Object &add_object(File &file, const XmlNode &node, const std::string &name);
    void read_children(File &file, const XmlNode &node, Object &object);
    void read_child(File &file, const XmlNode &node, Object &parent);
    Object::Value read_value(const XmlNode &node);
    void read_property(File &file, const XmlNode &node, Object &parent, bool is_known);
    void read_include(File &file, const XmlNode &node, Object &parent);
    void read_default(const XmlNode &node);
    void read_path(File &file, const XmlNode &node, const Object &parent);
    void read_alias(const XmlNode &node);
    void read_reference(File &file, const XmlNode &node, Object &parent);
    static void upgrade(Object &object);
    void check_repeated(Object &object) const;
    bool add_id(const XmlNode &node, const std::string &id, Object &object);
    void resolve_references();
    void check_graph(Object &root);
    void check_definitions(const Definitions &given, const SourcePlace &place) const;
    bool replace_names(const XmlNode &node);
    void tell_no_value(const XmlNode &node, const std::string &name);
    std::string replaced(const XmlNode &node, const std::string &text);

    ParseContext context_;
    std::deque<XmlDocument> files_;
    std::deque<Object> objects_;
    std::vector<std::filesystem::path> folders_, folders_of_includes_;
    std::unordered_map<std::string, Object *> ids_;
    std::vector<Reference> references_;

    Definitions values_, used_;  // of $name
    size_t longest_name_ = 0;    // of them
    size_t bytes_of_values_ = 0; // that stand for names
    size_t names_without_value_ = 0;
    size_t count_of_includes_ = 0;
};

} // namespace opal::mitsuba
