// The way of forces from the loop to a driver: the newest counts, for as long as the loop that wrote it
// lives, and a watchdog knows when somebody has to have looked again.
#pragma once

#include <atomic>

#include "core/safety/force_watch.hpp"
#include "platform/atomic_wait.hpp"
#include "platform/clock.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

class ForceSlot {
public:
    // Haptic thread.
    void write(const Vec3& force, const Vec3& torque, Nanoseconds now) {
        commands_.publish({force, torque, now});
    }

    // I/O thread: what the device is to be given from now until end() at the longest. `own`: of the device
    // itself, such as what carries its arm, for as long as the loop lives.
    Vec3 living(Nanoseconds now, const Vec3& own = Vec3(0.0)) {
        commands_.refresh();
        const ForceCommand& command = commands_.front();
        const bool alive = is_alive(command, now);
        const Vec3 force = alive ? command.force + own : Vec3(0.0);
        torque_ = alive ? command.torque : Vec3(0.0);
        end_ = alive ? command.written_at + force_lifetime : 0;
        watch(force == Vec3(0.0) && torque_ == Vec3(0.0) ? 0 : end_);
        return force;
    }
    // That goes with the force that living() has given.
    const Vec3& torque() const { return torque_; }
    // When what living() has given dies, if nothing comes; 0: the loop was silent.
    Nanoseconds end() const { return end_; }

    // I/O thread: the device gives no force any more.
    void rest() { watch(0); }

    // Watchdog: when the force that the device gives must have been renewed or taken away; 0: it gives none.
    Nanoseconds due() const { return due_.load(std::memory_order_acquire); }
    void wait_for_force() const { wait_while(due_, 0); }
    // Wakes who waits for a force, since none will come.
    void end_wait() { watch(-1); }

private:
    void watch(Nanoseconds due) {
        if (due_.exchange(due, std::memory_order_acq_rel) == 0 && due != 0) {
            wake_all(due_);
        }
    }

    TripleBuffer<ForceCommand> commands_;
    Vec3 torque_{0.0};  // I/O thread; likewise
    Nanoseconds end_ = 0;
    std::atomic<Nanoseconds> due_{0};
};

}  // namespace tactus
