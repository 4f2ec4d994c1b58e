// What `cmake --install` and `cpack` make: a tree and a .deb that work away from the build.
#include "support/scratch.h"

#include <catch2/catch.hpp>

using namespace opal::test;

TEST_CASE("The .deb, unpacked into an empty folder, holds all that belongs to it and runs", "[package]") {
    const ScratchFolder folder;
    const std::string in = "cd " + folder.path().string() + " && ";
    if (run_shell("command -v dpkg-deb dpkg-shlibdeps").exit_code != 0) {
        WARN("no dpkg-deb or no dpkg-shlibdeps: skipped");
        return;
    }
    const std::string build = std::filesystem::path(OPAL_BINARY).parent_path();
    const Outcome packed = run_shell(in + "cpack --config " + build +
                                     "/CPackConfig.cmake -B packed && "
                                     "dpkg-deb -x packed/*.deb tree && dpkg-deb -f packed/*.deb Depends Recommends");
    INFO(packed.out << packed.err);
    REQUIRE(packed.exit_code == 0);
    for (const char *part :
         {"libopenexr", "libpng16", "libjpeg62-turbo", "libfmt", "libpugixml", "libxxhash", "pocl-opencl-icd"})
        CHECK_THAT(packed.out, Catch::Contains(part));
    for (const char *file :
         {"bin/opal", "share/doc/opal/LICENSE", "share/man/man1/opal.1", "share/opal/scenes/cbox_mis.xml",
          "share/bash-completion/completions/opal", "share/zsh/vendor-completions/_opal"})
        CHECK(std::filesystem::exists(folder / ("tree/usr/" + std::string(file))));
    const Outcome rendered =
        run_shell(in + "tree/usr/bin/opal tree/usr/share/opal/scenes/cbox_mis.xml --width 8 --spp 1");
    INFO(rendered.err);
    CHECK(rendered.exit_code == 0);
    CHECK(std::filesystem::exists(folder / "cbox_mis.png"));
}
