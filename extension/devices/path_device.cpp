#include "devices/path_device.hpp"

namespace tactus {

DeviceSample PathDevice::read(Nanoseconds now) {
    if (!started_) {
        started_ = true;
        start_ = now;
    }
    const HandSample hand = sample_path(path_, now - start_);
    DeviceSample sample;
    sample.position = hand.position;
    sample.velocity = hand.velocity;
    sample.connected = true;
    return sample;
}

}  // namespace tactus
