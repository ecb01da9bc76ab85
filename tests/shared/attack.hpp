// Two sides of a teleoperation, as they really are, and somebody who throws packets at both.
#pragma once

#include <cstdint>
#include <string>

namespace tactus::shared {

enum class Attacker : std::uint8_t {
    stranger,     // hears nothing: noise and well-formed packets, against a sealed link
    without_key,  // hears all that is said on a sealed link: recordings, mutated, reordered, and its own
    with_key,     // one of the two: what opens, and says what no honest side would
    count
};
const char* name_of(Attacker attacker);

struct AttackSettings {
    std::size_t kind = 0;  // of Message, then whole descriptions of bodies and of joints
    Attacker attacker = Attacker::stranger;
    std::uint64_t packets = 0;
    std::uint64_t seed = 1;
};
std::string kind_name(std::size_t kind);
std::size_t kind_count();

struct AttackFigures {
    std::uint64_t packets = 0;        // that were thrown in
    std::uint64_t moved_objects = 0;  // bodies that the attacker does not own and that moved
    // Ticks in which the felt force changed by more than `max_force_step` beyond what the motion of the
    // touched body makes of it: who has the key may throw a body at the hand.
    std::uint64_t force_steps = 0;
    double largest_force_step = 0.0;    // of all (unit: newtons)
    double largest_unmoved_step = 0.0;  // beyond that motion's part (unit: newtons)
    std::uint64_t model_changes = 0;    // times that something was built of what was thrown
    double memory_growth_mb = 0.0;      // of the process, from when both were at work
    std::uint64_t not_recovered = 0;    // 1: the two do not talk seven seconds after the attack

    static constexpr double max_force_step = 0.5;  // (unit: newtons a tick)
};

AttackFigures run_attack(const AttackSettings& settings);

// How long after the first packet that comes again the far hand is where the network's own delay puts it, to
// a millimetre, after nothing came for `silence` (unit: seconds). Also the greatest speed of the far hand
// (unit: meters per second).
struct BlackoutFigures {
    double recovery_s = 0.0;
    double max_speed = 0.0;
    double hand_speed = 0.0;  // of the operator's own
};
BlackoutFigures run_blackout(double silence);

}  // namespace tactus::shared
