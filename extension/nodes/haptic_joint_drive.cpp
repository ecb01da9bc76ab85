#include "nodes/haptic_joint_drive.hpp"

#include <godot_cpp/classes/hinge_joint3d.hpp>
#include <godot_cpp/classes/slider_joint3d.hpp>

#include "nodes/haptic_world.hpp"

namespace tactus {

using namespace godot;

namespace {

bool godot_moves(const Node& node) {
    const HapticWorld* const world = HapticWorld::of(&node);
    return world != nullptr && world->get_authority_in_use() == HapticWorld::AUTHORITY_GODOT;
}

}  // namespace

PackedStringArray HapticJointDrive::_get_configuration_warnings() const {
    PackedStringArray warnings;
    const Node* const above = is_inside_tree() ? get_parent() : nullptr;
    if (above != nullptr && Object::cast_to<HingeJoint3D>(above) == nullptr &&
        Object::cast_to<SliderJoint3D>(above) == nullptr) {
        warnings.push_back(
            "This HapticJointDrive drives nothing: put it directly below a HingeJoint3D or a SliderJoint3D.");
    }
    if (godot_moves(*this)) {
        warnings.push_back(
            "This HapticJointDrive drives nothing: Godot's physics moves the bodies of its HapticWorld; set "
            "the world's 'authority' to Haptic.");
    }
    return warnings;
}

JointDrive HapticJointDrive::of(const Node& joint, double sign) {
    if (godot_moves(joint)) {
        return {};
    }
    for (int32_t i = 0; i < joint.get_child_count(); ++i) {
        if (const auto* node = Object::cast_to<HapticJointDrive>(joint.get_child(i))) {
            JointDrive drive = node->drive_;
            drive.rest *= sign;
            return drive;
        }
    }
    return {};
}

}  // namespace tactus
