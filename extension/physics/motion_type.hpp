// How a body moves, in Jolt's words.
#pragma once

#include "physics/body_description.hpp"
#include "physics/jolt.hpp"
// Jolt's own headers need its first one before them.
#include <Jolt/Physics/Body/MotionType.h>

namespace tactus {

inline JPH::EMotionType motion_type(Motion motion) {
    switch (motion) {
        case Motion::Static:
            return JPH::EMotionType::Static;
        case Motion::Kinematic:
            return JPH::EMotionType::Kinematic;
        case Motion::Dynamic:
            return JPH::EMotionType::Dynamic;
    }
    return JPH::EMotionType::Static;
}

// What moves only as it is told rests as soon as nothing moves it, also where it never sleeps while it is
// dynamic: hundreds that Godot moves and that are far from hands would take the tick's time.
inline bool may_sleep(Motion motion, bool can_sleep) {
    return can_sleep || motion != Motion::Dynamic;
}

}  // namespace tactus
