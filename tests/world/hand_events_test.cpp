#include "world/hand_events.hpp"

#include <gtest/gtest.h>

#include <string>

namespace tactus::hand_events_test {
namespace {

std::string told(const DeviceState& before, const DeviceState& now) {
    std::string all;
    for (const HandEvent& event : hand_events(before, now)) {
        all += std::string(event.name) + (event.button >= 0 ? std::to_string(event.button) : "") + " ";
    }
    return all;
}

TEST(HandEvents, NothingIsToldOfWhatIsAsItWas) {
    DeviceState state;
    EXPECT_EQ(told(state, state), "");
    state.connected = true;
    state.limited = 1;
    state.buttons = 5;
    EXPECT_EQ(told(state, state), "");
}

TEST(HandEvents, ComingAndGoingAreTold) {
    DeviceState there;
    there.connected = true;
    EXPECT_EQ(told({}, there), "connected ");
    EXPECT_EQ(told(there, {}), "disconnected ");
}

TEST(HandEvents, ALimitIsToldWhereItBegins) {
    DeviceState limited;
    limited.limited = 1;
    DeviceState otherwise;
    otherwise.limited = 2;
    EXPECT_EQ(told({}, limited), "force_limited ");
    EXPECT_EQ(told(limited, otherwise), "");
    EXPECT_EQ(told(limited, {}), "");
}

TEST(HandEvents, EachButtonIsToldByItsNumber) {
    DeviceState before, now;
    before.buttons = 0b0110;
    now.buttons = 0x8000'0000u | 0b0011;
    EXPECT_EQ(told(before, now), "button_pressed0 button_released2 button_pressed31 ");
}

}  // namespace
}  // namespace tactus::hand_events_test
