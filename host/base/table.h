// Look-up by name in a table. A name that is not there gives an Error that lists the names:
// "unknown bsdf 'difuse'; did you mean 'diffuse'? available: diffuse, ...".
// A row is any struct with a member `name` that converts to string_view.
#pragma once

#include "base/error.h"

#include <string>
#include <string_view>
#include <vector>

namespace opal {

// The known name nearest by edit distance (Levenshtein 1966); else the name that other renderers have for it ("nee" is
// emitter); else the one that begins with these letters; else "", also where there are more than 1000 to choose from.
std::string nearest_name(std::string_view name, const std::vector<std::string> &known);

std::string with_hyphens(std::string name); // as the command line spells it: "int_ior" -> "int-ior"

std::string joined(const std::vector<std::string> &names); // "a, b, c"; "none" for no names

// The sentence for an unknown name. what: its kind ("bsdf", "property"); of: its owner (" of <mesh>").
std::string unknown_name(std::string_view what, std::string_view name, const std::vector<std::string> &known,
                         const std::string &of = "");

template <class Rows> std::vector<std::string> names_of(const Rows &rows) {
    std::vector<std::string> names;
    for (const auto &row : rows)
        names.emplace_back(row.name);
    return names;
}

// The row of that name; throws Error(unknown_name(...)).
template <class Rows> const auto &find_row(const Rows &rows, std::string_view what, std::string_view name) {
    for (const auto &row : rows)
        if (row.name == name)
            return row;
    throw Error(unknown_name(what, name, names_of(rows)));
}

} // namespace opal
