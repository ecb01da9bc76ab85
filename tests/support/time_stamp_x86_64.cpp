#include <x86intrin.h>

#include "support/process.hpp"

namespace tactus::testing {

// rdtscp waits for what stands before it; the fence keeps what stands after it from starting earlier.
std::uint64_t time_stamp() {
    unsigned processor = 0;
    const std::uint64_t count = __rdtscp(&processor);
    _mm_lfence();
    return count;
}

}  // namespace tactus::testing
