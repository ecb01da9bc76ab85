#include "platform/processor.hpp"

#include <gtest/gtest.h>

namespace tactus::processor_x86_64_test {
namespace {

TEST(Processor, IsJudgedAsTheCompilersOwnLibraryJudgesIt) {
    __builtin_cpu_init();
    const bool suffices =
        __builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi2");
    EXPECT_EQ(missing_in_processor() == nullptr, suffices);
}

}  // namespace
}  // namespace tactus::processor_x86_64_test
