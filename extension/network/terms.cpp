#include "network/terms.hpp"

#include <cmath>
#include <cstdio>

namespace tactus {

namespace {

// Radii closer than this are told alike (unit: meters).
constexpr double same_radius = 1e-6;
// Likewise (unit: newton-seconds per meter).
constexpr double same_impedance = 1e-5;

std::uint32_t term_bit(Term term) {
    return 1u << static_cast<unsigned>(term);
}

bool is_traditional(const Terms& terms) {
    return terms.scenario == 2 || terms.scenario == 3;
}

// 0: nothing keeps them from working together. A teleoperator may have hands that the operator has not.
// Where a robot is felt, the operator's radius means nothing.
std::uint32_t compare(const HandTerms& of_operator, const HandTerms& of_teleoperator, bool robot_is_felt) {
    if (of_operator.kind == HandTerms::Kind::none) {
        return 0;
    }
    if (of_operator.kind != of_teleoperator.kind) {
        return term_bit(Term::missing_hand);
    }
    if (of_operator.kind == HandTerms::Kind::fingertip) {
        const bool differs = std::abs(of_operator.radius - of_teleoperator.radius) > same_radius;
        return differs && !robot_is_felt ? term_bit(Term::radius) : 0;
    }
    return of_operator.shape != of_teleoperator.shape ? term_bit(Term::tool) : 0;
}

const char* passivity_name(std::uint8_t passivity) {
    constexpr const char* names[] = {"none", "wave variables", "time domain", "two layers"};
    return passivity < std::size(names) ? names[passivity] : "unknown";
}

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::string millimeters(double radius) {
    return number(1e3 * radius) + " mm";
}

std::string of_hands(const Disagreement& disagreement, const Terms& own, const Terms& peer, Side side) {
    std::string text;
    constexpr std::size_t first_tool = 16;
    for (std::size_t i = 0; i < Terms::max_hands; ++i) {
        if ((disagreement.hands >> i & 1u) == 0) {
            continue;
        }
        const HandTerms& here = own.hands[i];
        const HandTerms& there = peer.hands[i];
        const std::string hand =
            i < first_tool ? "proxy " + std::to_string(i) : "tool " + std::to_string(i - first_tool);
        text += text.empty() ? "" : "; ";
        if (here.kind != there.kind) {
            const bool lacks_here = side == Side::teleoperator_side;
            text += std::string(lacks_here ? "this side has no " : "the other side has no ") + hand +
                    ": add it there, or remove the operator's";
        } else if (here.kind == HandTerms::Kind::fingertip) {
            text += hand + " has a radius of " + millimeters(here.radius) + " here and " +
                    millimeters(there.radius) + " on the other side: set both alike";
        } else {
            text += hand + " has another mesh here than on the other side: give both the same";
        }
    }
    return text;
}

}  // namespace

Disagreement compare(const Terms& of_operator, const Terms& of_teleoperator) {
    Disagreement found;
    if (of_operator.scenario != of_teleoperator.scenario) {
        found.terms |= term_bit(Term::scenario);
    } else if (is_traditional(of_operator) && of_operator.passivity != of_teleoperator.passivity) {
        found.terms |= term_bit(Term::passivity);
    } else if (is_traditional(of_operator) &&
               std::abs(of_operator.impedance - of_teleoperator.impedance) > same_impedance) {
        found.terms |= term_bit(Term::impedance);
    }
    if (of_operator.bodies < of_teleoperator.bodies) {
        found.terms |= term_bit(Term::bodies);
    }
    found.whole = found.terms != 0;
    for (std::size_t i = 0; i < Terms::max_hands; ++i) {
        if (const std::uint32_t why =
                compare(of_operator.hands[i], of_teleoperator.hands[i], of_operator.scenario == 3)) {
            found.hands |= 1u << i;
            found.terms |= why;
        }
    }
    return found;
}

std::string explain(const Disagreement& disagreement, const Terms& own, const Terms& peer, Side side) {
    if (disagreement.has(Term::scenario)) {
        return "the other side is set to scenario " + std::to_string(peer.scenario) + " and this side to " +
               std::to_string(own.scenario) + ": set both alike";
    }
    if (disagreement.has(Term::passivity)) {
        return std::string("the other side has the passivity '") + passivity_name(peer.passivity) +
               "' and this side '" + passivity_name(own.passivity) + "': set both alike";
    }
    if (disagreement.has(Term::impedance)) {
        return "the wave impedance is " + number(peer.impedance) + " N·s/m on the other side and " +
               number(own.impedance) + " here: set 'passivity_wave_impedance' of both MMTTunings alike";
    }
    if (disagreement.has(Term::bodies)) {
        const bool operates = side == Side::operator_side;
        const std::string room = std::to_string(operates ? own.bodies : peer.bodies);
        const std::string needed = std::to_string(operates ? peer.bodies : own.bodies);
        return std::string("the operator has room for ") + room + " bodies and the teleoperator has " +
               needed + ": raise 'max_bodies' of the operator's HapticWorld";
    }
    return of_hands(disagreement, own, peer, side);
}

}  // namespace tactus
