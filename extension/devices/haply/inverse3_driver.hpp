// Haply's Inverse3, with or without a VerseGrip, by Haply's service on this machine (version 3.5 and later):
// JSON over a WebSocket, one message with a force for each that brings a state.
//
// Threads: see driver.hpp.
#pragma once

#include "devices/device_claim.hpp"
#include "devices/driver.hpp"
#include "devices/haply/json_text.hpp"
#include "devices/haply/web_socket.hpp"

namespace tactus {

class Inverse3Driver final : public Driver {
public:
    static constexpr std::uint16_t usual_port = 10001;

    // `id`: the device's own; empty: the first that the service has.
    explicit Inverse3Driver(std::string id, std::uint16_t port = usual_port)
        : wanted_(std::move(id)), port_(port) {}
    ~Inverse3Driver() override { close(); }

    std::string open(const std::atomic<bool>& stop) override;
    void close() override;
    Exchange exchange(ForceSlot& forces, Nanoseconds until, DriverReading& reading) override;
    bool is_paced() const override { return true; }
    DeviceCapabilities capabilities() const override;
    std::string id() const override { return id_; }
    std::string advice() const override;

private:
    JsonValue device_in(const JsonValue& state) const;
    std::string choose(const JsonValue& state);
    bool take(const JsonValue& state, DeviceSample& sample);
    void send(const Vec3& force);
    void answer(ForceSlot& forces, Nanoseconds until);

    std::string wanted_, id_;
    DeviceClaim claim_;
    std::uint16_t port_;
    WebSocket socket_;
    JsonReader json_;
    std::string text_;
    Vec3 sent_{0.0};  // (unit: newtons)
    int owed_ = 0;    // answers to states; below 0: so many of the next have theirs
    bool is_calibrated_ = true, is_powered_ = true;
};

}  // namespace tactus
