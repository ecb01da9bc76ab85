// What a hand is given by a device that lies about a field of its readings, in real time: a whole session
// over a floor, a driver, and what stands in for the device below it.
#pragma once

#include <functional>
#include <memory>

#include "core/safety/hand_safety.hpp"
#include "devices/driver_device.hpp"
#include "shared/displayed_figures.hpp"
#include "shared/processor_stalls.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tactus::shared {

struct LyingDevice {
    WatchedDevice watched;
    std::function<void(stand_ins::Field, stand_ins::Lie)> tell;
    std::function<Nanoseconds()> told_at;  // when it first said that (on the steady clock); 0: not yet
    bool has_velocity = true;              // of its own, and a rotation; false: both follow from encoders
};

// Whether no force may be given on that. What repeats itself may be true where no other field contradicts it,
// and buttons are bits, of which each is a number.
inline bool is_nonsense(const LyingDevice& device, stand_ins::Field field, stand_ins::Lie lie) {
    using stand_ins::Field, stand_ins::Lie;
    switch (lie) {
        case Lie::no_number:
        case Lie::infinite:
            return field != Field::buttons;
        case Lie::is_frozen:
            return device.has_velocity && (field == Field::position || field == Field::velocity);
        case Lie::leaps:
        case Lie::is_silent:
            return true;
        default:
            return false;
    }
}

struct LyingFigures {
    double force = 0.0;  // before it lied (unit: newtons)
    // From when the device first said so until its motors gave nothing; -1: they always gave a force.
    double to_zero_ms = -1.0;
    bool was_even = true;          // no processor stood still until then
    double while_lying_max = 0.0;  // of the force, after that (unit: newtons)
    double return_step_max = 0.0;  // of the force, until it was whole again (unit: newtons)
    bool has_returned = false;     // to nearly what it was; the hand may lie a little otherwise
};

// A hand that is pressed into a floor, with the device's first button held. One session for all lies.
class LyingHand {
public:
    explicit LyingHand(const LyingDevice& device);
    ~LyingHand();
    LyingHand(const LyingHand&) = delete;
    LyingHand& operator=(const LyingHand&) = delete;

    bool is_there() const;
    double slew() const;  // of the device (unit: newtons per second)
    LyingFigures play(stand_ins::Field field, stand_ins::Lie lie);

private:
    class Room;
    LyingDevice device_;
    std::unique_ptr<Room> room_;
    ProcessorStalls stalls_;
};

}  // namespace tactus::shared
