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
    Exchange exchange(ForceSlot& forces, Nanoseconds until, DeviceSample& sample) override;
    void let_go() override;
    DeviceCapabilities capabilities() const override { return falcon_capabilities(); }
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
    Vec3 living(ForceSlot& forces, Nanoseconds now);
    static void in_done(usb::Transfer* transfer);
    static void out_done(usb::Transfer* transfer);
    static void spare_done(usb::Transfer* transfer);
    static void give_back(Queued& queued);
    bool is_any_in_flight() const;
    void note(usb::TransferStatus status);
    void wait(Nanoseconds until, int* until_done = nullptr);

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
    Vec3 sent_{0.0};        // force of the last packet (unit: newtons)
    double carried_ = 0.0;  // of the weight (unit: newtons)
    bool is_loop_alive_ = false;
    int owed_ = 0;           // packets that may be sent: one for each that has come
    Nanoseconds heard_ = 0;  // the last whole packet
    int heard_in_wait_ = 0;  // set from within the callbacks: there is something to look at
    bool gone_ = false;
    const std::atomic<bool>* stop_ = nullptr;  // while it starts
};

}  // namespace tactus
