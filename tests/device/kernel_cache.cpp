// The cache of compiled kernels and the folder that drivers work in: damage is found, and nothing is looked up or left
// in the user's working directory.
#include "device/kernel_cache.h"
#include "base/json.h"
#include "device/work_folder.h"
#include "support/device.h"
#include "support/scratch.h"

#include <chrono>
#include <fstream>

#include <sys/stat.h>

using namespace opal;
using namespace opal::test;

namespace fs = std::filesystem;

namespace {

// A folder with an empty cache, in which opal runs.
struct Place {
    ScratchFolder folder;
    fs::path cache = folder / "cache/opal", work = folder / "work", temporary = folder / "tmp";

    Place() {
        for (const fs::path &made : {folder / "cache", work, temporary})
            fs::create_directories(made);
    }
    Outcome run(const std::string &arguments, const std::string &variables = "", const std::string &before = "") const {
        return run_shell(
            "cd " + work.string() + " && " + before + " env -u POCL_CACHE_DIR TMPDIR=" + temporary.string() +
            " XDG_CACHE_HOME=" + (folder / "cache").string() + " " + variables + " " + OPAL_BINARY + " " + arguments);
    }
    Outcome render(const std::string &variables = "", const std::string &before = "") const {
        return run("render " OPAL_SOURCE_DIR "/scenes/cbox_mis.xml --width 8 --height 8 --spp 1 --quiet --device " +
                       wanted_device() + " -o " + (folder / "out.exr").string(),
                   variables, before);
    }
    std::vector<fs::path> files() const {
        std::vector<fs::path> found;
        for (const auto &entry : fs::directory_iterator(cache))
            found.push_back(entry.path());
        return found;
    }
};

bool keeps_kernels() { return device().info.platform == "Portable Computing Language"; }

size_t count_of(const fs::path &folder) {
    return size_t(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

mode_t mode_of(const fs::path &path) {
    struct stat status {};
    REQUIRE(stat(path.c_str(), &status) == 0);
    return status.st_mode & 0777;
}

} // namespace

TEST_CASE("A damaged file of the cache is thrown away, and its kernels are compiled anew", "[kernel_cache][alone]") {
    if (!keeps_kernels())
        return;
    const Place place;
    const Outcome first = place.render();
    INFO(first.err);
    REQUIRE(first.exit_code == 0);
    CHECK(first.err.empty());
    const std::string image = read_text(place.folder / "out.png");
    CHECK(place.files().size() == 2); // the renderer and the film, and nothing that the driver has left
    CHECK(mode_of(place.cache) == 0700);
    for (const fs::path &file : place.files())
        CHECK(mode_of(file) == 0600);

    const fs::path longer = place.files()[0], shorter = place.files()[1];
    fs::resize_file(longer, most_cache_bytes + 1); // sparse
    const Outcome huge = place.render();
    CHECK(huge.exit_code == 0);
    CHECK_THAT(huge.err, Catch::Contains("warning: " + longer.string() +
                                         ": a damaged file of the cache of kernels (it "
                                         "is too large)"));
    std::ofstream(longer, std::ios::app) << 'x';
    fs::resize_file(shorter, fs::file_size(shorter) / 2);
    const Outcome damaged = place.render();
    CHECK(damaged.exit_code == 0);
    for (const fs::path &file : {longer, shorter})
        CHECK_THAT(damaged.err, Catch::Contains("warning: " + file.string() + ": a damaged file of the cache"));
    CHECK(read_text(place.folder / "out.png") == image);
    const Outcome healed = place.render();
    CHECK(healed.exit_code == 0);
    CHECK(healed.err.empty());

    // A run that ended in the first launch of kernels leaves its work folder, unlocked.
    const fs::path dead = place.cache / "opal-run-dead";
    fs::create_directory(dead);
    std::ofstream(dead / "lock");
    std::ofstream(dead / "first_launch") << longer.string();
    const Outcome distrusting = place.render();
    CHECK(distrusting.exit_code == 0);
    CHECK_THAT(distrusting.err, Catch::StartsWith("warning: " + longer.string() + ": a run ended while it launched"));
    CHECK(read_text(place.folder / "out.png") == image);
    CHECK(place.files().size() == 2);

    // A lock that cannot be opened may be a live process's.
    fs::create_directories(dead / "lock");
    fs::last_write_time(dead, fs::file_time_type::clock::now() - std::chrono::hours(1));
    CHECK(place.render().exit_code == 0);
    CHECK(fs::exists(dead));

    // A cache that nothing can be added to costs its use, not the render.
    fs::remove_all(place.cache);
    std::ofstream(place.cache) << "no folder";
    const Outcome without = place.render();
    CHECK(without.exit_code == 0);
    CHECK(read_text(place.folder / "out.png") == image);
    CHECK(count_of(place.temporary) == 0);
}

TEST_CASE("Drivers compile in an empty folder of mode 700, whatever PATH says", "[kernel_cache][alone]") {
    if (!keeps_kernels())
        return;
    const Place place;
    const std::string told = place.folder / "told";
    const fs::path linker = place.folder.write("bin/ld", "#!/bin/sh\n{ pwd; ls -A; stat -c %a . ..; } >> " + told +
                                                             "\nexec /usr/bin/ld \"$@\"\n");
    fs::permissions(linker, fs::perms::owner_all);
    place.folder.write("work/ld", "#!/bin/sh\necho an ld of the working directory >> " + told + "\nexit 1\n");
    fs::permissions(place.work / "ld", fs::perms::owner_all);
    const Outcome outcome = place.render("PATH=.::" + linker.parent_path().string() + ":$PATH");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
    std::istringstream lines(read_text(told));
    std::vector<std::string> words{std::istream_iterator<std::string>(lines), {}};
    REQUIRE(words.size() == 6); // two kernels are linked
    for (size_t i = 0; i < words.size(); i += 3) {
        CHECK_THAT(words[i], Catch::Contains("/opal-run-") && Catch::EndsWith("/empty"));
        CHECK(words[i + 1] == "700");
        CHECK(words[i + 2] == "700");
    }
    CHECK(count_of(place.work) == 1);
}

TEST_CASE("Without a home, kernels are compiled in a private temporary folder", "[kernel_cache][alone]") {
    const Place place;
    for (const std::string variables : {"-i", "-i HOME=/nonexistent", "-i HOME=/dev/null XDG_CACHE_HOME=relative"}) {
        CAPTURE(variables);
        const Outcome outcome =
            run_shell("cd " + place.work.string() + " && env " + variables + " TMPDIR=" + place.temporary.string() +
                      " " + OPAL_BINARY + " devices --json - --device " + wanted_device());
        CHECK(outcome.exit_code == 0);
        CHECK_THAT(outcome.err, Catch::Contains("note: compiled kernels are not kept for the next run: HOME"));
        CHECK(count_of(place.temporary) == 0);
        CHECK(count_of(place.work) == 0);
    }
}

TEST_CASE("A cache folder that others may write to, or that is a link, is not used", "[kernel_cache][alone]") {
    const Place place;
    fs::create_directory(place.cache);
    fs::permissions(place.cache, fs::perms::all);
    CHECK_THAT(place.run("devices").err, Catch::Contains("/cache/opal: others may write to it"));
    CHECK(place.files().empty());
    fs::permissions(place.cache, fs::perms::owner_all);
    fs::rename(place.cache, place.folder / "elsewhere");
    fs::create_symlink(place.folder / "elsewhere", place.cache);
    CHECK_THAT(place.run("devices").err, Catch::Contains("/cache/opal: it is a link"));
    CHECK(count_of(place.folder / "elsewhere") == 0);
}

TEST_CASE("The cache is trimmed to the files that were used last, told and emptied", "[kernel_cache][alone]") {
    const Place place;
    fs::create_directory(place.cache);
    const auto now = fs::file_time_type::clock::now();
    const auto write = [&](const std::string &name, int hours) {
        const fs::path file = place.folder.write("cache/opal/" + name, std::string(1000, 'x'));
        fs::last_write_time(file, now - std::chrono::hours(hours));
        return file;
    };
    const fs::path oldest = write("a.kernels", 5), old = write("c.kernels", 2), latest = write("b.kernels", 1),
                   killed = write(".opal-tmp-abcdef", 3), other = write("notes.txt", 9);
    trim_cache(place.cache, 2500);
    CHECK(!fs::exists(oldest));
    CHECK(!fs::exists(killed));
    CHECK(fs::exists(old));
    trim_cache(place.cache, 1999);
    CHECK(!fs::exists(old));
    CHECK(fs::exists(latest));
    const auto told = [&](const std::string &flags) {
        const Outcome outcome = place.run("cache --json - " + flags);
        INFO(outcome.err);
        REQUIRE(outcome.exit_code == 0);
        return nlohmann::json::parse(outcome.out);
    };
    const nlohmann::json full = told("");
    CHECK(full["folder"] == place.cache.string());
    CHECK(full["programs"] == 1);
    CHECK(full["bytes"] == 1000);
    const fs::path half = write(".opal-tmp-123456", 0);
    CHECK(told("--clear")["programs"] == 0);
    CHECK(!fs::exists(half));
    CHECK(!fs::exists(latest));
    CHECK(fs::exists(other));
}

TEST_CASE("What is missing to build kernels is named", "[kernel_cache][alone]") {
    if (!keeps_kernels())
        return;
    const Place place;
    const Outcome unlinked = place.render("PATH=/nonexistent");
    CHECK(unlinked.exit_code == 1);
    CHECK_THAT(unlinked.err, Catch::StartsWith("error: ") && Catch::Contains("PoCL needs the program ld") &&
                                 Catch::Contains("binutils"));
    const Outcome limited = place.render("", "ulimit -f 20 &&");
    CHECK(limited.exit_code == 1);
    CHECK_THAT(limited.err, Catch::Contains("do not build") && Catch::Contains("(ulimit -f)"));
    CHECK(place.render().exit_code == 0);
    const Outcome kept = place.render("PATH=/nonexistent");
    CHECK(kept.exit_code == 0);
    CHECK_THAT(kept.err, Catch::StartsWith("warning: ") && Catch::Contains("PoCL needs the program ld"));
}

TEST_CASE("The working directory is the user's again after a driver was used, also a removed one",
          "[kernel_cache][alone]") {
    const fs::path before = fs::current_path();
    {
        const DriverScope outer, inner;
        CHECK(fs::is_empty(fs::current_path()));
        CHECK(fs::current_path() != before);
    }
    CHECK(fs::current_path() == before);
    const Place place;
    const Outcome outcome = place.run("devices", "", "mkdir gone && cd gone && rmdir ../gone &&");
    INFO(outcome.err);
    CHECK(outcome.exit_code == 0);
}
