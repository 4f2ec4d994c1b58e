#include "base/large_vector.h"

#include <cstdint>
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/mman.h>
#include <unistd.h>

namespace opal {

void return_large_blocks() {
#ifdef __GLIBC__
    constexpr int large = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, large);
    mallopt(M_TRIM_THRESHOLD, 2 * large); // glibc's own proportion
#endif
}

namespace {

// Gives the system advice about the whole pages of a block of memory, if there are any.
void advise(void *memory, std::size_t bytes, std::size_t page, int advice) {
    char *const begin = static_cast<char *>(memory), *const end = begin + bytes;
    char *const first = begin + (page - reinterpret_cast<std::uintptr_t>(begin) % page) % page;
    if (first + page <= end)
        madvise(first, std::size_t(end - first) / page * page, advice);
}

} // namespace

void advise_huge_pages(void *memory, std::size_t bytes) { advise(memory, bytes, huge_page, MADV_HUGEPAGE); }

void drop_pages(void *memory, std::size_t bytes) {
    advise(memory, bytes, std::size_t(sysconf(_SC_PAGESIZE)), MADV_DONTNEED);
}

} // namespace opal
