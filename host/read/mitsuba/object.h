// The objects of a Mitsuba scene file, as <bsdf type="diffuse" id="wall">: their properties, fetched by name and type,
// and the objects within them. One property that is never fetched is a mistake.
#pragma once

#include "base/color.h"
#include "base/math.h"
#include "base/table.h"
#include "read/context.h"
#include "read/mitsuba/spectrum.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace opal::mitsuba {

class Document;

// An object after `$names`, <include>, <ref> and the renaming of old versions. A <ref> gives the very Object that it
// refers to, which may so be met several times: a reader keeps what it made of one by its address. References make no
// circles, and no more than 64 objects lie within each other. Fetching marks a property as known, so an Object is no
// constant.
class Object {
public:
    Object(Document &document, size_t index, const XmlNode &node, std::string name);

    const std::string &tag() const;  // "bsdf"
    const std::string &type() const; // the plug-in: "diffuse"
    const std::string &id() const;   // "" where it has none
    const std::string &name() const; // that of the parameter it stands for in its parent: "reflectance"; mostly ""
    SourcePlace place() const;

    // The value, or nothing if it is not given. It is a mistake if it has another type.
    std::optional<bool> boolean(const std::string &name);
    std::optional<int> integer(const std::string &name);
    std::optional<double> number(const std::string &name); // <float> or <integer>
    std::optional<std::string> string(const std::string &name);
    std::optional<std::string> string_if(const std::string &name); // nothing, and no mistake, if it has another type
    std::optional<Vec3> point(const std::string &name);            // <point> or <vector>
    std::optional<Vec3> vector(const std::string &name);           // likewise
    std::optional<Transform> transform(const std::string &name);
    // The colour of an <rgb>, a <spectrum> or, as grey, a number. A <texture> there is none: it stays a child. It is a
    // mistake if an <rgb> is no reflectance, 0 to 1. What a curve has outside of what can be is clamped, and warned of.
    std::optional<Color> color(const std::string &name, SpectrumUse use);
    bool has(const std::string &name) const; // of any type, a named child included; does not fetch it

    // The objects within it of that tag, in the order of the file, references included. Fetches them.
    std::vector<std::shared_ptr<Object>> children(const std::string &tag);
    // The child that stands for a parameter, as <texture name="reflectance">, or null. Fetches it.
    std::shared_ptr<Object> child_named(const std::string &name);

    // The file that a property of type string names: looked for in the folders of <path>, then in that of the main
    // file, then in the working folder. Nothing if there is none: a mistake at the property, or if lenient a warning
    // that says what is done `instead`.
    std::optional<std::filesystem::path> file(const std::string &name, const std::string &instead = "it is left out");

    void ignore(const std::string &name); // accepts it, whatever its type
    // A mistake at the place of the property or named child, or of the object if it is not given, unless `good`.
    void check(bool good, const std::string &name, const std::string &message) const;
    void mistake(const std::string &message) const; // at the object
    void mistake_at(const std::string &name, const std::string &message) const;
    SourcePlace place_of(const std::string &name) const;

    // Each property and child that was never fetched is a mistake that names the nearest one that was asked for; if
    // lenient, a warning that says that it is left out. To be called once, after everything was fetched.
    void finish();
    // Marks all within it as fetched: for an object that is left out, whose properties nobody knows.
    void ignore_all();

    const ParseContext &context() const;

private:
    friend class Document;

    // What a property holds. monostate: there is a mistake in it, which is told. Object *: a child.
    using Value = std::variant<std::monostate, bool, int, double, std::string, Vec3, Color, Spectrum,
                               std::unique_ptr<Transform>, Object *>;
    struct Property {
        XmlNode node;
        std::string name; // empty: a child without one
        Value value;
        bool asked = false;
    };

    const Property *look(const std::string &name) const;
    Property *ask(const std::string &name);
    Property *ask(const std::string &name, std::initializer_list<const char *> tags);
    template <class T> std::optional<T> find(const std::string &name, std::initializer_list<const char *> tags);
    std::optional<Color> spectrum_color(SpectrumUse use); // of this object, a <spectrum type="...">
    std::string owner() const;                            // " of bsdf 'diffuse'"
    void tell_unfetched(const Property &property) const;

    Document *document_;
    size_t index_; // in it
    XmlNode node_;
    std::string tag_, type_, id_, name_;
    std::vector<Property> properties_; // in the order of the file, with the children
    std::vector<std::string> known_properties_, known_tags_;
    bool is_finished_ = false;
};

// A file as a tree of objects. The root's own place in the file, and its objects.
struct MitsubaScene {
    std::shared_ptr<Object> root; // the <scene>, or the object that a file's root is
    Definitions definitions;      // the values that stood for $name
    std::string version;          // of the main file, as written: "2.1.0"
};

// Reads a file and all that it includes. Mistakes go to the context; its hashes get every file that was read.
// definitions: by the command line. Throws Error where there is no tree: malformed XML, no version; UsageError if no
// attribute names one of the definitions. The context is copied; its Mistakes and hashes must outlive the tree.
MitsubaScene read_document(const std::filesystem::path &file, const Definitions &definitions,
                           const ParseContext &context);

// Is the text XML of Mitsuba: has its root element the attribute `version`, and its tags are not Nori's?
bool is_mitsuba(const std::string &text);

} // namespace opal::mitsuba
