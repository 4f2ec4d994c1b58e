// opal scene-for: a scene around a mesh, to start from.
#include "base/error.h"
#include "base/log.h"
#include "commands/commands.h"
#include "read/obj.h"
#include "read/ply.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <numbers>

namespace opal {

namespace {

struct Model {
    std::string file, type; // "obj", "ply"
    ObjFile obj;            // of a PLY file the mesh alone
};

Model read_model(const std::string &file) {
    std::string extension = std::filesystem::path(file).extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(), [](unsigned char c) { return tolower(c); });
    if (extension != ".ply")
        return {file, "obj", read_obj(file, {})};
    Model model{file, "ply", {}};
    model.obj.mesh = read_ply(file, {});
    return model;
}

// A sphere that holds all models; `lowest`: their least y, which is up.
struct Bounds {
    Vec3 center;
    double radius = 0, lowest = 0;
};

Bounds bounds_of(const std::vector<Model> &models) {
    Extent extent;
    for (const Model &model : models)
        extent.add(model.obj.mesh.extent());
    if (extent.empty())
        throw Error(models[0].file + ": there is nothing to see: no triangles");
    Bounds bounds{extent.middle(), 0, extent.lo.y};
    for (const Model &model : models)
        for (Vec3 p : model.obj.mesh.positions)
            bounds.radius = std::max(bounds.radius, length(p - bounds.center));
    return bounds;
}

// The direction at these angles, in degrees: azimuth from +z towards +x, elevation from there towards +y.
Vec3 direction(double azimuth, double elevation) {
    const double a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

// Coordinates to a thousandth of `size`.
std::string text_of(Vec3 p, double size) {
    const double step = std::pow(10, std::floor(std::log10(size))) / 1000;
    const auto number = [step](double x) {
        const double rounded = std::round(x / step) * step;
        const double digits = rounded == 0 ? 1 : std::log10(std::abs(rounded) / step) + 1.5;
        return fmt::format("{:.{}g}", rounded == 0 ? 0 : rounded, std::clamp(int(digits), 1, 17));
    };
    return fmt::format("{} {} {}", number(p.x), number(p.y), number(p.z));
}

// The value of an attribute.
std::string escaped(const std::string &text) {
    std::string escaped;
    for (char c : text)
        if (c == '&' || c == '<' || c == '>' || c == '"' || (static_cast<unsigned char>(c) < ' '))
            escaped += fmt::format("&#{};", int(c));
        else
            escaped += c;
    return escaped;
}

constexpr int width = 800, height = 600;
constexpr double fov = 30; // of the width, in degrees
constexpr double azimuth = 35, elevation = 20;

// So far away that the sphere fills nine tenths of the image's height.
double camera_distance(double radius) {
    const double half_height = std::atan(std::tan(fov / 2 * std::numbers::pi / 180) * height / width);
    return radius / (0.9 * std::sin(half_height));
}

std::string camera_text(const Bounds &bounds) {
    const double distance = camera_distance(bounds.radius);
    return fmt::format(
        R"(  <!-- The camera stands at `origin` and looks at `target`. fov is the angle that the image's width spans, in
       degrees. Nothing nearer than nearClip or beyond farClip is seen. -->
  <camera type="perspective">
    <transform name="toWorld">
      <lookat origin="{}" target="{}" up="0 1 0"/>
    </transform>
    <float name="fov" value="{:g}"/>
    <float name="nearClip" value="{:.2g}"/>
    <float name="farClip" value="{:.2g}"/>
    <integer name="width" value="{}"/>
    <integer name="height" value="{}"/>
    <rfilter type="gaussian"/>
  </camera>
)",
        text_of(bounds.center + direction(azimuth, elevation) * distance, bounds.radius),
        text_of(bounds.center, bounds.radius), fov, distance / 100, distance * 100, width, height);
}

std::string model_text(const Model &model) {
    const bool materials = !model.obj.materials.empty() && !model.obj.libraries.empty();
    return fmt::format(R"(  <mesh type="{}">
    <string name="filename" value="{}"/>
{}  </mesh>
)",
                       model.type, escaped(model.file),
                       materials ? R"(    <!-- The OBJ file's own materials. A <bsdf> here would replace them. -->
    <boolean name="materials" value="true"/>
)"
                                 : R"(    <!-- Other materials: mirror, dielectric, microfacet, phong. -->
    <bsdf type="twosided">
      <bsdf type="diffuse"><color name="albedo" value="0.7 0.7 0.7"/></bsdf>
    </bsdf>
)");
}

// A square, seen from its front, with side 2 `half`.
std::string square_text(Vec3 center, Vec3 front, double half, double size, const std::string &more) {
    const Vec3 u = normalize(std::abs(front.y) < 0.9 ? cross({0, 1, 0}, front) : Vec3{1, 0, 0}), v = cross(front, u);
    return fmt::format(R"(  <mesh type="parallelogram">
    <point name="origin" value="{}"/> <vector name="u" value="{}"/> <vector name="v" value="{}"/>
{}  </mesh>
)",
                       text_of(center - (u + v) * half, size), text_of(u * (2 * half), size),
                       text_of(v * (2 * half), size), more);
}

// Sizes, distances and radiances are such that the picture is lit in the same way whatever the model's size: what
// arrives depends on ratios alone.
std::string scene_text(const std::vector<Model> &models) {
    const Bounds bounds = bounds_of(models);
    const double r = bounds.radius;
    std::string text = R"(<scene>
  <!-- Written by `opal scene-for`. To render it: opal SCENE.xml; all that can stand here: scenes/README.md of Opal. -->

  <!-- How light is found: paths, by samples of lights and materials both, weighed by multiple importance sampling. -->
  <integrator type="path_mis"/>

  <!-- Samples a pixel: four times as many halve the noise. -->
  <sampler type="independent"><integer name="sampleCount" value="64"/></sampler>

)" + camera_text(bounds) +
                       R"(
  <!-- What is seen. The file is looked for beside this one, then in the current folder. -->
)";
    for (const Model &model : models)
        text += model_text(model);
    const Vec3 floor = {bounds.center.x, bounds.lowest - 1e-3 * r, bounds.center.z};
    text += R"(
  <!-- A floor. It lies a little below the model, as coincident surfaces would hide each other. -->
)" +
            square_text(floor, {0, 1, 0}, 20 * r, r,
                        R"(    <bsdf type="diffuse"><color name="albedo" value="0.5 0.5 0.5"/></bsdf>
)") + R"(
  <!-- A lamp, to the left of the camera and above. It shines on one side, that of u x v. -->
)";
    const Vec3 to_lamp = direction(azimuth - 50, 50);
    text += square_text(bounds.center + to_lamp * (5 * r), to_lamp * -1, r, r,
                        R"(    <bsdf type="diffuse"><color name="albedo" value="0 0 0"/></bsdf>
    <emitter type="area"><color name="radiance" value="14 14 14"/></emitter>
)");
    return text + R"(
  <!-- A sky, equally bright in all directions: it lights the shadows. -->
  <emitter type="constant"><color name="radiance" value="0.35 0.35 0.35"/></emitter>
</scene>
)";
}

int run(const std::vector<std::string> &files) {
    std::vector<Model> models;
    for (const std::string &file : files) {
        if (file.find('\\') != std::string::npos)
            throw Error(file + ": a scene cannot name this file: a backslash separates folders there");
        models.push_back(read_model(file));
    }
    print_data(scene_text(models));
    return 0;
}

} // namespace

Command scene_for_command() {
    auto files = std::make_shared<std::vector<std::string>>();
    return {
        .name = "scene-for",
        .help = "Print a scene that shows a mesh, to start from: opal scene-for MODEL.obj > SCENE.xml",
        .options =
            {{.flags = "MODEL.obj",
              .target = files.get(),
              .help = "Meshes to show, OBJ or PLY. Their paths are written into the scene as you type them: give them "
                      "relative to its folder",
              .required = true,
              .many_words = true}},
        .examples = {"opal scene-for model.obj > scene.xml", "opal scene-for cup.obj saucer.obj > scene.xml"},
        .run = [files] { return run(*files); }};
}

} // namespace opal
