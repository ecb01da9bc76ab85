// What an owner asks of a session by plain values alone, asked again: a command that was recorded, as a call.
#pragma once

#include "session/session.hpp"
#include "session/session_commands.hpp"

namespace tactus {

inline void ask(Session& session, const command::RemoveBody& c) {
    session.remove_body(c.handle);
}
inline void ask(Session& session, const command::TeleportBody& c) {
    session.teleport_body(c.handle, c.pose, c.axes);
}
inline void ask(Session& session, const command::ShiftBody& c) {
    session.shift_body(c.handle, c.by, c.turn);
}
inline void ask(Session& session, const command::MoveBody& c) {
    session.move_body(c.handle, c.pose, c.seconds);
}
inline void ask(Session& session, const command::SetBodyVelocity& c) {
    session.set_body_velocity(c.handle, c.linear, c.angular, c.axes);
}
inline void ask(Session& session, const command::SetTouchMaterial& c) {
    session.set_touch_material(c.handle, c.material, c.detail);
}
inline void ask(Session& session, const command::SetBodySurface& c) {
    session.set_body_surface(c.handle, c.surface);
}
inline void ask(Session& session, const command::SetBodyLayers& c) {
    session.set_body_layers(c.handle, c.layers);
}
inline void ask(Session& session, const command::SetBodyMotion& c) {
    session.set_body_motion(c.handle, c.motion);
}
inline void ask(Session& session, const command::SetBodyGravityScale& c) {
    session.set_body_gravity_scale(c.handle, c.scale);
}
inline void ask(Session& session, const command::SetBodyDamping& c) {
    session.set_body_damping(c.handle, c.linear, c.angular);
}
inline void ask(Session& session, const command::SetBodyPush& c) {
    session.set_body_push(c.handle, c.force, c.torque);
}
inline void ask(Session& session, const command::SeeBody& c) {
    session.see_body(c.handle, c.sighting);
}
inline void ask(Session& session, const command::LeadBody& c) {
    session.lead_body(c.handle, c.led);
}
inline void ask(Session& session, const command::CorrectBody& c) {
    session.correct_body(c.handle, c.correction);
}
inline void ask(Session& session, const command::PushBody& c) {
    session.push_body(c.handle, c.push);
}
inline void ask(Session& session, const command::RemoveJoint& c) {
    session.remove_joint(c.handle);
}
inline void ask(Session& session, const command::SetGravity& c) {
    session.set_gravity(c.gravity);
}
inline void ask(Session& session, const command::SetWorkspace& c) {
    session.set_workspace(c.handle, c.workspace);
}
inline void ask(Session& session, const command::RemoveDevice& c) {
    session.remove_device(c.handle);
}
inline void ask(Session& session, const command::SetProxy& c) {
    session.set_proxy(c.handle, c.description);
}
inline void ask(Session& session, const command::SetField& c) {
    session.set_hand_field(c.handle, c.moment);
}
inline void ask(Session& session, const command::SetGuideFrames& c) {
    session.set_guide_frames(c.handle, c.frames);
}
inline void ask(Session& session, const command::RemoveProxy& c) {
    session.remove_proxy(c.handle);
}
inline void ask(Session& session, const command::SetTool& c) {
    session.set_tool(c.handle, c.use);
}
inline void ask(Session& session, const command::RemoveTool& c) {
    session.remove_tool(c.handle);
}

template <typename Command>
concept PlainCommand = requires(Session& session, const Command& c) { ask(session, c); };

}  // namespace tactus
