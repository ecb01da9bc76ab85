// A hand that does again, tick by tick, what was recorded: the same bits in the same order, whatever the
// time.
#pragma once

#include <cstddef>
#include <vector>

#include "core/ports/device.hpp"

namespace tactus {

class RecordedDevice final : public Device {
public:
    // One sample for each tick, at least one.
    explicit RecordedDevice(std::vector<DeviceSample> samples) : samples_(std::move(samples)) {}

    // After the last sample the hand stays there, at rest and no longer connected.
    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds, const Vec3&) override {}

private:
    std::vector<DeviceSample> samples_;
    std::size_t next_ = 0;
};

}  // namespace tactus
