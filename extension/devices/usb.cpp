#include "devices/usb.hpp"

#include <mutex>

#include "platform/shared_library.hpp"

namespace tactus::usb {

namespace {

constexpr const char* name = "libusb-1.0.so.0";

template <typename Function>
bool find(const char* symbol, Function& function) {
    std::string error;
    function = reinterpret_cast<Function>(function_of_library(name, symbol, error));
    return function != nullptr;
}

bool find_all(Library& usb) {
    return find("libusb_init", usb.init) && find("libusb_exit", usb.exit) &&
           find("libusb_get_device_list", usb.get_device_list) &&
           find("libusb_free_device_list", usb.free_device_list) &&
           find("libusb_get_device_descriptor", usb.get_device_descriptor) &&
           find("libusb_get_bus_number", usb.get_bus_number) &&
           find("libusb_get_port_numbers", usb.get_port_numbers) &&
           find("libusb_open", usb.open) && find("libusb_close", usb.close) &&
           find("libusb_set_auto_detach_kernel_driver", usb.set_auto_detach_kernel_driver) &&
           find("libusb_claim_interface", usb.claim_interface) &&
           find("libusb_release_interface", usb.release_interface) &&
           find("libusb_control_transfer", usb.control_transfer) &&
           find("libusb_bulk_transfer", usb.bulk_transfer) &&
           find("libusb_alloc_transfer", usb.alloc_transfer) &&
           find("libusb_free_transfer", usb.free_transfer) &&
           find("libusb_submit_transfer", usb.submit_transfer) &&
           find("libusb_cancel_transfer", usb.cancel_transfer) &&
           find("libusb_handle_events_timeout_completed", usb.handle_events_timeout_completed) &&
           find("libusb_error_name", usb.error_name);
}

}  // namespace

const Library* library(std::string& error) {
    static std::mutex mutex;
    static Library usb;
    static bool ready = false;
    const std::lock_guard lock(mutex);
    if (ready) {
        return &usb;
    }
    if (!find("libusb_init", usb.init)) {
        error = "libusb is not installed: install it (Debian: apt-get install libusb-1.0-0)";
        return nullptr;
    }
    ready = find_all(usb);
    error = ready ? "" : "the libusb on this system is too old: version 1.0.16 or later is needed";
    return ready ? &usb : nullptr;
}

}  // namespace tactus::usb
