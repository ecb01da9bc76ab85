#include "nodes/passed_over.hpp"

#include <algorithm>
#include <functional>
#include <godot_cpp/classes/joint3d.hpp>
#include <godot_cpp/classes/physics_body3d.hpp>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>
#include <godot_cpp/variant/array.hpp>
#include <span>
#include <string_view>
#include <unordered_map>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

namespace {

// Whether a scene that uses it expects Godot's own physics to move its bodies.
enum class Asks : std::uint8_t { nothing, for_godot };

// A property that is used where it is another number than `unused`: a vector counts by its length, a flag as
// 0 or 1.
struct PassedProperty {
    const char* kind;
    const char* property;
    double unused;
    Asks asks;
    const char* why;
};

constexpr PassedProperty passed_properties[] = {
    {"RigidBody3D", "custom_integrator", 0, Asks::for_godot,
     "'custom_integrator' is not carried out, the world's own forces and damping go on: switch it off, and "
     "set 'gravity_scale' and the damping to 0 where a script moves the body"},
    {"RigidBody3D", "contact_monitor", 0, Asks::for_godot,
     "'contact_monitor' reports nothing (body_entered, get_colliding_bodies()): ask "
     "HapticWorld.intersect_sphere(), or listen to 'contact_started' of a ProxyPointer"},
    {"RigidBody3D", "sleeping", 0, Asks::nothing,
     "'sleeping' is not carried out: the world lets its bodies sleep when they rest; use 'freeze' for one "
     "that is to "
     "stay where it is"},
    {"StaticBody3D", "constant_linear_velocity", 0, Asks::for_godot,
     "'constant_linear_velocity' moves nothing that lies on it: move an AnimatableBody3D"},
    {"StaticBody3D", "constant_angular_velocity", 0, Asks::for_godot,
     "'constant_angular_velocity' moves nothing that lies on it: turn an AnimatableBody3D"},
    {"CollisionObject3D", "collision_priority", 1, Asks::nothing,
     "'collision_priority' is not carried out: all bodies are pushed apart alike, so leave it at 1"},
    {"VehicleBody3D", "engine_force", 0, Asks::nothing,
     "'engine_force' is not carried out: a VehicleBody3D is a rigid body here; push it with "
     "HapticWorld.apply_force()"},
    {"VehicleBody3D", "brake", 0, Asks::nothing,
     "'brake' is not carried out: a VehicleBody3D is a rigid body here; raise its 'linear_damp'"},
    {"VehicleBody3D", "steering", 0, Asks::nothing,
     "'steering' is not carried out: a VehicleBody3D is a rigid body here; turn wheels by HingeJoint3D"},
    {"Area3D", "gravity_space_override", 0, Asks::for_godot,
     "its gravity does not act on the bodies of this world: use HapticWorld.apply_central_force() on those "
     "in "
     "it, or their 'gravity_scale'"},
    {"Area3D", "linear_damp_space_override", 0, Asks::for_godot,
     "its damping does not act on the bodies of this world: set their 'linear_damp'"},
    {"Area3D", "angular_damp_space_override", 0, Asks::for_godot,
     "its damping does not act on the bodies of this world: set their 'angular_damp'"},
    {"Area3D", "wind_force_magnitude", 0, Asks::for_godot,
     "its wind does not act on the bodies of this world: use HapticWorld.apply_central_force() on those in "
     "it"},
};

// Nodes that are not carried over at all.
struct PassedKind {
    const char* kind;
    const char* why;
};
constexpr PassedKind passed_kinds[] = {
    {"GridMap",
     "a GridMap is not carried over: give its tiles as StaticBody3D nodes with shapes, or set the world's "
     "'authority' to Godot"},
    {"SoftBody3D",
     "a SoftBody3D is not carried over: put a HapticSoftBody below a StaticBody3D in its place, with its "
     "mesh and its pinned points, or set the world's 'authority' to Godot"},
    {"PhysicalBone3D",
     "a PhysicalBone3D is not carried over: give the bone as a RigidBody3D with joints, or as an "
     "AnimatableBody3D that follows the skeleton, or set the world's 'authority' to Godot"},
    {"VehicleWheel3D",
     "a VehicleWheel3D is not carried over: give the wheel as a RigidBody3D on a HingeJoint3D, or set the "
     "world's 'authority' to Godot"},
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

// What its script calls of the body that it belongs to; null: none of these.
const char* called_push(const Node& node) {
    const Variant script = node.get_script();
    const Object* const written =
        script.get_type() == Variant::OBJECT ? static_cast<Object*>(script) : nullptr;
    if (written == nullptr || Object::cast_to<RigidBody3D>(&node) == nullptr) {
        return nullptr;
    }
    const String source = written->get("source_code");  // empty in a program for players
    const auto* const found =
        std::ranges::find_if(pushes, [&source](const char* method) { return calls(source, method); });
    return found != std::end(pushes) ? *found : nullptr;
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

// Where a joint had one body, or has lost one, Godot Physics leaves an exception for none.
bool has_exceptions(const Node& node) {
    auto* const body = Object::cast_to<PhysicsBody3D>(const_cast<Node*>(&node));
    if (body == nullptr || is_joined(node)) {
        return false;
    }
    const Array others = body->get_collision_exceptions();
    for (int64_t i = 0; i < others.size(); ++i) {
        if (object_in<PhysicsBody3D>(others[i]) != nullptr) {
            return true;
        }
    }
    return false;
}

// Godot itself puts a body to sleep that it does not move: one that is frozen, or that the world holds.
bool is_used(const Node& node, const PassedProperty& property) {
    const auto* const body = Object::cast_to<RigidBody3D>(&node);
    const bool is_godots =
        std::string_view(property.property) == "sleeping" && body != nullptr &&
        PhysicsServer3D::get_singleton()->body_get_mode(body->get_rid()) < PhysicsServer3D::BODY_MODE_RIGID;
    return !is_godots && number_of(node.get(property.property)) != property.unused;
}

// The rows that nodes of one class can use.
struct Rows {
    std::vector<const PassedKind*> kinds;
    std::vector<const PassedProperty*> properties;
    std::vector<const PassedSignals*> signals;
    bool is_csg = false;
};

const Rows& rows_of(const Node& node) {
    static std::unordered_map<std::string, Rows> by_class;
    const auto [found, is_new] = by_class.try_emplace(from_godot(node.get_class()));
    Rows& rows = found->second;
    const auto take = [&node](const auto& table, auto& into) {
        for (const auto& row : table) {
            if (node.is_class(row.kind)) {
                into.push_back(&row);
            }
        }
    };
    if (is_new) {
        take(passed_kinds, rows.kinds);
        take(passed_properties, rows.properties);
        take(passed_signals, rows.signals);
        rows.is_csg = node.is_class("CSGShape3D");
    }
    return rows;
}

// One use of what a world does not carry out.
struct Use {
    std::string what;  // "uses ..."
    std::string why;   // what becomes of it, and what to do
    Asks asks = Asks::for_godot;
};

void for_each_use(const Node& node, const std::function<void(Use)>& take) {
    const Rows& rows = rows_of(node);
    for (const PassedKind* kind : rows.kinds) {
        take({std::string("is a ") + kind->kind, kind->why});
    }
    const std::string class_name = from_godot(node.get_class());
    if (rows.is_csg && static_cast<bool>(node.get("use_collision"))) {
        take({"uses 'use_collision'",
              "a " + class_name +
                  " is not carried over: bake its collision shape (menu CSG) into a StaticBody3D, or set "
                  "the world's 'authority' to Godot"});
    }
    for (const PassedProperty* one : rows.properties) {
        if (is_used(node, *one)) {
            take({std::string("uses '") + one->property + "'", one->why, one->asks});
        }
    }
    if (has_exceptions(node)) {
        take({"has collision exceptions",
              "its collision exceptions are not carried out: give the two bodies layers and masks that leave "
              "each other out",
              Asks::nothing});
    }
    for (const PassedSignals* row : rows.signals) {
        const auto used = std::ranges::find_if(row->signals, [&node](const char* signal) {
            return !node.get_signal_connection_list(signal).is_empty();
        });
        if (used != row->signals.end()) {
            const std::string name = std::string("'") + *used + "'";
            take({"has a listener of " + name, name + row->why});
        }
    }
    if (const char* const method = called_push(node)) {
        take({std::string("calls ") + method + "() in its script",
              std::string("its script calls ") + method +
                  "() of its own, which does nothing while a HapticWorld moves the body: call the "
                  "HapticWorld's method of that name, set 'constant_force', or set the world's 'authority' "
                  "to Godot"});
    }
    if (Object::cast_to<RigidBody3D>(&node) != nullptr && node.has_method("_integrate_forces")) {
        take({"has _integrate_forces() in its script",
              "its script has _integrate_forces(), which is not called while a HapticWorld moves the body: "
              "use _process() and HapticWorld.apply_force(), or set the world's 'authority' to Godot"});
    }
}

}  // namespace

std::vector<std::string> passed_over(const Node& node, bool engine_moves) {
    std::vector<std::string> found;
    if (!engine_moves) {
        for_each_use(node, [&found](Use use) { found.push_back(std::move(use.why)); });
    }
    return found;
}

std::string need_of_godot(const Node& node) {
    std::string need;
    for_each_use(node, [&](const Use& use) {
        if (need.empty() && use.asks == Asks::for_godot) {
            need = "'" + from_godot(String(node.get_name())) + "' " + use.what;
        }
    });
    return need;
}

}  // namespace tactus
