#include "device/program.h"

#include "base/error.h"
#include "base/log.h"
#include "base/units.h"
#include "base/values.h"
#include "device/kernel_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <exception>
#include <sstream>
#include <utility>

#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

namespace opal {

namespace {

// $OPAL_KERNEL_FLAGS adds flags, for experiments. The tests set -Werror by it.
std::string build_flags(const BuildOptions &options) {
    std::string flags = "-cl-std=CL1.2";
    if (options.math == MathMode::fast)
        flags += " -cl-fast-relaxed-math";
    if (const char *more = std::getenv("OPAL_KERNEL_FLAGS"); more && *more)
        flags += std::string(" ") + more;
    return flags;
}

// Most drivers report places by the #line directives: "cl/kernels/render.cl:40:18: ...".
std::string log_of(const cl::Program &program, const cl::Device &device) {
    try {
        return program.getBuildInfo<CL_PROGRAM_BUILD_LOG>(device);
    } catch (const cl::Error &error) {
        return "(the driver gives no log: " + cl_error_name(error.err()) + ")";
    }
}

// Whether $PATH has such a program.
bool has_program(const std::string &name) {
    const char *const path = std::getenv("PATH");
    std::istringstream folders(path ? path : "/bin:/usr/bin");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((folder + "/" + name).c_str(), X_OK) == 0)
            return true;
    return false;
}

// PoCL 3.1 ends the process where it cannot link a kernel for a CPU.
bool lacks_linker(const Device &device) {
    return device.info.platform == "Portable Computing Language" && device.info.type == "cpu" && !has_program("ld") &&
           !has_program("ld.lld");
}

std::string linker_text() { return "PoCL needs the program ld, and $PATH has none (Debian: apt-get install binutils)"; }

// What may have kept the driver from building, as drivers do not say: a line each.
std::string lacking(const Device &device) {
    constexpr rlim_t small_file = 16 << 20, small_memory = 2ull << 30; // bytes; a program's files take less than 1 MB
    std::string text;
    if (lacks_linker(device))
        text += "\n" + linker_text();
    rlimit limit{};
    if (getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur < small_file)
        text += fmt::format("\na file may have at most {} (ulimit -f)", bytes_text(limit.rlim_cur));
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur < small_memory)
        text += fmt::format("\nthis process may have at most {} of memory (ulimit -v)", bytes_text(limit.rlim_cur));
    const std::string folder = WorkFolder::own().driver_files().string();
    struct statvfs status {};
    if (statvfs(folder.c_str(), &status) != 0)
        text += fmt::format("\nthe driver's folder is gone: {}", folder);
    else if (const auto room = 1ull * status.f_bavail * status.f_frsize; room < small_file)
        text += fmt::format("\nthe disk is full: {} left in {}", bytes_text(room), folder);
    return text;
}

// All that compiled kernels depend on.
std::string identity_of(const Device &device, const std::string &key) {
    const DeviceInfo &info = device.info;
    return fmt::format("{}\n{}\n{}\n{}\n{}", info.platform, info.name, info.version, info.driver, key);
}

} // namespace

cl::Program build_program(const Device &device, const std::string &text, const BuildOptions &options, double *seconds) {
    const auto start = std::chrono::steady_clock::now();
    auto &programs = device.handles->programs;
    const std::string key = build_flags(options) + '\n' + text;
    if (const auto known = std::ranges::find(programs, key, &BuiltProgram::key);
        known != programs.end() && options.cache_salt.empty()) {
        std::rotate(programs.begin(), known, known + 1);
        if (seconds)
            *seconds = 0;
        return programs.front().program;
    }
    const DriverScope scope;
    std::shared_ptr<CachedProgram> file;
    if (options.cache_salt.empty())
        file = std::make_shared<CachedProgram>(identity_of(device, key), WorkFolder::own().driver_files());
    cl::Program program = with_device(device.info, [&] { return cl::Program(device.handles->context, text); });
    try {
        program.build({device.handles->device}, build_flags(options).c_str());
    } catch (const cl::Error &error) {
        std::vector<std::string> lines = lines_of(log_of(program, device.handles->device) + lacking(device));
        lines.insert(lines.begin(),
                     fmt::format("{} (driver {}): the kernels do not build: {}; flags {}", device.info.name,
                                 device.info.driver, cl_error_name(error.err()), build_flags(options)));
        throw ErrorList(lines);
    }
    if (file)
        file->find_files();
    if (const bool cached = file && file->was_cached(); lacks_linker(device)) {
        if (!cached)
            throw Error(fmt::format("{}: the kernels cannot be linked: {}", device.info.name, linker_text()));
        if (static bool warned = false; !std::exchange(warned, true))
            warn(fmt::format("{}: the driver ends this process if it needs more than the compiled kernels in the "
                             "cache: {}",
                             device.info.name, linker_text()));
    }
    const double taken = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    detail(fmt::format("build   {} for {} in {:.3g} s; flags {}; the driver says:\n{}",
                       options.kernels.empty() ? "the renderer" : options.kernels, device.info.name, taken,
                       build_flags(options), log_of(program, device.handles->device)));
    if (seconds)
        *seconds = taken;
    constexpr size_t most_programs = 4; // a renderer has two
    programs.insert(programs.begin(), {key, program, file});
    programs.resize(std::min(programs.size(), most_programs));
    return program;
}

LaunchScope::LaunchScope(const Device &device, const cl::Kernel &kernel) : exceptions_(std::uncaught_exceptions()) {
    const cl_program program = kernel.getInfo<CL_KERNEL_PROGRAM>()();
    for (const BuiltProgram &built : device.handles->programs)
        if (built.program() == program)
            file_ = built.file;
    first_ = file_ && file_->was_cached() && file_->is_first_launch(kernel.getInfo<CL_KERNEL_FUNCTION_NAME>());
    if (first_)
        WorkFolder::own().mark(file_->path());
}

LaunchScope::~LaunchScope() {
    const bool failed = std::uncaught_exceptions() > exceptions_;
    if (first_)
        WorkFolder::own().unmark();
    if (first_ && failed)
        file_->remove();
    if (!file_ || failed)
        return;
    try {
        file_->store();
    } catch (const std::exception &error) {
        warn(fmt::format("compiled kernels are not kept for the next run: {}", error.what()));
    }
}

} // namespace opal
