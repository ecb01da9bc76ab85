// What a recording of a session's inputs is made of. The owner's half: what it has asked of the session, in
// that order. The loop's half, tick by tick: when it was, how much of the former it took, and all else that
// it heard. Together they are everything that a session's results depend on.
#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "core/soft/soft_design.hpp"
#include "core/tool/tool_shape.hpp"
#include "session/session.hpp"
#include "session/session_commands.hpp"
#include "session/side_plan.hpp"
#include "session/value_stream.hpp"

namespace tactus {

// By the owner, where a command is not plain values.
namespace call {

// What a body is made of, but for what it is touched by: that is made of the same shapes again, and one that
// gives of the same design.
struct Form {
    BodyDescription description;
    std::vector<PlacedShape> touch_shapes;
    TouchMaterial touch_material;
    std::shared_ptr<const TouchDetail> detail;
    // Of its trees, one for each part. One whose number has been there is that tree, refitted: made anew it
    // would touch alike, but not to the last bit.
    std::vector<std::uint64_t> lineages;
    std::shared_ptr<const SoftDesign> soft;  // null: it does not give
    bool only_touched = false;               // see BodyAddition

    static Form of(const ReadyBody& body);
    const std::vector<PlacedShape>& touched() const {
        return touch_shapes.empty() ? description.shapes : touch_shapes;
    }
};
struct AddBody {
    SessionHandle handle = no_handle;
    Form form;
    FormerBody former;
};
struct DeformBody {
    SessionHandle handle = no_handle;
    Form form;
};
// To spheres of that radius (unit: meters); made of the body's form again.
struct NarrowTouch {
    SessionHandle handle = no_handle;
    double radius = 0.0;
};
struct AddDevice {
    SessionHandle handle = no_handle;
    Workspace workspace;
};
struct AddProxy {
    SessionHandle handle = no_handle;
    ProxyDescription description;
};
struct AddTool {
    SessionHandle handle = no_handle;
    std::shared_ptr<const ToolShape> shape;
    ToolUse use;
};
// `ring`: one number for each.
struct Record {
    std::uint32_t ring = 0;
    SessionHandle proxy = no_handle, object = no_handle;
};
struct EndRecording {
    std::uint32_t ring = 0;
};
struct Attach {
    std::vector<SidePlan> sides;
};
// To the far side at this end of a link.
struct Announce {
    std::uint32_t link = 0;
    PreparedDiscovery discovery;
};
// The zero of the session's clock, since 1970.
struct Epoch {
    Nanoseconds epoch = 0;
};
// What comes into this ring is written down, and later: that so many rows were.
struct WriteRows {
    std::uint32_t ring = 0;
};
struct RowsWritten {
    std::uint32_t ring = 0;
    std::uint64_t rows = 0;
};

}  // namespace call

using InputCall =
    std::variant<call::AddBody, command::RemoveBody, call::DeformBody, command::TeleportBody,
                 command::MoveBody, command::SetBodyVelocity, command::SetTouchMaterial,
                 command::SetBodySurface, command::SetBodyLayers, command::SetBodyMotion,
                 command::SetBodyGravityScale, command::SetBodyDamping, command::SetBodyPush,
                 command::SeeBody, command::PushBody, command::AddJoint, command::RemoveJoint,
                 command::SetGravity, call::AddDevice, command::SetWorkspace, command::RemoveDevice,
                 call::AddProxy, command::SetProxy, command::SetField, command::RemoveProxy, call::AddTool,
                 command::SetTool, command::RemoveTool, call::Record, call::EndRecording, call::Attach,
                 call::Announce, call::Epoch, call::WriteRows, call::RowsWritten, call::NarrowTouch,
                 command::ShiftBody, command::LeadBody, command::CorrectBody, command::SetGuideFrames>;

// By the loop. `link`: the number of the end.
namespace heard {

// A tick begins; so many commands were taken.
struct Tick {
    Nanoseconds now = 0;
    std::uint32_t commands = 0;
    Nanoseconds late = 0;  // it began so long after `now`
};
// Between ticks.
struct Settle {
    std::uint32_t commands = 0;
};
struct Rest {};

struct Reading {
    SessionHandle device = no_handle;
    DeviceSample sample;
};
// Where they are others than before.
struct Abilities {
    SessionHandle device = no_handle;
    DeviceCapabilities capabilities;
};
struct Arrival {
    std::uint32_t link = 0;
    Nanoseconds arrived = 0;
    std::vector<std::byte> datagram;
};
// Of the datagrams sent in this tick the link has not taken this one.
struct NotSent {
    std::uint32_t link = 0;
    std::uint32_t number = 0;
};
// From this tick on.
struct Overhead {
    std::uint32_t link = 0;
    std::uint64_t bytes = 0;
};
struct Settings {
    std::uint32_t link = 0;
    TeleopSettings settings;
};
struct Binding {
    std::uint32_t link = 0;
    ObjectBinding binding;
};
// The next call::Announce.
struct Announced {
    std::uint32_t link = 0;
};
struct Withdrawn {
    std::uint32_t link = 0;
    ObjectId object = no_object;
};
struct Acknowledged {
    std::uint32_t link = 0;
    DiscoveryAcknowledgement acknowledgement;
};
// The tick is over; what has come of it, as one number (SessionLoop::outcome).
struct Done {
    std::uint64_t outcome = 0;
};

}  // namespace heard

using HeardInput =
    std::variant<heard::Tick, heard::Settle, heard::Rest, heard::Reading, heard::Abilities, heard::Arrival,
                 heard::NotSent, heard::Overhead, heard::Settings, heard::Binding, heard::Announced,
                 heard::Withdrawn, heard::Acknowledged, heard::Done>;

// The number of a kind among those of a variant, as it stands before its value.
template <typename Kind, typename Variant>
inline constexpr std::uint8_t kind_of = 0;
template <typename Kind, typename... Kinds>
inline constexpr std::uint8_t kind_of<Kind, std::variant<Kinds...>> = [] {
    std::uint8_t at = 0;
    (void)((std::is_same_v<Kind, Kinds> || (++at, false)) || ...);
    return at;
}();

// --- how many members each has

template <>
inline constexpr int members<Pose> = 2;
template <>
inline constexpr int members<TriangleMesh> = 2;
template <>
inline constexpr int members<SphereShape> = 1;
template <>
inline constexpr int members<BoxShape> = 1;
template <>
inline constexpr int members<CapsuleShape> = 2;
template <>
inline constexpr int members<CylinderShape> = 2;
template <>
inline constexpr int members<PlaneShape> = 2;
template <>
inline constexpr int members<ConvexHullShape> = 1;
template <>
inline constexpr int members<MeshShape> = 4;
template <>
inline constexpr int members<HeightFieldShape> = 4;
template <>
inline constexpr int members<PlacedShape> = 2;
template <>
inline constexpr int members<TouchImage> = 3;
template <>
inline constexpr int members<ForceCurve> = 3;
template <>
inline constexpr int members<TouchImages> = 3;
template <>
inline constexpr int members<SurfaceFeel> = 2;
template <>
inline constexpr int members<TouchDetail> = 2;
template <>
inline constexpr int members<SurfaceMap> = 2;
template <>
inline constexpr int members<TouchMaterial> = 23;
template <>
inline constexpr int members<SurfaceMaterial> = 4;
template <>
inline constexpr int members<CollisionLayers> = 2;
template <>
inline constexpr int members<BodyDescription> = 18;
template <>
inline constexpr int members<JointRange> = 2;
template <>
inline constexpr int members<JointDrive> = 6;
template <>
inline constexpr int members<JointDescription> = 9;
template <>
inline constexpr int members<PhysicsSettings> = 11;
template <>
inline constexpr int members<SessionSettings> = 6;
template <>
inline constexpr int members<ProxySettings> = 4;
template <>
inline constexpr int members<SoftFinger> = 3;
template <>
inline constexpr int members<GuideWay::Block> = 2;
template <>
inline constexpr int members<GuideWay> = 2;
template <>
inline constexpr int members<HandGuide> = 8;
template <>
inline constexpr int members<HandAids> = 3;
template <>
inline constexpr int members<HandEffect> = 11;
template <>
inline constexpr int members<HandEffects> = 2;
template <>
inline constexpr int members<ProxyDescription> = 6;
template <>
inline constexpr int members<FieldLine> = 5;
template <>
inline constexpr int members<FieldMoment> = 6;
template <>
inline constexpr int members<ToolSettings> = 8;
template <>
inline constexpr int members<ToolUse> = 5;
template <>
inline constexpr int members<ToolSphere> = 2;
template <>
inline constexpr int members<ToolShape> = 4;
template <>
inline constexpr int members<Workspace> = 9;
template <>
inline constexpr int members<BodyPush> = 4;
template <>
inline constexpr int members<BodyMotion> = 3;
template <>
inline constexpr int members<PoseDoubt> = 2;
template <>
inline constexpr int members<BodySighting> = 3;
template <>
inline constexpr int members<FormerBody> = 2;
template <>
inline constexpr int members<DeviceSample> = 5;
template <>
inline constexpr int members<DeviceCapabilities> = 20;
template <>
inline constexpr int members<MotionThreshold> = 4;
template <>
inline constexpr int members<StealthSettings> = 10;
template <>
inline constexpr int members<EstimateSettings> = 7;
template <>
inline constexpr int members<ResidualSettings> = 11;
template <>
inline constexpr int members<PoseFilterSettings> = 5;
template <>
inline constexpr int members<SeenPoseSettings> = 2;
template <>
inline constexpr int members<ForceLimits> = 3;
template <>
inline constexpr int members<PassivitySettings> = 12;
template <>
inline constexpr int members<PassiveUpdateSettings> = 3;
template <>
inline constexpr int members<StandInSettings> = 3;
template <>
inline constexpr int members<DeadbandSettings> = 7;
template <>
inline constexpr int members<ClockSkew> = 3;
template <>
inline constexpr int members<TeleopSettings> = 28;
template <>
inline constexpr int members<EndpointSettings> = 8;
template <>
inline constexpr int members<OperatorRoom> = 6;
template <>
inline constexpr int members<PointerShare> = 2;
template <>
inline constexpr int members<SidePlan> = 5;
template <>
inline constexpr int members<ObjectBinding> = 2;
template <>
inline constexpr int members<DiscoveryAcknowledgement> = 3;
template <>
inline constexpr int members<PreparedDiscovery> = 3;
template <>
inline constexpr int members<SoftMaterial> = 7;
template <>
inline constexpr int members<HeldParts> = 3;
template <>
inline constexpr int members<SoftDesign> = 8;
template <>
inline constexpr int members<call::Form> = 7;
template <>
inline constexpr int members<command::RemoveBody> = 1;
template <>
inline constexpr int members<command::TeleportBody> = 3;
template <>
inline constexpr int members<command::ShiftBody> = 3;
template <>
inline constexpr int members<BodyCorrection> = 8;
template <>
inline constexpr int members<command::LeadBody> = 2;
template <>
inline constexpr int members<command::CorrectBody> = 2;
template <>
inline constexpr int members<command::MoveBody> = 3;
template <>
inline constexpr int members<command::SetBodyVelocity> = 4;
template <>
inline constexpr int members<command::SetTouchMaterial> = 3;
template <>
inline constexpr int members<command::SetBodySurface> = 2;
template <>
inline constexpr int members<command::SetBodyLayers> = 2;
template <>
inline constexpr int members<command::SetBodyMotion> = 2;
template <>
inline constexpr int members<command::SetBodyGravityScale> = 2;
template <>
inline constexpr int members<command::SetBodyDamping> = 3;
template <>
inline constexpr int members<command::SetBodyPush> = 3;
template <>
inline constexpr int members<command::SeeBody> = 2;
template <>
inline constexpr int members<command::PushBody> = 2;
template <>
inline constexpr int members<command::AddJoint> = 4;
template <>
inline constexpr int members<command::RemoveJoint> = 1;
template <>
inline constexpr int members<command::SetGravity> = 1;
template <>
inline constexpr int members<command::SetWorkspace> = 2;
template <>
inline constexpr int members<command::RemoveDevice> = 1;
template <>
inline constexpr int members<command::SetProxy> = 2;
template <>
inline constexpr int members<command::SetField> = 2;
template <>
inline constexpr int members<command::SetGuideFrames> = 2;
template <>
inline constexpr int members<command::RemoveProxy> = 1;
template <>
inline constexpr int members<command::SetTool> = 2;
template <>
inline constexpr int members<command::RemoveTool> = 1;
template <>
inline constexpr int members<call::AddBody> = 3;
template <>
inline constexpr int members<call::DeformBody> = 2;
template <>
inline constexpr int members<call::NarrowTouch> = 2;
template <>
inline constexpr int members<call::AddDevice> = 2;
template <>
inline constexpr int members<call::AddProxy> = 2;
template <>
inline constexpr int members<call::AddTool> = 3;
template <>
inline constexpr int members<call::Record> = 3;
template <>
inline constexpr int members<call::EndRecording> = 1;
template <>
inline constexpr int members<call::Attach> = 1;
template <>
inline constexpr int members<call::Announce> = 2;
template <>
inline constexpr int members<call::Epoch> = 1;
template <>
inline constexpr int members<call::WriteRows> = 1;
template <>
inline constexpr int members<call::RowsWritten> = 2;
template <>
inline constexpr int members<heard::Tick> = 3;
template <>
inline constexpr int members<heard::Settle> = 1;
template <>
inline constexpr int members<heard::Rest> = 0;
template <>
inline constexpr int members<heard::Reading> = 2;
template <>
inline constexpr int members<heard::Abilities> = 2;
template <>
inline constexpr int members<heard::Arrival> = 3;
template <>
inline constexpr int members<heard::NotSent> = 2;
template <>
inline constexpr int members<heard::Overhead> = 2;
template <>
inline constexpr int members<heard::Settings> = 2;
template <>
inline constexpr int members<heard::Binding> = 2;
template <>
inline constexpr int members<heard::Announced> = 1;
template <>
inline constexpr int members<heard::Withdrawn> = 2;
template <>
inline constexpr int members<heard::Acknowledged> = 2;
template <>
inline constexpr int members<heard::Done> = 1;

// --- the last value of each choice

template <>
struct LastOf<Motion> {
    static constexpr Motion value = Motion::Dynamic;
};
template <>
struct LastOf<SoftDesign::Form> {
    static constexpr SoftDesign::Form value = SoftDesign::Form::tetrahedra;
};
template <>
struct LastOf<JointKind> {
    static constexpr JointKind value = JointKind::SixAxes;
};
template <>
struct LastOf<ForceLaw> {
    static constexpr ForceLaw value = ForceLaw::smoothed;
};
template <>
struct LastOf<HandGuide::Form> {
    static constexpr HandGuide::Form value = HandGuide::Form::way;
};
template <>
struct LastOf<HandGuide::Mode> {
    static constexpr HandGuide::Mode value = HandGuide::Mode::forbid;
};
template <>
struct LastOf<HandEffect::Form> {
    static constexpr HandEffect::Form value = HandEffect::Form::wall;
};
template <>
struct LastOf<Derivation> {
    static constexpr Derivation value = Derivation::resimulate;
};
template <>
struct LastOf<Correction> {
    static constexpr Correction value = Correction::passive;
};
template <>
struct LastOf<ControlScheme> {
    static constexpr ControlScheme value = ControlScheme::position_force_relative;
};
template <>
struct LastOf<Passivity> {
    static constexpr Passivity value = Passivity::two_layers;
};
template <>
struct LastOf<Side> {
    static constexpr Side value = Side::teleoperator_side;
};
template <>
struct LastOf<SidePlan::Kind> {
    static constexpr SidePlan::Kind value = SidePlan::Kind::robot;
};
template <>
struct LastOf<DiscoveryVerdict> {
    static constexpr DiscoveryVerdict value = DiscoveryVerdict::removed;
};

}  // namespace tactus
