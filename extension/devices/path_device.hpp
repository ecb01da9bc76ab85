// A hand that follows a script and feels nothing. Its path begins with the first tick that reads it.
#pragma once

#include "core/ports/device.hpp"
#include "devices/hand_path.hpp"

namespace tactus {

class PathDevice final : public Device {
public:
    // Needs a path that problem_with() finds nothing wrong with.
    explicit PathDevice(HandPath path) : path_(std::move(path)) {}

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds, const Vec3&) override {}

private:
    HandPath path_;
    Nanoseconds start_ = 0;
    bool started_ = false;
};

}  // namespace tactus
