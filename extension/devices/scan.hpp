// Which haptic devices are plugged in, as USB tells it. None is opened.
#pragma once

#include <string>
#include <vector>

#include "devices/drivers.hpp"

namespace tactus {

struct PluggedDevice {
    DriverKind kind;
    std::string id;    // for DriverSettings::id; empty where only the driver knows it
    std::string name;  // for a person
};

// Empty where nothing is plugged in and where there is no libusb. By their places on the bus.
std::vector<PluggedDevice> plugged_devices();

}  // namespace tactus
