// The context of parsing: the user's options, and what becomes of mistakes.
#pragma once

#include "read/picture_loader.h"
#include "read/xml.h"
#include "scene/scene.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace opal {

// The mistakes of all files of a scene, told together.
class Mistakes {
public:
    // text: the whole message; at: its place in the scene's file, by which mistakes are ordered.
    // The same text twice in a row, of two channels of a colour, counts once.
    void add(const SourcePlace &at, const std::string &text) {
        if (list_.empty() || list_.back().text != text)
            list_.push_back({at, text});
    }
    size_t count() const { return list_.size(); }
    // Throws Error or ErrorList, if there are any: the first 20, and how many more there are. Files are in the order of
    // their first mistakes.
    void throw_all() const;

private:
    struct Mistake {
        SourcePlace at;
        std::string text;
    };
    std::vector<Mistake> list_;
};

// Thrown by the parser of an object that cannot be made. The reason was told before.
struct NoObject {};

struct ParseContext {
    std::filesystem::path folder;     // of the XML file: relative file names are looked for there first
    bool lenient = false;             // what is unknown warns instead of failing
    Mistakes *mistakes = nullptr;     // gathers mistakes; null: the first one is thrown
    std::optional<Dialect> dialect{}; // nothing: a scene's names tell it
    FileHashes *hashes = nullptr;     // gets those of the files that are read; null: nobody asks
    std::shared_ptr<PictureLoader> pictures = std::make_shared<PictureLoader>(); // of copies of the context, too
    // The map of an envmap that names no file (opal warp, selftest); null: that is a mistake.
    std::shared_ptr<const EnvironmentMap> example_map{};
    // Is it an attribute that means nothing in this format, and gets a note? null: there is none.
    bool (*is_leftover)(const XmlNode &node, const std::string &attribute) = nullptr;

    void mistake(const SourcePlace &place, const std::string &message) const;
    void mistake(const XmlNode &node, const std::string &message) const { mistake(node.place(), message); }
    MistakeHandler handler() const;
    // A name that Opal does not know: a mistake, or a warning if lenient.
    void unknown(const XmlNode &node, const std::string &message) const;
    // As XmlNode::require_attributes. Leftovers get a note.
    bool require_attributes(const XmlNode &node, std::initializer_list<const char *> names,
                            std::initializer_list<const char *> optional = {}) const;

    // Runs `make`, which may read the object. An Error is gathered with the others, so that parsing goes on.
    template <class Object, class Make> void attempt(const Object &object, Make make) const {
        try {
            make();
        } catch (const NoObject &) {
        } catch (const Error &error) {
            gather(object.place(), error);
        }
    }

private:
    void gather(const SourcePlace &place, const Error &error) const; // throws it if mistakes are not gathered
};

// Runs `parse` and adds the place of this node to its Error.
template <class Parse> decltype(auto) at_place(const XmlNode &node, Parse parse) {
    try {
        return parse();
    } catch (const Error &error) {
        node.fail(error.what());
    }
}

} // namespace opal
