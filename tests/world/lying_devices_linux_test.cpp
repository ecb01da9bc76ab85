// Every field of a reading with every lie, by every driver that a library or a service stands in for: a whole
// session, in real time. How long anything takes is the bench's to judge.
#include <gtest/gtest.h>

#include "shared/stand_in_devices_linux.hpp"

namespace tactus::lying_devices_linux_test {
namespace {

using shared::LyingDevice;
using shared::LyingFigures;
using shared::LyingHand;
using stand_ins::Field, stand_ins::Lie;

// A tick that is late on a busy machine is a cut of its own: what is not safe then is played again.
LyingFigures played(LyingHand& hand, bool is_cut, Field field, Lie lie, bool& is_safe) {
    LyingFigures figures;
    is_safe = false;
    for (int round = 0; round < 4 && !is_safe; ++round) {
        figures = hand.play(field, lie);
        is_safe = figures.force > 1.0 && (!is_cut || figures.to_zero_ms >= 0.0) && figures.has_returned &&
                  figures.return_step_max <= 1e-3 * hand.slew() + 0.01;
    }
    return figures;
}

void expect_safe(const LyingDevice& device) {
    LyingHand hand(device);
    ASSERT_TRUE(hand.is_there());
    for (int i = 0; i < static_cast<int>(Field::count); ++i) {
        for (int k = 1; k < static_cast<int>(Lie::count); ++k) {
            const auto field = static_cast<Field>(i);
            const auto lie = static_cast<Lie>(k);
            bool is_safe = false;
            const LyingFigures figures =
                played(hand, shared::is_nonsense(device, field, lie), field, lie, is_safe);
            EXPECT_TRUE(is_safe) << "field " << i << ", lie " << k << ": of " << figures.force
                                 << " N none after " << figures.to_zero_ms << " ms, back in steps of "
                                 << figures.return_step_max << " N"
                                 << (figures.has_returned ? "" : ", and not whole");
        }
    }
}

TEST(LyingDevices, ForceDimension) {
    auto& dhd = *shared::stand_in<stand_ins::ForceDimension>({"libdhd.so"}, "stand_in_force_dimension");
    dhd.has_wrist = true;
    dhd.buttons = 1;
    expect_safe(shared::force_dimension_device());
    EXPECT_EQ(dhd.wrong_calls, 0);
    dhd.has_wrist = false;
    dhd.buttons = 0;
}

TEST(LyingDevices, OpenHaptics) {
    auto& hd = *shared::stand_in<stand_ins::OpenHaptics>({"libHD.so"}, "stand_in_openhaptics");
    hd.buttons = 1;
    expect_safe(shared::openhaptics_device());
    EXPECT_EQ(hd.wrong_calls, 0);
    hd.buttons = 0;
}

TEST(LyingDevices, Inverse3) {
    JsonReader json;
    RuntimeLibrary wslay;
    if (!json.load().empty() || !wslay.load({"libwslay.so.1"}, "wslay_event_recv")) {
        GTEST_SKIP() << "libwslay1 and libjansson4 are needed";
    }
    shared::HaplyService service;
    expect_safe(shared::inverse3_device(service));
}

}  // namespace
}  // namespace tactus::lying_devices_linux_test
