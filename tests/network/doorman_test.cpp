// Who knocks at a port that is another's is told so, and nobody else is told anything.
#include "network/doorman.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "network/messages.hpp"

namespace tactus::doorman_test {
namespace {

using Bytes = std::vector<std::byte>;

Bytes greeting_of(std::uint64_t start) {
    Bytes greeting(sealed_format::greeting_bytes, std::byte{5});
    std::memcpy(greeting.data(), "TS\2\0", 4);
    std::memcpy(&greeting[sealed_format::sender_at], &start, sizeof start);
    return greeting;
}

TEST(Doorman, KnowsAKnockWithAndWithoutAKey) {
    EXPECT_EQ(number_of_knock(greeting_of(77)), 77u);
    Bytes hello(max_message_bytes);
    hello.resize(encode({99, 1, 0}, Hello{}, hello));
    EXPECT_EQ(number_of_knock(hello), 99u);
    Bytes request(max_message_bytes);
    request.resize(encode({99, 1, 0}, ClockRequest{}, request));
    EXPECT_FALSE(number_of_knock(request));
    for (std::size_t size = 0; size < hello.size(); ++size) {
        EXPECT_FALSE(number_of_knock(std::span(hello).first(size))) << size;
    }
    EXPECT_FALSE(number_of_knock(Bytes(68, std::byte{9})));
}

TEST(Doorman, SaysLessThanItIsTold) {
    const RefusalBytes said = refusal_of(77, sealed_format::expects_another);
    EXPECT_EQ(number_of_refusal(said), 77u);
    EXPECT_LT(said.size(), sealed_format::greeting_bytes);
    for (std::size_t at = 0; at < sealed_format::front_bytes; ++at) {
        RefusalBytes damaged = said;
        damaged[at] ^= std::byte{1};
        EXPECT_FALSE(number_of_refusal(damaged)) << at;
    }
    RefusalBytes other_reason = said;
    other_reason[sealed_format::reason_at] = std::byte{200};
    EXPECT_FALSE(number_of_refusal(other_reason));
    EXPECT_FALSE(number_of_refusal(std::span(said).first(said.size() - 1)));
}

// Neither is one the other: nothing that a doorman says is answered.
TEST(Doorman, ARefusalIsNoKnock) {
    EXPECT_FALSE(number_of_knock(refusal_of(77, sealed_format::expects_another)));
    EXPECT_FALSE(number_of_refusal(greeting_of(77)));
}

}  // namespace
}  // namespace tactus::doorman_test
