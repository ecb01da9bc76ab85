// A world whose past can be corrected: what really was is put in at a past tick, and what the hand did since
// is replayed.
//
//     timeline.correct(t, truth);           // as it was before the step of tick t
//     ... every tick, before or after the inputs of the coming step:
//     if (timeline.replay(3)) ...           // true in the one tick in which the present has jumped
//
// The present world steps on as ever. Beside it stands a twin with the same bodies; a replay runs there, as
// many steps a tick as the caller allows, until it has caught up, and only then the present is set to it. So
// no tick is late, however much there is to replay. Without a correction the twin costs nothing. A timeline
// without a past (ticks = 0) is the present world alone.
//
// What is replayed: forces, torques, poses, velocities, ways and gravity as they were; a hand's spring
// (apply_spring_force) presses by as much less as its point of the body now gives way along the force, so
// that a corrected body is felt where it is. Bodies, joints, kinds of motion and shapes are not part of the
// past: when one changes, the past before it is forgotten. Materials, dampings, layers and gravity scales
// hold in the past as they are now.
//
// Thread rule: that of PhysicsWorld, for both worlds together.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "physics/physics_world.hpp"

namespace tactus {

struct TimelineSettings {
    PhysicsSettings physics;    // with a past, full_rate_bodies has to be 0
    std::uint32_t ticks = 512;  // how far back it reaches; 0: no past, and no memory for it
    std::uint32_t ticks_a_snapshot =
        8;  // a correction replays up to so many ticks more; a snapshot costs 3 us a body
    std::uint32_t inputs_a_tick = 32;    // forces and moves; what exceeds them is applied but not replayed
    std::size_t snapshot_bytes = 65536;  // for each of ticks / ticks_a_snapshot (see PhysicsWorld::save)
};

// Where a body was and how it moved.
struct BodyTruth {
    BodyId id;
    Pose pose;
    Vec3 linear_velocity{0.0};
    Vec3 angular_velocity{0.0};
};

// Forces that depend on where the bodies are, as a hand's do, are better computed anew than repeated.
class PastInputs {
public:
    virtual ~PastInputs() = default;
    // Acts on `world` before the step of `tick`, in place of what was recorded. In the loop: no allocation,
    // no lock.
    virtual void act(std::uint64_t tick, PhysicsWorld& world) = 0;
};

class Timeline {
public:
    explicit Timeline(const TimelineSettings& settings);

    const PhysicsWorld& world() const { return present_; }
    bool has_past() const { return twin_ != nullptr; }

    // Both worlds get one of two alike bodies (duplicate()); without a past the second stays as it is. An
    // invalid id, and both are still the caller's, where the world is full. The past is forgotten.
    BodyId add(PreparedBody& body, PreparedBody& same_body);
    std::pair<PreparedBody, PreparedBody> remove(BodyId id);
    bool reshape(BodyId id, PreparedBody& other, PreparedBody& same_other);
    JointId add_joint(const JointDescription& joint, BodyId first, BodyId second);
    bool remove_joint(JointId id);
    bool set_motion(BodyId id, Motion motion);
    void settle_broad_phase();

    // Settings, in the past as well.
    void set_material(BodyId id, const SurfaceMaterial& material);
    void set_factors(BodyId id, const BodyFactors& factors);
    void set_damping(BodyId id, double linear, double angular);
    void set_gravity_scale(BodyId id, double scale);
    void set_collision(BodyId id, const CollisionLayers& collision);

    // Inputs of the coming step, recorded.
    void set_gravity(const Vec3& gravity);
    void move_to(BodyId id, const Pose& pose, double seconds);
    void apply_force(BodyId id, const Vec3& force, const Vec3& world_point);
    void apply_spring_force(BodyId id, const SpringForce& spring);
    void apply_torque(BodyId id, const Vec3& torque);
    void set_pose(BodyId id, const Pose& pose);
    void set_velocity(BodyId id, const Vec3& linear, const Vec3& angular);

    // See PhysicsWorld; the past is forgotten.
    bool restore(std::span<const std::byte> snapshot);
    void take_state(BodyId id, const PhysicsWorld& other);

    void set_hands(std::span<const Vec3> hands) { present_.set_hands(hands); }
    std::uint32_t step(double seconds);  // as PhysicsWorld::step()
    std::uint64_t tick() const {
        return tick_;
    }  // steps made so far: the state now is that before step `tick`
    std::uint64_t oldest_tick() const;  // the first that can be corrected

    // What was true before the step of `tick`. Starts a replay; a correction under way is replaced. False
    // when the past does not reach back so far. `truth` is copied, at most most_truths of it; `inputs` is
    // used until the replay is done, and acts from `tick` on.
    bool correct(std::uint64_t tick, std::span<const BodyTruth> truth, PastInputs* inputs = nullptr);

    // Replays at most `most_steps` ticks. True when a replay has caught up in this call and the present has
    // changed: any body may be elsewhere, asleep or awake. Inputs of the coming step that were made before
    // are made again.
    bool replay(std::uint32_t most_steps);
    bool replaying() const { return replaying_; }

    static constexpr std::size_t most_truths = 64;

private:
    struct Input {
        enum class Kind : std::uint8_t { force, spring_force, torque, pose, velocity, way, gravity };
        Kind kind = Kind::force;
        BodyId id;
        SpringForce spring;  // force and point of a plain one too; a torque, velocity or gravity in `force`
        Pose pose;           // a spring's point in the frame of the body, too
        Vec3 angular{0.0};
        double seconds = 0.0;  // of a way
    };
    struct Tick {
        double seconds = 0.0;
        std::uint32_t inputs = 0;
    };
    struct Snapshot {
        std::uint64_t tick = 0;
        std::size_t bytes = 0;  // 0: none
    };

    void forget_past();
    void begin_past();
    void record(const Input& input);
    static void apply(const Input& input, PhysicsWorld& world);
    void apply_inputs(std::uint64_t tick, PhysicsWorld& world) const;
    void save(const PhysicsWorld& world, std::uint64_t tick);
    void replay_tick();
    std::span<std::byte> slot(std::uint64_t tick);
    std::size_t slot_index(std::uint64_t tick) const;

    TimelineSettings settings_;
    PhysicsWorld present_;
    std::unique_ptr<PhysicsWorld> twin_;  // null: no past
    std::uint64_t tick_ = 0;
    bool known_ = false;             // there is a past, if only of the present
    std::uint64_t first_known_ = 0;  // no past before this tick

    std::vector<Tick> ticks_;          // by tick modulo settings_.ticks
    std::vector<Input> inputs_;        // inputs_a_tick for each of them
    std::vector<Snapshot> snapshots_;  // by tick / ticks_a_snapshot modulo their number
    std::vector<std::byte> memory_;    // snapshot_bytes for each of them
    std::vector<std::byte> hand_over_;

    bool replaying_ = false;
    std::uint64_t replay_at_ = 0;   // the twin's tick
    std::uint64_t truth_at_ = 0;    // when the truth is put in
    std::vector<BodyTruth> truth_;  // capacity most_truths
    PastInputs* past_inputs_ = nullptr;
};

}  // namespace tactus
