#include "scene/scene.h"

namespace opal {

std::string SourcePlace::text() const {
    std::string place = file;
    if (line > 0)
        place += ":" + std::to_string(line);
    if (column > 0)
        place += ":" + std::to_string(column);
    return place;
}

} // namespace opal
