// What both sides must agree on: the one list, told with every hello and whenever it changes, and compared by
// both sides when they meet. Where it differs neither side gives any force; where only a hand differs, that
// hand gives none. Both sides know which property it is.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "network/sides.hpp"

namespace tactus {

// A hand of the operator, or what stands in for it at the teleoperator.
struct HandTerms {
    enum class Kind : std::uint8_t { none = 0, fingertip = 1, tool = 2 };

    Kind kind = Kind::none;
    double radius = 0.0;      // of a fingertip (unit: meters), >= 0
    std::uint64_t shape = 0;  // of a tool: one number for its spheres

    bool operator==(const HandTerms&) const = default;
};

struct Terms {
    static constexpr std::uint8_t with_waves = 1;  // Passivity::wave_variables
    static constexpr std::size_t max_hands = 20;   // by pointer number; tools follow the fingertips

    std::uint8_t scenario = 4;   // 2 … 5
    std::uint8_t passivity = 0;  // enum Passivity; means something in scenarios 2 and 3
    double impedance = 0.0;  // of wave variables (unit: newton-seconds per meter), >= 0; 0: there are none
    // Operator: objects that it has room for, by number. Teleoperator: one more than the highest number of
    // its own.
    std::uint32_t bodies = 0;
    std::array<HandTerms, max_hands> hands{};

    bool operator==(const Terms&) const = default;
};

// What two sides differ in.
enum class Term : std::uint8_t { scenario, passivity, impedance, bodies, missing_hand, radius, tool };

struct Disagreement {
    bool whole = false;       // nothing can be done together
    std::uint32_t hands = 0;  // bit i: the hand of pointer number i cannot
    std::uint32_t terms = 0;  // bit by Term: for these reasons

    bool any() const { return whole || hands != 0; }
    bool has(Term term) const { return (terms >> static_cast<unsigned>(term) & 1u) != 0; }
    bool works(std::size_t hand) const { return !whole && (hands >> hand & 1u) == 0; }
};

Disagreement compare(const Terms& of_operator, const Terms& of_teleoperator);

// For the user of `side`: which property differs and how, and what to do. Empty where nothing does. Off the
// loop.
std::string explain(const Disagreement& disagreement, const Terms& own, const Terms& peer, Side side);

}  // namespace tactus
