#pragma once

#include <godot_cpp/classes/node.hpp>
#include <godot_cpp/core/binder_common.hpp>

#include "nodes/properties.hpp"
#include "physics/joint.hpp"

namespace tactus {

// Leads the joint above it along its free axis, at every tick.
class HapticJointDrive : public godot::Node {
    GDCLASS(HapticJointDrive, godot::Node)

public:
    TACTUS_PROPERTIES(HapticJointDrive)

    godot::PackedStringArray _get_configuration_warnings() const override;

    // The one of a joint; one that does nothing where it has none. Places count as those of the joint's own
    // limits, from which `sign` leads to ours.
    static JointDrive of(const godot::Node& joint, double sign);

protected:
    static void _bind_methods();

private:
    JointDrive drive_;
};

}  // namespace tactus
