// Whole images judged by statistics; what disagrees is left on the disk.
#pragma once

#include "commands/evidence.h"

namespace opal::test {

struct Verdict {
    bool agrees = false;
    stats::TileTest test;
    std::string message; // the figures and, where they disagree, the folder of the evidence
};

// Welch's test per tile of two images with variance layers. On a rejection writes the evidence into
// $OPAL_EVIDENCE/<name>, or evidence/<name> in the working directory. Use:
//   Verdict v = same_picture("cbox_mis", image, spp - 1, reference, 47, level);
//   INFO(v.message); CHECK(v.agrees);
Verdict same_picture(const std::string &name, const Image &image, double image_dof, const Image &reference,
                     double reference_dof, double significance, const stats::TileOptions &options = {});

} // namespace opal::test
