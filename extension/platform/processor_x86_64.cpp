#include "platform/processor.hpp"

namespace tactus {

void relax_processor() {
    __builtin_ia32_pause();
}

const char* missing_in_processor() {
    __builtin_cpu_init();
    const bool suffices =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    return suffices ? nullptr : "a processor with AVX2 and FMA (Intel since 2013, AMD since 2015)";
}

}  // namespace tactus
