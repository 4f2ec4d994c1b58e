#include "flatten/emitter_kinds.h"

#include "flatten/store.h"

#include <cmath>
#include <numbers>

namespace opal {

namespace {

constexpr double pi = std::numbers::pi;

// Half of the image's width at distance 1.
double half_width(const emitter_projector &light) { return std::tan(light.fov * (pi / 360)); }

} // namespace

void add_extent(const emitter_projector &light, Extent &extent) { extent.add(light.position); }

// On the plane at distance 1 the irradiance is pi times the parameter, all over the image.
double power_of(const emitter_projector &light, double) {
    const double width = 2 * half_width(light);
    return pi * luminance(light.irradiance) * width * width / light.aspect;
}

emitter_projector_record flattened(const emitter_projector &light, const Flattening &flattening) {
    emitter_projector_record record{};
    store(light.irradiance, pi * flattening.scale * flattening.scale, record.color);
    store((light.position - flattening.center) * flattening.scale, record.position);
    const Vec3 direction = normalize(light.direction);
    store(direction, record.direction);
    Vec3 right = cross(direction, light.up);
    if (!(length(right) > 0))
        right = cross(direction, std::abs(direction.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0});
    const Vec3 x = normalize(right);
    store_image_axes(light, x, cross(x, direction) * -1, record);
    return record;
}

void store_image_axes(const emitter_projector &light, Vec3 x, Vec3 y, emitter_projector_record &record) {
    store(x * (0.5 / half_width(light)), record.across[0]);
    store(y * (0.5 * light.aspect / half_width(light)), record.across[1]);
}

} // namespace opal
