#include "nodes/passed_over.hpp"

#include <algorithm>
#include <godot_cpp/classes/joint3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/variant/array.hpp>
#include <span>
#include <string_view>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// A property that is used where it is another number than `unused`: a vector counts by its length, a flag as
// 0 or 1.
struct PassedProperty {
    const char* kind;
    const char* property;
    double unused;
    const char* why;
};

constexpr PassedProperty passed_properties[] = {
    {"RigidBody3D", "custom_integrator", 0,
     "'custom_integrator' is not carried out, the world's own forces and damping go on: switch it off, and "
     "set 'gravity_scale' and the damping to 0 where a script moves the body"},
    {"RigidBody3D", "contact_monitor", 0,
     "'contact_monitor' reports nothing (body_entered, get_colliding_bodies()): ask "
     "HapticWorld.intersect_sphere(), or listen to 'contact_started' of a ProxyPointer"},
    {"RigidBody3D", "sleeping", 0,
     "'sleeping' is not carried out: the world lets its bodies sleep when they rest; use 'freeze' for one "
     "that is to "
     "stay where it is"},
    {"StaticBody3D", "constant_linear_velocity", 0,
     "'constant_linear_velocity' moves nothing that lies on it: move an AnimatableBody3D"},
    {"StaticBody3D", "constant_angular_velocity", 0,
     "'constant_angular_velocity' moves nothing that lies on it: turn an AnimatableBody3D"},
    {"CollisionObject3D", "collision_priority", 1,
     "'collision_priority' is not carried out: all bodies are pushed apart alike, so leave it at 1"},
    {"VehicleBody3D", "engine_force", 0,
     "'engine_force' is not carried out: a VehicleBody3D is a rigid body here; push it with "
     "HapticWorld.apply_force()"},
    {"VehicleBody3D", "brake", 0,
     "'brake' is not carried out: a VehicleBody3D is a rigid body here; raise its 'linear_damp'"},
    {"VehicleBody3D", "steering", 0,
     "'steering' is not carried out: a VehicleBody3D is a rigid body here; turn wheels by HingeJoint3D"},
    {"Area3D", "gravity_space_override", 0,
     "its gravity does not act on the bodies of this world: use HapticWorld.apply_central_force() on those "
     "in "
     "it, or their 'gravity_scale'"},
    {"Area3D", "linear_damp_space_override", 0,
     "its damping does not act on the bodies of this world: set their 'linear_damp'"},
    {"Area3D", "angular_damp_space_override", 0,
     "its damping does not act on the bodies of this world: set their 'angular_damp'"},
    {"Area3D", "wind_force_magnitude", 0,
     "its wind does not act on the bodies of this world: use HapticWorld.apply_central_force() on those in "
     "it"},
};

// Nodes that are not carried over at all.
struct PassedKind {
    const char* kind;
    const char* why;
};
constexpr PassedKind passed_kinds[] = {
    {"GridMap", "a GridMap is not carried over: give its tiles as StaticBody3D nodes with shapes"},
    {"SoftBody3D",
     "a SoftBody3D is not carried over: put a HapticSoftBody below a StaticBody3D in its place, with its "
     "mesh and its pinned points"},
    {"PhysicalBone3D",
     "a PhysicalBone3D is not carried over: give the bone as a RigidBody3D with joints, or as an "
     "AnimatableBody3D that follows the skeleton"},
    {"VehicleWheel3D",
     "a VehicleWheel3D is not carried over: give the wheel as a RigidBody3D on a HingeJoint3D"},
};

// What a script of the body may call of it, and has no effect on a body that the world moves.
constexpr const char* pushes[] = {"apply_central_force",   "apply_force",   "apply_torque",
                                  "apply_central_impulse", "apply_impulse", "apply_torque_impulse",
                                  "set_axis_velocity"};

// Signals that are not sent, where something listens to them.
struct PassedSignals {
    const char* kind;
    std::span<const char* const> signals;
    const char* why;
};
constexpr const char* of_areas[] = {"body_entered", "body_exited", "body_shape_entered", "body_shape_exited"};
constexpr const char* of_sleep[] = {"sleeping_state_changed"};
constexpr PassedSignals passed_signals[] = {
    {"Area3D", of_areas,
     " is not sent for bodies that the world moves: ask HapticWorld.intersect_sphere() for those that are "
     "there"},
    {"RigidBody3D", of_sleep, " is not sent: look whether the body's velocity is zero"},
};

double number_of(const Variant& value) {
    switch (value.get_type()) {
        case Variant::BOOL:
            return static_cast<bool>(value) ? 1.0 : 0.0;
        case Variant::VECTOR3:
            return static_cast<double>(static_cast<Vector3>(value).length());
        case Variant::INT:
        case Variant::FLOAT:
            return static_cast<double>(value);
        default:
            return 0.0;
    }
}

// Of itself: not of another object, which has a dot before the name, unless that is `self`.
bool calls(const String& source, const char* method) {
    const String call = String(method) + "(";
    for (int64_t at = source.find(call); at >= 0; at = source.find(call, at + 1)) {
        const String before = source.substr(std::max<int64_t>(0, at - 5), std::min<int64_t>(5, at));
        const String last = before.right(1);
        if (before == String("self.") ||
            (last != String(".") && last != String("_") && !last.is_valid_identifier())) {
            return true;
        }
    }
    return false;
}

void add_calls(const Node& node, std::vector<std::string>& found) {
    const Variant script = node.get_script();
    const Object* const written =
        script.get_type() == Variant::OBJECT ? static_cast<Object*>(script) : nullptr;
    if (written == nullptr || Object::cast_to<RigidBody3D>(&node) == nullptr) {
        return;
    }
    const String source = written->get("source_code");  // empty in a program for players
    for (const char* method : pushes) {
        if (calls(source, method)) {
            found.push_back(std::string("its script calls ") + method +
                            "() of its own, which does nothing while a HapticWorld moves the body: call the "
                            "HapticWorld's method of that name, or set 'constant_force'");
            return;
        }
    }
}

// A joint makes Godot's exceptions for the two that it joins, and is carried out.
bool is_joined(const Node& body) {
    const HapticWorld* const world = HapticWorld::above(&body);
    return world != nullptr && find_below(*world, [&body](Node& one) {
                                   const auto* joint = Object::cast_to<Joint3D>(&one);
                                   return joint != nullptr && joint->get_exclude_nodes_from_collision() &&
                                          (joint->get_node_or_null(joint->get_node_a()) == &body ||
                                           joint->get_node_or_null(joint->get_node_b()) == &body);
                               }) != nullptr;
}

void add_exceptions(const Node& node, std::vector<std::string>& found) {
    auto* const body = Object::cast_to<PhysicsBody3D>(const_cast<Node*>(&node));
    if (body != nullptr && !body->get_collision_exceptions().is_empty() && !is_joined(node)) {
        found.push_back(
            "its collision exceptions are not carried out: give the two bodies layers and masks that leave "
            "each other out");
    }
}

void add_signals(const Node& node, std::vector<std::string>& found) {
    for (const auto& [kind, signals, why] : passed_signals) {
        if (!node.is_class(kind)) {
            continue;
        }
        const auto used = std::ranges::find_if(signals, [&node](const char* signal) {
            return !node.get_signal_connection_list(signal).is_empty();
        });
        if (used != signals.end()) {
            found.push_back("'" + std::string(*used) + "'" + why);
        }
    }
}

// Godot itself puts a body to sleep that it does not move: one that is frozen, or that the world holds.
bool is_used(const Node& node, const PassedProperty& property) {
    const auto* const body = Object::cast_to<RigidBody3D>(&node);
    const bool is_godots =
        std::string_view(property.property) == "sleeping" && body != nullptr &&
        PhysicsServer3D::get_singleton()->body_get_mode(body->get_rid()) < PhysicsServer3D::BODY_MODE_RIGID;
    return !is_godots && node.is_class(property.kind) &&
           number_of(node.get(property.property)) != property.unused;
}

bool leaves_to_godot(const Node& node) {
    const HapticWorld* const world = HapticWorld::above(&node);
    return world != nullptr && world->leaves_bodies_to_godot();
}

}  // namespace

std::vector<std::string> passed_over(const Node& node) {
    std::vector<std::string> found;
    for (const PassedKind& kind : passed_kinds) {
        if (node.is_class(kind.kind) && !(leaves_to_godot(node) && node.is_class("VehicleWheel3D"))) {
            found.emplace_back(kind.why);
        }
    }
    if (node.is_class("CSGShape3D") && static_cast<bool>(node.get("use_collision"))) {
        found.push_back("a " + from_godot(node.get_class()) +
                        " is not carried over: bake its collision shape (menu CSG) into a StaticBody3D");
    }
    if (leaves_to_godot(node)) {  // all of that goes on
        return found;
    }
    for (const PassedProperty& one : passed_properties) {
        if (is_used(node, one)) {
            found.emplace_back(one.why);
        }
    }
    add_exceptions(node, found);
    add_signals(node, found);
    add_calls(node, found);
    return found;
}

}  // namespace tactus
