// The hand: what the loop asks of anything that has a position and can be pushed back.
#pragma once

#include <limits>
#include <optional>

#include "core/math/types.hpp"
#include "core/safety/force_watch.hpp"

namespace tactus {

// What a device can do. A hand without motors takes any force and feels none.
struct DeviceCapabilities {
    static constexpr double any = std::numeric_limits<double>::infinity();

    bool feels = false;            // it has motors: what is written moves a hand
    bool rotates = false;          // its samples have a rotation of their own
    double radius = 0.0;           // of the workspace, about its middle; 0: it has none (unit: meters)
    double rate = 0.0;             // of its own exchange; 0: that of the loop (unit: hertz)
    double max_force = any;        // (unit: newtons)
    double max_torque = 0.0;       // on the handle; 0: it has none (unit: newton meters)
    double max_torque_slew = any;  // (unit: newton meters per second)
    double max_slew = any;         // (unit: newtons per second)
    double max_power = any;        // given to the hand for long (unit: watts)
    double max_energy = any;       // and at once (unit: joules)
    double max_speed = any;        // of a hand that holds it (unit: meters per second)
    double damping = any;  // of its mechanics: what a stiff wall lives on (unit: newton seconds per meter)
    double max_damping = 0.0;  // that may be rendered on top (the same unit)
    double delay = 0.0;        // from a place's reading to its force, besides the tick (unit: seconds)
    // Of what moves with the hand, as a drive that moves it needs it.
    double mass = 0.0;     // (unit: kilograms); 0: unknown
    double viscous = 0.0;  // friction (unit: newton seconds per meter)
    double coulomb = 0.0;  // friction (unit: newtons)
    // Of DeviceSample::velocity, to first order; half of the window where it is the mean over one (unit:
    // seconds), >= 0.
    double velocity_smoothed = 0.0;
    double ramp = 0.0;    // until a force that begins is there (unit: seconds)
    double weight = 0.0;  // of its arm in the hand, which its motors are to carry (unit: newtons), >= 0

    bool operator==(const DeviceCapabilities&) const = default;
};

struct DeviceSample {
    Vec3 position{0.0};                 // of the handle, in the device's own frame (unit: meters)
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // of the handle; identity where the device cannot tell
    Vec3 velocity{0.0};                 // (unit: meters per second)
    std::uint32_t buttons = 0;          // bit i: button i is held
    bool connected = false;             // false: the sample repeats the last known position
};

// What the motors give, as it was known to the device's last stage when the loop read it.
struct DisplayedForce {
    Vec3 force{0.0};         // in the device's own frame (unit: newtons)
    std::uint32_t cuts = 0;  // bit i: the force has been cut since the read before, for ForceCut(i)
};

// Called by the haptic thread once a tick, read before write. Implementations neither allocate, lock, throw
// nor block in read and write; what takes time (opening, homing) belongs into their own set-up, off the loop.
class Device {
public:
    virtual ~Device() = default;

    // `now` is the tick's own time on the session's clock, not a clock reading.
    virtual DeviceSample read(Nanoseconds now) = 0;

    // The force on the hand in the device's own frame (unit: newtons).
    virtual void write(Nanoseconds now, const Vec3& force) = 0;

    // The torque on the handle that goes with the next force, in the same frame (unit: newton meters). For
    // devices whose capabilities have one.
    virtual void twist(const Vec3&) {}

    // How the loop will tick. The owner's thread, before the first tick that reads this device.
    virtual void set_pace(const LoopPace&) {}

    // Nothing where what is written is what is displayed.
    virtual std::optional<DisplayedForce> displayed() const { return std::nullopt; }

    // Changes only within read().
    virtual DeviceCapabilities capabilities() const { return {}; }
};

}  // namespace tactus
