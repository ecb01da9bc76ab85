// The Novint Falcon on USB: an FT232R that leads to a signal processor, which needs its firmware at every
// start.
//
// Threads: all but let_go() belongs to one I/O thread (driver.hpp). libusb calls back from within exchange()
// and close().
#pragma once

#include <array>
#include <span>
#include <vector>

#include "devices/driver.hpp"
#include "devices/falcon/falcon_arm.hpp"
#include "devices/falcon/falcon_packet.hpp"
#include "devices/usb.hpp"

namespace tactus {

struct FalconSettings {
    std::vector<std::uint8_t> firmware;  // the image; the maker's own, which is not ours to give away
    std::string id;                      // of one of several; empty: the first that is free
    double weight = 0.0;  // of arm and grip in the hand, which the motors carry (unit: newtons)
    FalconData data;
};

bool is_falcon(const usb::DeviceDescriptor& descriptor);

class FalconDriver final : public Driver {
public:
    explicit FalconDriver(FalconSettings settings) : settings_(std::move(settings)), arm_(settings_.data) {}
    ~FalconDriver() override { close(); }

    std::string open(const std::atomic<bool>& stop) override;
    void close() override;
    Exchange exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) override;
    void let_go() override;
    bool is_paced() const override { return true; }
    DeviceCapabilities capabilities() const override;
    std::string id() const override { return id_; }
    std::string advice() const override;

private:
    // Two each way keep the wire busy while one is being looked at.
    static constexpr std::size_t transfers_each_way = 2;
    static constexpr std::size_t read_size = 64;
    // The watchdog's own. One that has let go comes back when the I/O thread looks, and a force may be on
    // again before that.
    static constexpr std::size_t spare_transfers = 4;
    struct Queued {
        FalconDriver* driver = nullptr;
        usb::Transfer* transfer = nullptr;
        bool in_flight = false;
        std::array<unsigned char, read_size> bytes{};
    };
    struct Spare : Queued {
        std::atomic<bool> is_taken{false};
    };

    std::string open_device();
    bool is_over() const { return gone_ || stop_->load(std::memory_order_acquire); }
    std::string start();
    std::string start_once();
    bool greet();
    bool load();
    bool answers();

    bool control(std::uint8_t request, std::uint16_t value);
    bool send(std::span<const std::uint8_t> bytes);
    bool receive(std::span<std::uint8_t> bytes);
    void flush();

    bool make_queue();
    bool prepare(Queued& queued, unsigned char endpoint, void (*done)(usb::Transfer*));
    void submit_in(Queued& in);
    bool submit_out(const Vec3& force);
    FalconCommand command(const Vec3& force);
    static void in_done(usb::Transfer* transfer);
    static void out_done(usb::Transfer* transfer);
    static void spare_done(usb::Transfer* transfer);
    static void give_back(Queued& queued);
    bool is_any_in_flight() const;
    void note(usb::TransferStatus status);
    void watch_files();
    void wait(Nanoseconds until);
    void wait(ForceSlot& forces, Nanoseconds until);
    bool has_free_out() const;
    bool may_send() const;
    bool is_due(const ForceSlot& forces, Nanoseconds now) const;
    Nanoseconds quiet_until(const ForceSlot& forces) const;
    void forget_answer();

    FalconSettings settings_;
    const usb::Library* usb_ = nullptr;
    usb::Context* context_ = nullptr;
    usb::Handle* handle_ = nullptr;
    std::string id_;
    std::vector<std::uint8_t> received_;  // while it starts: what has come and was not asked for yet
    std::array<Queued, transfers_each_way> in_, out_;
    std::array<Spare, spare_transfers> spares_;  // packets without a force
    FalconStream<FalconReport> stream_;
    FalconArm arm_;
    FalconReport report_;
    Vec3 sent_{0.0};  // force of the last packet (unit: newtons)
    bool is_loop_alive_ = false;
    // When the packets were sent whose answers have not come, the oldest first.
    std::array<Nanoseconds, transfers_each_way> asked_{};
    std::size_t unanswered_ = 0;
    Nanoseconds sent_at_ = 0;      // the last packet
    Nanoseconds heard_ = 0;        // the last whole packet
    std::vector<WaitFile> files_;  // of libusb; empty: it has none here
    bool gone_ = false;
    const std::atomic<bool>* stop_ = nullptr;  // while it starts
};

}  // namespace tactus
