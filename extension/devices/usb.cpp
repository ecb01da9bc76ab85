#include "devices/usb.hpp"

#include <array>
#include <mutex>

#include "devices/runtime_library.hpp"

namespace tactus::usb {

const Library* library(std::string& error) {
    static std::mutex mutex;
    static Library usb;
    static bool ready = false;
    const std::lock_guard lock(mutex);
    if (ready) {
        return &usb;
    }
    RuntimeLibrary loaded;
    if (!loaded.load({"libusb-1.0.so.0", "libusb-1.0.0.dylib", "libusb-1.0.dll"}, "libusb_init")) {
        error = "libusb is not installed: install it (Debian: apt-get install libusb-1.0-0)";
        return nullptr;
    }
    ready = loaded.find({
        {"libusb_init", usb.init},
        {"libusb_exit", usb.exit},
        {"libusb_get_device_list", usb.get_device_list},
        {"libusb_free_device_list", usb.free_device_list},
        {"libusb_get_device_descriptor", usb.get_device_descriptor},
        {"libusb_get_bus_number", usb.get_bus_number},
        {"libusb_get_port_numbers", usb.get_port_numbers},
        {"libusb_open", usb.open},
        {"libusb_close", usb.close},
        {"libusb_set_auto_detach_kernel_driver", usb.set_auto_detach_kernel_driver},
        {"libusb_claim_interface", usb.claim_interface},
        {"libusb_release_interface", usb.release_interface},
        {"libusb_control_transfer", usb.control_transfer},
        {"libusb_bulk_transfer", usb.bulk_transfer},
        {"libusb_alloc_transfer", usb.alloc_transfer},
        {"libusb_free_transfer", usb.free_transfer},
        {"libusb_submit_transfer", usb.submit_transfer},
        {"libusb_cancel_transfer", usb.cancel_transfer},
        {"libusb_handle_events_timeout_completed", usb.handle_events_timeout_completed},
        {"libusb_get_pollfds", usb.get_pollfds},
        {"libusb_free_pollfds", usb.free_pollfds},
        {"libusb_error_name", usb.error_name},
    });
    error = ready ? "" : "the libusb on this system is too old: version 1.0.20 or later is needed";
    return ready ? &usb : nullptr;
}

std::string place_of(const Library& usb, Device* device) {
    std::array<std::uint8_t, 8> ports{};
    const int depth = usb.get_port_numbers(device, ports.data(), static_cast<int>(ports.size()));
    std::string place = "usb" + std::to_string(usb.get_bus_number(device));
    for (int port = 0; port < depth; ++port) {
        place += (port == 0 ? "-" : ".") + std::to_string(ports[static_cast<std::size_t>(port)]);
    }
    return place;
}

}  // namespace tactus::usb
