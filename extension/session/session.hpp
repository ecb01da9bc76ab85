// One scenario, wired up: bodies, proxies, devices and a recorder around the tick (design: one tick of 1 ms).
//
// Threads: a session has two sides. The *owner* side belongs to one thread (in Godot the main thread): it
// adds, changes and removes, and reads snapshots. The *loop* side is tick(), called by one thread at a time:
// the haptic thread in real time, or the owner itself in virtual time. The two meet in rings and a triple
// buffer only; neither ever waits for the other. Objects that leave the loop come back through a ring and are
// destroyed on the owner side.
//
// What makes no sense is refused: where a call gives a result, it says why; where it gives none (a place that
// is not a number, a material below zero), nothing happens.
//
// A session reads no clock: the same calls with the same times give the same bits.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>

#include "core/ports/device.hpp"
#include "realtime/recorder_ring.hpp"
#include "realtime/tick_status.hpp"
#include "realtime/tick_trace.hpp"
#include "session/session_types.hpp"
#include "session/soft_view.hpp"

namespace tactus {

class InputRecorder;
class SoftSlot;
class TeleopSide;
struct LinkEnd;
struct SoftModel;
struct ToolShape;

struct BodyAddition {
    BodyDescription description;
    // What the proxy touches, in the body's frame; empty: the description's own shapes.
    std::vector<PlacedShape> touch_shapes;
    // The same, made already and perhaps shared with other bodies; null: made from the above.
    std::shared_ptr<const TouchShape> touch;
    TouchMaterial touch_material;
    std::shared_ptr<const TouchDetail> detail;  // becomes touch_material.detail; null: none
    // A body that gives (core/soft/soft_body.hpp): its surface is what is touched, in place of the above. It
    // stays where it is put but for its form, and nothing collides with its shapes. For a session of its
    // model's tick.
    std::shared_ptr<const SoftModel> soft;
    std::shared_ptr<SoftView> soft_view;  // shows its form; null: nobody looks
    bool only_touched = false;            // it stays where it is put, and nothing collides with it
};

// A body for which everything that takes time or memory has happened.
struct ReadyBody {
    PreparedBody body, same_body;
    std::shared_ptr<const TouchShape> touch;
    TouchMaterial material;
    std::shared_ptr<const TouchDetail> detail;
    std::uint32_t layer = 0;
    Pose pose;
    Motion motion = Motion::Static;
    std::shared_ptr<SoftSlot> soft;  // null: it does not give
    BodyAddition source;             // that it was made of; what it points to is shared
    std::string error;               // what is wrong and what to do; empty where it can be added
};

struct AddResult {
    SessionHandle handle = no_handle;
    std::string error;     // what is wrong and what to do; empty where the handle is valid
    bool is_full = false;  // there is no place for it, and nothing is wrong with it
};

class Session {
public:
    // With a recorder, which outlives it, all that enters can be played again (input_replay.hpp).
    explicit Session(const SessionSettings& settings, InputRecorder* recorder = nullptr);
    ~Session();
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    const SessionSettings& settings() const;

    // --- owner side
    // -------------------------------------------------------------------------------------------------

    // Any thread, any time: builds the triangle tree and the rigid body, the tree with the help of `run`.
    static ReadyBody prepare_body(const BodyAddition& addition, const ParallelRunner& run = run_serially);
    // Hands it to the loop. Nothing is added on an error.
    AddResult add_body(ReadyBody&& body, const FormerBody& former = {});
    AddResult add_body(const BodyAddition& addition) { return add_body(prepare_body(addition)); }
    void remove_body(SessionHandle body);
    // The body takes another form where it is, of as many shapes as before; what it is else stays. Where only
    // corners of its meshes have moved (see is_deformation), proxies that touch it are carried and pushed
    // along their way, however far that is; else they are let out of it. Its former touch shape is kept
    // until the next form. A body that gives goes on in its shape and motion, made otherwise (see
    // same_structure). An error is that of the new body, and nothing happens.
    std::string deform_body(SessionHandle body, ReadyBody&& form);
    // `shape`: what narrowed() makes for that radius of what the body is touched by now. Nothing is felt of
    // it but that ticks are shorter. Of a body that gives, or of another form's triangles, it is not taken.
    void narrow_touch(SessionHandle body, std::shared_ptr<const TouchShape> shape, double radius);
    // Where the body is from the next tick on, without a way there: nothing is pushed. `axes`: bits 0 to 2
    // take x, y and z of the pose, bit 3 its rotation; the others stay as they are by then. False, and
    // nothing is done, where the pose is none.
    static constexpr std::uint32_t all_of_pose = 0b1111;
    bool teleport_body(SessionHandle body, const Pose& pose, std::uint32_t axes = all_of_pose);
    // The same, relative to where the body is by then: moved `by` (unit: meters), and turned about its own
    // position. False, and nothing is done, where these are no numbers.
    bool shift_body(SessionHandle body, const Vec3& by, const Quat& turn);
    // Moves a kinematic (or static) body there within `seconds`, pushing what is in the way.
    void move_body(SessionHandle body, const Pose& pose, double seconds);
    // `axes`: bits 0 to 2 set x, y and z of the linear velocity, bits 3 to 5 those of the angular one; the
    // others stay as they are by then.
    static constexpr std::uint32_t all_of_velocity = 0b111111;
    void set_body_velocity(SessionHandle body, const Vec3& linear, const Vec3& angular,
                           std::uint32_t axes = all_of_velocity);
    void set_touch_material(SessionHandle body, const TouchMaterial& material,
                            std::shared_ptr<const TouchDetail> detail = nullptr);
    void set_body_layers(SessionHandle body, const CollisionLayers& layers);
    void set_body_motion(SessionHandle body, Motion motion);
    void set_body_surface(SessionHandle body, const SurfaceMaterial& surface);
    void set_body_gravity_scale(SessionHandle body, double scale);
    void set_body_damping(SessionHandle body, double linear, double angular);
    // Pushes a dynamic body in every tick from now on: a force at its centre of mass and a torque, in the
    // world (units: newtons, newton meters).
    void set_body_push(SessionHandle body, const Vec3& force, const Vec3& torque);
    // A body is seen: it is where it must be by now, and no way leads there, as in teleport_body(). A dynamic
    // one where nothing is simulated goes on so until it is seen again, for longest_guess at most
    // (core/teleop/seen_pose.hpp).
    void see_body(SessionHandle body, const BodySighting& sighting);
    // Another physics moves the body, and this one predicts it while hands touch it: from now on snapshots
    // have a LedState of it. No more than max_led are.
    void lead_body(SessionHandle body, bool led);
    // Puts a led body right. The way goes on for as long as it takes to change no hand's force by more than
    // FadingForce::max_step a tick; what is left of earlier corrections is done as well. One that is not made
    // of numbers is not taken.
    void correct_body(SessionHandle body, const BodyCorrection& correction);
    // Once, in the next tick.
    void push_body(SessionHandle body, const BodyPush& push);
    void set_gravity(const Vec3& gravity);

    // Joins two bodies, or one and the world (no_handle). The joint's frame is given in that of the first of
    // them that is a body, its second frame, for which both are bodies or the first is, in that of the second
    // or in the world. It goes with its bodies.
    AddResult add_joint(const JointDescription& joint, SessionHandle first, SessionHandle second);
    void remove_joint(SessionHandle joint);

    // The device must live until remove_device has been carried out: see collect().
    AddResult add_device(Device& device, const Workspace& workspace);
    void set_workspace(SessionHandle device, const Workspace& workspace);
    void remove_device(SessionHandle device);

    AddResult add_proxy(const ProxyDescription& description);
    void set_proxy(SessionHandle proxy, const ProxyDescription& description);
    void remove_proxy(SessionHandle proxy);
    // A force on the hand, as its owner has just computed it; to be said again and again (hand_field.hpp). A
    // number that is none, or a force beyond 10^6 N, is not taken. `hand`: a proxy, or hand_of_tool().
    void set_hand_field(SessionHandle hand, const FieldMoment& moment);
    // The hand's guides are elsewhere, and go there evenly (FollowedFrame). `hand`: as above.
    using GuideFrames = std::array<Pose, HandAids::most_guides>;
    void set_guide_frames(SessionHandle hand, const GuideFrames& frames);

    // The shape is made by make_tool_shape.
    AddResult add_tool(std::shared_ptr<const ToolShape> shape, const ToolUse& use);
    void set_tool(SessionHandle tool, const ToolUse& use);
    void remove_tool(SessionHandle tool);

    // Records every tick of a hand (a proxy, or hand_of_tool()), with the place of `object` (or no_handle),
    // into a ring that the owner drains; again for the same ring: of another hand or object. The ring must
    // live until its end has been carried out. False where as many are recorded as can be (max_recordings).
    bool record(RecorderRing<SessionRecord>& ring, SessionHandle hand, SessionHandle object);
    void end_recording(RecorderRing<SessionRecord>& ring);

    // A side of a teleoperation (operator_side.hpp, teleoperator_side.hpp), in place of the one before; null:
    // none. Before anything else is added, or a twin does not know it. A recorder hears of it only where the
    // session makes it, of these ends of links.
    void attach(std::unique_ptr<TeleopSide> side);
    void attach(const std::vector<LinkEnd>& ends);
    // Neither bodies nor devices, proxies, tools or joints, nor any that the loop may still have.
    bool is_empty() const;

    // Destroys what the loop has given back; call it now and then, as each of Godot's frames does. True while
    // commands are still on their way to the loop.
    bool collect();

    // Takes the newest snapshot; false where there is none since the last call.
    bool refresh();
    const SessionSnapshot& snapshot() const;

    // Commands that found the ring full and wait on the owner side; collect() sends them on.
    std::size_t backlog() const;

    // Before the loop starts, on the owner's thread: carries out everything sent so far at once.
    void settle();

    // --- owner side, where a recording is played (input_replay.hpp)
    // -------------------------------------------------------------------------------------------------

    // What is added next gets this handle, where it is free.
    void use_handle(SessionHandle handle);
    // The next tick(), or settle(), takes exactly so many commands.
    void take_exactly(std::uint32_t commands);

    // --- loop side
    // --------------------------------------------------------------------------------------------------

    // One tick at `now`, a time that rises by the period. `trace` may be null. `late`: how long after `now`
    // it begins, for what is recorded (unit: nanoseconds).
    TickStatus tick(Nanoseconds now, TickTrace* trace = nullptr, Nanoseconds late = 0);

    // Where ticks stop for a while, or for good: devices are given no force, and the snapshot says so. A hand
    // that is elsewhere when they go on begins anew there, without a kick.
    void rest();

    // What has come of the last tick, to the bit, as one number: pointers, tools, what devices were given,
    // and every body that has changed.
    std::uint64_t outcome() const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tactus
