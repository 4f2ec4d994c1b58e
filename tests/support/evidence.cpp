#include "support/evidence.h"

#include <cstdlib>

namespace opal::test {

Verdict same_picture(const std::string &name, const Estimated &image, const Estimated &reference, double significance,
                     const stats::TileOptions &options) {
    Verdict verdict;
    verdict.test = stats::tile_test(estimate_of(image.image, image.samples, image.dof),
                                    estimate_of(reference.image, reference.samples, reference.dof), options);
    verdict.agrees = !verdict.test.rejected(significance);
    verdict.message = name + ": " + describe(verdict.test);
    if (!verdict.agrees) {
        const char *root = std::getenv("OPAL_EVIDENCE");
        std::filesystem::path folder =
            std::filesystem::absolute(std::filesystem::path(root ? root : "evidence") / name);
        write_evidence(folder, image.image, reference.image, verdict.test);
        verdict.message += "; evidence in " + folder.string();
    }
    return verdict;
}

} // namespace opal::test
