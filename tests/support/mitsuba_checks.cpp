// Spots, cameras, environments, smooth metals and panes against values that Mitsuba 3.9.1 (scalar_rgb) gave.
#include "densities/sampled.h"
#include "read/nori/parsers.h"
#include "scene/examples.h"
#include "selftest/checks.h"
#include "support/kernel_checks.h"
#include "support/probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

namespace opal::test {

namespace {

constexpr double tolerance = 1e-5;
constexpr double radians = std::numbers::pi / 180;

Camera camera_of(uint kind) {
    Camera camera;
    camera.kind = kind;
    camera.width = 200;
    camera.height = 100;
    camera.near_clip = 0.01;
    camera.far_clip = 10000;
    camera.perspective.fov = camera.thinlens.fov = 40;
    return camera;
}
Camera perspective(double fov) {
    Camera camera = camera_of(CAMERA_perspective);
    camera.perspective.fov = fov;
    return camera;
}
Camera tall() {
    Camera camera = perspective(40);
    std::swap(camera.width, camera.height);
    return camera;
}
Camera shifted() {
    Camera camera = perspective(40);
    camera.perspective.principal_point_x = -0.1; // Mitsuba's offset is 0.1: that of the film
    camera.perspective.principal_point_y = -0.2;
    return camera;
}
Camera moved() {
    Camera camera = perspective(40);
    camera.to_world = Transform::look_at({1, 2, 5}, {0, 0, 0}, {0, 1, 0});
    return camera;
}
Camera orthographic(double scale) {
    Camera camera = camera_of(CAMERA_orthographic);
    camera.to_world = Transform::scale({scale, scale, 1});
    return camera;
}
Camera thinlens() {
    Camera camera = camera_of(CAMERA_thinlens);
    camera.thinlens.aperture_radius = 0.5;
    camera.thinlens.focus_distance = 4;
    return camera;
}

struct KnownRay {
    double film[2], lens[2]; // in [0, 1]^2
    Vec3 origin, direction;  // the origin lies on the near plane
    double length;           // from there to the far plane; 0: unknown
};
struct KnownCamera {
    const char *name;
    Camera camera;
    std::vector<KnownRay> rays;
};

// Fields of view are those that Mitsuba derived across x from other axes and lengths. Points of the cropped film are
// given as points of the whole.
std::vector<KnownCamera> known_cameras() {
    return {
        {"fov 40",
         perspective(40),
         {{{0.5, 0.5}, {0.5, 0.5}, {2.980232e-10, 1.490116e-10, 0.01}, {2.980232e-08, 1.490116e-08, 1}, 9999.99},
          {{0, 0}, {0.5, 0.5}, {0.003639702, 0.001819851, 0.01}, {0.3371261, 0.1685631, 0.9262464}, 10796.25},
          {{1, 0}, {0.5, 0.5}, {-0.003639702, 0.001819851, 0.01}, {-0.337126, 0.1685631, 0.9262464}, 10796.25},
          {{0.25, 0.75},
           {0.5, 0.5},
           {0.001819851, -0.0009099253, 0.01},
           {0.1783313, -0.0891656, 0.9799222},
           10204.88}}},
        {"no fov",
         perspective(42.31171),
         {{{0, 0}, {0.5, 0.5}, {0.003869883, 0.001934942, 0.01}, {0.3551697, 0.1775849, 0.9177788}, 10895.86},
          {{1, 0}, {0.5, 0.5}, {-0.003869882, 0.001934942, 0.01}, {-0.3551696, 0.1775849, 0.9177788}, 10895.86},
          {{0.25, 0.75},
           {0.5, 0.5},
           {0.001934942, -0.0009674705, 0.01},
           {0.1891194, -0.09455965, 0.9773906},
           10231.31}}},
        {"axis y",
         perspective(72.10477),
         {{{0, 0}, {0.5, 0.5}, {0.007279404, 0.003639702, 0.01}, {0.5645881, 0.2822941, 0.7755966}, 12893.29},
          {{1, 0}, {0.5, 0.5}, {-0.007279403, 0.003639702, 0.01}, {-0.5645881, 0.2822941, 0.7755967}, 12893.29},
          {{0.25, 0.75}, {0.5, 0.5}, {0.003639702, -0.001819851, 0.01}, {0.3371261, -0.168563, 0.9262464}, 10796.25}}},
        {"axis diagonal",
         perspective(36.06479),
         {{{0, 0}, {0.5, 0.5}, {0.003255448, 0.001627724, 0.009999999}, {0.3059121, 0.1529561, 0.9396926}, 10641.77},
          {{1, 0}, {0.5, 0.5}, {-0.003255448, 0.001627724, 0.009999999}, {-0.3059121, 0.1529561, 0.9396926}, 10641.77},
          {{0.25, 0.75}, {0.5, 0.5}, {0.001627725, -0.000813862, 0.01}, {0.1601422, -0.08007108, 0.983841}, 10164.23}}},
        {"35 mm",
         perspective(57.87119),
         {{{0, 0}, {0.5, 0.5}, {0.005528405, 0.002764203, 0.01}, {0.4702615, 0.2351307, 0.8506277}, 11756.01},
          {{1, 0}, {0.5, 0.5}, {-0.005528404, 0.002764203, 0.009999999}, {-0.4702614, 0.2351308, 0.8506278}, 11756.01},
          {{0.25, 0.75}, {0.5, 0.5}, {0.002764203, -0.001382101, 0.01}, {0.2640959, -0.1320479, 0.9554144}, 10466.65}}},
        {"tall",
         tall(),
         {{{0, 0}, {0.5, 0.5}, {0.003639702, 0.007279404, 0.01}, {0.2822941, 0.5645882, 0.7755967}, 12893.29},
          {{1, 0}, {0.5, 0.5}, {-0.003639701, 0.007279404, 0.01}, {-0.282294, 0.5645882, 0.7755967}, 12893.29},
          {{0.25, 0.75}, {0.5, 0.5}, {0.001819851, -0.003639701, 0.01}, {0.1685631, -0.337126, 0.9262465}, 10796.25}}},
        {"principal point",
         shifted(),
         {{{0.5, 0.5},
           {0.5, 0.5},
           {-0.0007279402, -0.0007279402, 0.01},
           {-0.07241133, -0.07241133, 0.9947428},
           10052.84},
          {{0, 0}, {0.5, 0.5}, {0.002911762, 0.001091911, 0.01}, {0.2780422, 0.1042658, 0.9548933}, 10472.36},
          {{1, 0}, {0.5, 0.5}, {-0.004367642, 0.001091911, 0.01}, {-0.3982639, 0.099566, 0.9118511}, 10966.69},
          {{0.25, 0.75}, {0.5, 0.5}, {0.001091911, -0.001637866, 0.01}, {0.1071351, -0.1607026, 0.9811712}, 10191.89}}},
        {"crop",
         perspective(40),
         {{{0.25, 0.2}, {0.5, 0.5}, {0.001819851, 0.001091911, 0.01}, {0.1780201, 0.1068121, 0.9782127}, 10222.72},
          {{0.75, 0.2}, {0.5, 0.5}, {-0.001819851, 0.001091911, 0.01}, {-0.1780201, 0.1068121, 0.9782127}, 10222.72},
          {{0.375, 0.575},
           {0.5, 0.5},
           {0.0009099256, -0.0002729775, 0.01},
           {0.09058473, -0.0271754, 0.9955178},
           10045.01}}},
        {"look at",
         moved(),
         {{{0, 0}, {0.5, 0.5}, {0.9944749, 1.998043, 4.990933}, {-0.511759, -0.1812937, -0.8397828}, 10796.25},
          {{1, 0}, {0.5, 0.5}, {1.001613, 1.998043, 4.989506}, {0.1493996, -0.1812937, -0.9720145}, 10796.25},
          {{0.25, 0.75}, {0.5, 0.5}, {0.9964549, 1.995501, 4.991554}, {-0.3473914, -0.4408256, -0.8276424}, 10204.88}}},
        {"orthographic",
         orthographic(1),
         {{{0.5, 0.5}, {0.5, 0.5}, {1.192093e-07, 5.960464e-08, 0.01}, {0, 0, 1}, 9999.99},
          {{0, 0}, {0.5, 0.5}, {0.9999999, 0.5, 0.01}, {0, 0, 1}, 9999.99},
          {{1, 0}, {0.5, 0.5}, {-0.9999997, 0.5, 0.01}, {0, 0, 1}, 9999.99},
          {{0.25, 0.75}, {0.5, 0.5}, {0.5, -0.2499999, 0.01}, {0, 0, 1}, 9999.99}}},
        {"orthographic scale 3",
         orthographic(3),
         {{{0, 0}, {0.5, 0.5}, {3, 1.5, 0.01}, {0, 0, 1}, 9999.99},
          {{1, 0}, {0.5, 0.5}, {-2.999999, 1.5, 0.01}, {0, 0, 1}, 9999.99},
          {{0.25, 0.75}, {0.5, 0.5}, {1.5, -0.7499997, 0.01}, {0, 0, 1}, 9999.99}}},
        {"thinlens",
         thinlens(),
         {{{0.5, 0.5}, {0.5, 0.5}, {2.980232e-10, 1.490116e-10, 0.01}, {2.980232e-08, 1.490116e-08, 1}, 0},
          {{0.5, 0.5}, {0.1, 0.2}, {-0.3317564, -0.2216725, 0.01}, {0.08273433, 0.05528132, 0.9950371}, 0},
          {{0.5, 0.5}, {0.9, 0.3}, {0.3686279, -0.1526907, 0.01}, {-0.09192941, 0.03807844, 0.9950371}, 0},
          {{0, 0}, {0.5, 0.5}, {0.003639702, 0.001819851, 0.01}, {0.3371261, 0.1685631, 0.9262464}, 0},
          {{0, 0}, {0.1, 0.2}, {-0.3281166, -0.2198527, 0.01}, {0.3989035, 0.2119274, 0.8921676}, 0},
          {{0, 0}, {0.9, 0.3}, {0.3722676, -0.1508708, 0.01}, {0.2563616, 0.2079095, 0.9439556}, 0},
          {{1, 0}, {0.5, 0.5}, {-0.003639702, 0.001819851, 0.01}, {-0.337126, 0.1685631, 0.9262464}, 0},
          {{1, 0}, {0.1, 0.2}, {-0.3353961, -0.2198527, 0.01}, {-0.2635603, 0.2229398, 0.9385275}, 0},
          {{1, 0}, {0.9, 0.3}, {0.3649882, -0.1508708, 0.01}, {-0.4070775, 0.196469, 0.8920134}, 0}}},
    };
}

struct KnownSpot {
    double cutoff, beam; // degrees
    std::vector<double> falloff;
};
const double spot_angles[] = {0,  2.5, 5,    7.5, 10,   12.5, 14, 15, 16, 17, 17.5,
                              18, 19,  19.5, 20,  22.5, 25,   30, 35, 39, 40, 45};
const KnownSpot known_spots[] = {
    {20, 15, {1,         1,         1,         1, 1, 1, 1, 1, 0.8000001, 0.6000037, 0.4999993,
              0.4000009, 0.1999989, 0.1000001, 0, 0, 0, 0, 0, 0,         0,         0}},
    {40, 30, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0.5, 0.1000001, 0, 0}},
    {40, 10, {1,         1,         1,         1,          1,         0.9166666, 0.8666667, 0.8333334,
              0.8,       0.7666674, 0.7499998, 0.7333335,  0.6999998, 0.6833333, 0.6666666, 0.5833333,
              0.5000001, 0.3333332, 0.1666666, 0.03333337, 0,         0}},
    {30, 30, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0}},
    {20, 30, {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 0, 0, 0, 0, 0, 0, 0, 0}},
};

// Narrow cones about both ends of the axis, smooth or not, against the plain formulas in double. Rounding turns a
// direction by 1e-7; the arc cosine of a float would be off by 1e-4.
const double fine_angles[] = {0, 0.005, 0.011, 0.015, 0.019, 0.03, 90, 179.96, 179.985, 179.99, 180};
const emitter_spot fine_spots[] = {{{}, {0, 0, 1}, {1, 1, 1}, 0.02, 0.01, false},
                                   {{}, {0, 0, 1}, {1, 1, 1}, 0.02, 0.01, true},
                                   {{}, {0, 0, 1}, {1, 1, 1}, 179.99, 179.97, false},
                                   {{}, {0, 0, 1}, {1, 1, 1}, 179.99, 179.97, true}};
constexpr double rounding = 3e-7;

double falloff_of(const emitter_spot &spot, double angle) { // degrees
    const double linear = (spot.cutoff_angle - angle) / (spot.cutoff_angle - spot.beam_width);
    const double middle = (spot.cutoff_angle + angle) / 2 * radians,
                 whole = (spot.cutoff_angle + spot.beam_width) / 2 * radians;
    const double cosines = std::sin(middle) * std::sin((spot.cutoff_angle - angle) / 2 * radians) / std::sin(whole) /
                           std::sin((spot.cutoff_angle - spot.beam_width) / 2 * radians);
    return spot.smooth ? std::pow(std::clamp(cosines, 0., 1.), 4) : std::clamp(linear, 0., 1.);
}

// The falloff of a spot about +z, seen from these angles.
template <class Angles>
std::vector<double> falloffs(const emitter_spot &spot, const Angles &angles, int lanes, const Sources &sources) {
    std::vector<Vec3> from;
    for (double angle : angles)
        from.push_back({std::sin(angle * radians), 0, std::cos(angle * radians)});
    KernelProbe probe = probe_of(scene_of_light({spot, {}}, lanes), lanes, sources);
    const double scale = probe.scene().scale;
    const Planes drawn = probe.light_sample(from, Planes(2 * OPAL_PROBE_PAIRS, from.size()));
    std::vector<double> all;
    for (size_t i = 0; i < from.size(); i++)
        all.push_back(drawn.at(LIGHT_ACTIVE, i) != 0 ? drawn.at(LIGHT_RADIANCE_R, i) / (scale * scale) : 0);
    return all;
}

double largest(Vec3 v) { return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}); }

} // namespace

Findings check_cameras(const Sources &sources, unsigned) {
    Findings findings;
    for (const KnownCamera &known : known_cameras()) {
        SceneDescription scene;
        scene.camera = known.camera;
        scene.meshes = {examples::made_of(examples::quad({-3, 1, 2}, {4, 0, 0}, {0, 5, 1}), examples::diffuse(0.5))};
        scene.strategy.specialise = Specialise::off;
        Planes film(FILM_PLANES, known.rays.size());
        for (size_t i = 0; i < known.rays.size(); i++)
            for (size_t k = 0; k < 2; k++) {
                film.at(FILM_X + k, i) = float(known.rays[i].film[k]);
                film.at(FILM_LENS + k, i) = float(known.rays[i].lens[k]);
            }
        for (int lanes : tested_lanes()) {
            KernelProbe probe = probe_of(flatten(scene, lanes), lanes, sources);
            const Planes rays = probe.camera_rays(film);
            double worst = 0;
            for (size_t i = 0; i < known.rays.size(); i++) {
                const KnownRay &ray = known.rays[i];
                const Vec3 direction = rays.vec3(RAY_D_X, i);
                const double scale = probe.scene().scale, near = rays.at(RAY_TMIN, i), far = rays.at(RAY_TMAX, i);
                const Vec3 start = (rays.vec3(RAY_O_X, i) + direction * near) * (1 / scale) + probe.scene().center;
                worst = std::max({worst, largest(direction - ray.direction), largest(start - ray.origin),
                                  ray.length > 0 ? std::abs((far - near) / scale / ray.length - 1) : 0});
            }
            findings.push_back(
                exact(fmt::format("rays of camera {}{}, off by {:.1e}", known.name, at_width(lanes), worst),
                      worst < tolerance));
        }
    }
    return findings;
}

namespace {

// A picture of 64 x 64 pixels: red grows to the right, green downwards.
BitmapTexture ramps() {
    constexpr int size = 64;
    const auto picture = std::make_shared<Picture>();
    picture->width = picture->height = size;
    picture->channels = 3;
    for (int y = 0; y < size; y++)
        for (int x = 0; x < size; x++)
            for (float value : {(float(x) + 0.5f) / size, (float(y) + 0.5f) / size, 1.f})
                picture->floats.push_back(value);
    return {.picture = picture};
}

// What a spot along +z of 60 degrees, 50 of them full, sheds through that picture: Mitsuba 3.9.1.
struct KnownSlide {
    Vec3 point;
    double red, green;
};
const std::vector<KnownSlide> known_slides = {{{0.3, 0.2, 1}, 0.5866026, 0.557735},
                                              {{-0.5, 0.1, 2}, 0.42783123, 0.51443374},
                                              {{0.1, -1.1, 1}, 0.5288675, 0.18245737},
                                              {{0, 0, 1}, 0.5, 0.5}};

// What a projector along +z of 40 degrees sheds at a point by an image that is white, and by one of 4 x 2 pixels, whose
// red is 1, 2, 3, 4 and whose green is 1, 2: Mitsuba 3.9.1.
struct KnownProjection {
    Vec3 point;
    double red, green;
};
const std::vector<KnownProjection> known_white = {
    {{0, 0, 1}, 3.141593, 3.141593},    {{0, 0, 2}, 0.785398, 0.785398},
    {{0.1, 0, 1}, 3.157262, 3.157262},  {{0.2, 0, 1}, 3.203809, 3.203809},
    {{0.3, 0, 1}, 3.279919, 3.279919},  {{0.2, 0.2, 1}, 3.264839, 3.264839},
    {{0.6, 0, 2}, 0.81998, 0.81998},    {{0, 0, -1}, 0, 0},
    {{0.36, 0, 1}, 3.338968, 3.338968}, {{0.37, 0, 1}, 0, 0},
    {{0, 0.36, 1}, 3.338968, 3.338968}, {{0, 0.37, 1}, 0, 0}};
// Points of the plane at distance 1, over the half of the image's width there.
const std::vector<KnownProjection> known_image = {{{0.3, 0.2, 0}, 6.337058, 3.168529},
                                                  {{-0.3, 0.2, 0}, 9.505587, 3.168529},
                                                  {{0.9, 0.45, 0}, 3.345656, 3.345656},
                                                  {{0.9, -0.45, 0}, 3.345656, 6.691313},
                                                  {{-0.9, 0.45, 0}, 13.382626, 3.345656},
                                                  {{1.01, 0, 0}, 0, 0},
                                                  {{0, 0.51, 0}, 0, 0},
                                                  {{0, 0.99, 0}, 0, 0}};

BitmapTexture steps() {
    const auto picture = std::make_shared<Picture>();
    picture->width = 4;
    picture->height = 2;
    picture->channels = 3;
    for (float y : {1.f, 2.f})
        for (float x : {1.f, 2.f, 3.f, 4.f})
            for (float value : {x, y, 3.f})
                picture->floats.push_back(value);
    return {.picture = picture, .nearest = true};
}

Findings projector_findings(const Sources &sources, int lanes) {
    const emitter_projector white{{}, {0, 0, 1}, {0, 1, 0}, {1, 1, 1}, 40, 1};
    emitter_projector wide = white;
    wide.aspect = 2;
    Findings findings;
    const auto judge = [&](const Light &light, const std::vector<KnownProjection> &known, auto point_of) {
        KernelProbe probe = probe_of(scene_of_light(light, lanes), lanes, sources);
        for (const KnownProjection &row : known) {
            const Vec3 p = point_of(row.point);
            const Planes seen = probe.light_sample(p, Planes(2 * OPAL_PROBE_PAIRS, 1));
            const double lit = seen.at(LIGHT_ACTIVE, 0);
            findings.push_back(exact(
                fmt::format("a projector at {} {} {}{}", p.x, p.y, p.z, at_width(lanes)),
                std::abs(lit * seen.at(LIGHT_RADIANCE_R, 0) - row.red) < tolerance * std::max(1.0, row.red) &&
                    std::abs(lit * seen.at(LIGHT_RADIANCE_G, 0) - row.green) < tolerance * std::max(1.0, row.green)));
        }
    };
    judge({white, {}}, known_white, [](Vec3 p) { return p; });
    const double half = std::tan(20 * radians);
    judge({wide, {}, LightTexture{steps(), {-1, 0, 0}, {0, -1, 0}}}, known_image, [&](Vec3 p) {
        return Vec3{p.x * half, p.y * half, 1};
    });
    return findings;
}

} // namespace

Findings check_delta_lights(const Sources &sources, unsigned) {
    Findings findings;
    const auto judge = [&](const emitter_spot &spot, int lanes, double worst, double limit) {
        findings.push_back(exact(fmt::format("spot of {} and {} degrees{}{}, off by {:.1e}", spot.cutoff_angle,
                                             spot.beam_width, spot.smooth ? ", smooth" : "", at_width(lanes), worst),
                                 worst < limit));
    };
    for (int lanes : tested_lanes()) {
        const Light sun{emitter_directional{{0, 0, -1}, {1, 1, 1}}, {}};
        KernelProbe probe = probe_of(scene_of_light(sun, lanes), lanes, sources);
        const Planes drawn = probe.light_sample(Vec3{0, 0, 1}, Planes(2 * OPAL_PROBE_PAIRS, 1));
        findings.push_back(exact("light that goes to -z comes from +z" + at_width(lanes),
                                 largest(drawn.vec3(LIGHT_D_X, 0) - Vec3{0, 0, 1}) < tolerance &&
                                     std::abs(drawn.at(LIGHT_RADIANCE_R, 0) - 1) < tolerance &&
                                     drawn.at(LIGHT_DENSITY, 0) == 1 && drawn.at(LIGHT_ACTIVE, 0) == 1));
        Light textured{emitter_spot{{}, {0, 0, 1}, {1, 1, 1}, 60, 50, false}, {}};
        textured.texture = LightTexture{ramps(), {1, 0, 0}, {0, 1, 0}};
        KernelProbe slides = probe_of(scene_of_light(textured, lanes), lanes, sources);
        for (const auto &[point, red, green] : known_slides) {
            const Planes seen = slides.light_sample(point, Planes(2 * OPAL_PROBE_PAIRS, 1));
            const double distance2 = dot(point, point);
            findings.push_back(exact("the texture of a spot" + at_width(lanes),
                                     std::abs(seen.at(LIGHT_RADIANCE_R, 0) * distance2 - red) < tolerance &&
                                         std::abs(seen.at(LIGHT_RADIANCE_G, 0) * distance2 - green) < tolerance));
        }
        append(findings, projector_findings(sources, lanes));
        for (const KnownSpot &known : known_spots) {
            const emitter_spot spot{{}, {0, 0, 1}, {1, 1, 1}, known.cutoff, known.beam, false};
            const std::vector<double> found = falloffs(spot, spot_angles, lanes, sources);
            double worst = 0;
            for (size_t i = 0; i < found.size(); i++)
                // At the edge of a cone without transition the last bit of the direction decides.
                if (known.beam < known.cutoff || spot_angles[i] != known.cutoff)
                    worst = std::max(worst, std::abs(found[i] - known.falloff[i]));
            judge(spot, lanes, worst, tolerance);
        }
        for (const emitter_spot &spot : fine_spots) {
            const std::vector<double> found = falloffs(spot, fine_angles, lanes, sources);
            double worst = 0;
            for (size_t i = 0; i < found.size(); i++)
                worst = std::max(worst, std::abs(found[i] - falloff_of(spot, fine_angles[i])));
            const double steepest =
                spot.smooth ? 4 * 2 : 1; // the fourth power of a share that itself is twice as steep
            judge(spot, lanes, worst, steepest * rounding / ((spot.cutoff_angle - spot.beam_width) * radians));
        }
    }
    return findings;
}

namespace {

// The map of 8 x 4 pixels that Mitsuba was asked about.
std::shared_ptr<const EnvironmentMap> known_map() {
    Picture picture;
    picture.width = 8;
    picture.height = 4;
    picture.channels = 3;
    for (int y = 0; y < picture.height; y++)
        for (int x = 0; x < picture.width; x++)
            for (int value : {10 * (y + 1) + x, (x + 1) * (y + 1), 1 + (x * 7 + y * 3) % 5})
                picture.floats.push_back(float(value));
    return environment_of(std::move(picture), "known");
}

// What Mitsuba 3.9.1 sees in a direction: radiance, and the density of light sampling, without and with compensation.
struct KnownSky {
    Vec3 direction;
    Color radiance;
    double density = 0, compensated = 0;
};
const std::vector<KnownSky> known_sky = {
    {{0, 0, 1}, {28.5, 11.25, 3.75}, 0.07635018, 0.04712873},
    {{0, 0, -1}, {28.5, 11.25, 2.5}, 0.07587112, 0.1189347},
    {{1, 0, 0}, {26.5, 6.25, 2.25}, 0.05452739, 0},
    {{-1, 0, 0}, {30.5, 16.25, 2.75}, 0.09721486, 0.1379002},
    {{0, 1, 0}, {13.5, 4.5, 3}, 0, 0},
    {{0, -1, 0}, {43.5, 18, 4.5}, 0, 0},
    {{0.7071068, 0, 0.7071068}, {27.5, 8.749998, 2.999998}, 0.06543878, 0.01283047},
    {{-0.7071068, 0, 0.7071068}, {29.5, 13.75, 3.25}, 0.08678254, 0.08696876},
    {{0.7071068, 0, -0.7071068}, {25.5, 3.750001, 2.75}, 0.04409506, 0},
    {{-0.7071068, 0, -0.7071068}, {31.5, 18.75, 2.25}, 0.1076472, 0.2041644},
    {{0.2264554, 0.5661385, 0.7925939}, {22.39876, 7.981677, 4.393354}, 0.0666535, 0},
    {{-0.3487429, -0.9299811, 0.1162476}, {41.49565, 22.17205, 3.812952}, 0.1074242, 0.2136028},
    {{0.01009843, 0.999745, 0.02019687}, {13.12532, 3.993979, 2.325959}, 0.05483522, 0},
    {{0.09950372, 0, -0.9950372}, {27.61168, 9.029213, 2.626902}, 0.06648234, 0.08874854},
    {{-0.09950372, 0, -0.9950372}, {29.38831, 13.47078, 2.373098}, 0.08525991, 0.1491208},
    {{0.8571429, 0.4285714, -0.2857143}, {21.86085, 4.341732, 1.377021}, 0.04616025, 0},
    {{0.1464466, 0.9238795, -0.3535534}, {13.75, 1.375002, 2.125001}, 0.03107955, 4.938823e-08},
    {{0.3535534, 0.9238795, -0.1464466}, {14.75, 2.75, 2.25}, 0.03850272, 0},
    {{0.3535534, 0.9238795, 0.1464466}, {15.75, 4.125, 4.249999}, 0.04780369, 0},
    {{0.1464466, 0.9238795, 0.3535534}, {16.75, 5.500001, 3.125}, 0.05710468, 0},
    {{-0.1464466, 0.9238795, 0.3535534}, {17.75, 6.875, 3.25}, 0.06452788, 0},
    {{-0.3535534, 0.9238795, 0.1464466}, {18.75, 8.25, 2.125}, 0.07382887, 0},
    {{-0.3535534, 0.9238795, -0.1464466}, {19.75, 9.625, 2.25}, 0.08125207, 0.04347516},
    {{-0.1464466, 0.9238795, -0.3535534}, {20.75, 11, 4.25}, 0.09055302, 0.1035746},
    {{0.3535534, 0.3826834, -0.8535534}, {21.25, 2.125005, 3.75}, 0.03626769, 7.160711e-08},
    {{0.8535534, 0.3826834, -0.3535534}, {22.25, 4.250001, 1.375001}, 0.04524022, 0},
    {{0.8535534, 0.3826834, 0.3535534}, {23.25, 6.374999, 2.749999}, 0.05576836, 0},
    {{0.3535534, 0.3826834, 0.8535534}, {24.25, 8.500001, 4.75}, 0.06655578, 0.006943813},
    {{-0.3535534, 0.3826834, 0.8535534}, {25.25, 10.625, 2.375001}, 0.07552832, 0.01856207},
    {{-0.8535534, 0.3826834, 0.3535534}, {26.25, 12.75, 3.749999}, 0.0860565, 0.02850508},
    {{-0.8535534, 0.3826834, -0.3535534}, {27.25, 14.875, 1.375001}, 0.09502903, 0.08214196},
    {{-0.3535534, 0.3826834, -0.8535534}, {28.25, 17, 2.75}, 0.1055572, 0.1501709},
    {{0.3535534, -0.3826834, -0.8535534}, {28.75, 2.875007, 2.25}, 0.04789677, 1.739334e-07},
    {{0.8535534, -0.3826834, -0.3535534}, {29.75, 5.750001, 3.624999}, 0.06150794, 0},
    {{0.8535534, -0.3826834, 0.3535534}, {30.75, 8.624999, 1.250001}, 0.07356355, 0},
    {{0.3535534, -0.3826834, 0.8535534}, {31.75, 11.5, 3.250001}, 0.08743404, 0.04860669},
    {{-0.3535534, -0.3826834, 0.8535534}, {32.75, 14.375, 4.625}, 0.1010452, 0.1299345},
    {{-0.8535534, -0.3826834, 0.3535534}, {33.75, 17.25, 2.250001}, 0.1131009, 0.1995354},
    {{-0.8535534, -0.3826834, -0.3535534}, {34.75, 20.125, 3.624999}, 0.126712, 0.2868659},
    {{-0.3535534, -0.3826834, -0.8535534}, {35.75, 23, 1.25}, 0.1387676, 0.3647646},
    {{0.1464466, -0.9238795, -0.3535534}, {36.25, 3.625006, 3.874999}, 0.0451171, 1.729071e-07},
    {{0.3535534, -0.9238795, -0.1464466}, {37.25, 7.250001, 2.75}, 0.05813963, -1.494679e-09},
    {{0.3535534, -0.9238795, 0.1464466}, {38.25, 10.875, 2.874999}, 0.06928442, -1.969786e-08},
    {{0.1464466, -0.9238795, 0.3535534}, {39.25, 14.5, 1.750002}, 0.08230699, 0.05029154},
    {{-0.1464466, -0.9238795, 0.3535534}, {40.25, 18.125, 3.75}, 0.09532953, 0.1344384},
    {{-0.3535534, -0.9238795, 0.1464466}, {41.25, 21.75, 3.874999}, 0.1064743, 0.2064519},
    {{-0.3535534, -0.9238795, -0.1464466}, {42.25, 25.375, 2.75}, 0.1194969, 0.2905989},
    {{-0.1464466, -0.9238795, -0.3535534}, {43.25, 29, 2.874999}, 0.1306416, 0.3626122}};
// Scaled by 2 and turned by 90 degrees about y. At the poles Mitsuba itself is off by 3e-4.
const std::vector<KnownSky> known_turned_sky = {{{0, 0, 1}, {61, 32.5, 5.5}},
                                                {{0, 0, -1}, {53, 12.5, 4.5}},
                                                {{1, 0, 0}, {57, 22.5, 7.5}},
                                                {{-1, 0, 0}, {57, 22.5, 5}},
                                                {{0.7071068, 0, 0.7071068}, {59, 27.5, 6.5}},
                                                {{-0.7071068, 0, 0.7071068}, {63, 37.5, 4.5}}};

struct SkyErrors {
    double radiance = 0, density = 0; // the largest ones
};

SkyErrors errors_of(KernelProbe &probe, const std::vector<KnownSky> &known, bool compensated) {
    std::vector<Vec3> directions;
    for (const KnownSky &row : known)
        directions.push_back(normalize(row.direction));
    const Planes seen = probe.trace(rays_from({}, directions));
    SkyErrors errors;
    for (size_t i = 0; i < known.size(); i++) {
        for (size_t channel = 0; channel < 3; channel++)
            errors.radiance =
                std::max(errors.radiance, std::abs(seen.at(HIT_RADIANCE_R + channel, i) - known[i].radiance[channel]));
        errors.density = std::max(errors.density, std::abs(seen.at(HIT_LIGHT_DENSITY, i) -
                                                           (compensated ? known[i].compensated : known[i].density)));
    }
    return errors;
}

} // namespace

Findings check_environments(const Sources &sources, unsigned) {
    Findings findings;
    const auto judge = [&](const std::string &what, int lanes, double error, double limit) {
        findings.push_back(exact(fmt::format("{}{}, off by {:.1e}", what, at_width(lanes), error), error < limit));
    };
    for (int lanes : tested_lanes())
        for (const bool compensated : {false, true}) {
            SceneDescription scene;
            emitter_envmap light;
            light.map = known_map();
            light.mis_compensation = compensated;
            scene.lights = {{light, {}}};
            scene.strategy[AXIS_integrator] = CHOICE_integrator_path;
            scene.strategy[AXIS_lighting] = CHOICE_lighting_mis;
            KernelProbe probe = probe_of(flatten(scene, lanes), lanes, sources);
            const SkyErrors errors = errors_of(probe, known_sky, compensated);
            judge("radiance of an environment", lanes, errors.radiance, 2e-4); // of 47: 5e-6 of it
            judge("density of an environment", lanes, errors.density, 3e-6);

            // Without BSDF samples nothing is left out.
            scene.strategy[AXIS_lighting] = CHOICE_lighting_emitter;
            KernelProbe alone = probe_of(flatten(scene, lanes), lanes, sources);
            judge("its density without BSDF sampling", lanes, errors_of(alone, known_sky, false).density, 3e-6);

            light.scale = 2;
            light.to_world = Transform::rotate({0, 1, 0}, 90);
            scene.lights = {{light, {}}};
            KernelProbe turned = probe_of(flatten(scene, lanes), lanes, sources);
            judge("radiance of a turned one", lanes, errors_of(turned, known_turned_sky, false).radiance, 4e-4);
        }
    return findings;
}

// Samples of smooth metals and panes. Random numbers are right beside the reflectances that Mitsuba gives.
Findings check_metals(const Sources &sources, unsigned) {
    struct Sample {
        const char *type, *properties;
        Vec3 wi;
        float lobe; // random number
        Vec3 wo;
        Color weight;
    };
    const char *const gold = "<string name='material' value='Au'/>",
                      *const tinted = "<color name='specular_reflectance' value='0.5 0.25 1'/>"
                                      "<color name='specular_transmittance' value='0.75 1 0.125'/>";
    const Vec3 above{0.5, 0, 0.8660254}, below{0.5, 0, -0.8660254}, grazing{0.9254166, 0.3368241, 0.1736482};
    const Vec3 up{-0.5, 0, 0.8660254}, down{-0.5, 0, -0.8660254};
    const Sample samples[] = {
        {"conductor", gold, {0, 0, 1}, 0, {0, 0, 1}, {0.9666793, 0.8020099, 0.3241215}},
        {"conductor", gold, above, 0, up, {0.9664171, 0.8016297, 0.3261774}},
        {"conductor", gold, grazing, 0, {-0.9254166, -0.3368241, 0.1736482}, {0.9632077, 0.8755594, 0.5917323}},
        {"conductor", gold, below, 0, down, {0, 0, 0}},
        {"conductor", "", above, 0, up, {1, 1, 1}},
        {"thindielectric", "", above, 0.0807f, up, {1, 1, 1}}, // it reflects 0.08073905
        {"thindielectric", "", above, 0.0808f, down, {1, 1, 1}},
        {"thindielectric", "", below, 0.0807f, down, {1, 1, 1}},
        {"thindielectric", "", grazing, 0.5594f, {-0.9254166, -0.3368241, 0.1736482}, {1, 1, 1}}, // and 0.5594963
        {"thindielectric", "", grazing, 0.5596f, {-0.9254166, -0.3368241, -0.1736482}, {1, 1, 1}},
        {"thindielectric", tinted, above, 0, up, {0.5, 0.25, 1}},
        {"thindielectric", tinted, above, 0.9f, down, {0.75, 1, 0.125}},
        {"dielectric", tinted, above, 0, up, {0.5, 0.25, 1}},
        {"dielectric", tinted, below, 0.9f, {-0.7520916, 0, 0.6590585}, {0.75, 1, 0.125}},
    };
    std::vector<Bsdf> bsdfs;
    for (const Sample &sample : samples) {
        const XmlDocument document("a material",
                                   fmt::format("<bsdf type='{}'>{}</bsdf>", sample.type, sample.properties));
        bsdfs.push_back(parse_bsdf(document.root(), {}));
    }
    Findings findings;
    for (int lanes : tested_lanes()) {
        KernelProbe probe = probe_of(scene_of_bsdfs(bsdfs), lanes, sources);
        for (unsigned id = 0; id < bsdfs.size(); id++) {
            const Sample &sample = samples[id];
            Planes numbers(2 * OPAL_PROBE_PAIRS, 1);
            numbers.at(2, 0) = sample.lobe;
            const Planes drawn = probe.bsdf_sample(id, sample.wi, numbers);
            double error = length(drawn.vec3(BSDF_WO_X, 0) - sample.wo);
            for (size_t c = 0; c < 3; c++)
                error = std::max(error, std::abs(drawn.at(BSDF_WEIGHT_R + c, 0) - sample.weight[c]));
            findings.push_back(
                at_most("smooth metals and panes: direction and weight, off by", error, 2e-6,
                        fmt::format("{} {} by {}{}", sample.type, sample.properties, sample.lobe, at_width(lanes))));
            findings.push_back(exact("they are discrete", drawn.at(BSDF_DISCRETE, 0) == 1));
        }
    }
    return findings;
}

} // namespace opal::test
