#include "base/error.h"
#include "base/memory.h"
#include "flatten/camera.h"
#include "flatten/distribution.h"
#include "flatten/emitter_kinds.h"
#include "flatten/emitters.h"
#include "flatten/face_list.h"
#include "flatten/features.h"
#include "flatten/geometry.h"
#include "flatten/plastic_boundary.h"
#include "flatten/store.h"
#include "flatten/textures.h"
#include "scene/filter.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <map>

namespace opal {
namespace {

// Pixels around a pixel, to each side, whose samples the filter weighs into it; at most the image's.
int filter_reach(const Filter &filter, const Crop &window) {
    return int(
        std::ceil(std::clamp<double>(filter_extent(filter) - 0.5, 0, std::max(window.of_width, window.of_height))));
}

// The crop, and around it the pixels within reach of the filter, as far as the image goes. Sums of the largest sizes
// take more than 32 bits.
PixelWindow film_window(const Crop &crop, std::int64_t reach) {
    const std::int64_t left = std::max<std::int64_t>(0, crop.x - reach),
                       top = std::max<std::int64_t>(0, crop.y - reach);
    const std::int64_t right = std::min<std::int64_t>(crop.of_width, reach + crop.x + crop.width),
                       bottom = std::min<std::int64_t>(crop.of_height, reach + crop.y + crop.height);
    return {uint(left), uint(top), uint(right - left), uint(bottom - top)};
}

// Throws Error at the filter if a pixel would gather the samples of so many others that it takes hours, which nothing
// interrupts.
void check_gathered(const Filter &filter, int reach, const PixelWindow &film) {
    constexpr uint most = 32 * 32;
    const uint wide = 2 * uint(reach) + 1, columns = std::min(wide, film.width), rows = std::min(wide, film.height);
    if (columns * std::uint64_t(rows) > most)
        throw Error(fmt::format("{}: {}: each pixel would gather the samples of {} x {} pixels; possible: a radius up "
                                "to 15.5",
                                filter.place.text(), filter_text(filter), columns, rows));
}

void fill_film(const Camera &camera, Settings &settings) {
    settings.width = uint(camera.width);
    settings.height = uint(camera.height);
    settings.filter = camera.filter.kind;
    settings.filter_radius = float(filter_extent(camera.filter));
    settings.filter_stddev = float(camera.filter.stddev);
    settings.filter_b = float(camera.filter.b);
    settings.filter_c = float(camera.filter.c);
    const int reach = filter_reach(camera.filter, camera.window());
    settings.film = film_window(camera.window(), reach);
    check_gathered(camera.filter, reach, settings.film);
}

void fill_strategy(const SceneDescription &description, const Flattening &flattening, Settings &settings) {
    const Strategy &strategy = description.strategy;
    settings.spp = description.spp;
    settings.max_depth = strategy.max_depth;
    settings.rr_depth = strategy.rr_depth;
    settings.rr_prob = float(drawn_probability(strategy.rr_prob));
    // Rounded as the device's numbers are, before it is put on their grid.
    const bool in_double = strategy.math == MathMode::double_precision;
    settings.rr_max = float(drawn_probability(in_double ? strategy.rr_max : double(float(strategy.rr_max))));
    const bool counts = integrator_of(strategy).has(OPAL_ONE_SAMPLE_MIS); // the others take one sample of each kind
    settings.emitter_samples = counts ? strategy.emitter_samples : 1;
    settings.bsdf_samples = counts ? strategy.bsdf_samples : 1;
    settings.lights_reflect = description.lights_reflect;
    settings.normals_signed = description.normals_signed;
    settings.visibility_length = float(description.visibility_length * flattening.scale);
    store((description.simple_light.position - flattening.center) * flattening.scale, settings.light_position);
    for (int i = 0; i < 3; i++)
        settings.light_energy[i] = float(description.simple_light.energy[i] * flattening.scale * flattening.scale);
    std::copy(strategy.choices.begin(), strategy.choices.end(), settings.choices);
}

// The words of a material after --hemisphere, so that the device need not read the option, and in flattened units.
std::vector<uint> flattened_words(const Bsdf &bsdf, int hemisphere, double scale) {
    if (bsdf.is<bsdf_bumpmap_record>()) {
        auto record = bsdf.as<bsdf_bumpmap_record>();
        record.scale.value = float(record.scale.value * scale);
        return words_of(record);
    }
    if (!bsdf.is<bsdf_diffuse_record>() || hemisphere == CHOICE_hemisphere_material)
        return bsdf.words;
    auto record = bsdf.as<bsdf_diffuse_record>();
    record.use_cosine = hemisphere == CHOICE_hemisphere_cosine;
    return words_of(record);
}

#define OPAL_TEXTURE_SIZE(name) sizeof(texture_##name##_record),
constexpr std::size_t longest_texture_record = std::max({OPAL_TEXTURES(OPAL_TEXTURE_SIZE)});

class BsdfGatherer {
public:
    // scale: of flattening
    BsdfGatherer(int hemisphere, double scale, TextureGatherer &textures, LargeVector<uint> &table)
        : hemisphere_(hemisphere), scale_(scale), textures_(textures), table_(table) {}

    // Returns the first word of the record. BSDFs come after those that they lead to. A twosided with one BSDF has it
    // on both sides.
    uint add(const Bsdf &bsdf) {
        std::vector<uint> words = flattened_words(bsdf, hemisphere_, scale_);
        auto child = bsdf.children.begin();
        for (const Parameter &parameter : bsdf_parameters(bsdf.kind()))
            if (parameter.type == ParameterType::BSDF) {
                words[parameter.word] = add(*child);
                if (child + 1 != bsdf.children.end())
                    ++child;
            }
        for (const auto &[word, texture] : bsdf.textures)
            words[word] = textures_.add(texture);
        if (bsdf.is<bsdf_plastic_record>())
            words[bsdf_parameter(BSDF_plastic, "boundary")->word] = add_boundary(bsdf.as<bsdf_plastic_record>());
        if (bsdf.is<bsdf_roughplastic_record>())
            words[bsdf_parameter(BSDF_roughplastic, "boundary")->word] =
                add_boundary(bsdf.as<bsdf_roughplastic_record>());
        const auto [found, is_new] = known_.try_emplace(words, uint(table_.size()));
        if (is_new)
            table_.insert(table_.end(), words.begin(), words.end());
        return found->second;
    }

private:
    int hemisphere_;
    double scale_;
    TextureGatherer &textures_;
    LargeVector<uint> &table_;
    std::map<std::vector<uint>, uint> known_;      // first word of each record
    std::map<std::vector<uint>, uint> boundaries_; // and of the numbers of each plastic without its colours

    template <class Plastic> uint add_boundary(Plastic plastic) {
        plastic.diffuse_reflectance = plastic.specular_reflectance = 0;
        plastic.nonlinear = 0;
        const auto [found, is_new] = boundaries_.try_emplace(words_of(plastic), uint(table_.size()));
        if (is_new)
            for (const float number : plastic_boundary(plastic))
                table_.push_back(std::bit_cast<uint>(number));
        return found->second;
    }
};

void gather_bsdfs(const SceneDescription &description, TextureGatherer &textures, FlatScene &scene) {
    BsdfGatherer gatherer(description.strategy[AXIS_hemisphere], scene.scale, textures, scene.bsdfs);
    for (const Mesh &mesh : description.meshes)
        scene.meshes.push_back({gatherer.add(mesh.bsdf), OPAL_NONE});
        // Lanes that are not meant read records of other kinds as far as the longest one reaches.
#define OPAL_BSDF_SIZE(name, traits) sizeof(bsdf_##name##_record),
    const std::size_t longest = std::max({OPAL_ALL_BSDFS(OPAL_BSDF_SIZE)});
    scene.bsdfs.resize(scene.bsdfs.size() + longest / sizeof(uint));
}

// Corners of the boxes of lights, of emitting triangles, and those of the boxes of other primitives that emit: every
// shadow ray ends at one of these points or in their convex hull. Nothing: there are lights that are infinitely far.
std::optional<std::vector<Point3f>> light_points(const SceneDescription &description, const Flattening &flattening,
                                                 const TriangleSoup &soup, const LargeVector<Triangle> &triangles) {
    std::vector<Point3f> points;
    for (const Light &light : description.lights) {
        if (is_infinite(light.kind()) && !is_black(light))
            return {};
        Extent extent;
        add_extent(light, extent);
        for (unsigned corner = 0; corner < 8 && !extent.empty(); corner++)
            points.push_back(flattening(extent.corner(corner)));
    }
    for (size_t id = 0; id < triangles.size(); id++)
        if (description.meshes[triangles[id].mesh].radiance)
            for (uint vertex : soup.corners[id])
                points.push_back(soup.vertices[vertex]);
    for (const BoundedPrimitive &other : soup.others)
        if (description.meshes[other.mesh].radiance)
            for (const Point3f &corner : other.box.corners())
                points.push_back(corner);
    return points;
}

void build_acceleration(TriangleSoup &soup, const std::optional<std::vector<Point3f>> &lights, bool with_face_list,
                        bool always_tree, FlatScene &scene) {
    const auto start = std::chrono::steady_clock::now();
    const std::vector<uint> ids = choose_face_list(soup);
    // Triangles are paired at every width: pairing renumbers corners, and sampled points of lights depend on their
    // order.
    std::vector<Face> faces = pair_up(ids, soup, scene);
    if (!with_face_list)
        faces.clear();
    if (always_tree || faces.empty() || ids.size() < soup.corners.size() || !soup.others.empty())
        build_tree(soup, faces, scene);
    list_faces(soup, std::move(faces), lights, scene);
    scene.bvh_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

FlatScene flatten(const SceneDescription &description, int lanes, bool with_face_list,
                  const std::function<void(uint)> &on_gathered,
                  const std::function<void(const Picture &)> &free_picture) {
    double triangles = 0;
    for (const Mesh &mesh : description.meshes)
        if (const auto *shape = std::get_if<TriangleMesh>(&mesh.shape))
            triangles += double(shape->triangles.size());
    constexpr double tree_bytes_a_triangle = 60, tree_reserve_a_triangle = 170; // measured, beside the description
    check_memory(tree_bytes_a_triangle * triangles, tree_reserve_a_triangle * triangles,
                 fmt::format("the tree of {} triangles", triangles));

    FlatScene scene;
    const Extent extent = extent_of(description);
    const Flattening flattening = find_flattening(extent);
    scene.center = flattening.center;
    scene.scale = flattening.scale;
    scene.cameras.push_back(flatten_camera(description.camera, flattening));
    scene.crop = description.camera.window();
    fill_film(description.camera, scene.settings);
    fill_strategy(description, flattening, scene.settings);
    TriangleSoup soup = gather_primitives(description, flattening, scene, on_gathered);
    TextureGatherer textures(scene.textures, soup.attributes);
    gather_bsdfs(description, textures, scene);
    build_acceleration(soup, light_points(description, flattening, soup, scene.triangles),
                       with_face_list && lanes >= FACE_LIST_LANES, description.strategy.is_general(), scene);
    gather_emitters(description, flattening, extent.radius(), soup, textures, scene);
    scene.texels = textures.texels(free_picture);
    scene.texture_kinds = textures.kinds();
    scene.bitmap_forms = textures.bitmap_forms();
    if (!scene.textures.empty()) // as of BSDFs
        scene.textures.resize(scene.textures.size() + longest_texture_record / sizeof(uint));
    scene.features = find_features(description, scene, lanes);
    return scene;
}

void add_bitmap(Texture &texture, std::vector<BitmapTexture *> &bitmaps) {
    if (auto *bitmap = std::get_if<BitmapTexture>(&texture))
        bitmaps.push_back(bitmap);
}

void add_bitmaps(Bsdf &bsdf, std::vector<BitmapTexture *> &bitmaps) {
    for (auto &[word, texture] : bsdf.textures)
        add_bitmap(texture, bitmaps);
    for (Bsdf &child : bsdf.children)
        add_bitmaps(child, bitmaps);
}

// All that share pictures.
std::vector<BitmapTexture *> bitmaps_of(SceneDescription &scene) {
    std::vector<BitmapTexture *> bitmaps;
    for (Mesh &mesh : scene.meshes) {
        add_bitmaps(mesh.bsdf, bitmaps);
        if (mesh.texture)
            add_bitmap(*mesh.texture, bitmaps);
    }
    for (Light &light : scene.lights)
        if (light.texture)
            add_bitmap(light.texture->texture, bitmaps);
    return bitmaps;
}

} // namespace

std::size_t FlatScene::tree_bytes() const {
    std::size_t bytes = nodes.size() * sizeof(BvhNode);
#define OPAL_ADD_BLOCKS(name, Block) bytes += name##_blocks.size() * sizeof(name##_blocks[0]);
    OPAL_SHAPES(OPAL_ADD_BLOCKS)
#undef OPAL_ADD_BLOCKS
    return bytes;
}

FlatScene flatten(const SceneDescription &scene, int lanes, bool with_face_list) {
    return flatten(scene, lanes, with_face_list, [](uint) {}, {});
}

FlatScene flatten_and_free(SceneDescription &scene, int lanes) {
    const std::vector<BitmapTexture *> bitmaps = bitmaps_of(scene);
    const auto free_mesh = [&](uint i) {
        if (auto *mesh = std::get_if<TriangleMesh>(&scene.meshes[i].shape))
            *mesh = {};
    };
    const auto free_picture = [&](const Picture &picture) {
        const auto size = std::make_shared<const Picture>(
            Picture{picture.width, picture.height, picture.channels, {}, {}, picture.encoded});
        for (BitmapTexture *bitmap : bitmaps)
            if (bitmap->picture.get() == &picture)
                bitmap->picture = size;
    };
    return flatten(scene, lanes, true, free_mesh, free_picture);
}

} // namespace opal
