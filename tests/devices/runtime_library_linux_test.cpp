#include "devices/runtime_library.hpp"

#include <gtest/gtest.h>

namespace tactus::runtime_library_linux_test {
namespace {

TEST(RuntimeLibrary, FindsAllFunctionsOrNone) {
    RuntimeLibrary library;
    ASSERT_TRUE(library.load({"libnone.so", "libc.so.6"}, "abs"));
    int (*absolute)(int) = nullptr;
    long (*long_absolute)(long) = nullptr;
    EXPECT_FALSE(library.find({{"abs", absolute}, {"no_such_function", long_absolute}}));
    EXPECT_EQ(absolute, nullptr);
    EXPECT_TRUE(library.find({{"abs", absolute}, {"labs", long_absolute}}));
    EXPECT_EQ(absolute(-3), 3);
    EXPECT_EQ(long_absolute(-4L), 4L);
}

TEST(RuntimeLibrary, IsNotThereWithoutTheFunctionThatTellsIt) {
    RuntimeLibrary library;
    EXPECT_FALSE(library.load({"libnone.so", "libc.so.6"}, "no_such_function"));
}

}  // namespace
}  // namespace tactus::runtime_library_linux_test
