#include "fuzz/harness.h"

#include "base/log.h"

#include <sanitizer/allocator_interface.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <string>

#include <sys/mman.h>
#include <unistd.h>

namespace opal::fuzz {

namespace {

constexpr double seconds_per_mb = 5; // of a sanitized build, which takes some 10 times as long as a release
constexpr double least_seconds = 1;  // for files that an input names, and what is done once in a process
constexpr long long most_bytes = 1'000'000'000;

std::atomic<long long> used_bytes = 0, peak_bytes = 0; // of the heap

void count_malloc(const volatile void *, size_t bytes) {
    const long long now = used_bytes += static_cast<long long>(bytes);
    if (now > peak_bytes)
        peak_bytes = now;
}

void count_free(const volatile void *memory) {
    if (memory)
        used_bytes -= static_cast<long long>(__sanitizer_get_allocated_size(memory));
}

double cpu_seconds() {
    timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

// A stream that forgets what it is given, without a system call.
std::FILE *forgetful_stream() {
    cookie_io_functions_t functions{};
    functions.write = [](void *, const char *, size_t bytes) { return static_cast<ssize_t>(bytes); };
    return fopencookie(nullptr, "w", functions);
}

} // namespace

ServedFile::ServedFile(const char *name) : path_(std::filesystem::path(OPAL_FUZZ_FILES) / name) {
    // The name is a link to /proc/self/fd/NUMBER. So nothing is left behind, and processes do not share the file.
    descriptor_ = std::stoi(std::filesystem::read_symlink(path_).filename());
    const int memory = memfd_create(name, 0);
    require(memory >= 0 && dup2(memory, descriptor_) == descriptor_, "a file in memory");
    close(memory);
}

void ServedFile::write(std::string_view bytes) {
    require(pwrite(descriptor_, bytes.data(), bytes.size(), 0) == ssize_t(bytes.size()) &&
                ftruncate(descriptor_, off_t(bytes.size())) == 0,
            "a file in memory takes bytes");
}

void require(bool holds, const char *text) {
    if (holds)
        return;
    dprintf(STDERR_FILENO, "does not hold: %s\n", text);
    std::abort();
}

} // namespace opal::fuzz

extern "C" const char *__asan_default_options() {
    return "allocator_may_return_null=1:quarantine_size_mb=16:malloc_context_size=1";
}

extern "C" int LLVMFuzzerInitialize(int *, char ***) {
    opal::set_quiet(true);
    stderr = opal::fuzz::forgetful_stream(); // libFuzzer and the sanitizers keep the true one
    opal::fuzz::require(std::freopen("/dev/null", "w", stdout) != nullptr, "/dev/null takes stdout");
    __sanitizer_install_malloc_and_free_hooks(opal::fuzz::count_malloc, opal::fuzz::count_free);
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    using namespace opal::fuzz;
    const long long used_before = used_bytes;
    peak_bytes = used_before;
    const double start = cpu_seconds();
    try_input({reinterpret_cast<const char *>(data), size});
    opal::forget_warnings();
    const double seconds = cpu_seconds() - start;
    require(seconds <= least_seconds + seconds_per_mb * double(size) / 1e6, "at most 5 s per MB");
    require(peak_bytes - used_before <= most_bytes, "at most 1 GB");
    return 0;
}
