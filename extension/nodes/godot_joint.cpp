#include "nodes/godot_joint.hpp"

#include <godot_cpp/classes/engine.hpp>
#include <godot_cpp/classes/generic6_dof_joint3d.hpp>
#include <godot_cpp/classes/hinge_joint3d.hpp>
#include <godot_cpp/classes/pin_joint3d.hpp>
#include <godot_cpp/classes/slider_joint3d.hpp>
#include <godot_cpp/core/object.hpp>

#include "nodes/body_reading.hpp"
#include "nodes/haptic_joint_drive.hpp"
#include "world/joint_limits.hpp"

namespace tactus {

namespace {

using godot::Generic6DOFJoint3D;
using godot::HingeJoint3D;
using godot::Joint3D;
using godot::NodePath;
using godot::Object;
using godot::SliderJoint3D;

void read(const HingeJoint3D& node, JointReading& reading) {
    JointDescription& joint = reading.joint;
    joint.kind = JointKind::Hinge;
    joint.angular[2] = turned(limits(node.get_flag(HingeJoint3D::FLAG_USE_LIMIT),
                                     node.get_param(HingeJoint3D::PARAM_LIMIT_LOWER),
                                     node.get_param(HingeJoint3D::PARAM_LIMIT_UPPER)));
    if (node.get_flag(HingeJoint3D::FLAG_ENABLE_MOTOR)) {
        const double steps = godot::Engine::get_singleton()->get_physics_ticks_per_second();
        joint.motor_speed = -node.get_param(HingeJoint3D::PARAM_MOTOR_TARGET_VELOCITY);
        joint.motor_torque = node.get_param(HingeJoint3D::PARAM_MOTOR_MAX_IMPULSE) * steps;
    }
}

// Slides along x and turns about it within the angular limit, which is zero unless set.
void read(const SliderJoint3D& node, JointReading& reading) {
    JointDescription& joint = reading.joint;
    joint.linear[0] = {node.get_param(SliderJoint3D::PARAM_LINEAR_LIMIT_LOWER),
                       node.get_param(SliderJoint3D::PARAM_LINEAR_LIMIT_UPPER)};
    joint.angular[0] = turned({node.get_param(SliderJoint3D::PARAM_ANGULAR_LIMIT_LOWER),
                               node.get_param(SliderJoint3D::PARAM_ANGULAR_LIMIT_UPPER)});
    const bool turns = joint.angular[0].lower != 0.0 || joint.angular[0].upper != 0.0;
    joint.kind = turns ? JointKind::SixAxes : JointKind::Slider;
}

// Godot asks for each axis by functions of its own.
struct SixAxis {
    double (*param)(const Generic6DOFJoint3D&, Generic6DOFJoint3D::Param);
    bool (*flag)(const Generic6DOFJoint3D&, Generic6DOFJoint3D::Flag);
};

constexpr SixAxis six_axes[3] = {
    {[](const auto& node, auto param) -> double { return node.get_param_x(param); },
     [](const auto& node, auto flag) { return node.get_flag_x(flag); }},
    {[](const auto& node, auto param) -> double { return node.get_param_y(param); },
     [](const auto& node, auto flag) { return node.get_flag_y(flag); }},
    {[](const auto& node, auto param) -> double { return node.get_param_z(param); },
     [](const auto& node, auto flag) { return node.get_flag_z(flag); }},
};

void read(const Generic6DOFJoint3D& node, JointReading& reading) {
    using Joint = Generic6DOFJoint3D;
    JointDescription& joint = reading.joint;
    joint.kind = JointKind::SixAxes;
    bool has_more = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto& [param, flag] = six_axes[i];
        joint.linear[i] =
            limits(flag(node, Joint::FLAG_ENABLE_LINEAR_LIMIT), param(node, Joint::PARAM_LINEAR_LOWER_LIMIT),
                   param(node, Joint::PARAM_LINEAR_UPPER_LIMIT));
        joint.angular[i] = turned(limits(flag(node, Joint::FLAG_ENABLE_ANGULAR_LIMIT),
                                         param(node, Joint::PARAM_ANGULAR_LOWER_LIMIT),
                                         param(node, Joint::PARAM_ANGULAR_UPPER_LIMIT)));
        for (const Joint::Flag more : {Joint::FLAG_ENABLE_LINEAR_SPRING, Joint::FLAG_ENABLE_ANGULAR_SPRING,
                                       Joint::FLAG_ENABLE_MOTOR, Joint::FLAG_ENABLE_LINEAR_MOTOR}) {
            has_more |= flag(node, more);
        }
    }
    if (has_more) {
        reading.problem =
            "springs and motors of a Generic6DOFJoint3D are not carried out: switch them off, or use a "
            "HingeJoint3D for a motor";
    }
}

// Where Godot's own physics moves the bodies, it carries out each of its joints.
JointReading read_joint(const Joint3D& node, bool engine_moves) {
    JointReading reading;
    if (const auto* hinge = Object::cast_to<HingeJoint3D>(&node)) {
        read(*hinge, reading);
    } else if (const auto* slider = Object::cast_to<SliderJoint3D>(&node)) {
        read(*slider, reading);
    } else if (const auto* six = Object::cast_to<Generic6DOFJoint3D>(&node)) {
        read(*six, reading);
    } else if (Object::cast_to<godot::PinJoint3D>(&node) == nullptr) {
        reading.problem = "a " + from_godot(node.get_class()) +
                          " is not carried out: use a PinJoint3D, HingeJoint3D, SliderJoint3D or "
                          "Generic6DOFJoint3D";
        reading.usable = false;
    }
    // Angles are the first body's against the second, and lengths the second's against the first, as limits
    // are.
    reading.joint.drive = HapticJointDrive::of(node, reading.joint.kind == JointKind::Hinge ? -1.0 : 1.0);
    reading.joint.bodies_collide = !node.get_exclude_nodes_from_collision();
    reading.joint.frame = pose_of(node.get_global_transform());
    if (std::string wrong = wrong_in(reading.joint); reading.usable && !wrong.empty()) {
        reading.problem = std::move(wrong);
        reading.usable = false;
    }
    if (engine_moves) {
        reading.problem.clear();
    }
    return reading;
}

// Of a path that is set and leads to no body; empty where there is none.
std::string problem_of_paths(const Joint3D& node) {
    for (const auto& [property, path] :
         {std::pair("node_a", node.get_node_a()), {"node_b", node.get_node_b()}}) {
        if (!path.is_empty() && !is_solid_body(node.get_node_or_null(path))) {
            return from_godot(wrong_path(property, path, "a body") + ", or leave it empty for the world");
        }
    }
    return {};
}

// Why nothing is joined although no path is wrong; empty where something is.
std::string problem_of_ends(const Joint3D& node) {
    if (node.get_node_a().is_empty() && node.get_node_b().is_empty()) {
        return "it joins nothing: set node_a, node_b or both";
    }
    const auto can_move = [&node](const NodePath& path) {
        const godot::Node* body = path.is_empty() ? nullptr : node.get_node_or_null(path);
        return body != nullptr && !body->is_class("StaticBody3D");
    };
    if (!can_move(node.get_node_a()) && !can_move(node.get_node_b())) {
        return "it joins nothing that moves: let node_a or node_b lead to a RigidBody3D";
    }
    return {};
}

}  // namespace

std::string problem_of_joint(const Joint3D& node, bool engine_moves) {
    std::string problem = read_joint(node, engine_moves).problem;
    problem = problem.empty() ? problem_of_paths(node) : problem;
    return problem.empty() ? problem_of_ends(node) : problem;
}

bool GodotJoint::is_there() const {
    return godot::UtilityFunctions::is_instance_id_valid(static_cast<int64_t>(id_));
}

JointReading GodotJoint::read() const {
    return read_joint(node_, engine_moves_);
}

std::string GodotJoint::problem() const {
    std::string problem = problem_of_paths(node_);
    const bool is_empty = node_.get_node_a().is_empty() && node_.get_node_b().is_empty();
    return problem.empty() && !is_empty ? problem_of_ends(node_) : problem;
}

SceneJoint::End GodotJoint::end_of(const NodePath& path) const {
    const godot::Node* body = path.is_empty() ? nullptr : node_.get_node_or_null(path);
    return {!path.is_empty(), body != nullptr ? body->get_instance_id() : 0};
}

}  // namespace tactus
