#include "played/played_usb.hpp"

#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <umockdev.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <limits>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "platform/clock.hpp"
#include "played/played_node.hpp"

namespace tactus::shared {

namespace {

// A client in another process, whose poll() is not played, would ask again at once.
constexpr useconds_t nothing_to_reap = 100;

constexpr std::uint32_t capabilities = USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_BULK_CONTINUATION |
                                       USBDEVFS_CAP_NO_PACKET_SIZE_LIM | USBDEVFS_CAP_REAP_AFTER_DISCONNECT |
                                       USBDEVFS_CAP_ZERO_PACKET;

// Where the system shows the device on a port of the first bus.
std::string node_of(int port) {
    return "/dev/bus/usb/001/00" + std::to_string(1 + port);
}
std::string place_of(int port) {
    return "/devices/pci0000:00/usb1/1-" + std::to_string(port);
}

// Device, configuration, interface, bulk in 0x81 and bulk out 0x02 of an FT232R: 0403:cb48.
std::string device_text(int port) {
    const std::string number = std::to_string(1 + port);
    return "P: " + place_of(port) + "\nN: bus/usb/001/00" + number +
           "\n"
           "E: SUBSYSTEM=usb\n"
           "E: DRIVER=usb\n"
           "E: BUSNUM=001\n"
           "E: DEVNUM=00" +
           number + "\nE: DEVNAME=/dev/bus/usb/001/00" + number +
           "\n"
           "E: DEVTYPE=usb_device\n"
           "A: bConfigurationValue=1\\n\n"
           "A: busnum=1\\n\n"
           "A: devnum=" +
           number + "\\n\nA: devpath=" + std::to_string(port) +
           "\\n\n"
           "A: speed=12\\n\n"
           "H: descriptors=1201000200000008030448cb000601020301"
           "09022000010100a02d"
           "0904000002ffffff02"
           "07058102400000"
           "07050202400000\n";
}

// One for the process: it is told to libusb by the environment.
UMockdevTestbed* testbed() {
    static UMockdevTestbed* const one = umockdev_testbed_new();
    return one;
}

struct Urb {
    usbdevfs_urb* urb = nullptr;
    unsigned char* bytes = nullptr;
    std::uintptr_t address = 0;           // in the client's process
    UMockdevIoctlData* remote = nullptr;  // of another process: where its memory is kept until it is reaped
    Nanoseconds asked = 0;
    bool done = false;
};

}  // namespace

bool run_below_umockdev(char** arguments) {
    constexpr const char* preloaded = "libumockdev-preload.so.0";
    const char* const before = std::getenv("LD_PRELOAD");
    if (before != nullptr && std::strstr(before, preloaded) != nullptr) {
        return true;
    }
    setenv("LD_PRELOAD", preloaded, 1);
    execv("/proc/self/exe", arguments);
    return false;
}

struct PlayedUsb::Impl final : PlayedNode {
    Impl(const PlayedUsbSettings& given)
        : PlayedNode(node_of(given.port)),
          settings(given),
          random(given.seed),
          falcon(given.falcon, given.seed),
          failing(given.failing) {}
    ~Impl() override {
        vanish();
        forget_urbs();
    }

    int call(unsigned long request, void* argument) override;
    Nanoseconds ready_at() override;

    bool fails() { return random.unit() < failing; }
    int submit(Urb urb);
    std::optional<Urb> reap();
    int discard(std::uintptr_t address);
    int release();
    void forget_urbs();
    int answer(unsigned long request) const;
    void perform(Urb& urb);
    void look(Urb& urb, Nanoseconds now);

    // From another process.
    int submit_remote(UMockdevIoctlData* argument);
    int reap_remote(UMockdevIoctlData* argument);
    static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, Impl* self);

    PlayedUsbSettings settings;
    std::mutex mutex;
    RandomValues random;
    PlayedFalcon falcon;
    double failing;
    bool plugged = false;
    std::deque<Urb> urbs;
    bool in_use = false;
    UMockdevIoctlBase* handler = nullptr;
};

int PlayedUsb::Impl::call(unsigned long request, void* argument) {
    const std::lock_guard lock(mutex);
    switch (request) {
        case USBDEVFS_SUBMITURB: {
            auto* const urb = static_cast<usbdevfs_urb*>(argument);
            return submit(
                {urb, static_cast<unsigned char*>(urb->buffer), reinterpret_cast<std::uintptr_t>(urb)});
        }
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY: {
            const std::optional<Urb> urb = reap();
            if (urb) {
                *static_cast<void**>(argument) = urb->urb;
            }
            return urb ? 0 : -EAGAIN;
        }
        case USBDEVFS_DISCARDURB:
            return discard(reinterpret_cast<std::uintptr_t>(argument));
        case USBDEVFS_RELEASEINTERFACE:
            return release();
        case USBDEVFS_GET_CAPABILITIES:
            *static_cast<std::uint32_t*>(argument) = capabilities;
            return plugged ? 0 : -ENODEV;
        default:
            return answer(request);
    }
}

// What needs none of the client's memory.
int PlayedUsb::Impl::answer(unsigned long request) const {
    if (!plugged) {
        return -ENODEV;
    }
    switch (request) {
        case USBDEVFS_IOCTL:  // no driver of the kernel's holds it
            return -ENODATA;
        case USBDEVFS_CLAIMINTERFACE:
        case USBDEVFS_DISCONNECT_CLAIM:
            return in_use ? -EBUSY : 0;
        default:  // releases, resets
            return 0;
    }
}

gboolean PlayedUsb::Impl::on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, Impl* self) {
    std::unique_lock lock(self->mutex);
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto request = umockdev_ioctl_client_get_request(client);
    int result = 0;
    switch (request) {
        case USBDEVFS_SUBMITURB:
            result = self->submit_remote(argument);
            break;
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY:
            result = self->reap_remote(argument);
            break;
        case USBDEVFS_DISCARDURB:
            result = self->discard(*reinterpret_cast<std::uintptr_t*>(argument->data));
            break;
        case USBDEVFS_RELEASEINTERFACE:
            result = self->release();
            break;
        case USBDEVFS_GET_CAPABILITIES: {
            UMockdevIoctlData* const flags =
                umockdev_ioctl_data_resolve(argument, 0, sizeof capabilities, nullptr);
            std::memcpy(flags->data, &capabilities, sizeof capabilities);
            umockdev_ioctl_data_unref(flags);
            result = self->plugged ? 0 : -ENODEV;
            break;
        }
        default:
            result = self->answer(request);
    }
    lock.unlock();
    if (result == -EAGAIN) {
        usleep(nothing_to_reap);
    }
    umockdev_ioctl_client_complete(client, result < 0 ? -1 : 0, result < 0 ? -result : 0);
    return TRUE;
}

int PlayedUsb::Impl::submit_remote(UMockdevIoctlData* argument) {
    UMockdevIoctlData* const data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    auto* const urb = reinterpret_cast<usbdevfs_urb*>(data->data);
    UMockdevIoctlData* const bytes = umockdev_ioctl_data_resolve(
        data, offsetof(usbdevfs_urb, buffer), static_cast<gulong>(std::max(1, urb->buffer_length)), nullptr);
    umockdev_ioctl_data_unref(bytes);
    const int result = submit({urb, static_cast<unsigned char*>(urb->buffer), data->client_addr, data});
    if (result < 0) {
        umockdev_ioctl_data_unref(data);
    }
    return result;
}

int PlayedUsb::Impl::reap_remote(UMockdevIoctlData* argument) {
    const std::optional<Urb> urb = reap();
    if (!urb) {
        return -EAGAIN;
    }
    UMockdevIoctlData* const pointer = umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr);
    umockdev_ioctl_data_set_ptr(pointer, 0, urb->remote);
    umockdev_ioctl_data_unref(pointer);
    umockdev_ioctl_data_unref(urb->remote);
    return 0;
}

int PlayedUsb::Impl::submit(Urb urb) {
    if (!plugged) {
        return -ENODEV;
    }
    urb.asked = monotonic_now();
    urb.urb->actual_length = 0;
    urb.urb->status = 0;
    perform(urb);
    urbs.push_back(urb);
    changed();
    return 0;
}

// Who lets go of the interface hears no more of what was on its way.
int PlayedUsb::Impl::release() {
    forget_urbs();
    return answer(USBDEVFS_RELEASEINTERFACE);
}

void PlayedUsb::Impl::forget_urbs() {
    for (const Urb& urb : urbs) {
        if (urb.remote != nullptr) {
            umockdev_ioctl_data_unref(urb.remote);
        }
    }
    urbs.clear();
}

Nanoseconds PlayedUsb::Impl::ready_at() {
    const std::lock_guard lock(mutex);
    Nanoseconds ready = std::numeric_limits<Nanoseconds>::max();
    for (const Urb& urb : urbs) {
        if (urb.done || !plugged) {
            return 0;
        }
        // Reads are served in the order in which they were asked for.
        ready = std::min(ready, falcon.readable_at(urb.asked));
    }
    return ready;
}

// What the host sends arrives at once, or not at all.
void PlayedUsb::Impl::perform(Urb& urb) {
    usbdevfs_urb& u = *urb.urb;
    if (u.type == USBDEVFS_URB_TYPE_CONTROL) {
        urb.done = true;
        if (fails()) {
            u.status = -EPROTO;
            return;
        }
        falcon.control(urb.bytes[1], static_cast<std::uint16_t>(urb.bytes[2] | urb.bytes[3] << 8));
    } else if ((u.endpoint & 0x80) == 0) {
        urb.done = true;
        int length = u.buffer_length;
        if (fails()) {
            u.status = -EPROTO;
            length = random.flip() ? 0 : random.below(length);
        }
        u.actual_length = length;
        falcon.write({urb.bytes, static_cast<std::size_t>(length)}, urb.asked);
    }
}

void PlayedUsb::Impl::look(Urb& urb, Nanoseconds now) {
    usbdevfs_urb& u = *urb.urb;
    if (!plugged) {
        u.status = -ENODEV;
        urb.done = true;
        return;
    }
    if (now < falcon.readable_at(urb.asked)) {
        return;
    }
    std::size_t room = static_cast<std::size_t>(u.buffer_length);
    const bool wrong = fails();
    if (wrong && random.flip()) {
        u.status = -EPROTO;  // what it has stays in the chip
        urb.done = true;
        return;
    }
    if (wrong) {
        room = std::min<std::size_t>(room, 3 + static_cast<std::size_t>(random.below(8)));
    }
    const std::vector<std::uint8_t> bytes = falcon.read(room, urb.asked, now);
    if (!bytes.empty()) {
        std::memcpy(urb.bytes, bytes.data(), bytes.size());
        u.actual_length = static_cast<int>(bytes.size());
        urb.done = true;
    }
}

std::optional<Urb> PlayedUsb::Impl::reap() {
    bool reader_waits = false;
    for (auto urb = urbs.begin(); urb != urbs.end(); ++urb) {
        // Reads are served in the order in which they were asked for.
        if (!urb->done && !std::exchange(reader_waits, true)) {
            look(*urb, monotonic_now());
        }
        if (urb->done) {
            const Urb done = *urb;
            urbs.erase(urb);
            return done;
        }
    }
    return std::nullopt;
}

int PlayedUsb::Impl::discard(std::uintptr_t address) {
    const auto found = std::find_if(
        urbs.begin(), urbs.end(), [address](const Urb& urb) { return urb.address == address && !urb.done; });
    if (found == urbs.end()) {
        return -EINVAL;
    }
    found->urb->status = -ENOENT;
    found->done = true;
    changed();
    return 0;
}

PlayedUsb::PlayedUsb(const PlayedUsbSettings& settings) : impl_(std::make_unique<Impl>(settings)) {
    impl_->handler = umockdev_ioctl_base_new();
    g_signal_connect_after(impl_->handler, "handle-ioctl", G_CALLBACK(Impl::on_ioctl), impl_.get());
    umockdev_testbed_attach_ioctl(testbed(), node_of(settings.port).c_str(), impl_->handler, nullptr);
}

PlayedUsb::~PlayedUsb() {
    unplug();
    umockdev_testbed_detach_ioctl(testbed(), node_of(impl_->settings.port).c_str(), nullptr);
    g_object_unref(impl_->handler);
}

void PlayedUsb::plug() {
    {
        const std::lock_guard lock(impl_->mutex);
        if (impl_->plugged) {
            return;
        }
        impl_->falcon.power_cycle();
        impl_->plugged = true;
    }
    impl_->changed();
    umockdev_testbed_add_from_string(testbed(), device_text(impl_->settings.port).c_str(), nullptr);
}

void PlayedUsb::unplug() {
    {
        const std::lock_guard lock(impl_->mutex);
        if (!std::exchange(impl_->plugged, false)) {
            return;
        }
    }
    impl_->changed();
    umockdev_testbed_remove_device(testbed(), ("/sys" + place_of(impl_->settings.port)).c_str());
}

void PlayedUsb::set_failing(double share) {
    const std::lock_guard lock(impl_->mutex);
    impl_->failing = share;
}

void PlayedUsb::set_in_use(bool in_use) {
    const std::lock_guard lock(impl_->mutex);
    impl_->in_use = in_use;
}

void PlayedUsb::mean(const Vec3& there) {
    const std::lock_guard lock(impl_->mutex);
    impl_->falcon.mean(there);
}

void PlayedUsb::press(unsigned buttons) {
    const std::lock_guard lock(impl_->mutex);
    impl_->falcon.press(buttons);
}

void PlayedUsb::lie(stand_ins::Field field, stand_ins::Lie lie) {
    const std::lock_guard lock(impl_->mutex);
    impl_->falcon.lie(field, lie);
}

Nanoseconds PlayedUsb::lied_at() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.lied_at();
}

Vec3 PlayedUsb::hand() {
    const std::lock_guard lock(impl_->mutex);
    impl_->falcon.advance(monotonic_now());
    return impl_->falcon.hand();
}

Vec3 PlayedUsb::force() {
    const std::lock_guard lock(impl_->mutex);
    impl_->falcon.advance(monotonic_now());
    return impl_->falcon.force();
}

double PlayedUsb::take_most_step() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.take_most_step();
}

std::uint8_t PlayedUsb::leds() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.leds();
}

Nanoseconds PlayedUsb::let_go_at() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.let_go_at();
}

bool PlayedUsb::is_let_go() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.is_let_go();
}

bool PlayedUsb::running() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.running();
}

std::uint64_t PlayedUsb::exchanges() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.exchanges();
}

}  // namespace tactus::shared
