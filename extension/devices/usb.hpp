// libusb, loaded when a device on USB is first asked for, and never before. Its interface is stable since
// version 1.0, so what is used of it is declared here and nobody needs its headers.
#pragma once

#include <cstdint>
#include <string>

struct timeval;

namespace tactus::usb {

struct Context;
struct Device;
struct Handle;

struct DeviceDescriptor {  // of the USB standard, as libusb lays it out
    std::uint8_t length, type;
    std::uint16_t usb_version;
    std::uint8_t device_class, subclass, protocol, max_packet_0;
    std::uint16_t vendor, product, version;
    std::uint8_t manufacturer_index, product_index, serial_index, configurations;
};

enum Error : int {
    error_access = -3,
    error_no_device = -4,
    error_busy = -6,
    error_timeout = -7,
};

enum class TransferStatus : int { completed, error, timed_out, cancelled, stall, no_device, overflow };

struct Transfer {  // libusb_transfer
    Handle* handle;
    std::uint8_t flags;
    unsigned char endpoint;
    unsigned char type;
    unsigned timeout;
    TransferStatus status;
    int length;
    int actual_length;
    void (*callback)(Transfer*);
    void* user_data;
    unsigned char* buffer;
    int iso_packets;
};
inline constexpr unsigned char type_bulk = 2;

struct PollFile {  // libusb_pollfd
    int file;
    short events;
};

struct Library {
    int (*init)(Context**) = nullptr;
    void (*exit)(Context*) = nullptr;
    long (*get_device_list)(Context*, Device***) = nullptr;
    void (*free_device_list)(Device**, int) = nullptr;
    int (*get_device_descriptor)(Device*, DeviceDescriptor*) = nullptr;
    std::uint8_t (*get_bus_number)(Device*) = nullptr;
    int (*get_port_numbers)(Device*, std::uint8_t*, int) = nullptr;
    int (*open)(Device*, Handle**) = nullptr;
    void (*close)(Handle*) = nullptr;
    int (*set_auto_detach_kernel_driver)(Handle*, int) = nullptr;
    int (*claim_interface)(Handle*, int) = nullptr;
    int (*release_interface)(Handle*, int) = nullptr;
    int (*control_transfer)(Handle*, std::uint8_t, std::uint8_t, std::uint16_t, std::uint16_t, unsigned char*,
                            std::uint16_t, unsigned) = nullptr;
    int (*bulk_transfer)(Handle*, unsigned char, unsigned char*, int, int*, unsigned) = nullptr;
    Transfer* (*alloc_transfer)(int) = nullptr;
    void (*free_transfer)(Transfer*) = nullptr;
    int (*submit_transfer)(Transfer*) = nullptr;
    int (*cancel_transfer)(Transfer*) = nullptr;
    int (*handle_events_timeout_completed)(Context*, timeval*, int*) = nullptr;
    const PollFile** (*get_pollfds)(Context*) = nullptr;  // null: this system has none
    void (*free_pollfds)(const PollFile**) = nullptr;
    const char* (*error_name)(int) = nullptr;
};

// Null with an error that says what to install. Loaded once and kept: what runs in other threads may not
// vanish.
const Library* library(std::string& error);

// The bus and the ports on the way to a device, as the system names them.
std::string place_of(const Library& usb, Device* device);

}  // namespace tactus::usb
