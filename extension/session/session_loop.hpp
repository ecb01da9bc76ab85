// The loop's half of a session: the tick and everything that only the ticking thread touches. Private to
// session/.
//
// All memory is taken in the constructor. Nothing here allocates, locks, throws, logs or reads a clock.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/haptics/fading_force.hpp"
#include "core/haptics/surface_effects.hpp"
#include "core/haptics/touch_scene.hpp"
#include "core/proxy/proxy.hpp"
#include "core/teleop/residual_motion.hpp"
#include "physics/physics_world.hpp"
#include "realtime/tick_trace.hpp"
#include "realtime/triple_buffer.hpp"
#include "session/change_order.hpp"
#include "session/puncture.hpp"
#include "session/session_commands.hpp"
#include "session/soft_slot.hpp"
#include "session/teleop_side.hpp"
#include "session/tool_slot.hpp"

namespace tactus {

class InputRecorder;
struct LoopMemento;

// A device as what drives it has to know it.
struct RobotView {
    bool connected = false;
    DeviceCapabilities capabilities;
    Workspace workspace;
};

class SessionLoop {
public:
    struct Body {
        BodyId id;
        int slot = -1;  // in the touch scene; -1: not in the loop
        std::shared_ptr<const TouchShape> shape;
        std::shared_ptr<const TouchShape> former;  // form; its triangles may still be on their way
        bool takes_form = false;                   // `shape` is not in the touch scene yet
        std::shared_ptr<const TouchDetail> detail;
        Motion motion = Motion::Static;
        // A way that the owner asked for: from where it is to `target` in `ticks_left` ticks.
        Pose target;
        int ticks_left = 0;
        Vec3 push{0.0};  // in every tick, see Session::set_body_push
        Vec3 twist{0.0};
        // See set_residual().
        Residual residual, residual_turn;
        Vec3 helped{0.0}, helped_turn{0.0};  // velocities that it gave in the last step
        // See Session::see_body.
        std::optional<PoseDoubt> doubt;  // none: it has never been seen
        Nanoseconds guessed_until = 0;   // it goes on as it was seen to
        std::shared_ptr<SoftSlot> soft;  // null: it does not give; else the one that owns `shape`
        bool only_touched = false;       // see BodyAddition
        std::uint32_t asked = 0;         // see BodyState::asked
    };

    // What touching the scene gives a hand.
    struct SceneForce {
        Vec3 force{0.0};         // (unit: newtons)
        FadingForce::Step step;  // what the hand's own way can have made of it
        bool jumped = false;     // see ProxyTick
    };

    // Of what a pointer touches, the softest and the stiffest; 0 where there is nothing (unit: newtons per
    // meter).
    struct Stiffnesses {
        double least = 0.0, most = 0.0;

        bool operator==(const Stiffnesses&) const = default;
    };

    struct ProxySlot {
        std::unique_ptr<Proxy> proxy;
        ProxyDescription description;
        Vec3 hand{0.0};           // in the world (unit: meters)
        Vec3 hand_velocity{0.0};  // in the world (unit: meters per second)
        Vec3 force{0.0};          // of the scene as it is here; what the hand is given is state.force
                                  // (unit: newtons)
        Vec3 force_before{0.0};   // one tick ago
        FadingForce fading;       // from `force` to state.force
        double own_change = 0.0;  // see ForceExit::leave
        FadingForce::Step step;   // of `force`, see SceneForce
        bool jumped = false;
        HandForce parts;
        Vec3 pressed{0.0};  // of `parts`, what surfaces press with (unit: newtons)
        Stiffnesses walls;
        bool sliding = false;
        bool idle = false;  // a side says that nobody holds it: it touches nothing
        EffectMemory effects;
        AidMemory aids;
        HandField field;       // that its owner computes, see Session::set_hand_field
        bool changed = false;  // by its owner since the last tick: its guides, or where its hand is
        TorsionList torsion;   // one each of `parts`; none where the finger is a point
        bool rested = false;   // since the last tick
        ProxyState state;
        Punctures punctures;
        ImpactWatch impacts;
        BreakWatch breaks;
        TouchEvents events;

        bool present() const { return proxy && description.enabled; }
        SceneForce scene_force() const { return {force, step, jumped}; }
    };

    // `recorder`: hears what devices say; null: nobody does.
    SessionLoop(const SessionSettings& settings, TripleBuffer<SessionSnapshot>& snapshots,
                InputRecorder* recorder = nullptr);

    // Carries out a command. What has to be destroyed elsewhere is left in `retired`; true where there is
    // something.
    bool take(Command& command, Retired& retired);

    // Before a twin of `other` takes the same command: a joint holds bodies as they are in the present, and a
    // body that takes the place of another one goes on from there.
    void follow(const SessionLoop& other, const Command& command);

    // After the first bodies have come in and before the first tick.
    void settle() { physics_.settle_broad_phase(); }

    TickStatus tick(Nanoseconds now, TickTrace* trace, Nanoseconds late);

    // See Session.
    void rest();
    std::uint64_t outcome() const;

    // Another loop that has to get every command, too.
    SessionLoop* twin() { return side_ ? side_->twin() : nullptr; }

    // --- for a side of teleoperation, inside its three calls (teleop_side.hpp)

    double seconds() const { return seconds_; }
    std::size_t max_bodies() const { return bodies_.size(); }
    // One more than the highest handle of a body; 0: there is none.
    std::uint32_t bodies_end() const { return bodies_end_; }
    Body* body(SessionHandle handle);  // null where there is none
    const Body* body(SessionHandle handle) const;
    SessionHandle body_in(int slot) const {  // of the touch scene
        return slot < 0 ? no_handle : handle_of_slot_[static_cast<std::size_t>(slot)];
    }
    ProxySlot& proxy(std::size_t index) { return proxies_[index]; }
    ToolSlot* tool(std::size_t index) { return tools_[index].get(); }  // null: there is none
    const TouchScene& scene() const { return scene_; }
    DeviceSample device_sample(SessionHandle device) const;
    RobotView robot(SessionHandle device) const;
    // Of a pointer's force, what the last tick's limits have let through (unit: newtons).
    Vec3 given_force(const ProxySlot& slot) const;
    Vec3 given_force(const ToolSlot& slot) const;
    // Of all torques on its device, likewise (unit: newton meters).
    Vec3 given_torque(const ToolSlot& slot) const;

    // Where physics has the body after the last step.
    BodyMotion motion(SessionHandle handle);
    bool asleep(SessionHandle handle);
    // Nearest to `pose` that the joints of the body to what does not move allow.
    Pose on_joints(SessionHandle handle, const Pose& pose) const;
    bool touching(SessionHandle first, SessionHandle second) const;  // each other, in the last step
    void set_factors(SessionHandle handle, const BodyFactors& factors);
    // What acts on a body beyond this loop's physics, in every tick until all are taken away.
    void set_residual(SessionHandle handle, const Residual& linear, const Residual& turn);
    void clear_residuals();
    double mass(SessionHandle handle) const;  // (unit: kilograms); 0 for what cannot move
    void set_touch(SessionHandle handle, const TouchMaterial& material);
    const Vec3& gravity() const { return gravity_; }
    // Whether the owner has changed what is touched, or what touches, since this was asked last.
    bool take_touch_change() { return std::exchange(touch_changed_, false); }
    // The velocity that hands give a body in this tick (unit: meters per second).
    Vec3 pushed(SessionHandle handle) const;

    // The body is elsewhere. With `rides`, or where a proxy rests on it, it has been elsewhere a tick ago,
    // too, and what rests on it comes along; else it runs into what is in its way. `previous`: where it was a
    // tick ago, if that is known better. Its rates change where `with_velocity` says so.
    void put_right(SessionHandle handle, const BodyMotion& to, bool with_velocity, bool rides = false,
                   const Pose* previous = nullptr);
    bool rests_on(const Proxy& proxy, SessionHandle handle) const;
    bool rests_on(const ToolProxy& proxy, SessionHandle handle) const;
    // What hands that rest on it feel of it is another thing from now on, and fades in.
    void fade_in(SessionHandle handle);
    // Whether any hand rests on it.
    bool is_touched(SessionHandle handle) const;

    // Whether a hand is in the scene with that device, and holds this proxy.
    bool is_there(SessionHandle device) const { return device < max_devices && devices_[device].is_there(); }
    bool is_held(const ProxySlot& slot) const {
        return slot.description.enabled && !slot.idle && is_there(slot.description.device);
    }

    // Moves a proxy in the scene as it is; the force is in the slot then, and presses bodies later.
    void touch(ProxySlot& slot, Nanoseconds now);
    // The same for all tools; the wrenches are in their slots.
    void touch_tools();
    // What the hand may be given of a pointer's or a tool's force (unit: newtons).
    double force_limit(const ProxySlot& slot) const { return force_limit(slot.description.device); }
    double force_limit(const ToolSlot& slot) const;
    // Tools are put elsewhere, all at once; null: not this one. Those that would be in another one there
    // stay.
    using ToolPlaces = std::array<const ToolMemory*, max_tools>;
    void put_tools(const ToolPlaces& places);
    // Work that tools have done in the last replays, as WorkBudget counts; begins anew when it is asked for.
    std::int64_t take_tool_work() { return std::exchange(tool_work_, 0); }
    // What touch leaps by is spread over many ticks.
    void fade_jumps();

    // One tick of what does not face the world: no devices, no snapshots, no side. Corrections and the slots'
    // hands are set in between.
    void begin_replay_tick();
    void end_replay_tick(Nanoseconds now);

    // All that a replay starts from. False where `memory` is too small or the bodies are others now.
    bool save(LoopMemento& memento);
    bool restore(const LoopMemento& memento);
    // Still bodies are where they are in the other loop, and have always been there.
    void follow_still(SessionLoop& other);

private:
    struct Recording {
        RecorderRing<SessionRecord>* ring = nullptr;
        SessionHandle proxy = no_handle;  // or hand_of_tool()
        SessionHandle object = no_handle;
    };
    struct DeviceSlot {
        Device* device = nullptr;
        Workspace workspace;
        DeviceSample sample;
        Vec3 offset{0.0};         // in the world: what clutch and edge have made of it so far (unit: meters)
        Vec3 hand{0.0};           // in the world (unit: meters)
        Vec3 hand_velocity{0.0};  // in the world (unit: meters per second)
        Quat rotation{1.0, 0.0, 0.0, 0.0};        // of the handle, in the world
        Vec3 hand_turn{0.0};                      // in this tick, in the world (unit: radians)
        Quat turn_offset{1.0, 0.0, 0.0, 0.0};     // in the world: what the clutch has made of it
        Quat orientation{1.0, 0.0, 0.0, 0.0};     // of the hand, in the world
        Vec3 torque{0.0};                         // of all its tools, in the world (unit: newton meters)
        Vec3 force{0.0};                          // of all its proxies, in the world (unit: newtons)
        Vec3 asked{0.0};                          // the same before every limit (unit: newtons)
        Vec3 refused{0.0};                        // of that, by its limits (unit: newtons)
        DeviceSample heard;                       // as it came, with whatever nonsense
        std::optional<DisplayedForce> displayed;  // up to `heard`
        bool is_sound = true;                     // `heard` has none
        double silent = never_heard;              // since it was connected (unit: seconds)
        DeviceCapabilities capabilities;
        FadingWrench fading;       // from both to what its safety is asked for, as the device measures them
        bool jumped = false;       // its owner has changed what makes the force
        bool touch_faded = false;  // in the last tick, see touch_fades
        HandSafety safety;
        SafeForce safe;
        double carried = 0.0;  // of the weight of its arm (unit: newtons)
        // Of the walls that were pressed last, the one of which most was not safe; 0: all were (unit: newtons
        // per meter).
        double wanted_stiffness = 0.0, used_stiffness = 0.0;
        bool has_pressed = false;  // a wall, in this tick
        bool was_held = false;

        // A device is there from its first reading on, and a moment longer than its last: what it touches is
        // not lost with a reading. One that stays away has no proxy in the scene.
        static constexpr double never_heard = 1e9;
        static constexpr double longest_silence = 0.25;  // (unit: seconds)
        bool is_there() const { return device != nullptr && silent < longest_silence; }
    };

    void note_hand_change(SessionHandle device);
    bool carry_out(command::AddBody& c, Retired& retired);
    bool carry_out(command::RemoveBody& c, Retired& retired);
    bool carry_out(command::DeformBody& c, Retired& retired);
    bool carry_out(command::NarrowTouch& c, Retired& retired);
    bool carry_out(command::TeleportBody& c, Retired&);
    bool carry_out(command::ShiftBody& c, Retired&);
    bool carry_out(command::MoveBody& c, Retired&);
    bool carry_out(command::SetBodyVelocity& c, Retired&);
    bool carry_out(command::SetTouchMaterial& c, Retired& retired);
    bool carry_out(command::SetBodySurface& c, Retired&);
    bool carry_out(command::SetBodyLayers& c, Retired&);
    bool carry_out(command::SetBodyMotion& c, Retired&);
    bool carry_out(command::SetBodyGravityScale& c, Retired&);
    bool carry_out(command::SetBodyDamping& c, Retired&);
    bool carry_out(command::SetBodyPush& c, Retired&);
    bool carry_out(command::SeeBody& c, Retired&);
    bool carry_out(command::PushBody& c, Retired&);
    bool carry_out(command::LeadBody& c, Retired&);
    bool carry_out(command::CorrectBody& c, Retired&);
    bool carry_out(command::AddJoint& c, Retired&);
    bool carry_out(command::RemoveJoint& c, Retired& retired);
    bool carry_out(command::SetGravity& c, Retired&);
    bool carry_out(command::AddDevice& c, Retired&);
    bool carry_out(command::SetWorkspace& c, Retired&);
    bool carry_out(command::RemoveDevice& c, Retired& retired);
    bool carry_out(command::AddProxy& c, Retired&);
    bool carry_out(command::SetProxy& c, Retired&);
    bool carry_out(command::SetField& c, Retired&);
    bool carry_out(command::SetGuideFrames& c, Retired&);
    bool carry_out(command::RemoveProxy& c, Retired& retired);
    bool carry_out(command::AddTool& c, Retired&);
    bool carry_out(command::SetTool& c, Retired&);
    bool carry_out(command::RemoveTool& c, Retired& retired);
    bool carry_out(command::Record& c, Retired&);
    bool carry_out(command::EndRecording& c, Retired&);
    bool carry_out(command::Attach& c, Retired& retired);

    // See session_led.cpp.
    struct Led {
        LedState state;
        BodyCorrection left;  // of `by` and `turn`, in `seconds`; what speeds it up
    };
    Led* led(SessionHandle handle);
    void put_led_right();
    void put_right_at_once(Led& one);
    void go_on(Led& one);
    double smoothest_share(SessionHandle handle, double way) const;
    void note_led();

    void start_travel(SessionHandle handle, const Pose& target, double seconds);
    void end_travel(SessionHandle handle);
    void take_forms();
    void travel();
    void follow_physics();
    void put(SessionHandle handle, const Pose& pose);
    void place(SessionHandle handle, const Pose& pose, bool teleport);
    void place(SessionHandle handle, const BodyMotion& now, bool teleport);
    void show_state(SessionHandle handle);
    void go_on_from(const command::AddBody& added);
    void note_state(SessionHandle handle, const BodyMotion& now);
    void note_change(std::uint32_t state);
    void read_devices(Nanoseconds now);
    void place_hand(DeviceSlot& slot) const;
    void touch_all(Nanoseconds now);
    double force_limit(SessionHandle device) const;
    double fade_of(SessionHandle device) const;
    bool touch_fades(std::size_t device) const;
    void hold_tools(Nanoseconds now);
    ToolHand hand_at(ToolSlot& slot, Nanoseconds now) const;
    bool takes_hold(ToolSlot& slot) const;
    static bool fits_beside_tools(ToolSlot& slot);
    ToolGroup* tool_group() const;
    SessionHandle handle_of(const ToolProxy& tool) const;
    void feel(ToolSlot& slot, const ToolTick& tick);
    void fade_tools();
    void press_bodies(const ToolSlot& slot);
    void describe(ToolSlot& slot, const ToolTick& tick) const;
    FadingForce::Step step_of(const ProxySlot& slot) const;
    bool surface_jumps(const ProxySlot& slot, const HandForce& before) const;
    bool touches_other_walls(ProxySlot& slot) const;
    void press_all();
    Vec3 attract(const ProxySlot& slot, bool press);
    AidedHand aided_hand(SessionHandle device, const HandMotion& motion, Nanoseconds now) const;
    void hold_against_turning(ProxySlot& slot) const;
    void note_walls(const ProxySlot& slot, DeviceSlot& device) const;
    void break_surfaces(ProxySlot& slot, const HandForce& force);
    Wall feel_punctures(ProxySlot& slot, const AidedHand& hand, double damping);
    void note_magnet(SessionHandle handle);
    void forget_magnet(SessionHandle handle);
    void push_bodies();
    void help_bodies();
    void press_bodies(const ProxySlot& slot);
    void write_devices(Nanoseconds now);
    SafetySample safety_sample(DeviceSlot& slot, std::size_t index) const;
    Vec3 with_arm_carried(DeviceSlot& slot, double max_force) const;
    void step_physics();
    void take_soft_forms();
    void find_obstacles(const Body& giving);
    void forget_obstacle(int slot);
    bool place_obstacles(const Body& giving);
    void push_obstacles(const Body& giving);
    void step_soft(SessionHandle handle);
    void step_soft();
    void guess();
    void publish(Nanoseconds now);
    bool describe_hand(SessionHandle hand, SessionRecord& row);
    // One of them at most. Neither: there is no such hand.
    struct HandSlot {
        ProxySlot* proxy = nullptr;
        ToolSlot* tool = nullptr;
    };
    HandSlot hand_slot(SessionHandle hand);
    void append_record(const Recording& recording, Nanoseconds now, Nanoseconds late);
    void describe(ProxySlot& slot, const ProxyTick& tick);
    void note_events();
    ImpactContact impact_of(const Touch& touch, const Vec3& velocity, const Vec3& force) const;
    void note_impacts(ProxySlot& slot) const;
    void note_impacts(ToolSlot& slot) const;
    void note_breaks(ProxySlot& slot) const;

    SessionSettings settings_;
    double seconds_;  // of a tick
    TripleBuffer<SessionSnapshot>& snapshots_;
    InputRecorder* const recorder_;
    TouchScene scene_;
    PhysicsWorld physics_;
    std::vector<Body> bodies_;                   // by handle
    std::vector<SessionHandle> handle_of_slot_;  // touch scene slot to handle
    std::vector<SessionHandle> handle_of_id_;    // physics body to handle, by index
    std::vector<SessionHandle> travelling_;
    std::vector<SessionHandle> forming_;        // bodies that take another form in the coming tick
    std::vector<SessionHandle> giving_;         // bodies that give
    std::size_t soft_turn_ = 0;                 // of those, the first in the next tick
    std::size_t slowed_soft_ = 0;               // of those, left out in the last
    std::vector<SessionHandle> pushed_;         // bodies with a push of their own
    std::vector<SessionHandle> helped_;         // bodies with a residual
    std::vector<SessionHandle> guessed_;        // bodies that were seen to move
    std::array<Vec3, max_proxies> received_{};  // see SessionSnapshot
    std::vector<Led> led_;                      // see Session::lead_body
    std::vector<JointId> joints_;               // by handle
    std::vector<SessionHandle> magnets_;        // bodies that pull before they are touched
    std::uint64_t magnet_changes_ = 0;          // how often one came, went or was described anew
    std::vector<Vec3> hands_;                   // where the proxies are (unit: meters)
    std::vector<BodyState> states_;             // of all bodies that are not static, dense
    ChangeOrder state_changes_;                 // of states_
    std::vector<std::uint32_t> state_of_;       // by handle; no_handle: none
    std::uint64_t states_changed_at_ = 0;       // tick at which a state came or went
    std::array<DeviceSlot, max_devices> devices_;
    std::array<ProxySlot, max_proxies> proxies_;
    std::array<std::unique_ptr<ToolSlot>, max_tools> tools_;  // by handle
    std::unique_ptr<TeleopSide> side_;                        // null: nobody at the far side
    std::array<Recording, max_recordings> recordings_;
    std::size_t recording_count_ = 0;
    Vec3 gravity_;                // (unit: meters per second squared)
    std::int64_t tool_work_ = 0;  // see take_tool_work()
    bool touch_changed_ = false;  // see take_touch_change()
    bool follows_all_ = false;    // a memento was restored: where bodies are is to be read anew
    std::uint32_t bodies_end_ = 0;
    std::uint64_t tick_ = 0;
    Nanoseconds time_ = 0;  // of the last tick
    TickStatus status_ = 0;
};

}  // namespace tactus
