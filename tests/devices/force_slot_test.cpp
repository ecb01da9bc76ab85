#include "devices/force_slot.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <glm/geometric.hpp>

namespace tactus {
namespace {

constexpr Nanoseconds ms = 1'000'000;
constexpr Nanoseconds begin = 1'000 * ms;
const Vec3 asked(0.0, 4.0, 0.0);

DeviceCapabilities device() {
    DeviceCapabilities device;
    device.rate = 1000.0;
    device.max_slew = 4000.0;
    device.max_torque_slew = 50.0;
    return device;
}

ForceCommand command(const Vec3& force, Nanoseconds now) {
    return {force, Vec3(0.0), now, now - ms / 10, now};
}

// A loop, a driver at a pace of its own and a watchdog, in virtual time.
struct Line {
    ForceSlot slot;
    Nanoseconds tick = ms, look = ms;
    Nanoseconds next_write = begin, next_look = begin;
    Nanoseconds now = begin;
    bool loop_goes = true, device_goes = true, driver_goes = true;
    double least = 1e9;          // of what is displayed
    double most_step = 0.0;      // from one look to the next
    int taken = 0;               // by the watchdog,
    Nanoseconds taken_look = 0;  // last after this look of the driver
    Vec3 displayed{0.0};

    Line() { slot.begin(device(), true); }

    void run_until(Nanoseconds end) {
        while (now < end) {
            now = std::min({end, next_write, next_look});
            const ForceSlot::Due due = slot.due();
            if (due.looked_at != 0 && due.at < now && due.looked_at != taken_look) {
                taken_look = due.looked_at;
                slot.note_taken(due.at);
                slot.taken();
                displayed = Vec3(0.0);
                ++taken;
            }
            if (now == next_write) {
                if (loop_goes) {
                    slot.write(command(asked, now));
                }
                next_write += tick;
            }
            if (now == next_look) {
                look_once();
                next_look += look;
            }
        }
    }
    void look_once() {
        if (device_goes && driver_goes) {
            slot.heard(now, now);
        }
        if (driver_goes) {
            const Vec3 force = slot.living(now);
            most_step = std::max(most_step, glm::distance(force, displayed));
            displayed = force;
            least = std::min(least, displayed.y);
            slot.given(now);
        }
    }
};

// A force that lived 1.5 ms was cut behind nearly half of all phases.
TEST(ForceSlot, AnEvenLoopIsNotCutAtAnyPhaseOrRate) {
    for (const double rate : {4000.0, 2000.0, 1000.0, 640.0}) {
        for (int phase = 0; phase < 32; ++phase) {
            Line line;
            line.tick = from_seconds(1.0 / rate);
            line.slot.set_pace({line.tick, true});
            line.next_look = begin + phase * ms / 32;
            line.run_until(begin + 20 * ms);
            line.least = 1e9;
            line.run_until(begin + 2'000 * ms);
            EXPECT_EQ(line.least, 4.0) << rate << " Hz, phase " << phase;
            EXPECT_EQ(line.taken, 0) << rate << " Hz, phase " << phase;
            EXPECT_EQ(line.slot.cuts(), ForceSlot::Cuts{}) << rate << " Hz, phase " << phase;
        }
    }
}

// It declares a thousand exchanges a second, or says nothing of them: its lives follow from what it does.
TEST(ForceSlot, ADeviceThatIsSlowerThanItSaysIsNotCutAgainAndAgain) {
    for (const bool is_paced : {true, false}) {
        for (const Nanoseconds period : {ms * 13 / 10, ms * 16 / 10, 2 * ms, ms * 23 / 10}) {
            Line line;
            line.slot.begin(device(), is_paced);
            line.look = period;
            line.run_until(begin + 500 * ms);
            const ForceSlot::Cuts before = line.slot.cuts();
            line.taken = 0;
            line.least = 1e9;
            line.run_until(begin + 2'500 * ms);
            EXPECT_EQ(line.least, 4.0) << period;
            EXPECT_EQ(line.taken, 0) << period;
            EXPECT_EQ(line.slot.cuts(), before) << period;
            line.loop_goes = false;
            const Nanoseconds last = line.next_write - ms;
            line.run_until(last + free_within + 1);
            EXPECT_EQ(line.displayed, Vec3(0.0)) << "and free 2 ms after the loop, " << period;
        }
    }
}

TEST(ForceSlot, ADeviceThatAnswersTooSeldomIsGivenNothingUntilItAnswersOftenAgain) {
    for (const bool is_paced : {true, false}) {
        Line line;
        line.slot.begin(device(), is_paced);
        line.look = 4 * ms;
        line.run_until(begin + 1'000 * ms);
        EXPECT_TRUE(line.slot.is_too_slow());
        line.least = 1e9;
        const ForceSlot::Cuts before = line.slot.cuts();
        line.run_until(begin + 2'000 * ms);
        EXPECT_EQ(line.displayed, Vec3(0.0));
        EXPECT_EQ(line.slot.cuts(), before) << "it is refused, and not cut";
        line.look = ms;
        line.most_step = 0.0;
        line.run_until(begin + 6'000 * ms);
        EXPECT_FALSE(line.slot.is_too_slow());
        EXPECT_EQ(line.displayed, asked);
        EXPECT_LE(line.most_step, 4.0);
    }
}

// While no loop writes a driver looks as seldom as it likes.
TEST(ForceSlot, HowOftenADeviceIsReadWithoutALoopIsNotHeldAgainstIt) {
    Line line;
    line.slot.begin(device(), false);
    line.loop_goes = false;
    line.look = 10 * ms;
    line.run_until(begin + 5'000 * ms);
    line.loop_goes = true;
    line.look = ms;
    line.run_until(line.now + 20 * ms);
    EXPECT_FALSE(line.slot.is_too_slow());
    EXPECT_EQ(line.displayed, asked);
}

TEST(ForceSlot, ALoopThatIsRefusedGetsNothing) {
    for (const LoopPace pace :
         {LoopPace{10 * ms, true}, LoopPace{4 * ms, true}, LoopPace{2 * ms, true}, LoopPace{ms, false}}) {
        Line line;
        line.tick = pace.period;
        line.slot.set_pace(pace);
        line.run_until(begin + 100 * ms);
        EXPECT_EQ(line.displayed, Vec3(0.0));
        EXPECT_EQ(line.most_step, 0.0);
    }
}

TEST(ForceSlot, TheHandIsFreeTwoMillisecondsAfterTheLoop) {
    for (int phase = 0; phase < 32; ++phase) {
        Line line;
        line.next_look = begin + phase * ms / 32;
        line.run_until(begin + 50 * ms);
        line.loop_goes = false;
        const Nanoseconds last = line.next_write - ms;
        EXPECT_LE(line.slot.due().at, last + free_within) << phase;
        line.run_until(last + free_within + 1);
        EXPECT_EQ(line.displayed, Vec3(0.0)) << phase;
        EXPECT_EQ(line.slot.cuts()[static_cast<std::size_t>(ForceCut::loop_silent)], 1u) << phase;
    }
}

TEST(ForceSlot, TheHandIsFreeTwoMillisecondsAfterTheDevice) {
    Line line;
    line.run_until(begin + 50 * ms);
    line.device_goes = false;
    line.look = ms / 4;
    line.run_until(begin + 50 * ms + free_within + line.look);
    EXPECT_EQ(line.displayed, Vec3(0.0));
    EXPECT_EQ(line.slot.cuts()[static_cast<std::size_t>(ForceCut::device_silent)], 1u);
}

// Behind a device that is slower than it says, or whose readings come late now and then, a force outlived the
// first reading that did not come by a whole exchange more.
TEST(ForceSlot, TheHandIsFreeTwoMillisecondsAfterAReadingThatDoesNotCome) {
    struct Rhythm {
        Nanoseconds usual, late;  // from one reading to the next; every fiftieth is late
    };
    for (const Rhythm& rhythm : {Rhythm{ms, ms}, Rhythm{ms * 105 / 100, ms * 17 / 10},
                                 Rhythm{ms * 16 / 10, ms * 16 / 10}, Rhythm{ms * 23 / 10, ms * 23 / 10}}) {
        Line line;
        for (int i = 0; i < 5'000; ++i) {
            line.look = i % 50 == 0 ? rhythm.late : rhythm.usual;
            line.run_until(line.next_look + 1);
        }
        ASSERT_EQ(line.displayed, asked);
        line.device_goes = false;
        line.next_look -= line.look - ms / 20;  // the driver has just read, and looks on
        line.look = ms / 20;
        line.run_until(line.now + rhythm.usual + free_within);
        EXPECT_EQ(line.displayed, Vec3(0.0)) << rhythm.usual << ", " << rhythm.late;
    }
}

TEST(ForceSlot, TheHandIsFreeTwoMillisecondsAfterTheDriver) {
    Line line;
    line.run_until(begin + 50 * ms);
    line.driver_goes = false;
    line.run_until(begin + 50 * ms + free_within);
    EXPECT_EQ(line.displayed, Vec3(0.0));
    EXPECT_EQ(line.taken, 1);
    EXPECT_EQ(line.slot.cuts()[static_cast<std::size_t>(ForceCut::driver_stuck)], 1u);
}

// Whatever has stopped, and however long.
TEST(ForceSlot, AfterACutTheForceGrowsFromNothing) {
    for (bool Line::* what : {&Line::loop_goes, &Line::device_goes, &Line::driver_goes}) {
        for (const Nanoseconds span : {3 * ms, 30 * ms, 5'000 * ms}) {
            Line line;
            line.run_until(begin + 50 * ms);
            line.*what = false;
            line.run_until(begin + 50 * ms + span);
            ASSERT_EQ(line.displayed, Vec3(0.0));
            line.*what = true;
            line.most_step = 0.0;
            line.look = ms / 4;
            line.run_until(line.now + 20 * ms);
            EXPECT_EQ(line.displayed, asked);
            EXPECT_LE(line.most_step, 4.0);
            EXPECT_GT(line.most_step, 0.0);
        }
    }
}

// The watchdog says so before it takes the force away, and after: the driver may look at any moment between.
TEST(ForceSlot, ADriverThatLooksWhileItsForceIsTakenAwayBeginsAtNothing) {
    Line line;
    line.run_until(begin + 50 * ms);
    ASSERT_EQ(line.displayed, asked);
    line.slot.write(command(asked, line.now));
    line.slot.taken();
    const Vec3 between = line.slot.living(line.now + ms / 8);
    EXPECT_LE(glm::length(between), 0.5 + 1e-9) << "4 N/ms";
    line.slot.given(line.now + ms / 8);
    line.slot.taken();
    EXPECT_LE(glm::length(line.slot.living(line.now + ms / 4)), 0.5 + 1e-9) << "not on from there";
}

// A service is given a force for each of its states alone, and the driver looks in between.
TEST(ForceSlot, AForceThatReturnsGrowsFromWhatTheDeviceHas) {
    Line line;
    line.run_until(begin + 50 * ms);
    line.slot.taken();
    for (int look = 1; look <= 3; ++look) {
        line.slot.write(command(asked, line.now));
        line.displayed = line.slot.living(line.now + look * ms / 4);
        EXPECT_LE(glm::length(line.displayed), look * 1.0 + 1e-9) << "nothing has been sent, look " << look;
    }
    line.slot.given(line.now + ms);
    EXPECT_LE(glm::distance(line.slot.living(line.now + ms * 5 / 4), line.displayed), 1.0 + 1e-9);
}

TEST(ForceSlot, AForceThatReturnsIsAsSlowAsTheDevice) {
    Line line;
    line.run_until(begin + 50 * ms);
    line.loop_goes = false;
    line.run_until(begin + 55 * ms);
    line.loop_goes = true;
    line.look = ms / 8;
    line.next_look = line.now;
    line.run_until(line.now + 10 * ms);
    line.most_step = 0.0;
    line.slot.rest();
    line.displayed = Vec3(0.0);
    line.run_until(line.now + 10 * ms);
    EXPECT_LE(line.most_step, 0.5 + 1e-9) << "4 N/ms in an eighth of a millisecond";
    EXPECT_EQ(line.displayed, asked);
}

TEST(ForceSlot, AReadingIsTakenBeforeTheLoopLooks) {
    ForceSlot slot;
    slot.begin(device(), false);
    Nanoseconds look = begin, read = begin;
    Nanoseconds needed = 120'000;  // from a reading until the loop has it
    int late = 0;
    for (int i = 0; i < 5'000; ++i) {
        slot.heard(read, read + needed);
        const bool is_there = read + needed <= look;
        late += is_there || i < 500 ? 0 : 1;
        slot.write({asked, Vec3(0.0), look + 50'000, is_there ? read : read - ms, look});
        slot.living(look + 60'000);
        read = slot.next_reading();
        look += ms;
    }
    EXPECT_LT(late, 100);
    EXPECT_LT(look - read, ms / 4) << "and no sooner than it needs";
}

}  // namespace
}  // namespace tactus
