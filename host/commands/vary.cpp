#include "commands/vary.h"

#include "base/error.h"
#include "strategies/combinations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace opal {

namespace {

// "NAME=V" as the name of a folder: a letter that a path or a link reads otherwise becomes '_'.
std::string folder_name(const std::string &name, const std::string &value) {
    std::string folder = name + "=" + value;
    const std::string plain = "=.+-_";
    std::ranges::replace_if(
        folder, [&](char c) { return !std::isalnum(static_cast<unsigned char>(c)) && plain.find(c) == plain.npos; },
        '_');
    return folder;
}

} // namespace

OptionRow vary_row(std::string &vary, const std::string &does) {
    return {.flags = "--vary",
            .target = &vary,
            .help = "Give $NAME in the scene (see -D) each of these values: " + does,
            .type = "NAME=V1,V2,..."};
}

Variation load_variation(const SceneOptions &options, const std::string &vary) {
    const auto refuse = [&](const std::string &why) { throw UsageError(fmt::format("--vary {}: {}", vary, why)); };
    const size_t name_end = vary.find('=');
    Variation variation{vary.substr(0, name_end), {}};
    if (name_end == vary.npos || name_end == 0)
        refuse("is not NAME=V1,V2,...");
    if (options.load.definitions.contains(variation.name))
        refuse(fmt::format("-D gives {}, too", variation.name));
    std::vector<std::string> folders;
    const std::vector<std::string> values = split(vary.substr(name_end + 1), ',');
    if (values.size() < 2)
        refuse("needs at least two values");
    for (const std::string &value : values) {
        folders.push_back(folder_name(variation.name, value));
        if (std::ranges::count(folders, folders.back()) > 1)
            refuse(fmt::format("two values would share the folder {}", folders.back()));
    }
    for (size_t i = 0; i < values.size(); i++) {
        SceneOptions one = options;
        one.load.definitions[variation.name] = values[i];
        variation.variants.push_back({values[i], folders[i], load_scene(one)});
    }
    return variation;
}

} // namespace opal
