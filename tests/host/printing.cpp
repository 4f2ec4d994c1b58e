// Output that cannot be written: a lost message costs nothing else; a lost result is an error.
#include "base/json.h"
#include "image/image.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <sstream>

using namespace opal;
using namespace opal::test;
namespace fs = std::filesystem;

namespace {

const std::string inspect = OPAL_BINARY " inspect " OPAL_SOURCE_DIR "/scenes/cbox_mis.xml";

} // namespace

TEST_CASE("A result that stdout does not take is an error", "[printing]") {
    for (const std::string &command :
         {inspect, inspect + " --cl", std::string(OPAL_BINARY " --help"), std::string(OPAL_BINARY " --version"),
          std::string(OPAL_BINARY " warp --list")}) {
        INFO(command);
        const Outcome full = run_shell(command + " >/dev/full"), closed = run_shell(command + " >&-");
        CHECK(full.exit_code == 1);
        CHECK_THAT(full.err, Catch::EndsWith("error: stdout: cannot be written: No space left on device\n"));
        CHECK(closed.exit_code == 1);
        CHECK_THAT(closed.err, Catch::EndsWith("error: stdout: cannot be written: Bad file descriptor\n"));
    }
    const ScratchFolder folder;
    const Outcome limited = run_shell("ulimit -f 1; " + inspect + " >" + (folder / "result").string()); // SIGXFSZ
    CHECK(limited.exit_code == 1);
    CHECK_THAT(limited.err, Catch::EndsWith("error: stdout: cannot be written: File too large\n"));
}

TEST_CASE("A reader that has seen enough ends the command without a word", "[printing]") {
    const ScratchFolder folder;
    const std::string code = folder / "code";
    const Outcome outcome = run_shell("(" + inspect + " --cl; echo $? >" + code + ") | head -n 1");
    CHECK(outcome.out == "#define LANES " + outcome.out.substr(outcome.out.find_last_of(' ') + 1));
    CHECK(outcome.err.find("error") == std::string::npos);
    CHECK(read_text(code) == "1\n");
}

TEST_CASE("Messages that stderr does not take change nothing", "[printing]") {
    for (const std::string lost : {" 2>/dev/full", " 2>&-"}) {
        INFO(lost);
        const Outcome outcome = run_shell(inspect + lost);
        CHECK(outcome.exit_code == 0);
        CHECK(outcome.out == run_shell(inspect).out);
        CHECK(run_shell(OPAL_BINARY " inspect no-such.xml" + lost).exit_code == 1);
        CHECK(run_shell(inspect + " >/dev/full" + lost).exit_code == 1);
    }
}

TEST_CASE("Files are written where the figures cannot be printed, and hold no messages where all streams are closed",
          "[printing]") {
    const ScratchFolder folder;
    const std::string exr = folder / "image.exr", json = folder / "figures.json";
    write_exr(Image{1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}}, exr);
    for (const auto &[streams, code] :
         {std::pair(" >/dev/full", 1), {" 2>/dev/full", 0}, {" <&- >&- 2>&-", 1}, {" --quiet <&- >&- 2>&-", 0}}) {
        INFO(streams);
        CHECK(run_shell(OPAL_BINARY " compare " + exr + " " + exr + " --json " + json + streams).exit_code == code);
        CHECK(nlohmann::json::parse(read_text(json))["mse"] == 0);
        fs::remove(json);
    }
}

TEST_CASE("Bytes that are not UTF-8 cost no figures", "[printing]") {
    const ScratchFolder folder;
    const std::string name = folder / "b\344r.exr", json = folder / "figures.json";
    write_exr(Image{1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}}, name);
    REQUIRE(run_shell(OPAL_BINARY " compare " + name + " " + name + " --json " + json).exit_code == 0);
    CHECK(nlohmann::json::parse(read_text(json))["image"] == (folder / "b\uFFFDr.exr").string());
    CHECK(dump({{"name", "\xc3\xa4"}}) == "{\"name\":\"\xc3\xa4\"}"); // what is UTF-8 stays
}

// A direct call could throw because it cannot print, or lose a result because of a name.
TEST_CASE("Only host/base prints, writes JSON and reads files", "[printing]") {
    const auto offends = [](const std::string &line) {
        for (const char *word : {"fmt::print", "std::cout", "std::cerr", ".dump(", "ifstream"})
            if (line.find(word) != std::string::npos)
                return true;
        return false;
    };
    std::vector<std::string> offenders;
    for (const auto &entry : fs::recursive_directory_iterator(OPAL_SOURCE_DIR "/host")) {
        if (!entry.is_regular_file() || entry.path().parent_path().filename() == "base")
            continue;
        std::istringstream lines(read_text(entry.path()));
        for (std::string line; std::getline(lines, line);)
            if (offends(line))
                offenders.push_back(entry.path().filename().string() + ": " + line);
    }
    CHECK(offenders == std::vector<std::string>{});
    CHECK(offends("    std::cout << 1;"));
}
