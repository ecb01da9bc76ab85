// Libraries of the same names and C symbols as the vendors', for tests: what the driver says is checked, and
// what the device says comes from the test. Shared by the stand-in and its test through one function.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdint>

namespace tactus::stand_ins {

// The force of `force` becomes that: `most_step` notes how far it jumps where it grows. It may go at once.
inline void set_force(std::atomic<double> (&force)[3], std::atomic<double>& most_step, double x, double y,
                      double z) {
    const double step = std::hypot(x - force[0], y - force[1], z - force[2]);
    if (std::hypot(x, y, z) > std::hypot(force[0], force[1], force[2])) {
        most_step = std::max(most_step.load(), step);
    }
    force[0] = x;
    force[1] = y;
    force[2] = z;
}

// One field of a device's reading, and what it says instead of the truth.
enum class Field { position, velocity, rotation, buttons, count };
enum class Lie { none, no_number, infinite, leaps, is_frozen, is_silent, count };

struct Lying {
    std::atomic<Field> field{Field::position};
    std::atomic<Lie> lie{Lie::none};
    // When the device first said what is not so (on the steady clock; unit: nanoseconds); 0: not yet.
    mutable std::atomic<std::int64_t> told_at{0};

    void begin(Field of, Lie manner) {
        lie = Lie::none;
        field = of;
        told_at = 0;
        lie = manner;
    }
    void note() const {
        const std::chrono::nanoseconds now = std::chrono::steady_clock::now().time_since_epoch();
        std::int64_t not_yet = 0;
        told_at.compare_exchange_strong(not_yet, now.count());
    }

    // A value of that field; `leapt`: where it leaps to.
    double told(Field of, double truth, double leapt) const {
        if (field != of) {
            return truth;
        }
        if (lie != Lie::none && lie != Lie::is_frozen) {
            note();
        }
        switch (lie.load()) {
            case Lie::no_number:
                return std::nan("");
            case Lie::infinite:
                return HUGE_VAL;
            case Lie::leaps:
                return leapt;
            default:
                return truth;
        }
    }
    // Where a position or a velocity is frozen, both no longer fit together (unit: meters per second).
    double velocity() const {
        const bool moves = (field == Field::position || field == Field::velocity) && lie == Lie::is_frozen;
        if (moves) {
            note();
        }
        return told(Field::velocity, moves ? 1.5 : 0.0, 1e3);
    }
    // What is held and what is not is the other way round.
    bool swaps_buttons() const {
        const bool swaps = field == Field::buttons && lie == Lie::leaps;
        if (swaps) {
            note();
        }
        return swaps;
    }
    // The library does not come back.
    bool is_silent() const {
        const bool is_so = lie == Lie::is_silent;
        if (is_so) {
            note();
        }
        return is_so;
    }
};

// Of libdhd. One device, "omega.3".
struct ForceDimension {
    std::atomic<int> devices{1};
    std::atomic<bool> in_use{false}, unplugged{false}, hangs{false};
    std::atomic<double> position[3]{};   // in the device's own axes (unit: meters)
    std::atomic<double> force[3]{};      // what the motors give (unit: newtons)
    std::atomic<double> torque[3]{};     // (unit: newton meters)
    std::atomic<bool> has_wrist{false};  // with motors, a quarter turn about its x
    std::atomic<int> watchdog{0};        // of its firmware (in eighths of a millisecond)
    std::atomic<unsigned> buttons{0};
    Lying lying;
    std::atomic<const char*> fails{nullptr};  // the function that returns an error, by its name
    // The function whose next call, by its name, comes back only after a dhdStop(), and counts all the same.
    std::atomic<const char*> overtaken{nullptr};
    std::atomic<bool> is_open{false}, forces_on{false}, braked{false};
    std::atomic<bool> is_stale{false};  // forces were switched on by such a call, and not stopped since
    std::atomic<int> set_forces{0}, stale_forces{0}, stops{0};
    std::atomic<int> velocity_window{20};  // (unit: milliseconds)
    std::atomic<double> most_step{0.0};    // of the force from one call to the next (unit: newtons)
    // With another device, before it is open, or without forces that were ever switched on. After a
    // dhdStop(), which another thread may call, a force is refused and no more.
    std::atomic<int> wrong_calls{0};
};

// Of libHD. One device, and a second one named "Second", of which only the force is told apart; one named
// "Missing" is not there.
struct OpenHaptics {
    std::atomic<bool> unplugged{false}, hangs{false};
    std::atomic<unsigned> calibration{0x5000};
    std::atomic<double> position[3]{};  // (unit: millimeters)
    std::atomic<double> force[3]{};     // (unit: newtons)
    std::atomic<double> torque[3]{};    // (unit: newton millimeters)
    std::atomic<double> second_force[3]{};
    std::atomic<bool> has_six_motors{false};
    std::atomic<int> buttons{0};
    Lying lying;
    std::atomic<bool> is_open{false}, ticks{false};
    std::atomic<int> frames{0}, stops{0};
    std::atomic<int> start_time{0};      // of its scheduler, until its first tick (unit: milliseconds)
    std::atomic<double> most_step{0.0};  // of the force from one frame to the next (unit: newtons)
    std::atomic<int> wrong_calls{0};     // outside of a frame, of another device, unknown names
};

}  // namespace tactus::stand_ins

extern "C" {
tactus::stand_ins::ForceDimension* stand_in_force_dimension();
tactus::stand_ins::OpenHaptics* stand_in_openhaptics();
}
