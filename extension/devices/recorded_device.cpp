#include "devices/recorded_device.hpp"

namespace tactus {

DeviceSample RecordedDevice::read(Nanoseconds) {
    if (next_ < samples_.size()) {
        return samples_[next_++];
    }
    DeviceSample sample = samples_.back();
    sample.velocity = Vec3(0.0);
    sample.buttons = 0;
    sample.connected = false;
    return sample;
}

}  // namespace tactus
