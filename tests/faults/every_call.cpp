// Every error and signal at every system call that a render makes on its files, and SIGKILL at every call of a sweep.
// The calls are those of faults_preload.cpp. It leaves out pread, pwrite and ftruncate: only the lock of a sweep, and
// reading a descriptor that the user names, need them.
#include "base/json.h"
#include "support/faults.h"

#include <catch2/catch.hpp>

using namespace opal::test;
using nlohmann::json;

namespace {

// The figures of a sweep that no clock decides: those of its points.
void add_figures(const json &value, std::vector<double> &figures) {
    for (const auto &[key, inner] : value.items())
        if (inner.is_structured())
            add_figures(inner, figures);
        else if (key == "mse" || key == "rel_mse" || key == "mean_luminance")
            figures.push_back(inner);
}

std::vector<double> figures_of(const std::filesystem::path &folder) {
    std::vector<double> figures;
    const json record = json::parse(read_text(folder / "sweep.json"));
    for (const json &strategy : record["strategies"])
        add_figures(strategy["points"], figures);
    return figures;
}

} // namespace

TEST_CASE("Every error and every signal at every call leaves the old file or the new one", "[every_call][long]") {
    const FaultyRender render(GENERATE(false, true));
    for (const std::string &fault : fault_names())
        for (long call = 1; call <= render.calls(); call++)
            CHECK(render.broken_by(fault, call) == "");
}

TEST_CASE("A sweep that is killed at any call goes on to the same table", "[every_call][long]") {
    const ScratchFolder folder;
    const std::string scene = OPAL_SOURCE_DIR "/scenes/cbox_mis.xml", reference = folder / "reference.exr";
    REQUIRE(run_shell(OPAL_BINARY " render " + scene + " --width 8 --spp 64 --no-png -o " + reference).exit_code == 0);
    const auto sweep = [&](const std::filesystem::path &to) {
        return OPAL_BINARY " sweep " + scene + " --width 8 --spp 1,2 --replicates 2 --reference " + reference +
               " --strategies lighting=emitter lighting=mis -o " + to.string();
    };
    const std::filesystem::path whole = folder / "whole", cut = folder / "cut";
    REQUIRE(run_shell(with_fault(whole, "none", 0, folder / "log") + sweep(whole)).exit_code == 0);
    const std::vector<double> figures = figures_of(whole);
    REQUIRE(figures.size() >= 8);
    const long calls = lines_in(folder / "log");
    for (long call = 1; call <= calls; call++) {
        INFO("killed at call " << call);
        std::filesystem::remove_all(cut);
        const Outcome killed = run_shell(with_fault(cut, "KILL", call) + sweep(cut));
        CHECK((killed.exit_code == 137 || killed.exit_code == 0)); // 0: this run had fewer calls
        const Outcome resumed = run_shell(sweep(cut));
        INFO(resumed.err);
        CHECK(resumed.exit_code == 0);
        CHECK(figures_of(cut) == figures);
    }
}
