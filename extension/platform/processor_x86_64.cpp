#include <cpuid.h>

#include <cstdint>

#include "platform/processor.hpp"

namespace tactus {

namespace {

// Bits of CPUID (Intel's manual, volume 2) and of XCR0.
constexpr std::uint32_t fma_and_osxsave = 1u << 12 | 1u << 27;  // leaf 1, ECX
constexpr std::uint32_t avx2_and_bmi2 = 1u << 5 | 1u << 8;      // leaf 7, EBX
constexpr std::uint32_t xmm_and_ymm = 1u << 1 | 1u << 2;

// What the system saves of the registers when it switches threads; only where OSXSAVE is set.
std::uint32_t saved_registers() {
    std::uint32_t low = 0, high = 0;
    __asm__("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

constexpr bool has_all(std::uint32_t bits, std::uint32_t wanted) {
    return (bits & wanted) == wanted;
}

// Asked of the processor itself: __builtin_cpu_supports() needs a part of the compiler's library that not
// every one of them has.
bool has_avx2_fma_and_bmi2() {
    std::uint32_t a = 0, b = 0, c = 0, d = 0;
    if (__get_cpuid(1, &a, &b, &c, &d) == 0 || !has_all(c, fma_and_osxsave) ||
        !has_all(saved_registers(), xmm_and_ymm)) {
        return false;
    }
    return __get_cpuid_count(7, 0, &a, &b, &c, &d) != 0 && has_all(b, avx2_and_bmi2);
}

}  // namespace

void relax_processor() {
    __builtin_ia32_pause();
}

const char* missing_in_processor() {
    return has_avx2_fma_and_bmi2() ? nullptr
                                   : "a processor with AVX2 and FMA (Intel since 2013, AMD since 2015)";
}

}  // namespace tactus
