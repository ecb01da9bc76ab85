#include "devices/falcon/falcon_driver.hpp"

#include <algorithm>
#include <map>

#include "platform/clock.hpp"
#include "platform/time_value.hpp"

namespace tactus {

namespace {

constexpr std::uint16_t vendor = 0x0403;
constexpr std::uint16_t product = 0xcb48;
constexpr unsigned char endpoint_out = 0x02;
constexpr unsigned char endpoint_in = 0x81;
constexpr std::size_t modem_status = 2;  // bytes in front of whatever an FT232R says

// Requests of an FT232R.
enum : std::uint8_t {
    ftdi_reset = 0,
    ftdi_modem = 1,
    ftdi_flow = 2,
    ftdi_baud = 3,
    ftdi_data = 4,
    ftdi_latency = 9
};
constexpr std::uint16_t purge_in = 1, purge_out = 2;
constexpr std::uint16_t dtr_low = 0x0100, dtr_high = 0x0101, rts_low = 0x0200;
constexpr std::uint16_t eight_bits = 8;      // no parity, one stop bit
constexpr std::uint16_t baud_9600 = 0x4138;  // divisors of 3 MHz
constexpr std::uint16_t baud_140k = 0x0015;
constexpr std::uint8_t request_to_device = 0x40;

constexpr int attempts_to_start = 10;
constexpr int attempts_to_greet = 100;
constexpr int attempts_to_answer = 3;
constexpr int attempts_a_transfer = 40;  // half of them failing, one in 10^12 does not come through
constexpr unsigned transfer_time = 50;   // (unit: milliseconds)
constexpr int reads_for_an_answer = 60;  // each waits for the chip's latency timer, 16 ms
constexpr std::size_t piece = 62;        // of firmware, with the modem status a packet of USB

// A packet or its answer was lost that has not come after this time (unit: nanoseconds).
constexpr Nanoseconds answer_time = 4'000'000;

// Between two packets while no loop writes (unit: nanoseconds).
constexpr Nanoseconds idle_period = 2'000'000;

}  // namespace

std::string FalconDriver::open(const std::atomic<bool>& stop) {
    if (settings_.firmware.empty()) {
        return "the Falcon needs its firmware at every start: set 'firmware' to the maker's image "
               "(novint.bin, from its own software)";
    }
    std::string error;
    usb_ = usb::library(error);
    if (usb_ == nullptr) {
        return error;
    }
    if (context_ == nullptr && usb_->init(&context_) != 0) {
        context_ = nullptr;
        return "libusb does not start: is /dev/bus/usb there?";
    }
    error = open_device();
    if (error.empty()) {
        stop_ = &stop;
        error = start();
    }
    if (error.empty() && !make_queue()) {
        error = "libusb gives no transfers: is memory short?";
    }
    return error;
}

bool is_falcon(const usb::DeviceDescriptor& descriptor) {
    return descriptor.vendor == vendor && descriptor.product == product;
}

std::string FalconDriver::open_device() {
    usb::Device** devices = nullptr;
    const long count = usb_->get_device_list(context_, &devices);
    std::map<std::string, usb::Device*> falcons;  // by place: systems list them in any order
    for (long i = 0; i < count; ++i) {
        usb::DeviceDescriptor descriptor{};
        if (usb_->get_device_descriptor(devices[i], &descriptor) == 0 && is_falcon(descriptor)) {
            falcons.emplace(usb::place_of(*usb_, devices[i]), devices[i]);
        }
    }
    std::string error, others;
    for (const auto& [place, device] : falcons) {
        if (handle_ != nullptr) {
            break;
        }
        if (!settings_.id.empty() && settings_.id != place) {
            others += (others.empty() ? "" : ", ") + place;
            continue;
        }
        const int opened = usb_->open(device, &handle_);
        if (opened != 0) {
            handle_ = nullptr;
            error = opened == usb::error_access
                        ? "the Falcon may not be opened: run ./run setup --device-access once, and plug it "
                          "in again"
                        : std::string("the Falcon cannot be opened: ") + usb_->error_name(opened);
            continue;
        }
        usb_->set_auto_detach_kernel_driver(handle_, 1);
        if (const int claimed = usb_->claim_interface(handle_, 0); claimed != 0) {
            usb_->close(handle_);
            handle_ = nullptr;
            error = claimed == usb::error_busy
                        ? "the Falcon is in use: close the other program"
                        : std::string("the Falcon cannot be had: ") + usb_->error_name(claimed);
            continue;
        }
        id_ = place;
        error.clear();
    }
    if (devices != nullptr) {
        usb_->free_device_list(devices, 1);
    }
    if (handle_ != nullptr || !error.empty()) {
        return error;
    }
    if (settings_.id.empty()) {
        return "no Falcon is plugged in: plug it in, with its power";
    }
    return "the Falcon " + settings_.id + " is not plugged in" +
           (others.empty() ? ": plug it in, with its power" : ": set 'device_id' to one of " + others);
}

// --- start-up, with libusb's calls that wait

bool FalconDriver::control(std::uint8_t request, std::uint16_t value) {
    for (int attempt = 0; attempt < attempts_a_transfer && !is_over(); ++attempt) {
        const int done =
            usb_->control_transfer(handle_, request_to_device, request, value, 0, nullptr, 0, transfer_time);
        if (done >= 0) {
            return true;
        }
        gone_ = done == usb::error_no_device;
    }
    return false;
}

// What a failed transfer has sent is said; the rest follows.
bool FalconDriver::send(std::span<const std::uint8_t> bytes) {
    for (int attempt = 0; attempt < attempts_a_transfer && !is_over(); ++attempt) {
        std::array<unsigned char, 64> buffer{};
        std::copy(bytes.begin(), bytes.end(), buffer.begin());
        int sent = 0;
        const int done = usb_->bulk_transfer(handle_, endpoint_out, buffer.data(),
                                             static_cast<int>(bytes.size()), &sent, transfer_time);
        gone_ = done == usb::error_no_device;
        bytes =
            bytes.subspan(static_cast<std::size_t>(std::clamp<int>(sent, 0, static_cast<int>(bytes.size()))));
        if (bytes.empty()) {
            return true;
        }
    }
    return false;
}

// Exactly so many bytes; false where they do not come.
bool FalconDriver::receive(std::span<std::uint8_t> bytes) {
    for (int attempt = 0; attempt < reads_for_an_answer && received_.size() < bytes.size() && !is_over();
         ++attempt) {
        std::array<unsigned char, read_size> buffer{};
        int got = 0;
        const int done = usb_->bulk_transfer(handle_, endpoint_in, buffer.data(),
                                             static_cast<int>(buffer.size()), &got, transfer_time);
        gone_ = done == usb::error_no_device;
        const std::size_t size = static_cast<std::size_t>(std::clamp<int>(got, 0, read_size));
        if (size > modem_status) {
            received_.insert(received_.end(), buffer.begin() + modem_status, buffer.begin() + size);
        }
    }
    if (received_.size() < bytes.size()) {
        return false;
    }
    const auto end = received_.begin() + static_cast<std::ptrdiff_t>(bytes.size());
    std::copy(received_.begin(), end, bytes.begin());
    received_.erase(received_.begin(), end);
    return true;
}

// What is still on its way belongs to an attempt before.
void FalconDriver::flush() {
    received_.clear();
    control(ftdi_reset, purge_in);
    control(ftdi_reset, purge_out);
}

std::string FalconDriver::start() {
    std::string error;
    for (int attempt = 0; attempt < attempts_to_start && !is_over(); ++attempt) {
        error = start_once();
        if (error.empty()) {
            return error;
        }
    }
    return gone_ ? "the Falcon was unplugged while it started: plug it in again" : error;
}

std::string FalconDriver::start_once() {
    flush();
    const bool slow = control(ftdi_latency, 16) && control(ftdi_baud, baud_9600) &&
                      control(ftdi_data, eight_bits) && control(ftdi_flow, 0) &&
                      control(ftdi_modem, rts_low) && control(ftdi_modem, dtr_low) &&
                      control(ftdi_modem, dtr_high);
    if (!slow || !greet()) {
        return "the Falcon does not answer: check its power supply, and plug it in again";
    }
    const std::array<std::uint8_t, 1> knock{0x41};
    std::array<std::uint8_t, 1> answer{};
    const bool fast = control(ftdi_modem, dtr_low) && control(ftdi_baud, baud_140k) && send(knock) &&
                      receive(answer) && answer == knock;
    if (!fast) {
        return "the Falcon does not follow to its fast line: plug it in again";
    }
    if (!load()) {
        return "the Falcon does not take its firmware: is 'firmware' the maker's image?";
    }
    if (!control(ftdi_latency, 1)) {
        return "the Falcon's line cannot be made fast: plug it in again";
    }
    return answers() ? "" : "the Falcon does not run its firmware: is 'firmware' the maker's image?";
}

bool FalconDriver::greet() {
    const std::array<std::uint8_t, 3> hello{0x0a, 0x43, 0x0d};
    const std::array<std::uint8_t, 4> wanted{0x0a, 0x44, 0x2c, 0x0d};
    for (int attempt = 0; attempt < attempts_to_greet && !is_over(); ++attempt) {
        std::array<std::uint8_t, 4> answer{};
        if (!send(hello) || !receive(answer)) {
            continue;
        }
        if (answer[0] == 0x00) {  // the line was settling
            std::copy(answer.begin() + 1, answer.end(), answer.begin());
            if (!receive(std::span(answer).last(1))) {
                continue;
            }
        }
        if (answer == wanted) {
            return true;
        }
        flush();
    }
    return false;
}

// Each piece is sent back. One that comes back otherwise has arrived otherwise: all begins anew.
bool FalconDriver::load() {
    const std::span<const std::uint8_t> image(settings_.firmware);
    for (std::size_t at = 0; at < image.size() && !is_over(); at += piece) {
        const auto part = image.subspan(at, std::min(piece, image.size() - at));
        std::array<std::uint8_t, piece> echo{};
        if (!send(part) || !receive(std::span(echo).first(part.size())) ||
            !std::equal(part.begin(), part.end(), echo.begin())) {
            return false;
        }
    }
    return !is_over();
}

bool FalconDriver::answers() {
    stream_.reset();
    FalconCommand asked;
    asked.homing = true;
    for (int attempt = 0; attempt < attempts_to_answer && !is_over(); ++attempt) {
        FalconPacket answer{};
        if (send(falcon_encode(asked)) && receive(answer)) {
            stream_.take(answer);
        }
        if (stream_.next(report_)) {
            return true;
        }
    }
    return false;
}

// --- the exchange, with queued transfers

bool FalconDriver::prepare(Queued& queued, unsigned char endpoint, void (*done)(usb::Transfer*)) {
    queued.driver = this;
    queued.transfer = usb_->alloc_transfer(0);
    if (queued.transfer == nullptr) {
        return false;
    }
    usb::Transfer& transfer = *queued.transfer;
    transfer.handle = handle_;
    transfer.endpoint = endpoint;
    transfer.type = usb::type_bulk;
    transfer.timeout = 0;
    transfer.callback = done;
    transfer.user_data = &queued;
    transfer.buffer = queued.bytes.data();
    transfer.length = static_cast<int>(endpoint == endpoint_in ? queued.bytes.size() : falcon_packet_size);
    return true;
}

bool FalconDriver::make_queue() {
    stream_.reset();
    arm_.reset();
    report_ = {};
    sent_ = Vec3(0.0);
    unanswered_ = 0;
    sent_at_ = 0;
    heard_ = monotonic_now();
    watch_files();
    bool ready = true;
    const FalconPacket letting_go = falcon_encode(FalconCommand{});
    for (Spare& spare : spares_) {
        ready = prepare(spare, endpoint_out, spare_done) && ready;
        std::copy(letting_go.begin(), letting_go.end(), spare.bytes.begin());
    }
    for (std::size_t i = 0; i < transfers_each_way; ++i) {
        ready = prepare(in_[i], endpoint_in, in_done) && prepare(out_[i], endpoint_out, out_done) && ready;
    }
    return ready;
}

void FalconDriver::note(usb::TransferStatus status) {
    gone_ = gone_ || status == usb::TransferStatus::no_device;
}

void FalconDriver::submit_in(Queued& in) {
    const int done = usb_->submit_transfer(in.transfer);
    in.in_flight = done == 0;
    gone_ = gone_ || done == usb::error_no_device;
}

void FalconDriver::in_done(usb::Transfer* transfer) {
    Queued& in = *static_cast<Queued*>(transfer->user_data);
    in.in_flight = false;
    in.driver->note(transfer->status);
    const int got = std::clamp<int>(transfer->actual_length, 0, read_size);
    if (transfer->status == usb::TransferStatus::completed && got > static_cast<int>(modem_status)) {
        in.driver->stream_.take(
            std::span(in.bytes).subspan(modem_status, static_cast<std::size_t>(got) - modem_status));
    }
}

void FalconDriver::out_done(usb::Transfer* transfer) {
    Queued& out = *static_cast<Queued*>(transfer->user_data);
    out.in_flight = false;
    out.driver->note(transfer->status);
    // Nothing has arrived, so nothing will come back for it.
    if (transfer->status != usb::TransferStatus::completed) {
        out.driver->forget_answer();
    }
}

void FalconDriver::spare_done(usb::Transfer* transfer) {
    static_cast<Spare*>(static_cast<Queued*>(transfer->user_data))
        ->is_taken.store(false, std::memory_order_release);
}

// libusb takes transfers from any thread, also while another one is stuck in its events.
void FalconDriver::let_go() {
    for (Spare& spare : spares_) {
        if (spare.is_taken.exchange(true, std::memory_order_acq_rel)) {
            continue;
        }
        if (usb_->submit_transfer(spare.transfer) != 0) {
            spare.is_taken.store(false, std::memory_order_release);
        }
        return;
    }
}

FalconCommand FalconDriver::command(const Vec3& force) {
    FalconCommand command;
    command.homing = report_.homed != 7;
    if (command.homing) {
        command.leds = falcon_led_red;
    } else {
        command.torques = arm_.counts(force);
        command.leds = is_loop_alive_ ? falcon_led_green : falcon_led_blue;
    }
    return command;
}

// False where none of the transfers is free.
bool FalconDriver::submit_out(const Vec3& force) {
    for (Queued& out : out_) {
        if (out.in_flight) {
            continue;
        }
        const FalconPacket packet = falcon_encode(command(force));
        std::copy(packet.begin(), packet.end(), out.bytes.begin());
        const int done = usb_->submit_transfer(out.transfer);
        gone_ = gone_ || done == usb::error_no_device;
        out.in_flight = done == 0;
        sent_ = report_.homed == 7 ? force : Vec3(0.0);
        sent_at_ = monotonic_now();
        if (out.in_flight && unanswered_ < asked_.size()) {
            asked_[unanswered_++] = sent_at_;
        }
        return out.in_flight;
    }
    return false;
}

void FalconDriver::forget_answer() {
    if (unanswered_ > 0) {
        std::shift_left(asked_.begin(), asked_.begin() + static_cast<std::ptrdiff_t>(unanswered_), 1);
        --unanswered_;
    }
}

void FalconDriver::watch_files() {
    files_.clear();
    const usb::PollFile** const files = usb_->get_pollfds(context_);
    constexpr short reads = 1, writes = 4;  // POLLIN, POLLOUT wherever libusb has files
    for (std::size_t i = 0; files != nullptr && files[i] != nullptr; ++i) {
        files_.push_back({files[i]->file, (files[i]->events & reads) != 0, (files[i]->events & writes) != 0});
    }
    if (files != nullptr) {
        usb_->free_pollfds(files);
    }
}

// libusb's own wait, which is rounded up to whole milliseconds.
void FalconDriver::wait(Nanoseconds until) {
    timeval time = time_value(until - monotonic_now());
    usb_->handle_events_timeout_completed(context_, &time, nullptr);
}

// Until the loop has written, a transfer is done, or it is `until`.
void FalconDriver::wait(ForceSlot& forces, Nanoseconds until) {
    if (files_.empty() && unanswered_ > 0) {
        wait(until);
        return;
    }
    if (may_send()) {
        forces.wait_for_write(until, files_);
    } else {
        forces.wait_for_files(until, files_);
    }
    wait(0);
}

bool FalconDriver::has_free_out() const {
    return std::ranges::any_of(out_, [](const Queued& out) { return !out.in_flight; });
}

bool FalconDriver::may_send() const {
    return has_free_out() && unanswered_ < transfers_each_way;
}

// A packet is due as soon as the loop has written, when its last force ends, and now and then while there is
// no loop.
bool FalconDriver::is_due(const ForceSlot& forces, Nanoseconds now) const {
    if (sent_ != Vec3(0.0) && now > forces.end()) {
        return has_free_out();
    }
    return may_send() && (forces.is_written() || (unanswered_ == 0 && now >= sent_at_ + idle_period));
}

// Until then nothing is due that the loop or the device does not announce.
Nanoseconds FalconDriver::quiet_until(const ForceSlot& forces) const {
    const Nanoseconds lost = unanswered_ > 0 ? asked_[0] + answer_time : sent_at_ + idle_period;
    return sent_ != Vec3(0.0) && has_free_out() ? std::min(lost, forces.end() + 1) : lost;
}

// A packet goes out when the loop has written its force; its answer is the reading for the next tick. Two may
// be on their way: the wire is slower than some loops.
Driver::Exchange FalconDriver::exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) {
    for (;;) {
        for (Queued& in : in_) {
            if (!in.in_flight) {
                submit_in(in);
            }
        }
        if (gone_) {
            return Exchange::lost;
        }
        const Nanoseconds now = monotonic_now();
        if (unanswered_ > 0 && now - asked_[0] > answer_time) {
            forget_answer();
        }
        if (is_due(forces, now)) {
            const Vec3 force = forces.living(now);
            is_loop_alive_ = forces.is_alive();
            if (submit_out(force)) {
                forces.given(monotonic_now());
            }
        }
        if (stream_.next(report_)) {
            const double seconds = std::clamp(to_seconds(now - heard_), 2e-4, 0.02);
            heard_ = now;
            reading.at = unanswered_ > 0 ? asked_[0] : now;
            forget_answer();
            reading.sample.connected = report_.homed == 7 && arm_.read(report_, seconds, reading.sample);
            if (!reading.sample.connected) {
                forces.taken();  // whether or not the loop sees this reading
            }
            return Exchange::reading;
        }
        if (now >= until) {
            return Exchange::nothing;
        }
        wait(forces, std::min(until, quiet_until(forces)));
    }
}

DeviceCapabilities FalconDriver::capabilities() const {
    DeviceCapabilities falcon = falcon_capabilities();
    falcon.weight = settings_.weight;
    return falcon;
}

std::string FalconDriver::advice() const {
    return report_.homed == 7 ? ""
                              : "the Falcon does not know where it is yet: pull its handle all the way out, "
                                "then push it all the way in";
}

bool FalconDriver::is_any_in_flight() const {
    const auto flies = [](const Queued& queued) { return queued.in_flight; };
    const auto is_taken = [](const Spare& spare) { return spare.is_taken.load(std::memory_order_acquire); };
    return std::any_of(spares_.begin(), spares_.end(), is_taken) ||
           std::any_of(in_.begin(), in_.end(), flies) || std::any_of(out_.begin(), out_.end(), flies);
}

// One that never comes back is left to libusb.
void FalconDriver::give_back(Queued& queued) {
    if (queued.transfer != nullptr && !queued.in_flight) {
        queued.driver->usb_->free_transfer(queued.transfer);
    }
    queued.transfer = nullptr;
    queued.in_flight = false;
}

// A transfer belongs to libusb until it has come back, be it cancelled.
void FalconDriver::close() {
    if (usb_ == nullptr) {
        return;
    }
    if (handle_ != nullptr && !gone_ && sent_ != Vec3(0.0)) {
        submit_out(Vec3(0.0));
    }
    for (Queued& in : in_) {
        if (in.in_flight) {
            usb_->cancel_transfer(in.transfer);
        }
    }
    for (Nanoseconds began = monotonic_now();
         is_any_in_flight() && monotonic_now() - began < nanoseconds_per_second;) {
        wait(monotonic_now() + 10'000'000);
        for (Queued& out : out_) {
            if (out.in_flight && monotonic_now() - began > 50'000'000) {
                usb_->cancel_transfer(out.transfer);
            }
        }
    }
    for (std::size_t i = 0; i < transfers_each_way; ++i) {
        give_back(in_[i]);
        give_back(out_[i]);
    }
    for (Spare& spare : spares_) {
        spare.in_flight = spare.is_taken.exchange(false, std::memory_order_acq_rel);
        give_back(spare);
    }
    if (handle_ != nullptr) {
        usb_->release_interface(handle_, 0);
        usb_->close(handle_);
        handle_ = nullptr;
    }
    if (context_ != nullptr) {
        usb_->exit(context_);
        context_ = nullptr;
    }
    gone_ = false;
    report_ = {};
    sent_ = Vec3(0.0);
}

}  // namespace tactus
