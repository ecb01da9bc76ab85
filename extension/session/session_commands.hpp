// What crosses from the owner of a session to its loop, and what comes back to be destroyed. Private to
// session/.
#pragma once

#include <memory>
#include <optional>
#include <variant>

#include "core/ports/device.hpp"
#include "realtime/recorder_ring.hpp"
#include "session/session_types.hpp"

namespace tactus {

class Proxy;
class SoftSlot;
class TeleopSide;
struct ToolSlot;

}  // namespace tactus

namespace tactus::command {

struct AddBody {
    SessionHandle handle;
    PreparedBody body, same_body;  // the second for a twin
    std::shared_ptr<const TouchShape> shape;
    TouchMaterial material;
    std::shared_ptr<const TouchDetail> detail;  // keeps material.detail alive
    std::uint32_t layer;
    Pose pose;
    Motion motion;
    FormerBody former;
    std::shared_ptr<SoftSlot> soft;  // owns `shape`, then; null: it does not give
    bool only_touched = false;       // see BodyAddition
};
struct RemoveBody {
    SessionHandle handle;
};
// Another form of a body that stays where it is: the same triangles elsewhere, or others.
struct DeformBody {
    SessionHandle handle;
    PreparedBody body, same_body;  // as in AddBody
    std::shared_ptr<const TouchShape> shape;
    std::shared_ptr<SoftSlot> soft;  // owns `shape`, then; null: it does not give
};
// The body's form, with more known of what can be touched of it (see narrowed()).
struct NarrowTouch {
    SessionHandle handle;
    std::shared_ptr<const TouchShape> shape;
};
struct TeleportBody {
    SessionHandle handle;
    Pose pose;
    std::uint32_t axes;  // see Session::teleport_body
};
struct ShiftBody {
    SessionHandle handle;
    Vec3 by;    // (unit: meters)
    Quat turn;  // about its own position
};
struct MoveBody {
    SessionHandle handle;
    Pose pose;
    double seconds;
};
struct SetBodyVelocity {
    SessionHandle handle;
    Vec3 linear, angular;
    std::uint32_t axes;  // see Session::set_body_velocity
};
struct SetTouchMaterial {
    SessionHandle handle;
    TouchMaterial material;
    std::shared_ptr<const TouchDetail> detail;
};
struct SetBodySurface {
    SessionHandle handle;
    SurfaceMaterial surface;
};
struct SetBodyLayers {
    SessionHandle handle;
    CollisionLayers layers;
};
struct SetBodyMotion {
    SessionHandle handle;
    Motion motion;
};
struct SetBodyGravityScale {
    SessionHandle handle;
    double scale;
};
struct SetBodyDamping {
    SessionHandle handle;
    double linear, angular;
};
struct SetBodyPush {
    SessionHandle handle;
    Vec3 force, torque;
};
struct SeeBody {
    SessionHandle handle;
    BodySighting sighting;
};
struct PushBody {
    SessionHandle handle;
    BodyPush push;
};
struct LeadBody {
    SessionHandle handle;
    bool led;
};
struct CorrectBody {
    SessionHandle handle;
    BodyCorrection correction;
};
struct AddJoint {
    SessionHandle handle;
    JointDescription joint;  // its frames: see Session::add_joint
    SessionHandle first, second;
};
struct RemoveJoint {
    SessionHandle handle;
};
struct SetGravity {
    Vec3 gravity;
};
struct AddDevice {
    SessionHandle handle;
    Device* device;
    Workspace workspace;
};
struct SetWorkspace {
    SessionHandle handle;
    Workspace workspace;
};
struct RemoveDevice {
    SessionHandle handle;
};
struct AddProxy {
    SessionHandle handle;
    std::unique_ptr<Proxy> proxy;
    std::unique_ptr<Proxy> same_proxy;  // for a twin; else null
    ProxyDescription description;
};
struct SetProxy {
    SessionHandle handle;
    ProxyDescription description;
};
struct SetField {
    SessionHandle handle;  // of a proxy, or hand_of_tool()
    FieldMoment moment;
};
struct SetGuideFrames {
    SessionHandle handle;  // of a proxy, or hand_of_tool()
    std::array<Pose, HandAids::most_guides> frames;
};
struct RemoveProxy {
    SessionHandle handle;
};
struct AddTool {
    SessionHandle handle;
    std::unique_ptr<ToolSlot> tool;
    std::unique_ptr<ToolSlot> same_tool;  // for a twin; else null
};
struct SetTool {
    SessionHandle handle;
    ToolUse use;
};
struct RemoveTool {
    SessionHandle handle;
};
struct Record {
    RecorderRing<SessionRecord>* ring;
    SessionHandle proxy, object;
};
struct EndRecording {
    RecorderRing<SessionRecord>* ring;
};
struct Attach {
    std::unique_ptr<TeleopSide> side;  // null: detach
};

}  // namespace tactus::command

namespace tactus {

using Command = std::variant<
    command::AddBody, command::RemoveBody, command::DeformBody, command::NarrowTouch, command::TeleportBody,
    command::ShiftBody, command::MoveBody, command::SetBodyVelocity, command::SetTouchMaterial,
    command::SetBodySurface, command::SetBodyLayers, command::SetBodyMotion, command::SetBodyGravityScale,
    command::SetBodyDamping, command::SetBodyPush, command::SeeBody, command::PushBody, command::AddJoint,
    command::RemoveJoint, command::SetGravity, command::AddDevice, command::SetWorkspace,
    command::RemoveDevice, command::AddProxy, command::SetProxy, command::SetField, command::RemoveProxy,
    command::AddTool, command::SetTool, command::RemoveTool, command::Record, command::EndRecording,
    command::Attach, command::LeadBody, command::CorrectBody, command::SetGuideFrames>;

// What has left the loop. Its handle may be given out again once the owner has seen this.
struct Retired {
    enum class Kind { body, form, device, proxy, tool, detail, joint, side } kind = Kind::body;
    SessionHandle handle = no_handle;
    PreparedBody body;
    std::shared_ptr<const TouchShape> shape;
    std::unique_ptr<Proxy> proxy;
    std::shared_ptr<const TouchDetail> detail;
    std::unique_ptr<TeleopSide> side;
    std::shared_ptr<const TouchShape> former_shape = nullptr;
    std::unique_ptr<ToolSlot> tool{};
};

// The same command for a twin, where it concerns one: what it owns is taken from `command`. False where it
// does not.
bool duplicate(Command& command, Command& same);

}  // namespace tactus
