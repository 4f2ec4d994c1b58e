// Files that commands write: never an input, never two in one, through links and descriptors, whole or not at all.
#include "base/exit_code.h"
#include "base/file_use.h"
#include "image/image.h"
#include "support/error_of.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <thread>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

using namespace opal;
using namespace opal::test;
namespace fs = std::filesystem;

namespace {

// A folder with two images, a.exr and b.exr.
struct Images : ScratchFolder {
    Images() {
        for (const char *name : {"a.exr", "b.exr"})
            write_exr(Image{1, 1, {{"R", {1}}, {"G", {1}}, {"B", {1}}}, {}}, *this / name);
    }
    std::string compare(const std::string &arguments) const {
        return "cd " + path().string() + " && " OPAL_BINARY " compare --quiet " + arguments;
    }
};

std::vector<std::string> names_in(const fs::path &folder) {
    std::vector<std::string> names;
    for (const auto &entry : fs::directory_iterator(folder))
        names.push_back(entry.path().filename().string());
    std::sort(names.begin(), names.end());
    return names;
}

unsigned mode_of(const fs::path &file) { return unsigned(fs::status(file).permissions()); }

} // namespace

TEST_CASE("An output that is an input or another output is refused before the work", "[outputs]") {
    const Images folder;
    fs::create_hard_link(folder / "a.exr", folder / "hard.exr");
    fs::create_symlink("a.exr", folder / "link.exr");
    fs::create_symlink("new.json", folder / "dangling.exr");
    const std::string before = read_text(folder / "a.exr"), both = "read and written", twice = "written twice";
    for (const auto &[arguments, reason] : {std::pair("a.exr b.exr -o a.exr", both),
                                            {"a.exr b.exr --json b.exr", both},
                                            {"a.exr b.exr -o hard.exr", both},
                                            {"a.exr b.exr --json link.exr", both},
                                            {"a.exr b.exr -o new.exr --json new.exr", twice},
                                            {"a.exr b.exr -o new.exr --json new.png", twice},
                                            {"a.exr b.exr -o dangling.exr --json ./new.json", twice}}) {
        INFO(arguments);
        const Outcome outcome = run_shell(folder.compare(arguments));
        CHECK(outcome.exit_code == exit_usage);
        CHECK_THAT(outcome.err, Catch::Contains(reason));
        CHECK(names_in(folder.path()).size() == 5);
    }
    CHECK(read_text(folder / "a.exr") == before);
    CHECK(run_shell(folder.compare("a.exr b.exr -o /dev/null --json /dev/null")).exit_code == exit_done);
    const std::string text = "<scene><camera type='perspective'/></scene>", scene = folder.write("s.xml", text);
    CHECK(run_shell(OPAL_BINARY " inspect " + scene + " --json " + scene).exit_code == exit_usage);
    CHECK(read_text(scene) == text);
}

TEST_CASE("What goes to a descriptor is one file, and is appended where the shell appends", "[outputs]") {
    const Images folder;
    const std::string in = "a.exr b.exr ", json = R"("mse": 0.0)";
    for (const std::string out : {"/dev/stdout", "/proc/self/fd/1", "-"}) {
        INFO(out);
        folder.write("log", "before\n");
        CHECK(run_shell(folder.compare(in + "--json " + out + " >> log")).exit_code == 0);
        CHECK_THAT(read_text(folder / "log"), Catch::StartsWith("before\n{") && Catch::Contains(json));
        CHECK_THAT(run_shell(folder.compare(in + "--json " + out + " | cat")).out, Catch::Contains(json));
    }
    CHECK(run_shell(folder.compare(in + "-o /dev/fd/3 3>> log")).exit_code == 0); // no /dev/fd/3.png
    CHECK_THAT(read_text(folder / "log"), Catch::StartsWith("before\n{") && Catch::Contains("v/1\x01"));
    CHECK(run_shell(folder.compare(in + "-o /dev/fd/3 3< log")).exit_code == exit_failed); // cannot be written
}

TEST_CASE("A link that leads nowhere yet is written through, and a loop of links is refused", "[outputs]") {
    const ScratchFolder folder;
    fs::create_directory(folder / "there");
    fs::create_symlink("there/target", folder / "link");
    fs::create_symlink("link", folder / "second");
    CHECK_NOTHROW(check_writable(folder / "second"));
    write_safely(folder / "second", "new");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(read_text(folder / "there/target") == "new");
    fs::create_symlink("loop", folder / "loop");
    CHECK_THAT(error_of([&] { check_writable(folder / "loop"); }), Catch::Contains("Too many levels"));
}

TEST_CASE("The mode of a file stays, a new one has the usual, and a read-only one is refused", "[outputs]") {
    const ScratchFolder folder;
    const fs::path file = folder.write("file", "old"), fresh = folder / "fresh";
    for (const unsigned mode : {0600u, 0664u, 0755u}) {
        chmod(file.c_str(), mode);
        write_safely(file, "new");
        CHECK(mode_of(file) == mode);
    }
    const mode_t before = umask(027);
    write_safely(fresh, "new");
    umask(before);
    CHECK(mode_of(fresh) == 0640);
    chmod(file.c_str(), 0444);
    CHECK_THAT(error_of([&] { check_writable(file); }), Catch::Contains(geteuid() ? "Permission" : "(mode 444)"));
}

TEST_CASE("Names as long as the system allows are written, and longer ones refused", "[outputs]") {
    const ScratchFolder folder;
    for (const size_t length : {247u, 255u}) {
        const fs::path file = folder / std::string(length, 'x');
        CHECK_NOTHROW(check_writable(file));
        write_safely(file, "text");
        CHECK(read_text(file) == "text");
    }
    CHECK_THAT(error_of([&] { check_writable(folder / std::string(256, 'x')); }),
               Catch::Contains("File name too long"));
}

TEST_CASE("Temporary files cannot be foretold, and writers do not meet in them", "[outputs]") {
    const Images folder;
    folder.write("victim", "untouched");
    // The name that the temporary file once had.
    const std::string link =
        "ln -s victim .o.json.$$.tmp; exec " OPAL_BINARY " compare --quiet a.exr b.exr --json o.json";
    CHECK(run_shell("cd " + folder.path().string() + " && sh -c '" + link + "'").exit_code == 0);
    CHECK(read_text(folder / "victim") == "untouched");
    std::vector<std::thread> writers;
    std::vector<std::string> errors(8);
    for (size_t i = 0; i < errors.size(); i++) // of one process number, as in two containers
        writers.emplace_back([&, i] {
            for (int n = 0; n < 50; n++)
                errors[i] += error_of([&] { write_safely(folder / "o", std::string(100'000, char('a' + i))); });
        });
    for (std::thread &writer : writers)
        writer.join();
    CHECK(errors == std::vector<std::string>(8));
    const std::string text = read_text(folder / "o");
    CHECK(text == std::string(100'000, text[0]));
    for (const std::string &name : names_in(folder.path()))
        CHECK(name.find(".opal-") == std::string::npos);
}

TEST_CASE("A temporary file that a killed process left goes after a day, and no other file", "[outputs]") {
    const ScratchFolder folder;
    const timespec old[2] = {{time(nullptr) - 48 * 3600, 0}, {time(nullptr) - 48 * 3600, 0}};
    for (const char *name : {".opal-0123456789abcdef.tmp", ".opal-notes.tmp", "old.exr"})
        utimensat(AT_FDCWD, folder.write(name, "").c_str(), old, 0);
    folder.write(".opal-fedcba9876543210.tmp", ""); // another process writes it
    check_writable(folder / "a.exr");
    CHECK(names_in(folder.path()) ==
          std::vector<std::string>{".opal-fedcba9876543210.tmp", ".opal-notes.tmp", "old.exr"});
}

TEST_CASE("A limit on the size of files is an error, and leaves no file", "[outputs]") { // SIGXFSZ
    const Images folder;
    const Outcome limited = run_shell("ulimit -f 1; " + folder.compare("a.exr b.exr --json o.json"));
    CHECK(limited.exit_code == exit_failed);
    CHECK_THAT(limited.err, Catch::Contains("o.json: cannot be written: File too large"));
    CHECK(names_in(folder.path()) == std::vector<std::string>{"a.exr", "b.exr"});
}

TEST_CASE("What a PNG or an EXR cannot hold is known by its size", "[outputs]") {
    CHECK_NOTHROW(check_png_size(1'000'000, 1'000'000));
    CHECK_THAT(error_of([] { check_png_size(1, 2'000'000); }), Catch::Contains("at most 1000000 pixels a side"));
    CHECK_NOTHROW(check_exr_size(65535, 6));
    CHECK_THAT(error_of([] { check_exr_size(200'000'000, 3); }), Catch::Contains("pixels a line"));
}
