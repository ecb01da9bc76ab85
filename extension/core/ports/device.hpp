// The hand: what the loop asks of anything that has a position and can be pushed back.
#pragma once

#include "core/math/types.hpp"

namespace tactus {

struct DeviceSample {
    Vec3 position{0.0};                 // of the handle, in the device's own frame (unit: meters)
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // of the handle; identity where the device cannot tell
    Vec3 velocity{0.0};                 // (unit: meters per second)
    std::uint32_t buttons = 0;          // bit i: button i is held
    bool connected = false;             // false: the sample repeats the last known position
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
};

}  // namespace tactus
