// A hand that is where it is put, and whose device turns it as well.
#pragma once

#include "core/ports/device.hpp"

namespace tactus::shared {

class TurningHand final : public Device {
public:
    DeviceSample read(Nanoseconds) override {
        return {position, Quat(1.0, 0.0, 0.0, 0.0), velocity, 0, connected};
    }
    void write(Nanoseconds, const Vec3& given) override { force = given; }
    DeviceCapabilities capabilities() const override {
        DeviceCapabilities can;
        can.rotates = true;
        can.max_torque = 10.0;
        return can;
    }

    Vec3 position{0.0, 0.1, 0.0};
    Vec3 velocity{0.0};
    Vec3 force{0.0};
    bool connected = true;
};

}  // namespace tactus::shared
