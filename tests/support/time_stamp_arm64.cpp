#include "support/process.hpp"

namespace tactus::testing {

std::uint64_t time_stamp() {
    std::uint64_t count;
    asm volatile("isb\n\tmrs %0, cntvct_el0\n\tisb" : "=r"(count) : : "memory");
    return count;
}

}  // namespace tactus::testing
