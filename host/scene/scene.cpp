#include "scene/scene.h"

#include <fmt/format.h>

namespace opal {

std::string SourcePlace::text() const {
    if (line == 0)
        return file;
    return column == 0 ? fmt::format("{}:{}", file, line) : fmt::format("{}:{}:{}", file, line, column);
}

#define OPAL_NAME(name) #name,
const char *bsdf_name(unsigned kind) {
    static const char *const names[] = {OPAL_BSDFS(OPAL_NAME)};
    return names[kind];
}

#undef OPAL_NAME

const char *emitter_name(unsigned kind) {
#define OPAL_NAME(name, traits) #name,
    static const char *const names[] = {OPAL_EMITTERS(OPAL_NAME)};
#undef OPAL_NAME
    return names[kind];
}

int emitter_traits(unsigned kind) {
#define OPAL_TRAITS(name, traits) traits,
    static const int all[] = {OPAL_EMITTERS(OPAL_TRAITS)};
#undef OPAL_TRAITS
    return all[kind];
}

} // namespace opal
