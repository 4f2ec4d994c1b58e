#include "read/environment.h"

#include "base/log.h"
#include "read/picture.h"

#include <fmt/format.h>

#include <cmath>

namespace opal {

std::shared_ptr<const EnvironmentMap> read_environment(const std::filesystem::path &file, FileHashes *hashes) {
    return environment_of(read_picture(file, hashes), file);
}

void warn_of_scale(const Transform &to_world, const SourcePlace &place) {
    constexpr double rounded = 1e-3; // of a matrix with three decimals
    const Transform turned = orthonormal(to_world);
    double off = 0;
    for (size_t row = 0; row < 3; row++)
        for (size_t column = 0; column < 3; column++)
            off = std::max(off, std::abs(turned.rows[row][column] - to_world.rows[row][column]));
    if (off > rounded)
        warn(fmt::format("{}: this transform scales an environment, which has no size; it is turned and mirrored alone "
                         "(Mitsuba looks up other rows of the map, by light sampling others than by BSDF sampling)",
                         place.text()));
}

} // namespace opal
