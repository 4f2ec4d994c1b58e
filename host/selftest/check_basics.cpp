// Record layouts, random numbers bit for bit, and math functions in ulp.
#include "device/buffers.h"
#include "device/program.h"
#include "kernels/selftest_list.h"
#include "probe/kernel_probe.h"
#include "selftest/selftest.h"

#include <bit>
#include <cmath>
#include <cstddef>
#include <random>

namespace opal {

namespace {

constexpr double pi = 3.14159265358979323846;

double exact(int function, double x) {
    using namespace std;
#define OPAL_EXACT(name, device, host, low, high, scale, limit)                                                        \
    if (function == MATH_##name)                                                                                       \
        return host;
    OPAL_MATH(OPAL_EXACT)
    return NAN;
}

struct Range {
    const char *name;
    double low, high, scale, limit;
};
#define OPAL_RANGE(name, device, host, low, high, scale, limit) {#name, low, high, scale, limit},
constexpr Range ranges[] = {OPAL_MATH(OPAL_RANGE)};

cl::Program build_selftest(const Device &device, BuildOptions build, const Sources &sources) {
    build.kernels = "kernels/selftest.cl";
    return build_program(device, program_text(scene_of_bsdfs({}).features, build, sources), build);
}

double wrong_layouts(const Device &device, const cl::Program &program) {
    std::vector<cl_uint> host;
#define OPAL_SIZE(T) host.push_back(cl_uint(sizeof(T)));
#define OPAL_OFFSET(T, member) host.push_back(cl_uint(offsetof(T, member)));
    OPAL_LAYOUT
    const cl::Buffer out = make_zeros<cl_uint>(device, host.size(), "layouts");
    with_device(device.info, [&] {
        cl::Kernel kernel(program, "layout");
        kernel.setArg(0, out);
        const LaunchScope launching(device, kernel);
        device.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(1), cl::NDRange(1));
        return device.handles->queue.finish();
    });
    const std::vector<cl_uint> said = read_buffer<cl_uint>(device, out, host.size());
    double wrong = 0;
    for (size_t i = 0; i < host.size(); i++)
        wrong += said[i] != host[i];
    return wrong;
}

constexpr size_t math_count = 4096;

std::vector<float> math_inputs() {
    std::mt19937 random(1);
    std::vector<float> xs;
    for (const Range &r : ranges) {
        std::uniform_real_distribution<double> flat(r.low, r.high),
            exponents(std::log(std::max(r.low, 1e-300)), std::log(r.high));
        for (size_t i = 0; i < math_count; i++)
            xs.push_back(float(r.low > 0 ? std::exp(exponents(random)) : flat(random)));
    }
    return xs;
}

// The distance of two neighbouring floats at |x|, normal ones.
double ulp(double x) { return std::ldexp(1.0, std::max(std::ilogb(std::max(std::abs(x), 1e-37)), -126) - 23); }

Findings math_errors(const Device &device, const cl::Program &program, MathMode math) {
    const std::vector<float> xs = math_inputs();
    const cl::Buffer in = make_table(device, xs, "numbers"),
                     out = make_zeros<float>(device, xs.size(), "their functions");
    with_device(device.info, [&] {
        cl::Kernel kernel(program, "math_values");
        kernel.setArg(0, in);
        kernel.setArg(1, cl_uint(math_count));
        kernel.setArg(2, out);
        const LaunchScope launching(device, kernel);
        device.handles->queue.enqueueNDRangeKernel(kernel, cl::NullRange, cl::NDRange(math_count),
                                                   cl::NDRange(group_size(device.info)));
        return device.handles->queue.finish();
    });
    const std::vector<float> values = read_buffer<float>(device, out, xs.size());
    // Relaxed math may do what it likes; 512 ulp, 3e-5, is where an image would begin to differ from noise.
    const bool fast = math == MathMode::fast;
    Findings findings;
    for (int function = 0; function < MATH_COUNT; function++) {
        double worst = 0;
        for (size_t i = size_t(function) * math_count; i < size_t(function + 1) * math_count; i++) {
            const double want = exact(function, xs[i]), error = std::abs(double(values[i]) - want) /
                                                                ulp(std::max(std::abs(want), ranges[function].scale));
            worst = worst_of(worst, error);
        }
        findings.push_back(at_most(std::string("error of ") + ranges[function].name + ", ulp", worst,
                                   fast ? 512 : ranges[function].limit));
    }
    return findings;
}

// Known values: the FNV-1a hash (Fowler, Noll and Vo) of all bits that 4096 samples of 3 pairs of numbers have. The
// first and second were computed apart, from the papers of pcg3d, pcg4d and Kensler; the third holds what was tested
// when it was written.
struct KnownNumbers {
    const char *name;
    int sampler;
    std::uint64_t hash;
};
constexpr KnownNumbers known_numbers[] = {
    {"independent numbers, wrong", CHOICE_sampler_independent, 0x11ccfe9af6c78d2b},
    {"stratified numbers, wrong", CHOICE_sampler_stratified, 0xdedc2681841d4188},
    {"Sobol numbers, wrong", CHOICE_sampler_sobol, 0x3edb4088db211466},
};

std::uint64_t fnv1a_of(const Planes &planes) {
    static_assert(std::endian::native == std::endian::little);
    std::uint64_t hash = 0xcbf29ce484222325;
    for (std::byte byte : std::as_bytes(std::span(planes.values)))
        hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3;
    return hash;
}

Findings check_numbers(const Device &device, const SelftestOptions &options) {
    KernelProbe probe(device, scene_of_bsdfs({}), options.build, *options.sources);
    Findings findings;
    double largest = 0;
    for (const KnownNumbers &known : known_numbers) {
        NumberOptions which;
        which.seed = 12345;
        which.pixel_step = 7;
        which.sampler = known.sampler;
        which.spp = 4096;
        const Planes numbers = probe.numbers(4096, which);
        findings.push_back(none_wrong(known.name, fnv1a_of(numbers) != known.hash));
        for (float u : numbers.values)
            largest = worst_of(largest, u);
    }
    findings.push_back(at_most("largest random number", largest, 1 - 0x1p-24));
    return findings;
}

} // namespace

Findings check_functions(const Device &device, const BuildOptions &build, const Sources &sources) {
    return math_errors(device, build_selftest(device, build, sources), build.math);
}

Findings run_basics(const Device &device, const SelftestOptions &options) {
    const cl::Program program = build_selftest(device, options.build, *options.sources);
    Findings findings = {none_wrong("records laid out otherwise", wrong_layouts(device, program))};
    append(findings, check_numbers(device, options));
    append(findings, math_errors(device, program, options.build.math));
    return findings;
}

} // namespace opal
