// What the owner of a session asks of its bodies and joints.
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "physics/limits.hpp"
#include "session/request_checks.hpp"
#include "session/session_impl.hpp"

namespace tactus {

namespace {

// The longest way that a body can be told (unit: seconds).
constexpr double max_seconds = 1e5;

TouchMaterial with_detail(TouchMaterial material, const TouchDetail* detail) {
    material.detail = detail;
    return material;
}

}  // namespace

ReadyBody Session::prepare_body(const BodyAddition& addition, const ParallelRunner& run) {
    ReadyBody ready;
    ready.error = check_feel(addition.touch_material, addition.detail.get());
    if (!ready.error.empty()) {
        return ready;
    }
    BodyDescription description = addition.description;
    if (addition.soft) {
        ready.soft =
            std::make_shared<SoftSlot>(addition.soft, addition.soft_view, description.collision.mask, run);
        ready.touch = {ready.soft, &ready.soft->form()};
    } else {
        ready.touch = addition.touch;
    }
    if (!ready.touch) {
        const auto& touched =
            addition.touch_shapes.empty() ? addition.description.shapes : addition.touch_shapes;
        TouchShapeResult touch = make_touch_shape(touched, run);
        ready.touch = std::move(touch.shape);
        ready.error = std::move(touch.error);
    }
    if (!ready.error.empty()) {
        return ready;
    }
    if (addition.soft || addition.only_touched) {
        // The rigid world has it as a place alone.
        const double reach = addition.soft ? 0.5 * addition.soft->size : ready.touch->reach;
        description.shapes = {{SphereShape{std::max(1e-3, reach)}, {}}};
        description.collision = {0, 0};
        description.motion = Motion::Static;
        description.may_move = false;
    }
    ready.body = prepare(description);
    ready.error = ready.body.error();
    ready.material = with_detail(addition.touch_material, addition.detail.get());
    ready.detail = addition.detail;
    ready.layer = addition.description.collision.layer;
    ready.pose = addition.description.pose;
    ready.motion = description.motion;
    ready.source = addition;
    return ready;
}

AddResult Session::add_body(ReadyBody&& body, const FormerBody& former) {
    if (!body.error.empty()) {
        return {no_handle, std::move(body.error)};
    }
    const double tick = to_seconds(impl_->settings.period);
    if (body.soft && std::abs(body.soft->body.model().design.seconds - tick) > 1e-6 * tick) {
        return {no_handle, "the body that gives was made for ticks of another length: make it anew"};
    }
    impl_->make_second(body);
    const SessionHandle handle = impl_->take_from(impl_->bodies);
    if (handle == no_handle) {
        return {no_handle,
                "the world already holds its limit of " + std::to_string(impl_->settings.max_bodies) +
                    " bodies: raise the limit or remove some",
                true};
    }
    if (impl_->recorder) {
        impl_->note(call::AddBody{handle, call::Form::of(body), former});
    }
    impl_->send(command::AddBody{handle, std::move(body.body), std::move(body.same_body),
                                 std::move(body.touch), body.material, std::move(body.detail), body.layer,
                                 body.pose, body.motion, former, std::move(body.soft),
                                 body.source.only_touched});
    return {handle, {}};
}

void Session::remove_body(SessionHandle body) {
    if (impl_->bodies.let_go(body)) {
        impl_->send(command::RemoveBody{body});
    }
}

std::string Session::deform_body(SessionHandle body, ReadyBody&& form) {
    if (form.error.empty() && impl_->bodies.in_use(body)) {
        impl_->make_second(form);
        if (impl_->recorder) {
            impl_->note(call::DeformBody{body, call::Form::of(form)});
        }
        impl_->send(command::DeformBody{body, std::move(form.body), std::move(form.same_body),
                                        std::move(form.touch), std::move(form.soft)});
    }
    return std::move(form.error);
}

void Session::narrow_touch(SessionHandle body, std::shared_ptr<const TouchShape> shape, double radius) {
    if (shape && impl_->bodies.in_use(body) && is_proxy_radius(radius)) {
        impl_->note(call::NarrowTouch{body, radius});
        impl_->send(command::NarrowTouch{body, std::move(shape)});
    }
}

bool Session::teleport_body(SessionHandle body, const Pose& pose, std::uint32_t axes) {
    const bool is_one = limits::is_pose(pose);
    if (is_one) {
        impl_->send(command::TeleportBody{body, pose, axes});
    }
    return is_one;
}

bool Session::shift_body(SessionHandle body, const Vec3& by, const Quat& turn) {
    const bool is_one = limits::is_pose({by, turn});
    if (is_one) {
        impl_->send(command::ShiftBody{body, by, turn});
    }
    return is_one;
}

void Session::move_body(SessionHandle body, const Pose& pose, double seconds) {
    if (limits::is_pose(pose) && std::abs(seconds) <= max_seconds) {
        impl_->send(command::MoveBody{body, pose, seconds});
    }
}

void Session::set_body_velocity(SessionHandle body, const Vec3& linear, const Vec3& angular,
                                std::uint32_t axes) {
    impl_->send(command::SetBodyVelocity{body, linear, angular, axes});
}

void Session::set_touch_material(SessionHandle body, const TouchMaterial& material,
                                 std::shared_ptr<const TouchDetail> detail) {
    if (check_feel(material, detail.get()).empty()) {
        const TouchMaterial complete = with_detail(material, detail.get());
        impl_->send(command::SetTouchMaterial{body, complete, std::move(detail)});
    }
}

void Session::set_body_layers(SessionHandle body, const CollisionLayers& layers) {
    impl_->send(command::SetBodyLayers{body, layers});
}

void Session::set_body_motion(SessionHandle body, Motion motion) {
    impl_->send(command::SetBodyMotion{body, motion});
}

void Session::set_body_surface(SessionHandle body, const SurfaceMaterial& surface) {
    impl_->send(command::SetBodySurface{body, surface});
}

void Session::set_body_gravity_scale(SessionHandle body, double scale) {
    impl_->send(command::SetBodyGravityScale{body, scale});
}

void Session::set_body_damping(SessionHandle body, double linear, double angular) {
    impl_->send(command::SetBodyDamping{body, linear, angular});
}

void Session::set_body_push(SessionHandle body, const Vec3& force, const Vec3& torque) {
    if (limits::is_number(force) && limits::is_number(torque)) {
        impl_->send(command::SetBodyPush{body, force, torque});
    }
}

void Session::see_body(SessionHandle body, const BodySighting& sighting) {
    const BodyMotion& motion = sighting.motion;
    if (is_sound(sighting.doubt) && limits::is_pose(motion.pose) && sighting.age >= 0.0 &&
        limits::is_number(motion.linear_velocity) && limits::is_number(motion.angular_velocity)) {
        impl_->send(command::SeeBody{body, sighting});
    }
}

void Session::lead_body(SessionHandle body, bool led) {
    impl_->send(command::LeadBody{body, led});
}

void Session::correct_body(SessionHandle body, const BodyCorrection& correction) {
    const BodyCorrection& c = correction;
    if (limits::is_pose({c.by, {1.0, 0.0, 0.0, 0.0}}) && limits::is_number(c.turn) && c.seconds >= 0.0 &&
        c.seconds <= max_seconds && limits::is_number(c.linear) && limits::is_number(c.angular) &&
        limits::is_number(c.acceleration) && limits::is_number(c.spin_up) && c.mass > 0.0 &&
        std::isfinite(c.mass)) {
        impl_->send(command::CorrectBody{body, correction});
    }
}

AddResult Session::add_joint(const JointDescription& joint, SessionHandle first, SessionHandle second) {
    if (std::string error = wrong_in(joint); !error.empty()) {
        return {no_handle, std::move(error)};
    }
    if (first == second) {
        return {no_handle, "the joint joins a body with itself, or nothing at all: name two different ones"};
    }
    const SessionHandle handle = impl_->take_from(impl_->joints);
    if (handle == no_handle) {
        return {no_handle, "a world takes at most " + std::to_string(impl_->settings.physics.max_joints) +
                               " joints: remove one"};
    }
    impl_->send(command::AddJoint{handle, joint, first, second});
    return {handle, {}};
}

void Session::remove_joint(SessionHandle joint) {
    if (impl_->joints.let_go(joint)) {
        impl_->send(command::RemoveJoint{joint});
    }
}

void Session::push_body(SessionHandle body, const BodyPush& push) {
    impl_->send(command::PushBody{body, push});
}
void Session::set_gravity(const Vec3& gravity) {
    impl_->send(command::SetGravity{gravity});
}

}  // namespace tactus
