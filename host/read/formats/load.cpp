#include "read/load.h"

#include "base/log.h"
#include "base/read_file.h"
#include "read/mitsuba/load.h"
#include "read/mitsuba/object.h"
#include "read/nori/load.h"

#include <fmt/format.h>

namespace opal {

namespace {

// A scene of Mitsuba without a version would be told as one of Nori with many unknown tags.
void refuse_without_version(const std::filesystem::path &file, const std::string &text, bool lenient) {
    const size_t root = text.find("<scene");
    if (root == text.npos || text.substr(root, text.find('>', root) - root).find("version") != text.npos)
        return;
    for (const char *tag : {"<sensor", "<film"}) // that Nori does not have
        if (text.find(tag, root) != text.npos) {
            const std::string message = file.string() + ": has tags of Mitsuba, but its <scene> lacks the version that "
                                                        "a scene of Mitsuba has, as in <scene version=\"3.0.0\">";
            if (!lenient)
                throw Error(message);
            return warn(message + "; it is read as Nori's");
        }
}

bool is_for_mitsuba(const std::filesystem::path &file, const LoadOptions &options) {
    if (options.dialect != "auto")
        return options.dialect == name_of(Dialect::mitsuba);
    const std::string text = read_file(file, Pipes::read);
    if (mitsuba::is_mitsuba(text))
        return true;
    refuse_without_version(file, text, options.lenient);
    return false;
}

} // namespace

SceneDescription load_scene(const std::filesystem::path &file, const LoadOptions &options) {
    if (is_for_mitsuba(file, options))
        return mitsuba::load_scene(file, options);
    if (!options.sensor.empty())
        throw UsageError(fmt::format("--sensor {}: a scene of Nori has one camera, without a name", options.sensor));
    return load_nori_scene(file, options);
}

} // namespace opal
