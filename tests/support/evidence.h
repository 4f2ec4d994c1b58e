// Whole images judged by statistics; images that disagree are left on the disk.
#pragma once

#include "compare/evidence.h"

namespace opal::test {

struct Verdict {
    bool agrees = false;
    stats::TileTest test;
    std::string message; // the figures and, where they disagree, the folder of the evidence
};

// Welch's test per tile of two images with variance layers. On a rejection writes the evidence into
// $OPAL_EVIDENCE/<name>, or evidence/<name> in the working directory. Use:
//   Verdict v = same_picture("cbox_mis", estimated(image, spp), {reference, 6144, 47}, level);
//   INFO(v.message); CHECK(v.agrees);
struct Estimated {
    const Image &image;
    double samples; // a pixel
    double dof;     // of its variances
};
inline Estimated estimated(const Image &image, double spp) { return {image, spp, spp - 1}; }

Verdict same_picture(const std::string &name, const Estimated &image, const Estimated &reference, double significance,
                     const stats::TileOptions &options = {});

} // namespace opal::test
