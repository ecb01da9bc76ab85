// A rigid placement: where a body's own frame sits in the frame around it.
#pragma once

#include <glm/geometric.hpp>

#include "core/math/types.hpp"

namespace tactus {

struct Pose {
    Vec3 position{0.0};                 // (unit: meters)
    Quat rotation{1.0, 0.0, 0.0, 0.0};  // unit quaternion, body to parent
};

inline Vec3 to_parent(const Pose& pose, const Vec3& point) {
    return pose.position + pose.rotation * point;
}

inline Vec3 to_local(const Pose& pose, const Vec3& point) {
    return glm::conjugate(pose.rotation) * (point - pose.position);
}

inline Vec3 direction_to_parent(const Pose& pose, const Vec3& direction) {
    return pose.rotation * direction;
}

inline Vec3 direction_to_local(const Pose& pose, const Vec3& direction) {
    return glm::conjugate(pose.rotation) * direction;
}

// The placement of `inner`'s frame in the parent of `outer`.
inline Pose compose(const Pose& outer, const Pose& inner) {
    return {to_parent(outer, inner.position), outer.rotation * inner.rotation};
}

inline Pose inverse(const Pose& pose) {
    const Quat back = glm::conjugate(pose.rotation);
    return {-(back * pose.position), back};
}

}  // namespace tactus
