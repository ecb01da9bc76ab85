// What scripts do to the bodies of a world: Godot's own physics, which RigidBody3D's methods speak to, does
// not move them.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <godot_cpp/classes/rigid_body3d.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/tree_walk.hpp"
#include "nodes/world_run.hpp"

namespace tactus {

using namespace godot;

namespace {

Dictionary dictionary_of(const BodyPoint& found, const SceneBodies& bodies) {
    Dictionary result;
    if (found.at.hit) {
        result["collider"] = result["body"] = bodies.node(found.index);
        result["position"] = to_godot(found.at.point);
        result["normal"] = to_godot(found.at.normal);
        result["distance"] = found.at.distance;
    }
    return result;
}

// Godot's own physics moves the body.
void push_in_godot(RigidBody3D& body, const BodyPush& push, bool for_a_frame) {
    const Vector3 force = to_godot(push.impulse), turn = to_godot(push.turn);
    const Vector3 at = push.central ? body.get_global_transform().basis.xform(body.get_center_of_mass())
                                    : to_godot(push.point);
    if (for_a_frame) {
        body.apply_force(force, at);
        body.apply_torque(turn);
    } else {
        body.apply_impulse(force, at);
        body.apply_torque_impulse(turn);
    }
}

void refuse_body(const HapticWorld& world, const char* method, const String& problem) {
    UtilityFunctions::push_error(name_of(world), ": ", method, "() did nothing: the body that it was given ",
                                 problem, ": give it a body of this world that is in the scene tree.");
}

}  // namespace

// As the method of a RigidBody3D has it: a position is seen from the body's place, in the world's axes.
void HapticWorld::push(const char* method, const Variant& body, const BodyPush& push, bool for_a_frame) {
    const char* wrong = nullptr;
    const auto* rigid = object_in<RigidBody3D>(body);
    if (run_ == nullptr) {
        wrong = "this HapticWorld does not run: put it into the scene tree first";
    } else if (const String problem = problem_of_object(body); !problem.is_empty()) {
        refuse_body(*this, method, problem);
        return;
    } else if (rigid == nullptr || run_->body_of(rigid) == no_handle) {
        wrong =
            "the body is no RigidBody3D that this HapticWorld moves: put it below this world, and wait for "
            "the next frame";
    } else if (rigid->is_freeze_enabled()) {
        wrong = "the body is frozen: switch its 'freeze' off";
    } else if (!std::isfinite(glm::length(push.impulse + push.point + push.turn))) {
        wrong = "what it is given is not made of finite numbers";
    }
    if (wrong != nullptr) {
        UtilityFunctions::push_error(name_of(*this), ": ", method, "() did nothing: ", wrong, ".");
        return;
    }
    if (run_->engine_moves()) {
        push_in_godot(*object_in<RigidBody3D>(body), push, for_a_frame);
        return;
    }
    run_->running().push(run_->body_of(rigid), push, for_a_frame);
}

void HapticWorld::apply_central_impulse(const Variant& body, const Vector3& impulse) {
    push("apply_central_impulse", body, {.impulse = from_godot(impulse), .central = true}, false);
}

void HapticWorld::apply_impulse(const Variant& body, const Vector3& impulse, const Vector3& position) {
    push("apply_impulse", body, {.impulse = from_godot(impulse), .point = from_godot(position)}, false);
}

void HapticWorld::apply_torque_impulse(const Variant& body, const Vector3& impulse) {
    push("apply_torque_impulse", body, {.central = true, .turn = from_godot(impulse)}, false);
}

void HapticWorld::apply_central_force(const Variant& body, const Vector3& force) {
    push("apply_central_force", body, {.impulse = from_godot(force), .central = true}, true);
}

void HapticWorld::apply_force(const Variant& body, const Vector3& force, const Vector3& position) {
    push("apply_force", body, {.impulse = from_godot(force), .point = from_godot(position)}, true);
}

void HapticWorld::apply_torque(const Variant& body, const Vector3& torque) {
    push("apply_torque", body, {.central = true, .turn = from_godot(torque)}, true);
}

bool HapticWorld::see(const Node* body, const BodySighting& sighting) {
    const SessionHandle seen = run_ != nullptr ? run_->body_of(body) : no_handle;
    if (seen != no_handle) {
        run_->session().see_body(seen, sighting);
    }
    return seen != no_handle;
}

BodyState HapticWorld::state_of(const char* method, const Variant& body) const {
    if (const String problem = problem_of_object(body); !problem.is_empty()) {
        refuse_body(*this, method, problem);
        return {};
    }
    const auto* const rigid = object_in<RigidBody3D>(body);
    if (run_ != nullptr && run_->engine_moves() && rigid != nullptr) {
        BodyState state;
        state.linear_velocity = from_godot(rigid->get_linear_velocity());
        state.angular_velocity = from_godot(rigid->get_angular_velocity());
        return state;
    }
    return run_ != nullptr ? run_->state_of(object_in<Node>(body)) : BodyState{};
}

Vector3 HapticWorld::get_linear_velocity(const Variant& body) const {
    return to_godot(state_of("get_linear_velocity", body).linear_velocity);
}

Vector3 HapticWorld::get_angular_velocity(const Variant& body) const {
    return to_godot(state_of("get_angular_velocity", body).angular_velocity);
}

bool HapticWorld::can_ask(const char* method, const Vector3& where, double size) const {
    if (!where.is_finite() || !is_at_least_zero(size)) {
        UtilityFunctions::push_error(
            name_of(*this), ": ", method,
            "() was asked with numbers that are no place or size: give finite ones.");
        return false;
    }
    return run_ != nullptr;
}

std::vector<QueriedBody> HapticWorld::touchable(int64_t mask) const {
    return run_->bodies().mirrors().touchable(static_cast<std::uint32_t>(mask));
}

Dictionary HapticWorld::get_nearest_surface(const Vector3& point, double max_distance, int64_t mask) const {
    if (!can_ask("get_nearest_surface", point, max_distance)) {
        return Dictionary();
    }
    return dictionary_of(nearest_of(touchable(mask), from_godot(point), max_distance), run_->bodies());
}

Array HapticWorld::get_tree_boxes(const Vector3& point, double radius, int64_t most) const {
    Array boxes;
    if (!can_ask("get_tree_boxes", point, radius)) {
        return boxes;
    }
    const std::size_t room = static_cast<std::size_t>(std::clamp<int64_t>(most, 1, 65'536));
    for (const PlacedTreeBox& placed : tree_boxes(touchable(-1), from_godot(point), radius, room)) {
        const Vec3 middle = 0.5 * (placed.box.low + placed.box.high);
        const Basis sides =
            Basis(to_godot(placed.pose.rotation)).scaled_local(to_godot(placed.box.high - placed.box.low));
        boxes.push_back(Transform3D(sides, to_godot(to_parent(placed.pose, middle))));
    }
    return boxes;
}

Dictionary HapticWorld::intersect_ray(const Vector3& from, const Vector3& to, int64_t mask) const {
    if (!can_ask("intersect_ray", from, static_cast<double>(to.length()))) {
        return Dictionary();
    }
    return dictionary_of(first_on_way(touchable(mask), from_godot(from), from_godot(to)), run_->bodies());
}

TypedArray<CollisionObject3D> HapticWorld::intersect_sphere(const Vector3& center, double radius,
                                                            int64_t mask) const {
    TypedArray<CollisionObject3D> bodies;
    if (can_ask("intersect_sphere", center, radius)) {
        for (const std::size_t index : within(touchable(mask), from_godot(center), radius)) {
            bodies.push_back(run_->bodies().node(index));
        }
    }
    return bodies;
}

}  // namespace tactus
