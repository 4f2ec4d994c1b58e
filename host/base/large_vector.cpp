#include "base/large_vector.h"

#include <cstdint>
#include <cstdlib>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <sys/mman.h>

namespace opal {

void return_large_blocks() {
#ifdef __GLIBC__
    constexpr int large = 1 << 20;
    mallopt(M_MMAP_THRESHOLD, large);
    mallopt(M_TRIM_THRESHOLD, 2 * large); // glibc's own proportion
#endif
}

void advise_huge_pages(void *memory, std::size_t bytes) {
    char *const begin = static_cast<char *>(memory), *const end = begin + bytes;
    char *const first = begin + (huge_page - reinterpret_cast<std::uintptr_t>(begin) % huge_page) % huge_page;
    if (first + huge_page <= end)
        madvise(first, std::size_t(end - first) / huge_page * huge_page, MADV_HUGEPAGE);
}

} // namespace opal
