// A session that is soon full: what does not fit in is refused often.
#pragma once

#include "session/session.hpp"

namespace tactus::fuzz {

inline SessionSettings small_session(std::uint32_t max_bodies, std::uint32_t max_parts) {
    SessionSettings settings;
    settings.max_bodies = max_bodies;
    settings.max_parts = max_parts;
    settings.physics.max_touching_pairs = settings.physics.max_contacts = 64;
    settings.physics.max_joints = 16;
    return settings;
}

}  // namespace tactus::fuzz
