// A hand that follows a script and feels nothing.
#pragma once

#include "core/ports/device.hpp"
#include "devices/hand_path.hpp"
#include "devices/path_clock.hpp"

namespace tactus {

class PathDevice final : public Device {
public:
    // Needs a path that problem_with() finds nothing wrong with.
    explicit PathDevice(HandPath path) : path_(std::move(path)) {}

    DeviceSample read(Nanoseconds now) override;
    void write(Nanoseconds, const Vec3&) override {}

    PathClock& clock() { return clock_; }

private:
    HandPath path_;
    PathClock clock_;
};

}  // namespace tactus
