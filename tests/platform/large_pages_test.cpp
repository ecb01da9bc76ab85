#include "platform/large_pages.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

using namespace tactus;

namespace {

std::vector<std::uint32_t> counted(std::size_t count) {
    std::vector<std::uint32_t> values(count);
    std::iota(values.begin(), values.end(), 7u);
    return values;
}

}  // namespace

TEST(LargePages, WhatIsMovedStaysWhatAndWhereItWas) {
    std::vector<std::uint32_t> values = counted(std::size_t{3} << 20);  // 12 MiB
    const std::uint32_t* const before = values.data();
    // Neither end on a page's border.
    move_to_large_pages(std::as_bytes(std::span(values)).subspan(4, 11'000'000));
    EXPECT_EQ(values.data(), before);
    EXPECT_EQ(values, counted(values.size()));
    values[1'000'000] = 5;
    EXPECT_EQ(values[1'000'000], 5u);
}

TEST(LargePages, WhatFillsNoPageIsLeftAlone) {
    const std::vector<std::uint32_t> values = counted(100);
    move_to_large_pages(std::as_bytes(std::span(values)));
    move_to_large_pages({});
    EXPECT_EQ(values, counted(100));
}
