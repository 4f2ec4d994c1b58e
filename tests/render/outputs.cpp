// Where renders write: inputs are safe, FIFOs and stdout get one file, and no image is lost that could be written.
#include "base/exit_code.h"
#include "base/json.h"
#include "image/image.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <sys/stat.h>

using namespace opal;
using namespace opal::test;
namespace fs = std::filesystem;

namespace {

// A folder with a scene, its mesh and the library of that.
struct Scene : ScratchFolder {
    Scene() {
        write("light.mtl", "newmtl grey\nKd 0.5 0.5 0.5\n");
        write("light.obj", "mtllib light.mtl\nv -9 -9 5\nv 9 -9 5\nv 0 9 5\nusemtl grey\nf 1 3 2\n");
        write("s.xml",
              "<scene><integrator type='path_mis'/><camera type='perspective'><integer name='width' value='8'/>"
              "<integer name='height' value='8'/></camera><mesh type='obj'><string name='filename' "
              "value='light.obj'/><boolean name='materials' value='true'/><emitter type='area'><color "
              "name='radiance' value='1 1 1'/></emitter></mesh></scene>");
    }
    std::string in(const std::string &command) const { return "cd " + path().string() + "; " + command; }
    std::string render(const std::string &arguments) const {
        return in(OPAL_BINARY " render s.xml --spp 1 --quiet " + arguments);
    }
    size_t files() const { return size_t(std::distance(fs::directory_iterator(path()), fs::directory_iterator())); }
};

bool is_exr(const std::string &bytes) { return bytes.starts_with("v/1\x01"); }

} // namespace

TEST_CASE("No output of a render is an input or another output", "[outputs]") {
    const Scene folder;
    fs::create_hard_link(folder / "light.obj", folder / "hard.exr");
    const size_t files = folder.files();
    for (const std::string arguments :
         {"--json s.xml", "--json light.obj", "--json light.mtl", "-o hard.exr", "-o o.exr --json o.exr",
          "-o o.exr --json o.png", "-o - --json -", "-o /dev/stdout --json -", "-o - --json /dev/stdout"}) {
        INFO(arguments);
        const Outcome outcome = run_shell(folder.render(arguments));
        INFO(outcome.err);
        CHECK(outcome.exit_code == exit_usage);
        CHECK(folder.files() == files);
    }
    CHECK(run_shell(folder.in("cp s.xml a.exr && " OPAL_BINARY " render a.exr -o a.exr")).exit_code == exit_usage);
    CHECK_THAT(read_text(folder / "a.exr"), Catch::StartsWith("<scene>"));
    fs::create_directory(folder / "out");
    fs::create_symlink("../b.xml", folder / "out/s.exr"); // a scene that is read after the first render
    CHECK(run_shell(folder.in("cp s.xml b.xml && " OPAL_BINARY " render s.xml b.xml --spp 1 -o out/")).exit_code ==
          exit_usage);
    CHECK(read_text(folder / "b.xml") == read_text(folder / "s.xml"));
    for (const std::string own :
         {"sweep s.xml -o out --json out/equal_time_1.exr", "sweep s.xml -o out --vary v=1,2 --json out/v=1/sweep.json",
          "verify s.xml -o out --json out/z.png", "verify s.xml -o out/ --json out/image.exr"})
        CHECK_THAT(run_shell(folder.in(OPAL_BINARY " " + own)).err, Catch::Contains("writes this file itself"));
}

TEST_CASE("stdout, a FIFO and a device get one file, in the format of the ending", "[outputs]") {
    const Scene folder;
    for (const std::string out : {"/dev/stdout", "/dev/fd/1", "-"}) {
        INFO(out);
        CHECK(is_exr(run_shell(folder.render("-o " + out + " | cat")).out));
        folder.write("log", "before\n");
        REQUIRE(run_shell(folder.render("-o " + out + " >> log")).exit_code == 0);
        CHECK(is_exr(read_text(folder / "log").substr(7)));
    }
    for (const char *name : {"fifo", "fifo.exr", "fifo.png"})
        REQUIRE(mkfifo((folder / name).c_str(), 0600) == 0);
    const size_t files = folder.files();
    for (const std::string name : {"fifo", "fifo.exr", "fifo.png"}) {
        const Outcome outcome = run_shell(folder.render("-o " + name + " & cat " + name + "; wait $!"));
        CHECK(outcome.exit_code == 0);
        CHECK((name == "fifo.png" ? outcome.out.starts_with("\x89PNG") : is_exr(outcome.out)));
    }
    CHECK(run_shell(folder.render("-o /dev/null")).exit_code == 0);
    CHECK(folder.files() == files);
}

TEST_CASE("One signal ends a wait for a FIFO's reader", "[outputs]") {
    const Scene folder;
    REQUIRE(mkfifo((folder / "fifo").c_str(), 0600) == 0);
    for (const auto &[signal, code] : {std::pair("INT", 130), {"TERM", 143}, {"HUP", 129}}) {
        // A message tells that Opal waits.
        const std::string script = std::string("(" OPAL_BINARY " render s.xml --spp 1 -o fifo 2>said; echo $? >code) & "
                                               "for i in $(seq 600); do grep -q 'waits for a reader' said && break; "
                                               "sleep 0.1; done; pkill -") +
                                   signal + " -P $!; wait";
        run_shell(folder.in(script));
        CHECK(read_text(folder / "code") == std::to_string(code) + "\n");
    }
}

TEST_CASE("If one of several files cannot be written, the others are, and the command fails", "[outputs]") {
    const Scene folder;
    for (const auto &[arguments, written] : {std::pair("-o o.exr --json /dev/full", std::vector{"o.exr", "o.png"}),
                                             {"-o /dev/full --json o.json", {"o.json"}}}) {
        const Outcome outcome = run_shell(folder.render(arguments));
        CHECK(outcome.exit_code == exit_failed);
        CHECK_THAT(outcome.err, Catch::Contains("error: /dev/full: cannot be written: No space left on device"));
        for (const char *name : written)
            CHECK(fs::file_size(folder / name) > 100);
    }
}

TEST_CASE("A render whose messages nobody reads, or whose terminal is closed, leaves its image", "[outputs]") {
    const Scene folder;
    const std::string render = OPAL_BINARY " render s.xml --spp 1 -o o.exr";
    for (const std::string &command : {render + " 2>&1 | head -n 1", render + " 2>/dev/full", render + " 2>&-",
                                       render + " <&- >&- 2>&-", "(trap '' PIPE; " + render + " 2>&1 | true)"}) {
        INFO(command);
        fs::remove(folder / "o.exr");
        run_shell(folder.in(command));
        for (int i = 0; i < 100 && !fs::exists(folder / "o.exr"); i++) // what stands behind the pipe ends first
            usleep(100'000);
        CHECK(read_exr(folder / "o.exr").width == 8);
    }
}

TEST_CASE("An image that a PNG cannot hold is refused before rendering", "[outputs]") {
    const Scene folder;
    std::string text = read_text(folder / "s.xml");
    text.replace(text.find("name='height' value='8'"), 23, "name='height' value='2000000'");
    text.replace(text.find("name='width' value='8'"), 22, "name='width' value='1'");
    folder.write("s.xml", text);
    const size_t files = folder.files();
    const Outcome outcome = run_shell(folder.render("-o o.exr --json o.json"));
    CHECK(outcome.exit_code == exit_failed);
    CHECK_THAT(outcome.err,
               Catch::Contains("o.png: a PNG holds at most 1000000 pixels a side") && Catch::Contains("give --no-png"));
    CHECK(folder.files() == files);
    CHECK(run_shell(folder.render("-o o.exr --no-png --crop 0,0,1,4")).exit_code == 0);
}

TEST_CASE("A sweep writes over nothing that it reads, by whatever name", "[outputs]") {
    const Scene folder;
    const std::string text = read_text(folder / "s.xml");
    folder.write("sweep.csv", text);
    folder.write("l/other.txt", "");
    fs::create_symlink("../s.xml", folder / "l/equal_time_1.exr");
    for (const std::string names : {"sweep.csv -o .", "s.xml -o l"}) {
        INFO(names);
        const Outcome outcome =
            run_shell(folder.in(OPAL_BINARY " sweep --width 8 --spp 1 --replicates 2 --quiet " + names));
        INFO(outcome.err);
        CHECK(outcome.exit_code == exit_usage);
        CHECK_THAT(outcome.err, Catch::Contains("would be both read and written"));
    }
    CHECK(read_text(folder / "s.xml") == text);
    CHECK(read_text(folder / "sweep.csv") == text);
}
