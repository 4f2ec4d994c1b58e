// Checks of rendering. A test runs them on Opal's kernels, which must pass; a negative control runs them on mutants
// (support/mutants.h), which must fail.
#pragma once

#include "device/context.h"
#include "device/sources.h"
#include "selftest/finding.h"

#include <functional>
#include <string>

namespace opal::test {

// A check at this level, split over its p-values (Sidak): a right kernel fails one check in a hundred thousand.
constexpr double check_level = 1e-5;
const Finding &worst(const Findings &findings); // the first that fails, else the smallest p-value
bool rejected(const Findings &findings);
std::string text_of(const Finding &finding);     // check, case, figure, limit
void require_all_pass(const Findings &findings); // CHECKs each, with what it is

// A comparison that holds or does not, without statistics.
Finding exact(const std::string &what, bool holds);

using Check = std::function<Findings(const Sources &sources, unsigned seed)>;

Findings check_furnace(const Sources &sources, unsigned seed);
Findings check_glass_furnace(const Sources &sources, unsigned seed);
Findings check_triangle_light(const Sources &sources, unsigned seed);
// Kernels of one scene, which leave out the last segments that meet no light that counts.
Findings check_last_segments(const Sources &sources, unsigned seed);
Findings check_sphere_light(const Sources &sources, unsigned seed); // and the furnace in a sphere
Findings check_point_light(const Sources &sources, unsigned seed);  // integrator simple, too
Findings check_smooth_normals(const Sources &sources, unsigned seed);

// Discrete choices are drawn with the probability that their weights state: to 1e-6, without statistics.
Findings check_counted(const Sources &sources, unsigned seed);

// Strategies with one expectation, each held against the others: path tracing in a room of all materials; direct light
// in a matte room, where direct_lighting, whitted and paths of two segments have one expectation; ambient occlusion.
Findings check_agreement(const Sources &sources, unsigned seed);

// Masks and null, hidden emitters, and several samples of a kind: known means in every strategy, by the general kernel;
// then by kernels of each scene, at one lane and at the device's width.
Findings check_masks(const Sources &sources, unsigned seed);
Findings check_hidden_emitters(const Sources &sources, unsigned seed);
Findings check_sample_counts(const Sources &sources, unsigned seed);
Findings check_masks_specialised(unsigned seed);
Findings check_hidden_emitters_specialised(unsigned seed);
Findings check_sample_counts_specialised(unsigned seed);

// The pixel filters: a constant picture, the sum of the weights, an edge whose blur is known.
Findings check_filters(const Sources &sources, unsigned seed);

// The film's sums against double on the host, for samples of very different size.
Findings check_film(const Sources &sources, unsigned seed);
// The end of a film of 2^28 pixels, or of as many rows of it as a buffer of the device has room for.
Findings check_largest_film();
// Passes cut differently: the same bits.
Findings check_crops(const Sources &sources, unsigned seed); // hold the bits of the whole image
Findings check_passes(const Sources &sources, unsigned seed);

} // namespace opal::test
