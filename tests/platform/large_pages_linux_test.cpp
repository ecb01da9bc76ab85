#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>
#include <fstream>
#include <string>

#include "platform/large_pages.hpp"

using namespace tactus;

namespace {

// Of all anonymous memory of this process, what lies in large pages (unit: kB).
long in_large_pages() {
    std::ifstream sums("/proc/self/smaps_rollup");
    for (std::string line; std::getline(sums, line);) {
        if (line.starts_with("AnonHugePages:")) {
            return std::stol(line.substr(14));
        }
    }
    return -1;
}

bool system_has_them() {
    std::string choice;
    std::ifstream enabled("/sys/kernel/mm/transparent_hugepage/enabled");
    return std::getline(enabled, choice) && choice.find("[never]") == std::string::npos &&
           in_large_pages() >= 0;
}

}  // namespace

TEST(LargePagesOnLinux, MemoryInUseIsMoved) {
    if (!system_has_them()) {
        GTEST_SKIP() << "this system gives no large pages to programs";
    }
    constexpr std::size_t size = std::size_t{32} << 20;
    void* const memory = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    ASSERT_NE(memory, MAP_FAILED);
    ASSERT_EQ(madvise(memory, size, MADV_NOHUGEPAGE), 0);
    std::memset(memory, 3, size);
    const long before = in_large_pages();
    move_to_large_pages({static_cast<const std::byte*>(memory), size});
    const long after = in_large_pages();
    munmap(memory, size);
    if (after == before) {
        GTEST_SKIP() << "Linux older than 6.1, or no large page free: they come later, or not";
    }
    EXPECT_GE(after - before, 8 * 2048);
}
