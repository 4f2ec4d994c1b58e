// Reading and expanding the kernels' sources, and the text that a program is built from.
#include "device/sources.h"
#include "base/error.h"
#include "flatten/flat_scene.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

using namespace opal;

namespace {

std::string message_of(const Sources &sources, const std::string &file) {
    try {
        sources.expand(file, 4);
    } catch (const Error &error) {
        return error.what();
    }
    return "no error";
}

} // namespace

TEST_CASE("An include is expanded in place, once, between #line directives", "[sources]") {
    const Sources sources{{
        {"a.cl", "one\n#include \"b.h\"\ntwo\n  # include \"c.h\"\nthree"},
        {"b.h", "#include \"c.h\"\nb\n"},
        {"c.h", "c\n"},
    }};
    CHECK(sources.expand("a.cl", 4) == "#line 1 \"cl/a.cl\"\none\n"
                                       "#line 1 \"cl/b.h\"\n"
                                       "#line 1 \"cl/c.h\"\nc\n"
                                       "#line 2 \"cl/b.h\"\nb\n"
                                       "#line 3 \"cl/a.cl\"\ntwo\n"
                                       "\n" // c.h, a second time
                                       "three\n");
}

TEST_CASE("A pattern includes the .cl files of a folder, each once", "[sources]") {
    const Sources sources{{{"k/all.cl", "#include \"k/b.cl\"\n#include \"k/*.cl\"\nend\n"},
                           {"k/a.cl", "#include \"k/b.cl\"\na\n"},
                           {"k/b.cl", "b\n"},
                           {"k/deeper/d.cl", "d\n"},
                           {"k/h.h", "h\n"}}};
    CHECK(sources.expand("k/all.cl", 4) == "#line 1 \"cl/k/all.cl\"\n"
                                           "#line 1 \"cl/k/b.cl\"\nb\n"
                                           "#line 2 \"cl/k/all.cl\"\n"
                                           "#line 1 \"cl/k/a.cl\"\n\na\n"
                                           "#line 3 \"cl/k/all.cl\"\nend\n");
}

TEST_CASE("What is for another width leaves an empty line", "[sources]") {
    const Sources sources{{{"a.cl", "one\n#include \"t/one_lane/b.cl\"\n#include \"t/many_lanes/c.cl\"\ntwo\n"},
                           {"t/one_lane/b.cl", "b\n"},
                           {"t/many_lanes/c.cl", "c\n"}}};
    CHECK(sources.expand("a.cl", 1) == "#line 1 \"cl/a.cl\"\none\n"
                                       "#line 1 \"cl/t/one_lane/b.cl\"\nb\n"
                                       "#line 3 \"cl/a.cl\"\n\ntwo\n");
    for (int lanes : {4, 8, 16})
        CHECK(sources.expand("a.cl", lanes) == "#line 1 \"cl/a.cl\"\none\n\n"
                                               "#line 1 \"cl/t/many_lanes/c.cl\"\nc\n"
                                               "#line 4 \"cl/a.cl\"\ntwo\n");
}

TEST_CASE("A program holds the code of its own width alone", "[sources]") {
    for (const char *file : {"kernels/render.cl", "kernels/probe.cl", "kernels/rays.cl"})
        for (int lanes : {1, 4, 8, 16}) {
            const std::string text = Sources::embedded().expand(file, lanes);
            INFO(file << " at " << lanes << " lanes");
            CHECK((text.find("one_lane/walk.cl\"\n//") != std::string::npos) == (lanes == 1));
            CHECK((text.find("many_lanes/walk.cl\"\n//") != std::string::npos) == (lanes != 1));
        }
}

TEST_CASE("A missing include names its place and what there is", "[sources]") {
    const Sources sources{{{"a.cl", "\n#include \"b.h\"\n"}, {"b.h", "\n\n#include \"bsdfs/lits.h\"\n"}}};
    CHECK(message_of(sources, "a.cl") == "cl/b.h:3: no file \"bsdfs/lits.h\" below cl/; available: a.cl, b.h");
    CHECK(message_of(sources, "c.cl") == "program: no file \"c.cl\" below cl/; available: a.cl, b.h");
}

TEST_CASE("A folder of sources holds what the binary embeds", "[sources]") {
    CHECK(Sources::from_folder(OPAL_SOURCE_DIR "/cl").files == Sources::embedded().files);
    CHECK(Sources::embedded().files.count("shared/types.h") == 1);
    CHECK_THROWS_AS(Sources::from_folder(OPAL_SOURCE_DIR "/no-such-folder"), Error);
    const test::ScratchFolder empty;
    CHECK_THROWS_WITH(Sources::from_folder(empty.path().string()), Catch::Contains("holds no .cl file"));
}

TEST_CASE("The program text defines width, precision, every feature and every axis, then the sources", "[sources]") {
    const Sources sources{{{"kernels/k.cl", "kernel void k() {}\n"}}};
    Features features;
    features.list[FEATURE_tree].on = true;
    features.axes.fill(-1);
    features.axes[AXIS_lighting] = CHOICE_lighting_mis;
    BuildOptions options;
    options.lanes = 8;
    options.math = MathMode::fast;
    options.kernels = "kernels/k.cl";
    const std::string text = program_text(features, options, sources);
    CHECK_THAT(text, Catch::StartsWith(
                         "#define LANES 8\n#define OPAL_DOUBLE 0\n#define OPAL_FAST 1\n#define OPAL_COUNT_TESTS 0\n"
                         "#define OPAL_REPEAT_traversal 0\n#define OPAL_REPEAT_sampling 0\n"
                         "#define OPAL_HAS_bsdf_diffuse 0\n"));
    CHECK_THAT(text, Catch::Contains("#define OPAL_HAS_face_list 0\n#define OPAL_HAS_tree 1\n"
                                     "#define OPAL_HAS_large_tree 0\n#define OPAL_HAS_last_rays 0\n"
                                     "#define OPAL_HAS_endless_paths 0\n"
                                     "#define OPAL_TEXTURED_bsdf_diffuse 0\n"));
    CHECK_THAT(text, Catch::Contains("#define OPAL_AXIS_integrator -1\n#define OPAL_AXIS_lighting 2\n"));
    CHECK_THAT(text, Catch::Contains("#define OPAL_AXIS_sampler -1\n"));
    CHECK_THAT(text, Catch::Contains("\n#line 1 \"cl/kernels/k.cl\"\nkernel void k() {}\n"));
    CHECK(program_text(features, options, sources) == text);
}
