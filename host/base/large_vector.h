// Arrays of millions of elements, in huge pages where the system gives them on request: the system then hands memory
// out 2 MiB at a time instead of 4 KiB, and a walk through a large tree spends a tenth less on finding its pages.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace opal {

// Asks for huge pages for the part of a block of memory that they can cover. It is advice: no harm where it is refused.
void advise_huge_pages(void *memory, std::size_t bytes);

constexpr std::size_t huge_page = 2u << 20;

// Gives the pages that lie wholly in a part of a block of memory back to the system. Their bytes are lost.
void drop_pages(void *memory, std::size_t bytes);

// Makes malloc give every large block back to the system once it is freed. By default glibc keeps blocks below the size
// of the largest one that was freed before, up to 32 MiB, and they add to the peak of what comes later.
void return_large_blocks();

// Smaller arrays are those of std::vector.
constexpr bool is_large(std::size_t bytes) { return bytes >= huge_page; }

template <class T> struct LargeAllocator {
    using value_type = T;
    LargeAllocator() = default;
    template <class U> LargeAllocator(const LargeAllocator<U> &) {}

    T *allocate(std::size_t count) {
        const std::size_t bytes = count * sizeof(T);
        if (!is_large(bytes))
            return static_cast<T *>(::operator new(bytes));
        void *memory = ::operator new(bytes, std::align_val_t(huge_page));
        advise_huge_pages(memory, bytes);
        return static_cast<T *>(memory);
    }
    void deallocate(T *memory, std::size_t count) {
        if (is_large(count * sizeof(T)))
            ::operator delete(memory, std::align_val_t(huge_page));
        else
            ::operator delete(memory);
    }
    bool operator==(const LargeAllocator &) const { return true; }
};

template <class T> using LargeVector = std::vector<T, LargeAllocator<T>>;

// Empties a container and frees its memory. Assigning {} keeps it.
template <class Container> void free_memory(Container &container) { Container().swap(container); }

} // namespace opal
