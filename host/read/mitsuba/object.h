// The objects of a Mitsuba scene file, as <bsdf type="diffuse" id="wall">: their properties, fetched by name and type,
// and the objects within them. One property that is never fetched is a mistake.
#pragma once

#include "base/color.h"
#include "base/math.h"
#include "base/table.h"
#include "read/context.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace opal::mitsuba {

class Document;

// What a spectrum is for, which decides how it becomes linear RGB.
enum class SpectrumUse {
    reflectance, // and opacities, weights: unbounded textures
    radiance,    // and intensity, irradiance
    index        // eta and k of conductors
};

// An object after `$names`, <include>, <ref> and the renaming of old versions: what a <ref> names is the same Object as
// that which it refers to. Fetching marks a property as known, so an Object is no constant.
class Object {
public:
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
    std::optional<Vec3> point(const std::string &name);  // <point> or <vector>
    std::optional<Vec3> vector(const std::string &name); // likewise
    std::optional<Transform> transform(const std::string &name);
    // The colour of an <rgb>, a <spectrum> or, as grey, a <float>. A <texture> there is none: it stays a child.
    std::optional<Color> color(const std::string &name, SpectrumUse use);
    bool has(const std::string &name) const; // of any type, a named child included; does not fetch it

    // The objects within it of that tag, in the order of the file, references included. Fetches them.
    std::vector<std::shared_ptr<Object>> children(const std::string &tag);
    // The child that stands for a parameter, as <texture name="reflectance">, or null. Fetches it.
    std::shared_ptr<Object> child_named(const std::string &name);

    // The file that a property of type string names: looked for in the folders of <path>, then in that of the main
    // file, then in the working folder. A mistake at the property, and then nothing, if there is none.
    std::optional<std::filesystem::path> file(const std::string &name);

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
};

// A file as a tree of objects. The root's own place in the file, and its objects.
struct MitsubaScene {
    std::shared_ptr<Object> root; // the <scene>, or the object that a file's root is
    Definitions definitions;      // the values that stood for $name
    std::string version;          // of the main file, as written: "2.1.0"
};

// Reads a file and all that it includes. Mistakes go to the context; its hashes get every file that was read.
// definitions: by the command line. Throws Error where there is no tree: malformed XML, no version.
MitsubaScene read_document(const std::filesystem::path &file, const Definitions &definitions,
                           const ParseContext &context);

// Does the text's root element have the attribute `version`, as Mitsuba's files have and Nori's do not?
bool is_mitsuba(const std::string &text);

} // namespace opal::mitsuba
