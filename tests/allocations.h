/// The memory of a test program on the host, counted by its operators new and delete. For one source of a program.
#pragma once
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <malloc.h>
#include <new>

namespace vkpm {

inline std::atomic<std::size_t> heapBytes{0};
inline std::atomic<std::size_t> heapPeak{0};
/// An allocation that would take the heap beyond this throws std::bad_alloc.
inline std::atomic<std::size_t> heapLimit{SIZE_MAX};

inline void* countedAllocate(std::size_t size) {
    if (size > heapLimit || heapBytes + size > heapLimit) throw std::bad_alloc();
    void* memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr) throw std::bad_alloc();
    const std::size_t now = heapBytes += ::malloc_usable_size(memory);
    if (now > heapPeak) heapPeak = now;
    return memory;
}

inline void countedFree(void* memory) {
    if (memory == nullptr) return;
    heapBytes -= ::malloc_usable_size(memory);
    std::free(memory);
}

} // namespace vkpm

void* operator new(std::size_t size) { return vkpm::countedAllocate(size); }
void operator delete(void* memory) noexcept { vkpm::countedFree(memory); }
void operator delete(void* memory, std::size_t) noexcept { vkpm::countedFree(memory); }
