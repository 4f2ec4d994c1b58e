// Output that cannot be written: a lost message costs nothing else; a lost result is an error.
#include "base/json.h"
#include "base/printable.h"
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
    for (const std::string &command : {inspect, inspect + " --cl", std::string(OPAL_BINARY " --help"),
                                       std::string(OPAL_BINARY " --version"), std::string(OPAL_BINARY " version"),
                                       std::string(OPAL_BINARY " man"), std::string(OPAL_BINARY " completion bash"),
                                       std::string(OPAL_BINARY " devices"), std::string(OPAL_BINARY " warp --list")}) {
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
    CHECK(nlohmann::json::parse(read_text(json))["image"] == (folder / "b\\xe4r.exr").string());
    CHECK(dump({{"name", "\xc3\xa4"}}) == "{\"name\":\"\xc3\xa4\"}"); // what is UTF-8 stays
}

TEST_CASE("No name or value steers the terminal", "[printing]") {
    const ScratchFolder folder;
    const std::string wild = "a\x1b[31m\x07\x7f\u009b\u202e\x9b\n\xc0\xafz";
    const std::string shown = "a\\x1b[31m\\x07\\x7f\\u009b\\u202e\\x9b\\n\\xc0\\xafz";
    CHECK(in_one_line(printable(wild)) == shown);
    CHECK(printable("\xc3\xa4 \u2713 \U0001f600\tb\n") == "\xc3\xa4 \u2713 \U0001f600\tb\n"); // what is harmless stays
    for (const char *bytes :
         {"\xed\xa0\x80", "\xf4\x90\x80\x80", "\xe2\x82", "\xc1\x81"}) // surrogate, too large, cut, overlong
        CHECK(as_utf8(bytes).find_first_not_of("\\x0123456789abcdef") == std::string::npos);
    const auto is_harmless = [](const std::string &text) {
        return text.find_first_of("\x1b\x07\x7f\x9b") == std::string::npos && text.find("\u202e") == std::string::npos;
    };
    folder.write(wild + ".xml", "<scene><camera type='perspective'/><bsdf type='" + wild + "'/></scene>");
    const std::string good =
        folder.write("good.xml", "<scene><camera type='perspective'/><mesh type='parallelogram'>"
                                 "<string name='name' value='" +
                                     wild.substr(0, wild.find('\n')) +
                                     "'/><point name='origin' value='0 0 1'/><vector name='u' value='1 0 0'/>"
                                     "<vector name='v' value='0 1 0'/></mesh></scene>");
    for (const std::string &command :
         {"inspect '" + (folder / (wild + ".xml")).string() + "'", "inspect '" + good + "'",
          "inspect '" + good + "' --json -", "inspect '" + wild + "'", "'" + wild + "'",
          "render '" + wild + ".xml' -o '" + wild + "'", "compare '" + wild + "' b"}) {
        const Outcome outcome = run_shell(OPAL_BINARY " " + command);
        INFO(outcome.out << outcome.err);
        CHECK(is_harmless(outcome.out + outcome.err));
        CHECK(outcome.out + outcome.err != "");
    }
    const Outcome json = run_shell(OPAL_BINARY " inspect '" + good + "' --json -");
    const std::string name = nlohmann::json::parse(json.out)["meshes"][0]["name"];
    CHECK(name == "a\x1b[31m\x07\x7f\u009b\u202e\\x9b"); // in the JSON, all is there
}

TEST_CASE("No message repeats more than 200 bytes of an input", "[printing]") {
    const ScratchFolder folder;
    const std::string word(20'000'000, 'x'), start = "<scene><camera type='perspective'>", end = "</camera></scene>";
    std::string numbers;
    for (int i = 0; i < 1'000'000; i++)
        numbers += "1 ";
    folder.write("word.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nv 1 1 " + word.substr(0, 1'000'000) + "\n");
    const std::string mesh = "<mesh type='obj'><string name='filename' value='";
    for (const std::string &text :
         {start + "<float name='fov' value='" + word + "'/>" + end,
          start + "<float name='fov' value='" + numbers + "'/>" + end,
          start + "<float name='" + word + "' value='1'/>" + end,
          start + "<point name='fov' value='" + numbers + "'/>" + end,
          start + "<float name='" + numbers + "' value='1'/>" + end, start + "<" + word + "/>" + end,
          start + end.substr(0, 9) + "<integrator type='" + numbers + "'/></scene>",
          start + end.substr(0, 9) + mesh + word + "'/></mesh></scene>",
          start + end.substr(0, 9) + mesh + "word.obj'/></mesh></scene>",
          start + end.substr(0, 9) + "<mesh type='obj'><float name='radius' value='$" + word.substr(0, 100000) +
              "'/></mesh></scene>"}) {
        const std::string scene = folder.write("s.xml", text);
        const Outcome outcome = run_shell(OPAL_BINARY " inspect " + scene);
        INFO(outcome.err.substr(0, 3000));
        CHECK(outcome.exit_code == 1);
        CHECK(outcome.err.size() < 3000);
        CHECK(outcome.err.find(std::string(201, 'x')) == std::string::npos);
        CHECK(outcome.err.find(numbers.substr(0, 201)) == std::string::npos);
        CHECK_THAT(outcome.err, Catch::Contains("error: ") && Catch::Contains(" bytes ...]"));
    }
    CHECK(quoted("short") == "'short'");
    CHECK(shortened_message("it's not " + word + "'s").size() < 300);
    CHECK(shortened_message("a 'b' c\nd") == "a 'b' c\nd");
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
