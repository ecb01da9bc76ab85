// Where something is, in the words of tests.
#pragma once

#include "core/math/pose.hpp"

namespace tactus::shared {

inline Pose at(const Vec3& position, const Quat& rotation = {1.0, 0.0, 0.0, 0.0}) {
    return {position, rotation};
}

}  // namespace tactus::shared
