#include "scene/scene.h"

#include <fmt/format.h>

namespace opal {

std::string SourcePlace::text() const {
    if (line == 0)
        return file;
    return column == 0 ? fmt::format("{}:{}", file, line) : fmt::format("{}:{}:{}", file, line, column);
}

} // namespace opal
