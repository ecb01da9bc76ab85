#include "devices/scan.hpp"

#include <algorithm>

#include "devices/falcon/falcon_driver.hpp"
#include "devices/usb.hpp"

namespace tactus {

namespace {

constexpr std::uint16_t force_dimension_vendor = 0x1451;

void add_known(const usb::Library& usb, usb::Device* device, std::vector<PluggedDevice>& found) {
    usb::DeviceDescriptor descriptor{};
    if (usb.get_device_descriptor(device, &descriptor) != 0) {
        return;
    }
    const std::string place = usb::place_of(usb, device);
    if (is_falcon(descriptor)) {
        found.push_back({DriverKind::falcon, place, "Novint Falcon at " + place});
    } else if (descriptor.vendor == force_dimension_vendor) {
        found.push_back({DriverKind::force_dimension, "", "Force Dimension at " + place});
    }
}

}  // namespace

std::vector<PluggedDevice> plugged_devices() {
    std::vector<PluggedDevice> found;
    std::string error;
    const usb::Library* const usb = usb::library(error);
    usb::Context* context = nullptr;
    if (usb == nullptr || usb->init(&context) != 0) {
        return found;
    }
    usb::Device** devices = nullptr;
    const long count = usb->get_device_list(context, &devices);
    for (long i = 0; i < count; ++i) {
        add_known(*usb, devices[i], found);
    }
    if (count >= 0) {
        usb->free_device_list(devices, 1);
    }
    usb->exit(context);
    std::ranges::sort(found, {}, &PluggedDevice::name);
    return found;
}

}  // namespace tactus
