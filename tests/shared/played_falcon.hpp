// A Novint Falcon as its host sees it, played: the chip on USB, the loader, the firmware's packets, and a
// delta arm with mass and friction in a user's hand, which the torques drive and the encoders show. Plain
// values; time comes in.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <utility>
#include <vector>

#include "devices/falcon/falcon_arm.hpp"
#include "devices/falcon/falcon_packet.hpp"
#include "shared/random_values.hpp"
#include "stand_ins/stand_ins.hpp"

namespace tactus::shared {

struct PlayedFalconSettings {
    FalconData data;
    double mass = 0.15;             // of arm and grip (unit: kilograms)
    double friction = 1.5;          // (unit: newton seconds per meter)
    double hand_mass = 0.3;         // of the user's (unit: kilograms)
    double hand_stiffness = 200.0;  // with which the user goes where he means to (unit: newtons per meter)
    double hand_damping = 8.0;      // (unit: newton seconds per meter)
    Nanoseconds torque_time = 10'000'000;  // without a packet its motors are let go
    double settling = 0.5;                 // how often the greeting comes with a 0 in front, 0 … 1
    double wrong_echo = 0.0;               // how often a byte of firmware comes back otherwise, 0 … 1
};

class PlayedFalcon {
public:
    PlayedFalcon(const PlayedFalconSettings& settings, std::uint64_t seed);

    static std::vector<std::uint8_t> firmware();  // a dummy image, which it takes and no other

    // The host's side, in the order of time (unit of `now`: nanoseconds).
    void control(std::uint8_t request, std::uint16_t value);
    void write(std::span<const std::uint8_t> bytes, Nanoseconds now);
    // When a read that was asked for then has something to bring, if nothing is written before.
    Nanoseconds readable_at(Nanoseconds asked) const;
    // What the chip sends at `now`, with its two bytes of modem status, at most `room` bytes; empty: not yet.
    std::vector<std::uint8_t> read(std::size_t room, Nanoseconds asked, Nanoseconds now);

    // The user's: where he means the hand to be, in the frame of DeviceSample. Until the legs have been
    // homed, he pulls it out and pushes it in.
    void mean(const Vec3& place) { meant_ = place; }
    void press(unsigned buttons) { buttons_ = buttons; }
    // Of its reports: encoders stand for position, velocity and rotation, of which a Falcon has one alone.
    void lie(stand_ins::Field field, stand_ins::Lie lie) {
        lying_field_ = field;
        lie_ = lie;
        lied_at_ = 0;
    }
    // When the chip first had a report, or should have had one, that is not so; 0: not yet.
    Nanoseconds lied_at() const { return lied_at_; }
    void advance(Nanoseconds now);

    bool running() const { return stage_ == Stage::running; }
    Vec3 hand() const { return place_ - delta_centre(settings_.data.geometry); }
    Vec3 force() const { return force_; }  // of its motors on the hand (unit: newtons)
    std::uint8_t leds() const { return command_.leds; }
    // When a packet, or that none came, last took away a force that the one before had given; 0: never.
    Nanoseconds let_go_at() const { return let_go_at_; }
    bool is_let_go() const { return command_.torques == std::array<std::int16_t, 3>{}; }
    std::uint64_t exchanges() const { return exchanges_; }
    // Of a force that grows, from one packet to the next, since the last call (unit: newtons).
    double take_most_step() { return std::exchange(most_step_, 0.0); }
    void power_cycle();

private:
    enum class Stage { off, greeting, knocked, loading, running, dead };

    void greet(std::uint8_t byte);
    void load(std::uint8_t byte);
    void answer(std::span<const std::uint8_t> bytes, Nanoseconds at = 0);
    void step(double seconds);
    Vec3 motor_force(const DeltaPose& pose) const;
    FalconReport report();

    struct Waiting {
        std::uint8_t byte;
        Nanoseconds at;  // when the chip has it
    };

    PlayedFalconSettings settings_;
    RandomValues random_;
    Stage stage_ = Stage::off;
    std::uint16_t baud_ = 0;
    Nanoseconds latency_ = 16'000'000;
    bool dtr_ = false;
    std::vector<std::uint8_t> heard_;
    std::deque<Waiting> out_;
    FalconStream<FalconCommand> commands_;
    FalconCommand command_;
    Nanoseconds commanded_ = 0;
    Nanoseconds let_go_at_ = 0;
    Nanoseconds next_report_ = 0;
    Nanoseconds time_ = 0;
    std::uint64_t exchanges_ = 0;
    Vec3 asked_{0.0};  // by the last packet (unit: newtons)
    double most_step_ = 0.0;
    unsigned buttons_ = 0;
    stand_ins::Field lying_field_ = stand_ins::Field::position;
    stand_ins::Lie lie_ = stand_ins::Lie::none;
    Nanoseconds lied_at_ = 0;
    unsigned homed_ = 0;
    unsigned pulled_out_ = 0;
    Vec3 meant_{0.0};
    Vec3 place_, velocity_{0.0}, force_{0.0};
};

}  // namespace tactus::shared
