// Negative controls of rendering: wrong kernels that the checks must reject.
#include "support/mutants.h"
#include "base/error.h"
#include "support/device.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

namespace {

const std::string light_hit = "v3_mul(path->throughput, light_met(scene, path, &s, on_surface, active))";
const std::string first_only = "to_real(uints_pick(to_mask(path->depth == 1u), (uints)(2), (uints)(1)))";

const std::vector<Control> furnaces = {
    {{"emitter counted twice at the first hit", "integrators/path.cl", light_hit,
      "v3_scale(" + light_hit + ", " + first_only + ")"},
     "furnace",
     check_furnace},
    {{"MIS weight left out where a light is hit", "integrators/steps.cl",
      "path->specular ? (real)(1) : mis_weight(scene, ratio)", "(real)(1)"},
     "furnace",
     check_furnace},
    {{"roulette without division", "integrators/steps.cl", "plays ? 1 / survival : (real)(1)", "(real)(1)"},
     "furnace",
     check_furnace},
    {{"roulette by another probability than it divides by", "integrators/steps.cl", "(u < survival)",
      "(u < square(survival))"},
     "furnace",
     check_furnace},
    {{"one segment too many", "integrators/path.cl", "to_mask(path->depth < scene->settings->max_depth)",
      "to_mask(path->depth <= scene->settings->max_depth)"},
     "furnace",
     check_furnace},
    {{"whitted's roulette without division", "integrators/whitted.cl",
      "specular ? 1 / survives.probability : (real)(1)", "(real)(1)"},
     "glass furnace",
     check_glass_furnace},
    {{"eta inverted in the scaling of radiance", "integrators/steps.cl", "1 / square(sample.eta)",
      "square(sample.eta)"},
     "glass furnace",
     check_glass_furnace},
    {{"rays leave on the normal's side always", "surface.cl", "copysign(s->ray_offset, v3_dot(s->normal, d))",
      "s->ray_offset"},
     "glass furnace",
     check_glass_furnace},
};

const std::vector<Control> lights = {
    {{"no cosine at the light", "emitters/area_light.cl", "inverse_pdf * fabs(v3_dot(normal, d)) *", "inverse_pdf *"},
     "triangle light",
     check_triangle_light},
    {{"no cosine at the receiver", "integrators/steps.cl", "light.radiance), fabs(wo.z) * inverse_pdf)",
      "light.radiance), inverse_pdf)"},
     "triangle light",
     check_triangle_light},
    {{"distance instead of its square", "emitters/area_light.cl", "* square(inverse_distance);", "* inverse_distance;"},
     "triangle light",
     check_triangle_light},
    {{"MIS weighs area against solid angle where a light is hit", "emitters/mesh.cl",
      "return pdf_of_hit(GATHER(real, scene->light_triangles, row, .inverse_pdf), d, s);",
      "return 1 / GATHER(real, scene->light_triangles, row, .inverse_pdf);"},
     "triangle light",
     check_triangle_light},
    {{"MIS by the light's density alone where a light is sampled", "integrators/steps.cl",
      "real ratio = bsdf.pdf * inverse_pdf;", "real ratio = inverse_pdf;"},
     "triangle light",
     check_triangle_light},
    {{"lights sampled from behind", "emitters/area_light.cl", "(v3_dot(shading_normal, to_light) < 0)",
      "(v3_dot(shading_normal, to_light) != 0)"},
     "triangle light",
     check_triangle_light},
    {{"lights seen from behind", "emitters/dispatch.cl", "on_light & ((s->wi.z > 0) | both_sides)", "on_light"},
     "triangle light",
     check_triangle_light},
    {{"one sample counted once", "integrators/direct_lighting.cl", "discrete ? (real)(1) : 1 / light.probability",
      "(real)(1)"},
     "triangle light",
     check_triangle_light},
    {{"spheres that shadow themselves as lights", "emitters/sphere.cl", "SHADOW_END_ROUNDINGS * EPSILON *",
      "0 * EPSILON *"},
     "sphere light",
     check_sphere_light},
    {{"sphere lights seen from the wrong side", "emitters/sphere.cl", "both | (inward ? view.inside : !view.inside)",
      "both | (inward ? !view.inside : view.inside)"},
     "sphere light",
     check_sphere_light},
    {{"MIS by another density of a sphere's inside", "emitters/sphere.cl", "return INV_TWO_PI /",
      "return 2 * INV_TWO_PI /"},
     "sphere light",
     check_sphere_light},
    {{"a point light twice as dense", "emitters/point.cl", "square(inverse_distance)), (real)(1), p,",
      "square(inverse_distance)), (real)(0.5f), p,"},
     "point light",
     check_point_light},
    {{"simple by the distance", "integrators/simple.cl", "cosine / distance2", "cosine * rsqrt(distance2)"},
     "point light",
     check_point_light},
    {{"one corner's normal taken twice", "shapes/triangle.cl", "v3_mad(vertex_normal(scene, corners.index[1]), u,",
      "v3_mad(vertex_normal(scene, corners.index[2]), u,"},
     "normals",
     check_smooth_normals},
};

const std::vector<Control> strategies = {
    {{"shadow rays that end half-way", "emitters/dispatch.cl", "(real)(0), (real)(1)};", "(real)(0), (real)(0.5f)};"},
     "agreement",
     check_agreement},
    {{"shadow rays that go on behind the light", "emitters/dispatch.cl", "(real)(0), (real)(1)};",
      "(real)(0), (real)(2)};"},
     "agreement",
     check_agreement},
    {{"emitters' choice left out of sampled light", "integrators/steps.cl", "light.inverse_pdf / choice.probability",
      "light.inverse_pdf"},
     "agreement",
     check_agreement},
    {{"a sky half as dense", "emitters/constant.cl", "color, 1 / square_to_uniform_sphere_pdf(d)",
      "color, 2 / square_to_uniform_sphere_pdf(d)"},
     "agreement",
     check_agreement},
    {{"a sky that is hit weighed as if it were not sampled", "emitters/constant.cl",
      "return square_to_uniform_sphere_pdf(d);", "return 0 * square_to_uniform_sphere_pdf(d);"},
     "agreement",
     check_agreement},
    {{"rays that escape meet no sky", "emitters/dispatch.cl", "*met = *met | escaped;", ""},
     "agreement",
     check_agreement},
    {{"shadow rays that end before the sky", "emitters/dispatch.cl", "light.infinite ? (real)(FAR)",
      "light.infinite ? (real)(0.3f)"},
     "agreement",
     check_agreement},
    {{"light behind mirrors and glass taken for sampled", "integrators/steps.cl", "path->specular = sample.discrete;",
      "path->specular = NO_LANES;"},
     "agreement",
     check_agreement},
    {{"light sampled at mirrors alone", "integrators/path.cl", "active & !bsdf_is_discrete(scene, s.bsdf)",
      "active & bsdf_is_discrete(scene, s.bsdf)"},
     "agreement",
     check_agreement},
    {{"occlusion without the uniform sample's cosine", "integrators/ao.cl", "cosine ? (real)(1) : 2 * wo.z",
      "(real)(1)"},
     "agreement",
     check_agreement},
};

const std::vector<Control> passing = {
    {{"a mask's light not times its opacity", "bsdfs/dispatch.cl", "r.f = v3_scale(r.f, s->opacity);", ""},
     "masks",
     check_masks},
    {{"a mask's density not times its opacity", "bsdfs/dispatch.cl", "r.pdf = r.pdf * drawn;", ""},
     "masks",
     check_masks},
    {{"masks passed without division", "bsdfs/dispatch.cl", "(1 - s->opacity) / meets.probability", "1 - s->opacity"},
     "masks",
     check_masks},
    {{"of nested masks the inner one alone", "bsdfs/mask.cl", "o.opacity * b.opacity", "b.opacity"},
     "masks",
     check_masks},
    {{"light behind masks taken for sampled", "bsdfs/interface.cl", "v3_all(weight), (real)(0), (real)(1), ALL_LANES)",
      "v3_all(weight), (real)(0), (real)(1), NO_LANES)"},
     "masks",
     check_masks},
    {{"mixed BSDFs followed as discrete ones by direct_lighting", "integrators/direct_lighting.cl",
      "by_bsdf = MIXED_BSDFS ? active : active & discrete", "by_bsdf = active & discrete"},
     "masks",
     check_masks},
    {{"the first of several hidden emitters passed", "integrators/steps.cl", "passing = passing & is_hit(hit);",
      "passing = NO_LANES;"},
     "hidden emitters",
     check_hidden_emitters},
    {{"a sky hidden from all that comes after", "integrators/steps.cl", "path->straight & sample.passes",
      "path->straight"},
     "hidden emitters",
     check_hidden_emitters},
    {{"a hidden sky behind null", "integrators/steps.cl", "path->straight & sample.passes", "NO_LANES"},
     "hidden emitters",
     check_hidden_emitters},
    {{"light samples weighed as one", "integrators/steps.cl", "ratio = ratio / light_samples_per_bsdf_sample(scene);",
      "ratio = ratio * 1;"},
     "sample counts",
     check_sample_counts},
    {{"BSDF samples weighed as one", "integrators/steps.cl", "ratio = ratio * light_samples_per_bsdf_sample(scene);",
      "ratio = ratio * 1;"},
     "sample counts",
     check_sample_counts},
    {{"BSDF samples added up", "integrators/direct_lighting.cl", "(real)(1 / (real1)scene->settings->bsdf_samples)",
      "(real)(1)"},
     "sample counts",
     check_sample_counts},
    {{"light samples added up", "integrators/direct_lighting.cl", "v3_scale(sum, (real)(1 / (real1)count))", "sum"},
     "sample counts",
     check_sample_counts},
    {{"throughput kept for the next BSDF sample", "integrators/direct_lighting.cl",
      "path->throughput = v3_pick(back, v3_all((real)(1)), path->throughput);", ""},
     "sample counts",
     check_sample_counts},
};

const std::vector<Control> choices = {
    {{"roulette by the survival that was wished for", "integrators/steps.cl",
      "drawn_probability(real_min(survival, (real)(scene->settings->rr_max)))",
      "real_min(survival, (real)(scene->settings->rr_max))"},
     "counted",
     check_counted},
    {{"what rounding takes from a path's sum is forgotten", "integrators/steps.cl",
      "path->lost = v3_sub(term, v3_sub(sum, path->radiance));", ""},
     "counted",
     check_counted},
    {{"weights by the probability that was wished for", "core/rng.cl", "c.probability = c.first ? drawn : 1 - drawn;",
      "c.probability = c.first ? p : 1 - p;"},
     "counted",
     check_counted},
    {{"one number more than the probability says", "core/rng.cl", "c.first = u < p;", "c.first = u < p + GRID_STEP;"},
     "counted",
     check_counted},
    {{"rows of an alias table by fewer bits", "emitters/alias_table.cl", "bits & 0xffffff00u", "bits & 0xfffffc00u"},
     "counted",
     check_counted},
};

const std::vector<Control> films = {
    {{"low parts of the sums dropped", "film/sums.cl", "r.lo = lo - (r.hi - hi);", "r.lo = 0;"}, "film", check_film},
    {{"what is not finite is kept", "film/sums.cl", "x = valid ? x : (real)(0);", ""}, "film", check_film},
    {{"infinity taken for finite", "core/math.cl", "to_mask((x & all) != all)", "to_mask((x & all) <= all)"},
     "film",
     check_film},
    {{"random numbers by the place in the pass", "kernels/many_lanes/path_starts.cl", "sample, scene->settings->seed",
      "sample - queue->pass_first, scene->settings->seed", true},
     "passes",
     check_passes},
    {{"one lane: another seed in each pass", "kernels/one_lane/path_starts.cl", "scene->settings->seed",
      "scene->settings->seed + queue->pass_first"},
     "passes",
     check_passes},
    {{"filters centred on the pixel's corner", "film/gather.cl", "v2_of(offset.x - R(0.5),", "v2_of(offset.x,"},
     "filters",
     check_filters},
    {{"Gaussian not lowered to 0 at its end", "film/filter.cl", " - exp(falloff * radius * radius)", ""},
     "filters",
     check_filters},
    {{"Mitchell's parts exchanged", "film/filter.cl", "t < 1 ? inner : outer", "t < 1 ? outer : inner"},
     "filters",
     check_filters},
    {{"filters draw by the pixel of the crop", "film/gather.cl",
      "(y + settings->film.top) * settings->width + (x + settings->film.left)", "y * settings->film.width + x"},
     "crops",
     check_crops},
    {{"filters that reach their own pixel alone", "film/gather.cl",
      "float reach = max(ceil(settings->filter_radius - 0.5f), 0.0f);", "float reach = 0;"},
     "filters",
     check_filters},
    {{"the image mirrored", "cameras/perspective.cl", "(1 - 2 * film.x)", "(2 * film.x - 1)"},
     "filters",
     check_filters},
};

} // namespace

TEST_CASE("A mutant whose text is not there is an error", "[mutants][long]") {
    const Mutant mutant{"none", "core/math.cl", "no such text", ""};
    CHECK_THROWS_WITH(mutated(Sources::embedded(), mutant),
                      Catch::Contains("mutant \"none\"") && Catch::Contains("cl/core/math.cl"));
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"many", "core/math.cl", "real", ""}), Error);
    CHECK_THROWS_AS(mutated(Sources::embedded(), {"nowhere", "maths.cl", "real", ""}), Error);
}

TEST_CASE("Every mutant that furnaces show is killed", "[mutants][stat][long]") {
    require_all_killed(furnaces, test_seed(30));
}
TEST_CASE("Every mutant of the lights is killed", "[mutants][stat][long]") {
    require_all_killed(lights, test_seed(31));
}
TEST_CASE("Every mutant of the strategies is killed", "[mutants][stat][long]") {
    require_all_killed(strategies, test_seed(32));
}
TEST_CASE("Every mutant of masks, hidden emitters and sample counts is killed", "[mutants][stat][long]") {
    require_all_killed(passing, test_seed(35));
}
TEST_CASE("Every mutant of discrete choices is killed", "[mutants][stat][long]") {
    require_all_killed(choices, test_seed(34));
}
TEST_CASE("Every mutant of the film is killed", "[mutants][stat][long]") { require_all_killed(films, test_seed(33)); }
