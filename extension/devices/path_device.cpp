#include "devices/path_device.hpp"

namespace tactus {

DeviceSample PathDevice::read(Nanoseconds now) {
    const HandSample hand = sample_path(path_, clock_.at(now));
    DeviceSample sample;
    sample.position = hand.position;
    sample.velocity = hand.velocity;
    sample.connected = true;
    return sample;
}

}  // namespace tactus
