#include "nodes/haptic_joint_drive.hpp"

#include <godot_cpp/classes/hinge_joint3d.hpp>
#include <godot_cpp/classes/slider_joint3d.hpp>

namespace tactus {

using namespace godot;

PackedStringArray HapticJointDrive::_get_configuration_warnings() const {
    PackedStringArray warnings;
    const Node* const above = is_inside_tree() ? get_parent() : nullptr;
    if (above != nullptr && Object::cast_to<HingeJoint3D>(above) == nullptr &&
        Object::cast_to<SliderJoint3D>(above) == nullptr) {
        warnings.push_back(
            "This HapticJointDrive drives nothing: put it directly below a HingeJoint3D or a SliderJoint3D.");
    }
    return warnings;
}

JointDrive HapticJointDrive::of(const Node& joint, double sign) {
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
