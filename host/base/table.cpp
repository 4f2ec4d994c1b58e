#include "base/table.h"

#include "base/printable.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numeric>

namespace opal {

namespace {

// Edit distance with one row kept; upper and lower case are alike.
size_t edit_distance(std::string_view a, std::string_view b) {
    auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
    std::vector<size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), size_t(0));
    for (size_t i = 0; i < a.size(); ++i) {
        size_t diagonal = row[0];
        row[0] = i + 1;
        for (size_t j = 0; j < b.size(); ++j) {
            size_t replaced = diagonal + (lower(a[i]) != lower(b[j]));
            diagonal = row[j + 1];
            row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
        }
    }
    return row[b.size()];
}

// Other words for names of Opal, as courses, papers and other renderers have them.
struct OtherWord {
    std::string_view word, name;
};
constexpr OtherWord other_words[] = {{"nee", "emitter"},           {"light", "emitter"},
                                     {"direct", "emitter"},        {"brdf", "bsdf"},
                                     {"path_tracer", "path"},      {"pathtracer", "path"},
                                     {"path-tracer", "path"},      {"pt", "path"},
                                     {"random", "independent"},    {"balance_heuristic", "balance"},
                                     {"power_heuristic", "power"}, {"relaxed", "fast"},
                                     {"fp64", "double"},           {"float64", "double"}};

// The one known name that begins with these letters, or "".
std::string completed(std::string_view name, const std::vector<std::string> &known) {
    constexpr size_t least_letters = 3;
    std::string found;
    for (const std::string &candidate : known)
        if (name.size() >= least_letters && candidate.starts_with(name)) {
            if (!found.empty())
                return "";
            found = candidate;
        }
    return found;
}

} // namespace

std::string with_hyphens(std::string name) {
    std::replace(name.begin(), name.end(), '_', '-');
    return name;
}

std::string joined(const std::vector<std::string> &names) {
    constexpr size_t most_told = 100; // Opal's own tables are shorter; the names of a user's file may be a million
    const size_t told = std::min(names.size(), most_told);
    std::string text;
    for (size_t i = 0; i < told; ++i)
        text += (text.empty() ? "" : ", ") + names[i];
    if (told < names.size())
        text += fmt::format(" and {} more", names.size() - told);
    return text.empty() ? "none" : text;
}

std::string nearest_name(std::string_view name, const std::vector<std::string> &known) {
    constexpr size_t most_letters = 1000, most_names = 1000; // of a user's file: it takes letters^2 * names steps
    if (name.size() > most_letters || known.size() > most_names)
        return "";
    std::string nearest;
    size_t least = std::max<size_t>(name.size() / 3, 1) + 1;
    for (const std::string &candidate : known) {
        // Each letter that one has more costs an edit: a name of a megabyte is compared with none.
        if (std::max(name.size(), candidate.size()) - std::min(name.size(), candidate.size()) >= least)
            continue;
        size_t distance = edit_distance(name, candidate);
        if (distance < least && distance < candidate.size()) {
            least = distance;
            nearest = candidate;
        }
    }
    for (const OtherWord &other : other_words)
        if (nearest.empty() && other.word == name && std::find(known.begin(), known.end(), other.name) != known.end())
            return std::string(other.name);
    return nearest.empty() ? completed(name, known) : nearest;
}

std::string unknown_name(std::string_view what, std::string_view name, const std::vector<std::string> &known,
                         const std::string &of) {
    std::string nearest = nearest_name(name, known);
    std::string hint = nearest.empty() ? "" : fmt::format("did you mean '{}'? ", nearest);
    return fmt::format("unknown {} {}{}; {}available: {}", what, quoted(name), of, hint, joined(known));
}

} // namespace opal
