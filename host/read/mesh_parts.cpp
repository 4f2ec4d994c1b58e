#include "read/mesh_parts.h"

#include "base/log.h"
#include "base/values.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

namespace opal {

namespace {

// Whether all of the word is a number; also infinity and NaN.
bool parse(std::string_view word, double &number) {
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
    return error == std::errc() && end == word.data() + word.size();
}

} // namespace

// The slower parse_number knows what is wrong, and forms that are rare.
double parse_coordinate(std::string_view word) {
    double value;
    return parse(word, value) && std::abs(value) <= std::numeric_limits<float>::max() ? value : parse_number(word);
}

double parse_coordinate_or_nan(std::string_view word) {
    double value;
    if (parse(word, value) && std::abs(value) <= std::numeric_limits<float>::max())
        return value;
    const std::string_view size = word.substr(word.starts_with('+') || word.starts_with('-'));
    return (parse(size, value) && !std::isfinite(value)) || size.starts_with("1.#") ? NAN : parse_number(word);
}

double rounding_of(const std::array<Vec3, 3> &triangle) {
    double largest = 0;
    for (const Vec3 &p : triangle)
        largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return 4 * std::numeric_limits<double>::epsilon() * largest;
}

bool has_area(const std::array<Vec3, 3> &p, double rounding) {
    double longest2 = 0;
    for (int i = 0; i < 3; ++i)
        longest2 = std::max(longest2, dot(p[(i + 1) % 3] - p[i], p[(i + 1) % 3] - p[i]));
    const Vec3 doubled_area = cross(p[1] - p[0], p[2] - p[0]);
    return dot(doubled_area, doubled_area) >
           rounding * rounding * longest2; // no overflow: squares of floats fit into doubles
}

void warn_of_dropped(const std::string &file, const DroppedTriangles &dropped, const TriangleMesh &mesh) {
    std::string text;
    if (dropped.count) {
        const double size = mesh.extent().longest_side();
        const std::string limit =
            dropped.rounding > 0 && size > 0
                ? fmt::format(", in height below {:.2g} of the mesh's size", dropped.rounding / size)
                : "";
        const std::string object =
            dropped.first_object.empty() ? "" : fmt::format(", the first in '{}'", dropped.first_object);
        text = fmt::format("dropped {} triangles without area{}{}", dropped.count, limit, object);
    }
    if (mesh.triangles.empty())
        warn(fmt::format("{}: holds no triangles, so it is neither seen nor a light{}", file,
                         text.empty() ? "" : ": " + text));
    else if (!text.empty())
        warn(fmt::format("{}: {}, kept {}", dropped.first_place, text, mesh.triangles.size()));
}

bool fits_float(Vec3 p) {
    return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}) <= std::numeric_limits<float>::max();
}

Vec3 unit_normal(const Transform &to_world, Vec3 normal) {
    const Vec3 n = to_world.normal(normal);
    const double size = length(n);
    return std::isnormal(size) ? n * (1 / size) : Vec3{};
}

} // namespace opal
