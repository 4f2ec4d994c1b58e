// Building and running kernels on the device, and the messages when that fails.
#include "base/units.h"
#include "support/kernels.h"

using namespace opal;
using namespace opal::test;

TEST_CASE("A kernel runs with tables, values and outputs", "[program]") {
    const cl::Program built = program_of("kernel void scale(global const float *in, float by, global float *out) {\n"
                                         "    size_t i = get_global_id(0);\n    out[i] = in[i] * by * LANES;\n}\n",
                                         4);
    const Output<float> out(3);
    run(built, "scale", 3, std::vector<float>{1, 2, 3}, 0.5f, out);
    CHECK(out.read() == std::vector<float>{2, 4, 6});
}

TEST_CASE("A kernel that does not build is reported with device, driver, file and line", "[program]") {
    const std::string text = "// first line\nkernel void broken(global float *out) {\n    out[0] = nothing;\n}\n";
    CHECK_THROWS_WITH(program_of(text, 1), Catch::Contains(device().info.name) &&
                                               Catch::Contains(device().info.driver) &&
                                               Catch::Contains("cl/tests/inline.cl:3:14"));
}

TEST_CASE("In tests a warning is an error", "[program]") {
    CHECK_THROWS_AS(program_of("#warning careful\nkernel void fine(global float *out) { out[0] = 1; }\n", 1), Error);
}

TEST_CASE("The records shared with the device have one size", "[program]") {
    const cl::Program built = program_of(
        "#include \"shapes/list.h\"\n#include \"bsdfs/list.h\"\n#include \"emitters/list.h\"\n"
        "kernel void sizes(global uint *out) {\n"
        "    out[0] = sizeof(BvhNode); out[1] = sizeof(TriangleBlock); out[2] = sizeof(Settings);\n"
        "    out[3] = sizeof(bsdf_phong_record); out[4] = sizeof(EmitterRecord); out[5] = sizeof(LightTriangle);\n"
        "    Settings s;\n"
        "    out[6] = (uint)((char *)&s.choices - (char *)&s);\n}\n",
        1);
    const Output<cl_uint> out(7);
    run(built, "sizes", 1, out);
    CHECK(out.read() == std::vector<cl_uint>{sizeof(BvhNode), sizeof(TriangleBlock), sizeof(Settings),
                                             sizeof(bsdf_phong_record), sizeof(EmitterRecord), sizeof(LightTriangle),
                                             offsetof(Settings, choices)});
}

TEST_CASE("A buffer that does not fit is refused with bytes wanted and available", "[program]") {
    const unsigned long long wanted = device().info.max_allocation + 1;
    CHECK_THROWS_WITH(make_buffer(device(), CL_MEM_READ_WRITE, wanted, nullptr, "the film"),
                      Catch::Contains("no room for the film: " + bytes_text(wanted) + " wanted") &&
                          Catch::Contains(device().info.name) && Catch::Contains(bytes_text(device().info.memory)));
    CHECK_THROWS_WITH(check_room(device(), device().info.memory + 1, "everything"), Catch::Contains("everything"));
    CHECK(make_table(device(), std::vector<float>{}, "nothing").getInfo<CL_MEM_SIZE>() == sizeof(float));
}

TEST_CASE("An OpenCL error names the device and the error", "[program]") {
    const auto fail = [] {
        with_device(device().info, []() -> int { throw cl::Error(CL_OUT_OF_RESOURCES, "clFinish"); });
    };
    CHECK_THROWS_WITH(fail(), device().info.name + ": clFinish failed: CL_OUT_OF_RESOURCES");
}
