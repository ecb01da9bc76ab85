#include <sys/mman.h>

#include <cstdint>

#include "platform/large_pages.hpp"

namespace tactus {

namespace {

constexpr std::uintptr_t page = std::uintptr_t{2} << 20;
#ifdef MADV_COLLAPSE
constexpr int collapse = MADV_COLLAPSE;
#else
constexpr int collapse = 25;  // of Linux since 6.1; older ones refuse it
#endif

}  // namespace

void move_to_large_pages(std::span<const std::byte> bytes) {
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes.data());
    const std::uintptr_t first = (begin + page - 1) & ~(page - 1);
    const std::uintptr_t end = (begin + bytes.size()) & ~(page - 1);
    if (first >= end) {
        return;
    }
    void* const start = reinterpret_cast<void*>(first);
    if (madvise(start, end - first, MADV_HUGEPAGE) == 0) {
        madvise(start, end - first, collapse);
    }
}

}  // namespace tactus
