// Ctrl-C: the binary writes what it has, says how much that is, and exits with a code of its own.
#include "base/signals.h"
#include "image/image.h"
#include "support/device.h"
#include "support/scratch.h"

#include <cmath>

using namespace opal;
using namespace opal::test;

TEST_CASE("An interrupted render leaves an image of the samples it finished", "[interrupt]") {
    const ScratchFolder folder;
    const std::string exr = folder / "out.exr", said = folder / "said.txt";
    // Interrupted once its progress shows that it renders; stopped by force should it not end. A shell's background job ignores
    // SIGINT unless it asks for it, as Opal does.
    const Outcome outcome = run_shell("timeout -k 1 120 " OPAL_BINARY " render " OPAL_SOURCE_DIR "/scenes/furnace.xml --width 64 --height 64 --spp 100000000 --no-png -o " +
                                      exr + " > " + said + " 2>&1 & job=$!\n"
                                      "for i in $(seq 600); do grep -q '^render' " + said + " && break; sleep 0.1; done\n"
                                      "pkill -INT -P $job; wait $job; exit $?");
    INFO(read_text(said));
    CHECK(outcome.exit_code == exit_interrupted);
    CHECK_THAT(read_text(said), Catch::Contains("interrupted: the image holds") && Catch::Contains("of 100000000 samples a pixel"));
    const Image image = read_exr(exr);
    CHECK(image.width == 64);
    CHECK(image.metadata.at("opal.invalid_samples") == "0");
    const double spp = std::stod(image.metadata.at("opal.spp"));
    CHECK(spp > 1);
    CHECK(spp < 1e8);
    double mean = 0;
    for (float value : image.get("G").values)
        mean += double(value) / double(image.get("G").values.size());
    CHECK(mean == Approx(0.5).epsilon(0.05));
}
