// A Falcon whose reports are nonsense, leap or fail to come, below libusb: a whole session, in real time. How
// long anything takes is the bench's to judge.
#include <gtest/gtest.h>

#include "devices/falcon/falcon_driver.hpp"
#include "played/played_usb.hpp"
#include "shared/lying_figures.hpp"

namespace tactus::lying_falcon_test {
namespace {

using stand_ins::Field, stand_ins::Lie;

TEST(PlayedFalcon, OnNonsenseItsForceGoesAndGrowsAgain) {
    shared::PlayedUsb usb({});
    usb.plug();
    usb.mean({0.0, -0.03, 0.0});
    usb.press(1);
    const shared::LyingDevice device{
        {[] {
             FalconSettings settings;
             settings.firmware = shared::PlayedFalcon::firmware();
             return std::make_unique<FalconDriver>(settings);
         },
         [&usb] { return usb.force(); }, [&usb] { return usb.take_most_step(); }},
        [&usb](Field field, Lie lie) { usb.lie(field, lie); },
        [&usb] { return usb.lied_at(); },
        false};
    shared::LyingHand hand(device);
    ASSERT_TRUE(hand.is_there());
    for (const Field field : {Field::position, Field::buttons}) {
        for (int lie = 1; lie < static_cast<int>(Lie::count); ++lie) {
            const bool is_cut = shared::is_nonsense(device, field, static_cast<Lie>(lie));
            shared::LyingFigures figures;
            bool is_safe = false;
            // A tick that is late on a busy machine is a cut of its own: then it is played again.
            for (int round = 0; round < 4 && !is_safe; ++round) {
                figures = hand.play(field, static_cast<Lie>(lie));
                is_safe = figures.force > 1.0 && (!is_cut || figures.to_zero_ms >= 0.0) &&
                          figures.has_returned && figures.return_step_max <= 1e-3 * hand.slew() + 0.5;
            }
            EXPECT_TRUE(is_safe) << "lie " << lie << ": of " << figures.force << " N none after "
                                 << figures.to_zero_ms << " ms, back in steps of " << figures.return_step_max
                                 << " N" << (figures.has_returned ? "" : ", and not whole");
        }
    }
}

}  // namespace
}  // namespace tactus::lying_falcon_test
