// What a device said, tick by tick, in a file that gives back every bit of it: one line for each tick,
// numbers in hexadecimal floating point.
#pragma once

#include <cstdio>
#include <span>
#include <string>
#include <vector>

#include "core/ports/device.hpp"

namespace tactus {

// False when the file could not be written.
bool write_device_recording(std::FILE* file, std::span<const DeviceSample> samples);

struct DeviceRecording {
    std::vector<DeviceSample> samples{};
    std::string error{};  // empty, or which line could not be understood; then there are no samples
};
DeviceRecording read_device_recording(std::FILE* file);

}  // namespace tactus
