// How much of a session a side of a teleoperation takes: plain values, without the side itself.
#pragma once

#include <cstddef>

#include "session/session_types.hpp"

namespace tactus {

struct OperatorRoom {
    std::size_t max_tracked = 64;       // moving bodies that are compared with the past; others are put where
                                        // the far side saw them
    std::size_t samples = 1024;         // of the past; states that are older are brought to the present by
                                        // their velocity, once no hand has pressed anything since
    std::size_t samples_a_memento = 8;  // a replay does up to so many ticks more
    std::size_t memento_bytes = 65536;  // of physics in each (see PhysicsWorld::save)
    std::size_t pointers = 4;           // that can be carried along (stealthy_translate, stealthy_turn)
    bool replays = true;                // false: no twin, re-simulation is not available
};

// Which pointers of the environment an operator has: of several operators, each has every so manieth.
struct PointerShare {
    std::size_t first = 0;
    std::size_t every = 1;  // >= 1

    // That stands in for a pointer of the operator.
    std::size_t proxy_of(std::size_t pointer) const { return first + pointer * every; }
    bool has(std::size_t proxy) const { return proxy >= first && (proxy - first) % every == 0; }
    // Pointers of the operator that can have one.
    std::size_t most(std::size_t all = max_proxies) const {
        return first < all ? (all - first + every - 1) / every : 0;
    }
};

}  // namespace tactus
