// Whole images against references of another renderer, with their variances (../shared/references), tile by tile.
#include "base/json.h"
#include "read/nori/load.h"
#include "stats/hypothesis.h"
#include "support/checks.h"
#include "support/device.h"
#include "support/evidence.h"
#include "support/pictures.h"
#include "support/scratch.h"
#include "support/seeds.h"

#include <set>

using namespace opal;
using namespace opal::test;

namespace {

const std::filesystem::path shared = OPAL_SOURCE_DIR "/../shared";

constexpr unsigned spp = 64;
constexpr double reference_samples = 48 * 128, reference_dof = 47; // 48 batches of 128 samples a pixel

} // namespace

TEST_CASE("Pictures are those of the references, tile by tile", "[references][stat]") {
    if (!std::filesystem::exists(shared / "references/means.json")) {
        WARN("skipped: " << shared.string() << "/references is not there");
        return;
    }
    const nlohmann::json rows = nlohmann::json::parse(read_text(shared / "references/means.json"));
    std::set<std::string> seen;
    for (const auto &[name, row] : rows.items())
        seen.insert(row["image"].get<std::string>());
    const double level = stats::sidak_level(check_level, double(seen.size()));
    for (const auto &[name, row] : rows.items()) {
        const std::string file = row["image"];
        if (!seen.erase(file)) // rows of one expectation share an image: the first of them stands for all
            continue;
        SceneDescription scene = load_scene(shared / "scenes" / (name + ".xml"));
        scene.camera.width = row["size"][0];
        scene.camera.height = row["size"][1];
        // By the strategy of the least noise: a few thousand samples a tile that hardly ever meet a light prove
        // nothing.
        scene = with_strategy(scene, {{"lighting", "mis"}, {"mis", "power"}});
        scene.spp = spp;
        const Film film = render(scene, spp, test_seed(300));
        INFO(name);
        CHECK(film.invalid == 0);
        const Image image = image_of(film, true), reference = read_exr(shared / "references" / file);
        const Verdict verdict =
            same_picture("reference_" + std::filesystem::path(file).stem().string(), estimated(image, spp),
                         {reference, reference_samples, reference_dof}, level);
        INFO(verdict.message);
        CHECK(verdict.agrees);
    }
}

// A negative control: a picture 3 % too bright in one corner is found, and the evidence of it written.
TEST_CASE("A picture that is off is found and its evidence left", "[references][stat]") {
    const ScratchFolder folder;
    const std::filesystem::path file = shared / "references/importance_diffuse-cbox_pt_nee.exr";
    if (!std::filesystem::exists(file)) {
        WARN("skipped: " << file.string() << " is not there");
        return;
    }
    const Image reference = read_exr(file);
    Image off = reference;
    for (const char *channel : {"R", "G", "B"})
        for (Layer &layer : off.layers)
            if (layer.name == channel)
                for (int y = 0; y < 24; y++)
                    for (int x = 0; x < 24; x++)
                        layer.values[size_t(y) * size_t(off.width) + size_t(x)] *= 1.03f;
    setenv("OPAL_EVIDENCE", folder.path().c_str(), 1);
    const Verdict verdict = same_picture("off", {off, reference_samples, reference_dof},
                                         {reference, reference_samples, reference_dof}, check_level);
    unsetenv("OPAL_EVIDENCE");
    INFO(verdict.message);
    CHECK_FALSE(verdict.agrees);
    for (const char *what : {"image", "reference", "z", "p"})
        for (const char *ending : {".exr", ".png"})
            CHECK(std::filesystem::exists(folder / (std::string("off/") + what + ending)));
}
