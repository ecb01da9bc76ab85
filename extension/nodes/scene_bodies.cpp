#include "nodes/scene_bodies.hpp"

#include <algorithm>
#include <godot_cpp/classes/physics_server3d.hpp>
#include <godot_cpp/classes/world3d.hpp>
#include <utility>

#include "nodes/body_parts.hpp"
#include "nodes/body_reading.hpp"
#include "nodes/godot_joint.hpp"
#include "nodes/passed_over.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/tree_walk.hpp"

namespace tactus {

using namespace godot;

// A shape or mesh that comes or goes changes the body above it.
void SceneBodies::scene_changed(Node& node, bool comes) {
    const bool is_mirrored = is_solid_body(&node) || Object::cast_to<Joint3D>(&node) != nullptr;
    tree_changed_ |= is_mirrored || is_soft_body(node);
    if (!is_mirrored) {
        others_.push_back(node.get_instance_id());
    }
    if (const Node* parent = node.get_parent(); parent != nullptr && is_solid_body(parent)) {
        mirrors_.news()->changed.push_back(parent->get_instance_id());
    }
    auto* const rigid = Object::cast_to<RigidBody3D>(&node);
    if (rigid == nullptr || scene_.engine_moves) {
        return;
    }
    const std::uint64_t id = node.get_instance_id();
    if (comes && scene_.world.is_ancestor_of(rigid)) {
        arrived_.insert(id);
    } else if (!comes && arrived_.erase(id) == 0 && held_.erase(id) > 0) {
        hold_still(*rigid, false);
    }
}

void SceneBodies::hold_arrived() {
    for (const std::uint64_t id : std::exchange(arrived_, {})) {
        if (const auto* const body = node_of_id<RigidBody3D>(id)) {
            say_passed_over(*body);  // as the script has made it: a body that is held sleeps
            hold_still(*body, true);
            held_.insert(id);
        }
    }
}

void SceneBodies::say_passed_over(const Node& node) {
    for (const std::string& problem : passed_over(node, scene_.engine_moves)) {
        scene_.complaints.say(node, problem);
    }
}

std::vector<std::string> SceneBodies::problems() const {
    std::vector<std::string> all = mirrors_.problems();
    std::ranges::move(server_bodies_.mirrors().problems(), std::back_inserter(all));
    for_each_below(scene_.world, [&](const Node& node) {
        if (!is_solid_body(&node)) {
            for (const std::string& problem : passed_over(node, scene_.engine_moves)) {
                all.push_back(from_godot(name_of(node)) + ": " + problem);
            }
        }
    });
    return all;
}

void SceneBodies::find(Session& session) {
    std::vector<std::uint64_t> bodies, joints, soft_bodies;
    for_each_below(scene_.world, [&](Node& node) {
        if (is_solid_body(&node)) {
            bodies.push_back(node.get_instance_id());
        } else if (Object::cast_to<Joint3D>(&node) != nullptr) {
            joints.push_back(node.get_instance_id());
        } else {
            if (is_soft_body(node)) {
                soft_bodies.push_back(node.get_instance_id());
            }
            if (is_first_look_) {
                say_passed_over(node);
            }
        }
    });
    is_first_look_ = false;
    server_bodies_.set_soft_bodies(std::move(soft_bodies));
    const auto make_body = [this](std::uint64_t id) {
        return std::make_unique<GodotBody>(*node_of_id<CollisionObject3D>(id), scene_, mirrors_.news());
    };
    const auto make_joint = [this](std::uint64_t id) {
        return std::make_unique<GodotJoint>(*node_of_id<Joint3D>(id), scene_.engine_moves, scene_.complaints);
    };
    mirrors_.match(bodies, make_body, joints, make_joint, session);
    arrived_.clear();
    held_.clear();
}

void SceneBodies::synchronise(MirrorContext context) {
    for (const std::uint64_t id : std::exchange(others_, {})) {
        auto* other = node_of_id<Node>(id);
        if (other != nullptr && scene_.world.is_ancestor_of(other)) {
            say_passed_over(*other);
        }
    }
    if (std::exchange(tree_changed_, false)) {
        find(context.session);
    }
    context.mesh_changes = part_changes();
    mirrors_.synchronise(context);
    server_bodies_.synchronise(context);
}

namespace {

// A server with a thread of its own has still to do what scripts have told it, and its queries find bodies
// that are freed. Its answers come when all of that is done.
void await_server(const Node3D& world) {
    if (const Ref<World3D> around = world.get_world_3d(); has_physics_thread() && around.is_valid()) {
        PhysicsServer3D::get_singleton()->space_is_active(around->get_space());
    }
}

}  // namespace

// A body counts that is within arm's length of a hand, or next to a local model, which may lie on it.
void SceneBodies::exchange(PhysicsFrame frame) {
    constexpr double close = 0.5, farthest = 5.0;  // (unit: meters)
    await_server(scene_.world);
    const double radius = std::min(farthest, close + 2.0 * mirrors_.widest_led());
    const std::span<const CloseShape> shapes = close_.around(scene_.world, frame.hands, radius);
    if (close_.is_full()) {
        scene_.complaints.say(scene_.world,
                              "there are so many shapes about a hand that those farther from it are left "
                              "out: join small shapes to fewer ones");
    }
    std::vector<std::uint64_t> bodies;
    std::vector<CloseShape> others;
    for (const CloseShape& shape : shapes) {
        if (mirrors_.of(shape.owner) != nullptr) {
            bodies.push_back(shape.owner);
        } else {
            others.push_back(shape);
        }
    }
    frame.close = bodies;
    mirrors_.exchange(frame);
    server_bodies_.exchange(others, radius, frame);
}

std::uint64_t SceneBodies::node_of(SessionHandle body) const {
    const std::uint64_t node = mirrors_.node_of(body);
    return node != 0 ? node : server_bodies_.owner_of(body);
}

void SceneBodies::release(Session& session) {
    for (const std::uint64_t id : std::exchange(held_, {})) {
        if (const auto* body = node_of_id<RigidBody3D>(id)) {
            hold_still(*body, false);
        }
    }
    mirrors_.release(session);
    server_bodies_.release(session);
}

void SceneBodies::begin_to_show() {
    scene_.is_at_origin = scene_.world.get_global_transform() == Transform3D();
}

CollisionObject3D* SceneBodies::node(std::size_t index) const {
    return node_of_id<CollisionObject3D>(mirrors_.bodies()[index]->id());
}

}  // namespace tactus
