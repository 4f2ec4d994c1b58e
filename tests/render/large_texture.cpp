// The memory that a scene with a picture of 16384 x 16384 pixels takes.
#include "base/json.h"
#include "support/scratch.h"

#include <catch2/catch.hpp>

#include <cstdio>
#include <jpeglib.h>
#include <vector>

using namespace opal;
using namespace opal::test;

namespace {

constexpr unsigned side = 16384;

void write_ramps(const std::string &name) {
    FILE *file = std::fopen(name.c_str(), "wb");
    REQUIRE(file);
    jpeg_compress_struct jpeg{};
    jpeg_error_mgr errors{};
    jpeg.err = jpeg_std_error(&errors);
    jpeg_create_compress(&jpeg);
    jpeg_stdio_dest(&jpeg, file);
    jpeg.image_width = jpeg.image_height = side;
    jpeg.input_components = 3;
    jpeg.in_color_space = JCS_RGB;
    jpeg_set_defaults(&jpeg);
    jpeg_start_compress(&jpeg, TRUE);
    std::vector<JSAMPLE> row(3 * side);
    for (unsigned y = 0; y < side; y++) {
        for (unsigned x = 0; x < side; x++) {
            row[3 * x] = JSAMPLE(x / 64);
            row[3 * x + 1] = JSAMPLE(y / 64);
            row[3 * x + 2] = JSAMPLE((x + y) / 128);
        }
        JSAMPROW rows = row.data();
        jpeg_write_scanlines(&jpeg, &rows, 1);
    }
    jpeg_finish_compress(&jpeg);
    jpeg_destroy_compress(&jpeg);
    std::fclose(file);
}

} // namespace

TEST_CASE("A JPEG of 16384 x 16384 pixels takes 900 MB of the device and 2 GB of memory", "[large_texture][long]") {
    const ScratchFolder folder;
    write_ramps(folder / "large.jpg");
    folder.write("large.xml", R"(<scene version="3.0.0"><integrator type="path"/><emitter type="constant"/>
  <sensor type="perspective"><transform name="to_world"><lookat origin="0 0 4" target="0 0 0" up="0 1 0"/></transform>
    <film type="hdrfilm"><integer name="width" value="16"/><integer name="height" value="16"/></film></sensor>
  <shape type="rectangle"><bsdf type="diffuse"><texture type="bitmap" name="reflectance">
    <string name="filename" value="large.jpg"/></texture></bsdf></shape>
</scene>)");
    const std::vector<std::string> render{"render",        folder / "large.xml", "--spp",   "1",  "--device",
                                          wanted_device(), "--no-png",           "--quiet", "-o", folder / "large.exr"};
    peak_bytes_of_opal(render); // compiles
    const double peak = peak_bytes_of_opal(render);
    CHECK(peak <= 2e9);
    CHECK(peak > 3.0 * side * side);
    REQUIRE(run_shell(OPAL_BINARY " inspect " + (folder / "large.xml").string() + " --json " +
                      (folder / "large.json").string())
                .exit_code == 0);
    double device = 0;
    for (const auto &buffer : nlohmann::json::parse(read_text(folder / "large.json")).at("buffers"))
        device += buffer.at("bytes").get<double>();
    CHECK(device <= 900e6);
    CHECK(device >= 3.0 * side * side);
}
