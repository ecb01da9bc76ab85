// A moment of a session's loop, from which a twin replays the past. Private to session/.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/haptics/hand_aids.hpp"
#include "core/haptics/surface_effects.hpp"
#include "core/proxy/proxy.hpp"
#include "core/tool/tool_proxy.hpp"
#include "session/session_types.hpp"

namespace tactus {

// All memory is taken once.
struct LoopMemento {
    LoopMemento(std::size_t max_bodies, std::size_t bytes_of_physics)
        : places(max_bodies), physics(bytes_of_physics) {}

    struct Place {
        SessionHandle handle = no_handle;
        Pose pose;  // in the touch scene
    };
    struct Pointer {
        ProxyMemory proxy;
        EffectMemory effects;
        TorsionList torsion;
        Vec3 force{0.0};
        AidMemory aids{};
    };

    std::size_t place_count = 0;
    std::vector<Place> places;
    std::size_t physics_bytes = 0;  // 0: nothing is saved here
    std::vector<std::byte> physics;
    std::array<Pointer, max_proxies> pointers;
    std::array<ToolMemory, max_tools> tools;
};

}  // namespace tactus
