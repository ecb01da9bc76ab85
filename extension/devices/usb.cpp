#include "devices/usb.hpp"

#include <mutex>

#include "devices/runtime_library.hpp"

namespace tactus::usb {

namespace {

bool find_all(const RuntimeLibrary& library, Library& usb) {
    return library.find("libusb_init", usb.init) && library.find("libusb_exit", usb.exit) &&
           library.find("libusb_get_device_list", usb.get_device_list) &&
           library.find("libusb_free_device_list", usb.free_device_list) &&
           library.find("libusb_get_device_descriptor", usb.get_device_descriptor) &&
           library.find("libusb_get_bus_number", usb.get_bus_number) &&
           library.find("libusb_get_port_numbers", usb.get_port_numbers) &&
           library.find("libusb_open", usb.open) && library.find("libusb_close", usb.close) &&
           library.find("libusb_set_auto_detach_kernel_driver", usb.set_auto_detach_kernel_driver) &&
           library.find("libusb_claim_interface", usb.claim_interface) &&
           library.find("libusb_release_interface", usb.release_interface) &&
           library.find("libusb_control_transfer", usb.control_transfer) &&
           library.find("libusb_bulk_transfer", usb.bulk_transfer) &&
           library.find("libusb_alloc_transfer", usb.alloc_transfer) &&
           library.find("libusb_free_transfer", usb.free_transfer) &&
           library.find("libusb_submit_transfer", usb.submit_transfer) &&
           library.find("libusb_cancel_transfer", usb.cancel_transfer) &&
           library.find("libusb_handle_events_timeout_completed", usb.handle_events_timeout_completed) &&
           library.find("libusb_error_name", usb.error_name);
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
    RuntimeLibrary loaded;
    if (!loaded.load({"libusb-1.0.so.0", "libusb-1.0.0.dylib", "libusb-1.0.dll"}, "libusb_init")) {
        error = "libusb is not installed: install it (Debian: apt-get install libusb-1.0-0)";
        return nullptr;
    }
    ready = find_all(loaded, usb);
    error = ready ? "" : "the libusb on this system is too old: version 1.0.16 or later is needed";
    return ready ? &usb : nullptr;
}

}  // namespace tactus::usb
