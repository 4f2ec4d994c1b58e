// --vary NAME=V1,V2,...: a command runs once for each value of $NAME in the scene.
#pragma once

#include "commands/options.h"

namespace opal {

struct Variant {
    std::string value;
    std::string folder; // "NAME=V", below the command's own folder
    SceneDescription scene;
};
struct Variation {
    std::string name;
    std::vector<Variant> variants;
};

// does: "one sweep a value, ...", for the help.
OptionRow vary_row(std::string &vary, const std::string &does);

// The scene with each of the values. All are loaded now, so that a value that is refused costs no time. Throws
// UsageError if `vary` is not as above, gives a value twice, or names what -D gives; Error if a scene does not load.
Variation load_variation(const SceneOptions &options, const std::string &vary);

} // namespace opal
