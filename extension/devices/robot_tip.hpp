// The tip of an emulated robot as the hand of another world: what it runs into there pushes the robot.
//
//     robot's tick -> place of the tip -> hand of the other world
//     robot's tick <- what pushes the robot <- force on that hand
//
// Threads: each side belongs to its own world's loop; neither waits for the other, and each has the other's
// newest word, in real time up to a tick old.
#pragma once

#include <memory>

#include "devices/robot_table.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

struct TipExchange {
    TripleBuffer<DeviceSample> tip;
    TripleBuffer<Vec3> push{Vec3(0.0)};  // (unit: newtons)
};

// What an emulated robot can run into: its own table, and the world that its tip is a hand of.
class TipSurroundings final : public RobotSurroundings {
public:
    TipSurroundings(const RobotTable::Settings& table, std::shared_ptr<TipExchange> exchange)
        : table_(table), exchange_(std::move(exchange)) {}
    ~TipSurroundings() override { exchange_->tip.publish({}); }

    Vec3 push(Nanoseconds now, const Vec3& tip, const Vec3& velocity) override {
        DeviceSample& sample = exchange_->tip.back();
        sample = {};
        sample.position = tip;
        sample.velocity = velocity;
        sample.connected = true;
        exchange_->tip.publish();
        exchange_->push.refresh();
        return table_.push(now, tip, velocity) + exchange_->push.front();
    }

private:
    RobotTable table_;
    std::shared_ptr<TipExchange> exchange_;
};

class TipDevice final : public Device {
public:
    explicit TipDevice(std::shared_ptr<TipExchange> exchange) : exchange_(std::move(exchange)) {}
    // Nothing pushes the robot any more.
    ~TipDevice() override { exchange_->push.publish(Vec3(0.0)); }

    DeviceSample read(Nanoseconds) override {
        exchange_->tip.refresh();
        return exchange_->tip.front();
    }
    void write(Nanoseconds, const Vec3& force) override { exchange_->push.publish(force); }
    DeviceCapabilities capabilities() const override { return {.feels = true}; }

private:
    std::shared_ptr<TipExchange> exchange_;
};

}  // namespace tactus
