// Reading files: every reader names a file that cannot be read, and takes no failure for the file's end.
#include "base/read_file.h"
#include "base/hash.h"
#include "image/image.h"
#include "support/error_of.h"
#include "support/scratch.h"
#include "sweep/record.h"

#include <catch2/catch.hpp>

#include <fcntl.h>
#include <fstream>
#include <sys/stat.h>
#include <thread>
#include <unistd.h>

using namespace opal;
using namespace opal::test;
namespace fs = std::filesystem;

namespace {

// A regular file whose first byte (address 0 of a process) cannot be read: EIO, as of a failing disk.
const char *const unreadable = "/proc/self/mem";
const std::string reason = ": cannot read: Input/output error";

// A scene whose mesh is `obj`.
std::string scene_of(const std::string &obj) {
    return "<scene><integrator type='path_mis'/><camera type='perspective'/>"
           "<mesh type='obj'><string name='filename' value='" +
           obj + "'/></mesh></scene>";
}

void check_fails(const std::string &arguments, const std::string &message) {
    const Outcome outcome = run_shell(OPAL_BINARY " " + arguments);
    INFO(arguments << "\n" << outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err, Catch::Contains("error: " + message));
}

} // namespace

TEST_CASE("The hash of a file is XXH3's of 128 bits", "[read_file]") { // figures of xxhash 0.8.1's xxh128sum
    CHECK(xxh128("") == "99aa06d3014798d86001c324468d497f");
    CHECK(xxh128("opal") == "c580edc7dbb0e30bb40cccda770b14d0");
    CHECK(xxh128(std::string(100000, 'a')) == "819d5302938c790308f809ef04c54838");
}

TEST_CASE("A file is read whole, be it empty, long or a pipe that delivers piece by piece", "[read_file]") {
    const ScratchFolder folder;
    CHECK(read_file(folder.write("empty", "")).empty());
    std::string text;
    for (int i = 0; i < 60000; i++)
        text += std::to_string(i) + '\n' + '\0';
    CHECK(read_file(folder.write("long", text)) == text);
    const fs::path pipe = folder / "pipe";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << text; });
    CHECK(read_file(pipe) == text);
    writer.join();
}

TEST_CASE("A file that a descriptor names is read anew each time, from its begin", "[read_file]") {
    const ScratchFolder folder;
    const int descriptor = open(folder.write("a", "first").c_str(), O_RDONLY | O_CLOEXEC);
    REQUIRE(descriptor >= 0);
    const std::string name = "/dev/fd/" + std::to_string(descriptor);
    fs::create_symlink("/proc/self/fd/" + std::to_string(descriptor), folder / "link");
    CHECK(read_file(name) == "first");
    CHECK(read_file(name) == "first");
    CHECK(read_file(folder / "link") == "first");
    folder.write("a", "the second");
    CHECK(read_file(name) == "the second");
    CHECK(read_file(folder / "link") == "the second");
    close(descriptor);
}

TEST_CASE("What cannot be read is an error with its name and reason", "[read_file]") {
    const ScratchFolder folder;
    CHECK(error_of([&] { read_file(folder / "none"); }) ==
          (folder / "none").string() + ": cannot read: No such file or directory");
    CHECK(error_of([&] { read_file(folder.path()); }) == folder.path().string() + ": is a folder, not a file");
    CHECK(error_of([&] { read_file(unreadable); }) == unreadable + reason);
}

TEST_CASE("A file that ends before its size is an error", "[read_file]") {
    const char *const shorter = "/sys/devices/system/cpu/online"; // the kernel reports 4096 bytes for each such file
    std::error_code error;
    if (fs::file_size(shorter, error) != 4096 || error) {
        WARN("there is no /sys here: a file that ends early is not tried");
        return;
    }
    CHECK_THAT(error_of([&] { read_file(shorter); }),
               Catch::Matches(".*online: cannot read: it ended after [0-9]+ of 4096 bytes"));
}

TEST_CASE("A read error of any file that Opal reads ends the command, with the file's name", "[read_file]") {
    const ScratchFolder folder;
    const std::string scene = folder.write("scene.xml", scene_of(unreadable));
    check_fails("inspect " + scene, unreadable + reason + " (the mesh at " + scene);
    check_fails("inspect " + std::string(unreadable), unreadable + reason);
    check_fails("test " + std::string(unreadable), unreadable + reason);

    write_exr(Image{1, 1, {{"R", {0}}, {"G", {0}}, {"B", {0}}}, {}}, folder / "image.exr");
    check_fails("compare " + (folder / "image.exr").string() + " " + unreadable, unreadable + reason);

    fs::copy(OPAL_SOURCE_DIR "/cl", folder / "cl", fs::copy_options::recursive);
    fs::remove(folder / "cl/film/sums.cl");
    fs::create_symlink(unreadable, folder / "cl/film/sums.cl");
    check_fails("inspect " OPAL_SOURCE_DIR "/scenes/cbox_mis.xml --cl --cl-dir " + (folder / "cl").string(),
                (folder / "cl/film/sums.cl").string() + reason);

    fs::create_symlink(unreadable, folder / "sweep.json");
    CHECK(error_of([&] { load_record(folder.path()); }) == (folder / "sweep.json").string() + reason);
}

TEST_CASE("A mesh that is a device, a pipe, a socket or a folder is refused by name", "[read_file]") {
    const ScratchFolder folder;
    const std::string pipe = folder / "pipe.obj", library = folder / "pipe.mtl";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const auto &[file, kind] : {std::pair(std::string("/dev/zero"), "device"),
                                     {"/dev/null", "device"},
                                     {pipe, "pipe"},
                                     {folder.path().string(), "folder"}}) {
        const std::string scene = folder.write("scene.xml", scene_of(file));
        check_fails("inspect " + scene, file + ": is a " + kind + ", not a file (the mesh at " + scene);
        if (file != pipe)
            check_fails("inspect " + file, file + ": is a " + kind + ", not a file");
        if (file != pipe)
            check_fails("compare " + file + " " + file, file + ": is a " + kind + ", not a file");
    }
    const Outcome piped =
        run_shell("echo v | " OPAL_BINARY " inspect " + folder.write("scene.xml", scene_of("/dev/stdin")).string());
    CHECK_THAT(piped.err, Catch::Contains("error: /dev/stdin: is a pipe, not a file"));
}

TEST_CASE("A scene may come by stdin, a pipe or a FIFO, and its meshes are those of the current folder",
          "[read_file]") {
    const ScratchFolder folder;
    folder.write("triangle.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const std::string scene = folder.write("scene.xml", scene_of("triangle.obj")), pipe = folder / "pipe",
                      in = "cd " + folder.path().string() + " && ", inspect = OPAL_BINARY " inspect --json ";
    REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
    for (const std::string &command :
         {inspect + "out.json - < scene.xml", inspect + "out.json /dev/stdin < scene.xml",
          "cat scene.xml | " + inspect + "out.json -", "cat scene.xml | " + inspect + "out.json /dev/stdin",
          inspect + "out.json /dev/fd/3 3< scene.xml", "(cat scene.xml > pipe &) ; " + inspect + "out.json pipe"}) {
        INFO(command);
        std::filesystem::remove(folder / "out.json");
        const Outcome outcome = run_shell(in + command);
        INFO(outcome.err);
        CHECK(outcome.exit_code == 0);
        CHECK_THAT(read_text(folder / "out.json"), Catch::Contains("triangle.obj"));
    }
}

TEST_CASE("A mesh for which memory is short is an error, not a part of it", "[read_file]") {
#ifdef __SANITIZE_ADDRESS__
    WARN("AddressSanitizer needs all addresses: short memory is not tried");
#else
    const ScratchFolder folder;
    const fs::path obj = folder.write("large.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n#");
    fs::resize_file(obj, 1u << 30); // a comment of zeros that takes no disk space
    const std::string scene = folder.write("scene.xml", scene_of(obj.string()));
    const Outcome outcome = run_shell("ulimit -v 600000; " OPAL_BINARY " inspect " + scene);
    INFO(outcome.out << outcome.err);
    CHECK(outcome.exit_code == 1);
    CHECK_THAT(outcome.err,
               Catch::Contains("error: " + obj.string() + ": cannot read: about 1.0 GiB of memory wanted, and "));
#endif
}
