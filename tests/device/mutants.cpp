// Negative controls of the kernels' functions: wrong ones that the checks must reject.
#include "support/device.h"
#include "support/kernel_checks.h"
#include "support/mutants.h"
#include "support/seeds.h"

using namespace opal;
using namespace opal::test;

namespace {

const std::vector<Control> numbers = {
    {{"numbers that may be 1", "rng.cl", "to_real(bits >> 8) * GRID_STEP", "to_real(bits) * R(2.3283064365386963e-10)"}, "known numbers", check_known_numbers},
    {{"Sobol's second dimension mirrored", "rng.cl", "(x & 0x55555555u) << 1;\n    x ^= (x & 0x33333333u) << 2", "(x & 0xaaaaaaaau) >> 1;\n    x ^= (x & 0xccccccccu) >> 2"}, "Sobol", check_sobol},
    {{"scramble from the lowest bit", "rng.cl", "x ^= x * 0x53a22864u;\n    return reverse_bits(x);", "x ^= x * 0x53a22864u;\n    return x;"}, "Sobol", check_sobol},
    {{"a permutation that repeats", "rng.cl", "return (r + turn % n) % n;", "return (r & ~1u) % n;"}, "stratified", check_stratified},
    {{"strata turned by the bits that shuffle them", "rng.cl", "return (r + turn % n) % n;", "return (r + p % n) % n;"}, "stratified", check_stratified},
    {{"strata in one order for all dimensions", "rng.cl", "u3 h = pcg3d(s.pixel, dimension, (uints)(seed) ^ (round * 0x85ebca6bu));", "u3 h = pcg3d(s.pixel, (uints)(0), (uints)(seed) ^ (round * 0x85ebca6bu));"},
     "stratified", check_stratified},
    {{"one jitter for all dimensions", "rng.cl", "u3 jitter = pcg3d(s.key0, s.key1, dimension);", "u3 jitter = pcg3d(s.key0, s.key1, (uints)(0));"}, "independence", check_independence},
    {{"neighbouring pixels share numbers", "rng.cl", "uints x = pixel, y = sample, z", "uints x = pixel >> 1, y = sample, z"}, "independence", check_independence},
    {{"the seed is ignored", "rng.cl", "z = (uints)(seed), w", "z = (uints)(seed * 0u), w"}, "independence", check_independence},
};

constexpr bool of_many_lanes = true;

const std::vector<Control> hits = {
    {{"children beyond tmin are dropped", "bvh.cl", "} while (w->nearest > w->limit);", "} while (w->nearest > key_of(4 * rays->tmin[w->at.lane] + R(0.3)));", of_many_lanes}, "tree", check_tree},
    {{"any-hit enters one child of each node", "bvh.cl", "w->at.top += w->met != 0;", "", of_many_lanes},
     "tree", check_tree},
    {{"far bound ignored in leaves", "triangle.cl", "real8 bound = ray->tmax *", "real8 bound = R(1e30) *", of_many_lanes}, "tree", check_tree},
    {{"near bound ignored in leaves", "triangle.cl", "test.distance > ray->tmin * test.determinant ?", "test.distance > 0 ?", of_many_lanes}, "tree", check_tree},
    {{"back faces culled", "triangle.cl", " | real8_max(a, real8_max(b, c)) <= 0", "", of_many_lanes}, "tree", check_tree},
    {{"last hit instead of nearest", "bvh.cl", "candidate & (distance * best->determinant < best->distance * determinant)", "candidate & (distance < R(1e30) * determinant)", of_many_lanes}, "tiny", check_tiny},
    {{"barycentric weights swapped", "surface.cl", "v3_cross(e1, w)", "v3_cross(e2, w)", of_many_lanes}, "tiny", check_tiny},
    {{"a quadrilateral's second triangle taken for its first", "bvh.cl", "positive ? bc < 0 : bc > 0};", "NO_LANES};", of_many_lanes}, "tiny", check_tiny},
    {{"listed faces met from one side only", "bvh.cl", "{turned_as(distance, determinant), fabs(determinant),", "{distance, determinant,", of_many_lanes}, "tiny", check_tiny},
    {{"far bound ignored by any-hit", "bvh.cl", " & (test.distance < ray.tmax * test.determinant));", ");", of_many_lanes}, "tiny", check_tiny},
    {{"edges belong to no triangle", "triangle.cl", "real8_min(a, real8_min(b, c)) >= 0 | real8_max(a, real8_max(b, c)) <= 0", "real8_min(a, real8_min(b, c)) > 0 | real8_max(a, real8_max(b, c)) < 0", of_many_lanes},
     "watertight", check_watertight},
    {{"boxes a little small", "bvh.cl", "v3_scale(inverse, (real)(1 + 8 * EPSILON))", "v3_scale(inverse, (real)(1 - 1000 * EPSILON))", of_many_lanes}, "watertight", check_watertight},
    {{"one lane: a node's other children forgotten", "one_lane/walk.cl", "if (order != NO_CHILDREN) {", "if (order == NO_CHILDREN) {"}, "tree", check_tree},
    {{"one lane: far bound ignored by any-hit", "one_lane/walk.cl", " || !(test.distance < tmax * test.determinant)) continue;", ") continue;"}, "tree", check_tree},
    {{"one lane: near bound ignored in leaves", "one_lane/walk.cl", "!(test.distance > r->tmin * test.determinant)", "!(test.distance > 0)"}, "tree", check_tree},
    {{"one lane: last hit of a block instead of nearest", "one_lane/walk.cl", "if (!(t < r->tmax)) continue;", ""}, "tree", check_tree},
    {{"one lane: back faces culled", "one_lane/walk.cl", " || fmax(a, fmax(b, c)) <= 0", ""}, "tree", check_tree},
    {{"one lane: weights of a triangle's corners exchanged", "one_lane/walk.cl", "fabs(sum), fabs(b), fabs(c),", "fabs(sum), fabs(c), fabs(b),"}, "tree", check_tree},
    {{"one lane: the last of a node's children left out", "one_lane/walk.cl", "uint end = 1u << 3 * count;", "uint end = 1u << 3 * min(count, 3u);"}, "tree", check_tree},
    {{"one lane: edges belong to no triangle", "one_lane/walk.cl", "fmin(a, fmin(b, c)) >= 0 || fmax(a, fmax(b, c)) <= 0", "fmin(a, fmin(b, c)) > 0 || fmax(a, fmax(b, c)) < 0"},
     "watertight", check_watertight},
    {{"one lane: boxes a little small", "one_lane/walk.cl", "v3_scale(inverse, 1 + 8 * EPSILON)", "v3_scale(inverse, 1 - 1000 * EPSILON)"}, "watertight", check_watertight},
};

const std::vector<Control> densities = {
    {{"cosine hemisphere without the cosine", "warp.cl", "direction_of(sqrt(1 - u.x), sqrt(u.x), u.y)", "direction_of(1 - u.x, sqrt(u.x * (2 - u.x)), u.y)"}, "warps", check_warps},
    {{"cosine density 2 % too large", "warp.cl", "return real_max(w.z, (real)(0)) * INV_PI;", "return real_max(w.z, (real)(0)) * (INV_PI * R(1.02));"}, "warps", check_warps},
    {{"tent 2 % narrower", "warp.cl", "return v2_of(tent_1d(u.x), tent_1d(u.y));", "return v2_of(R(0.98) * tent_1d(u.x), tent_1d(u.y));"}, "warps", check_warps},
    {{"disk without the root", "warp.cl", "real r = sqrt(u.x);", "real r = u.x;"}, "warps", check_warps},
    {{"Beckmann without its last cosine", "warp.cl", "* q * q * (q * alpha)", "* q * q"}, "warps", check_warps},
    {{"Phong lobe drawn by n", "warp.cl", "log(u.x) / (n + 1)", "log(u.x) / n"}, "warps", check_warps},
    {{"cosine dropped from the uniform weight", "bsdfs/diffuse.cl", "b.use_cosine ? (real)(1) : 2 * wo.z", "b.use_cosine ? (real)(1) : (real)(1)"}, "BSDFs", check_bsdfs},
    {{"half vector's Jacobian halved", "bsdfs/microfacet.cl", "real coat = square_to_beckmann_pdf(h, b.alpha) / (4 *", "real coat = square_to_beckmann_pdf(h, b.alpha) / (2 *"}, "BSDFs", check_bsdfs},
    {{"Phong's parts in each other's share", "bsdfs/phong.cl", "real density = b.base_chance * square_to_cosine_hemisphere_pdf(wo) + (1 - b.base_chance)", "real density = (1 - b.base_chance) * square_to_cosine_hemisphere_pdf(wo) + b.base_chance"},
     "BSDFs", check_bsdfs},
    {{"Phong's lobe about the viewer", "bsdfs/phong.cl", "Frame mirrored = frame_of(reflect_z(wi));", "Frame mirrored = frame_of(wi);"}, "BSDFs", check_bsdfs},
    {{"shadowing of one side only", "bsdfs/microfacet.cl", "microfacet_g1(wi, h, b.alpha) * microfacet_g1(wo, h, b.alpha)", "microfacet_g1(wi, h, b.alpha)"}, "albedos", check_albedos},
    {{"coat's indices swapped", "bsdfs/microfacet.cl", "boundary_of(b.ext_ior, b.int_ior)", "boundary_of(b.int_ior, b.ext_ior)"}, "albedos", check_albedos},
    {{"Phong's density by the share that was wished for", "bsdfs/phong.cl", "GATHER(real, scene->bsdfs, id, .u.phong.n), drawn_probability(pd)};", "GATHER(real, scene->bsdfs, id, .u.phong.n), pd};"}, "choices", check_choices},
    {{"the coat's density by the share that was wished for", "bsdfs/microfacet.cl", "ks, drawn_probability(ks),", "ks, ks,"}, "choices", check_choices},
    {{"albedo off by 2 %", "bsdfs/diffuse.cl", "v3_scale(b.albedo, wi.z > 0 ? weight : (real)(0))", "v3_scale(b.albedo, wi.z > 0 ? weight * R(1.02) : (real)(0))"}, "albedos", check_albedos},
    {{"eta inverted", "bsdfs/dielectric.cl", "real near = outside ? b.ext_ior : b.int_ior, far = outside ? b.int_ior : b.ext_ior;", "real near = outside ? b.int_ior : b.ext_ior, far = outside ? b.ext_ior : b.int_ior;"},
     "refraction", check_refraction},
    {{"Snell's law inverted", "fresnel.cl", "safe_sqrt(1 - sin2 * square(b.inverse_eta))", "safe_sqrt(1 - sin2 * square(b.eta))"}, "refraction", check_refraction},
    {{"one polarisation only", "fresnel.cl", "R(0.5) * (r_s * r_s + r_p * r_p)", "(r_s * r_s)"}, "refraction", check_refraction},
    {{"emitter's alias kept where it should be left", "emitter.cl", "mask kept_ = unit_real((u).y) < GATHER", "mask kept_ = unit_real((u).y) >= GATHER"},
     "emitters", check_emitters},
    {{"triangle's alias never taken", "emitters/mesh.cl", "ALIAS_ENTRY(scene, light_triangles, first, count, triangle, row)", "row = first + alias_row(triangle.x, count);"}, "emitters", check_emitters},
    {{"the triangle's half of the square alone", "emitters/mesh.cl", "real u = folded ? 1 - point.x : point.x, v = folded ? 1 - point.y : point.y;", "real u = point.x, v = point.y * (1 - point.x);"}, "emitters",
     check_emitters},
    {{"density of the mesh for that of the triangle", "emitters/mesh.cl", "GATHER(real, scene->light_triangles, row, .area)", "GATHER(real, scene->emitters, id, .area)"}, "emitters", check_emitters},
    {{"emitters' choice left out of the density", "emitter.cl", "return pdf * emitter_probability(scene, id);", "return pdf;"}, "emitters", check_emitters},
    {{"light's normal reversed", "emitters/parallelogram.cl", "GATHER_V3(scene->emitters, id, .normal);", "v3_neg(GATHER_V3(scene->emitters, id, .normal));"}, "emitters", check_emitters},
    {{"a coefficient of the sine", "math.cl", "R(8.3333333333333333e-03)", "R(8.333e-03)"}, "turns", check_trigonometry},
};

} // namespace

TEST_CASE("Every mutant of the random numbers is killed", "[mutants]") { require_all_killed(numbers, test_seed(140)); }
TEST_CASE("Every mutant of the intersection is killed", "[mutants]") { require_all_killed(hits, test_seed(141)); }
TEST_CASE("Every mutant of what is drawn is killed", "[mutants]") { require_all_killed(densities, test_seed(142)); }
