// What a hand's touch begins and ends, kept until the owner has read it. Private to session/, but for
// TouchEvents.
//
// A contact's impulse is the time integral of its normal force over the first `impact_window`, or until it
// ends. The rest of a contact is pressing, which no longer belongs to the impact.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/math/types.hpp"

namespace tactus {

struct TouchEvent {
    enum class Kind : std::uint8_t { impact, broken, left };

    Kind kind = Kind::impact;
    std::uint32_t body = 0xffff'ffffu;  // SessionHandle
    double speed = 0.0;                 // into the surface, of an impact (unit: meters per second), >= 0
    double impulse = 0.0;               // of an impact (unit: newton seconds), >= 0
    double force = 0.0;                 // at which the surface broke (unit: newtons)
};

// The last events of one hand. An owner that reads more seldom than `most` come misses the oldest.
struct TouchEvents {
    static constexpr std::size_t most = 8;

    std::array<TouchEvent, most> ring{};
    std::uint64_t count = 0;  // since the hand came

    void add(const TouchEvent& event) { ring[count++ % most] = event; }
};

// A contact in one tick.
struct ImpactContact {
    std::uint32_t body = 0xffff'ffffu;
    double approach = 0.0;  // of the hand into the surface (unit: meters per second)
    double force = 0.0;     // normal (unit: newtons)
};

class ImpactWatch {
public:
    static constexpr std::size_t most = 6;         // bodies
    static constexpr double impact_window = 0.01;  // (unit: seconds)

    // One tick of that many seconds; several contacts of one body are one. At most `most` contacts.
    void tick(std::span<const ImpactContact> contacts, double seconds, TouchEvents& events);

private:
    struct Known {
        std::uint32_t body = 0xffff'ffffu;
        double speed = 0.0;
        double impulse = 0.0;
        double seconds = 0.0;  // since it began
        bool is_told = false;
        bool is_touched = false;  // in this tick
    };

    Known* known(std::uint32_t body);

    std::array<Known, most> known_{};
    std::size_t count_ = 0;
};

// Bodies whose surface has broken under a hand, from tick to tick.
class BreakWatch {
public:
    static constexpr std::size_t most = 8;  // bodies

    struct Broken {
        std::uint32_t body = 0xffff'ffffu;
        double force = 0.0;  // that broke it (unit: newtons)
    };

    // One tick, with those that are broken in it; at most `most`.
    void tick(std::span<const Broken> broken, TouchEvents& events);

private:
    std::array<Broken, most> known_{};
    std::size_t count_ = 0;
};

}  // namespace tactus
