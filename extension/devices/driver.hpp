// What a device on a wire of its own has to bring along: one class, in one file. driver_device.hpp runs it on
// a thread and hands its readings to the haptic thread.
//
// All but let_go() is called by that one I/O thread. It may wait and allocate; it throws nothing.
#pragma once

#include <atomic>
#include <string>

#include "core/ports/device.hpp"
#include "devices/force_slot.hpp"

namespace tactus {

// What a device has said, and when it was asked for that.
struct DriverReading {
    DeviceSample sample;
    Nanoseconds at = 0;  // on the steady clock
};

// Of a velocity that its maker smooths and does not say how long: as long as the mean over 20 ms, which Force
// Dimension's is unless another window is set (unit: seconds, see DeviceCapabilities::velocity_smoothed).
constexpr double unstated_smoothing = 0.01;

class Driver {
public:
    enum class Exchange {
        reading,  // `reading` is new
        nothing,  // nothing has come in time; it may still
        lost,     // the device is gone, or talks nonsense: close and open it again
    };

    virtual ~Driver() = default;

    // Finds the device, opens it, starts it. Gives up soon after `stop` is set. Empty, or why not and what to
    // do.
    virtual std::string open(const std::atomic<bool>& stop) = 0;
    virtual void close() = 0;

    // Sends the force that lives in `forces`, as soon as the loop has written it and when it ends, and waits
    // for a reading until `until` at the latest (on the steady clock).
    virtual Exchange exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) = 0;

    // From the watchdog's thread, between open() and close(), while exchange() is stuck: takes the device's
    // force away, again and again as long as it is. Nothing where the transport has no way past a call that
    // hangs.
    virtual void let_go() {}

    // Whether the device is asked at a pace of its own (DeviceCapabilities::rate), not in step with the loop.
    virtual bool is_paced() const { return false; }

    // Of the open device.
    virtual DeviceCapabilities capabilities() const = 0;
    // A name that stays the same when it is plugged in again.
    virtual std::string id() const = 0;
    // What a user has to do before it can work, such as homing; empty where nothing.
    virtual std::string advice() const { return {}; }
    // What the transport said when exchange() has returned Exchange::lost; empty where nothing.
    virtual std::string why_lost() const { return {}; }
};

}  // namespace tactus
