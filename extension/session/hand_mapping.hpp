// How a device's workspace stands in the scene. A point p of the device is at pose * (scale * p); forces are
// turned with the pose. Pure functions.
#pragma once

#include "core/math/pose.hpp"

namespace tactus {

struct Workspace {
    Pose pose;
    double scale = 1.0;          // of positions, > 0
    double force_limit = 8.0;    // longest force the device is given (unit: newtons)
    bool clutch = false;         // held: the hand in the scene stays where it is while the device moves
    std::uint32_t dead_man = 0;  // buttons, any of which must be held for a force; 0: none
    double force_scale = 1.0;    // of forces: newtons of the device for each of the scene, > 0
    double edge_speed = 0.0;     // see drift_at_edge (unit: meters per second)
    Vec3 torque{0.0};            // that the scene gives to the handle, in the scene (unit: newton meters)
    Vec3 force{0.0};             // to the hand, besides what touch gives (unit: newtons)
};

inline Vec3 into_scene(const Workspace& workspace, const Vec3& point) {
    return to_parent(workspace.pose, workspace.scale * point);
}

inline Vec3 velocity_in_scene(const Workspace& workspace, const Vec3& velocity) {
    return direction_to_parent(workspace.pose, workspace.scale * velocity);
}

inline Vec3 force_in_scene(const Workspace& workspace, const Vec3& force) {
    return direction_to_parent(workspace.pose, force / workspace.force_scale);
}

inline Vec3 force_on_device(const Workspace& workspace, const Vec3& force) {
    return direction_to_local(workspace.pose, force * workspace.force_scale);
}

// The same turns the hand by the same angle: as much energy as the force gives, over the same ways.
inline Vec3 torque_on_device(const Workspace& workspace, const Vec3& torque) {
    return direction_to_local(workspace.pose, torque * (workspace.force_scale / workspace.scale));
}

inline Vec3 torque_in_scene(const Workspace& workspace, const Vec3& torque) {
    return direction_to_parent(workspace.pose, torque * (workspace.scale / workspace.force_scale));
}

// A wall of the scene is K·scale·force_scale stiff at the device: what the device's damping is worth in the
// scene, and likewise its energy.
inline double damping_in_scene(const Workspace& workspace, double damping) {
    return damping / (workspace.scale * workspace.force_scale);
}
inline double energy_on_device(const Workspace& workspace, double energy) {
    return energy * workspace.force_scale / workspace.scale;
}

// Rate control at the edge of a workspace of this radius: beyond seven eighths of it the hand in the scene
// goes on by itself, outwards, at edge_speed at the very edge and slower before (unit: meters per second, in
// the scene). So a small device reaches a large scene without a clutch.
Vec3 drift_at_edge(const Workspace& workspace, double radius, const Vec3& position);

}  // namespace tactus
