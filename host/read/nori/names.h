// Names in which Nori's forks differ, each written once: other names for the same thing, names that tell the dialect,
// and leftovers, which scenes carry although no renderer reads them.
#pragma once

#include "read/xml.h"
#include "scene/scene.h"

#include <optional>
#include <span>

namespace opal {

// The tag that Opal knows for this one: "emitter" for <luminaire>, "mesh" for <shape>.
std::string known_tag(const std::string &tag);
// The name of a property of that object: "albedo" for the reflectance of a bsdf.
std::string known_property(const XmlNode &object, const std::string &name);

// A name that only scenes of one dialect have.
struct DialectName {
    Dialect dialect;
    std::string tag;    // of an object, or "color" for a property
    std::string name;   // its type, or the property's name; empty: the tag itself
    std::string with{}; // a property that the object must have, where types of two dialects share a name; empty: none
    bool is_property() const { return tag == "color"; }
};
std::span<const DialectName> dialect_names();

struct DialectChoice {
    Dialect dialect = Dialect::upstream;
    std::string reason;  // "integrator 'direct_ems' at a.xml:1:8"; empty: no name told the dialect
    std::string against; // the same of a name of another dialect
};
// The dialect of a scene by its names. Where names of several dialects stand in it, it is the first of upstream, course
// and eth: ETH's names are shared by other courses, and so the camera is mirrored only if no name speaks against it.
DialectChoice dialect_of(const XmlNode &scene);

// A property or attribute that means nothing to an object. It gets a note.
struct Leftover {
    std::string tag;                  // of the object
    std::string type;                 // of the object; empty: all
    std::string name;                 // '*' at its end stands for any letters
    std::string property_tag{};       // of the property; empty: all
    std::optional<double> harmless{}; // the only value that is harmless; another is warned of
};
std::span<const Leftover> leftovers();
// The row of a property in that object, or null.
const Leftover *find_leftover(const XmlNode &object, const std::string &property_tag, const std::string &name);

bool is_leftover_attribute(const XmlNode &node, const std::string &name);

} // namespace opal
