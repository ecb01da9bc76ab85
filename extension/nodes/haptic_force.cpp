#include "nodes/haptic_force.hpp"

#include <glm/geometric.hpp>

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

HandEffect HapticForce::effect(const Transform3D& frame) const {
    const Vec3 along = from_godot(frame.basis.xform(to_godot(direction_)));
    const double length = glm::length(along);
    HandEffect effect;
    effect.form = form_;
    effect.place = from_godot(frame.origin);
    effect.direction = length > 0.0 ? along / length : along;
    effect.force = force_;
    effect.first_force = first_force_;
    effect.stiffness = stiffness_;
    effect.damping = damping_;
    effect.period = period_;
    effect.phase = phase_;
    effect.duration = duration_;
    effect.pitch = pitch_;
    return effect;
}

void HapticForce::form_changed() {
    notify_property_list_changed();
    emit_changed();
}

}  // namespace tactus
