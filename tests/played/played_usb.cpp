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
#include <string>
#include <utility>

#include "platform/clock.hpp"
#include "played/played_poll.hpp"

namespace tactus::shared {

namespace {

// A client in another process, whose poll() is not played, would ask again at once.
constexpr useconds_t nothing_to_reap = 100;

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
    UMockdevIoctlData* data = nullptr;  // of a usbdevfs_urb, ours until it is reaped
    Nanoseconds asked = 0;
    bool done = false;

    usbdevfs_urb& urb() const { return *reinterpret_cast<usbdevfs_urb*>(data->data); }
    unsigned char* bytes() const { return static_cast<unsigned char*>(urb().buffer); }
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

struct PlayedUsb::Impl final : PlayedPoll {
    Impl(const PlayedUsbSettings& given)
        : PlayedPoll(node_of(given.port)),
          settings(given),
          random(given.seed),
          falcon(given.falcon, given.seed),
          failing(given.failing) {}

    Nanoseconds ready_at() override;

    bool fails() { return random.unit() < failing; }
    bool handle(UMockdevIoctlClient* client);
    bool submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
    bool reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
    bool discard(UMockdevIoctlClient* client, UMockdevIoctlData* argument);
    void perform(Urb& urb);
    void look(Urb& urb, Nanoseconds now);

    static gboolean on_ioctl(UMockdevIoctlBase*, UMockdevIoctlClient* client, Impl* self) {
        return self->handle(client) ? TRUE : FALSE;
    }

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

bool PlayedUsb::Impl::handle(UMockdevIoctlClient* client) {
    std::unique_lock lock(mutex);
    UMockdevIoctlData* const argument = umockdev_ioctl_client_get_arg(client);
    const auto request = umockdev_ioctl_client_get_request(client);
    if (!plugged && request != USBDEVFS_REAPURBNDELAY && request != USBDEVFS_DISCARDURB) {
        umockdev_ioctl_client_complete(client, -1, ENODEV);
        return true;
    }
    switch (request) {
        case USBDEVFS_GET_CAPABILITIES: {
            UMockdevIoctlData* const flags =
                umockdev_ioctl_data_resolve(argument, 0, sizeof(guint32), nullptr);
            const guint32 capabilities = USBDEVFS_CAP_BULK_SCATTER_GATHER | USBDEVFS_CAP_BULK_CONTINUATION |
                                         USBDEVFS_CAP_NO_PACKET_SIZE_LIM |
                                         USBDEVFS_CAP_REAP_AFTER_DISCONNECT | USBDEVFS_CAP_ZERO_PACKET;
            std::memcpy(flags->data, &capabilities, sizeof capabilities);
            umockdev_ioctl_client_complete(client, 0, 0);
            umockdev_ioctl_data_unref(flags);
            return true;
        }
        case USBDEVFS_SUBMITURB:
            return submit(client, argument);
        case USBDEVFS_REAPURB:
        case USBDEVFS_REAPURBNDELAY: {
            if (reap(client, argument)) {
                return true;
            }
            lock.unlock();
            if (!is_used()) {
                usleep(nothing_to_reap);
            }
            umockdev_ioctl_client_complete(client, -1, EAGAIN);
            return true;
        }
        case USBDEVFS_DISCARDURB:
            return discard(client, argument);
        case USBDEVFS_IOCTL:  // no driver of the kernel's holds it
            umockdev_ioctl_client_complete(client, -1, ENODATA);
            return true;
        case USBDEVFS_CLAIMINTERFACE:
        case USBDEVFS_DISCONNECT_CLAIM:
            umockdev_ioctl_client_complete(client, in_use ? -1 : 0, in_use ? EBUSY : 0);
            return true;
        default:  // releases, resets
            umockdev_ioctl_client_complete(client, 0, 0);
            return true;
    }
}

bool PlayedUsb::Impl::submit(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    Urb urb;
    urb.data = umockdev_ioctl_data_resolve(argument, 0, sizeof(usbdevfs_urb), nullptr);
    UMockdevIoctlData* const bytes =
        umockdev_ioctl_data_resolve(urb.data, offsetof(usbdevfs_urb, buffer),
                                    static_cast<gulong>(std::max(1, urb.urb().buffer_length)), nullptr);
    umockdev_ioctl_data_unref(bytes);
    urb.asked = monotonic_now();
    urb.urb().actual_length = 0;
    urb.urb().status = 0;
    perform(urb);
    urbs.push_back(urb);
    umockdev_ioctl_client_complete(client, 0, 0);
    changed();
    return true;
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
    usbdevfs_urb& u = urb.urb();
    if (u.type == USBDEVFS_URB_TYPE_CONTROL) {
        urb.done = true;
        if (fails()) {
            u.status = -EPROTO;
            return;
        }
        const unsigned char* const setup = urb.bytes();
        falcon.control(setup[1], static_cast<std::uint16_t>(setup[2] | setup[3] << 8));
    } else if ((u.endpoint & 0x80) == 0) {
        urb.done = true;
        int length = u.buffer_length;
        if (fails()) {
            u.status = -EPROTO;
            length = random.flip() ? 0 : random.below(length);
        }
        u.actual_length = length;
        falcon.write({urb.bytes(), static_cast<std::size_t>(length)}, urb.asked);
    }
}

void PlayedUsb::Impl::look(Urb& urb, Nanoseconds now) {
    usbdevfs_urb& u = urb.urb();
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
        std::memcpy(urb.bytes(), bytes.data(), bytes.size());
        u.actual_length = static_cast<int>(bytes.size());
        urb.done = true;
    }
}

bool PlayedUsb::Impl::reap(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    bool reader_waits = false;
    for (auto urb = urbs.begin(); urb != urbs.end(); ++urb) {
        // Reads are served in the order in which they were asked for.
        if (!urb->done && !std::exchange(reader_waits, true)) {
            look(*urb, monotonic_now());
        }
        if (urb->done) {
            UMockdevIoctlData* const pointer =
                umockdev_ioctl_data_resolve(argument, 0, sizeof(gpointer), nullptr);
            umockdev_ioctl_data_set_ptr(pointer, 0, urb->data);
            umockdev_ioctl_client_complete(client, 0, 0);
            umockdev_ioctl_data_unref(pointer);
            umockdev_ioctl_data_unref(urb->data);
            urbs.erase(urb);
            return true;
        }
    }
    return false;
}

bool PlayedUsb::Impl::discard(UMockdevIoctlClient* client, UMockdevIoctlData* argument) {
    const auto address = reinterpret_cast<gulong>(*reinterpret_cast<void**>(argument->data));
    const auto found = std::find_if(urbs.begin(), urbs.end(), [address](const Urb& urb) {
        return urb.data->client_addr == address && !urb.done;
    });
    if (found == urbs.end()) {
        umockdev_ioctl_client_complete(client, -1, EINVAL);
        return true;
    }
    found->urb().status = -ENOENT;
    found->done = true;
    changed();
    umockdev_ioctl_client_complete(client, 0, 0);
    return true;
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
    for (const Urb& urb : impl_->urbs) {
        umockdev_ioctl_data_unref(urb.data);
    }
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

std::uint8_t PlayedUsb::leds() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.leds();
}

Nanoseconds PlayedUsb::let_go_at() {
    const std::lock_guard lock(impl_->mutex);
    return impl_->falcon.let_go_at();
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
