// The private rigid-body world of one HapticWorld.
//
// Thread rule: one thread at a time is inside a PhysicsWorld, the haptic one while the loop runs. Everything
// but the constructor and the destructor may be called in the loop: it allocates nothing from the system,
// frees nothing, and takes no lock another thread can hold. Memory enters and leaves inside PreparedBody
// objects, which are made and destroyed elsewhere (prepared_body.hpp).
//
// The same calls in the same order give the same bits, on any number of cores.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "core/math/body_motion.hpp"
#include "physics/body_description.hpp"
#include "physics/joint.hpp"
#include "physics/prepared_body.hpp"

namespace tactus {

// Names a body of one world for as long as it is in it; never reused while fewer than 256 bodies have come
// and gone in its place.
struct BodyId {
    std::uint32_t value = 0xffffffffu;

    bool valid() const { return value != 0xffffffffu; }
    // Below PhysicsSettings::max_bodies, and different for all bodies that are in the world at the same time.
    std::uint32_t index() const { return value & 0x7fffffu; }
    friend bool operator==(BodyId, BodyId) = default;
};

struct PhysicsSettings {
    std::uint32_t max_bodies = 4096;  // 1..65536; what is added beyond is refused
    std::uint32_t max_touching_pairs =
        8192;  // pairs of bodies near each other; beyond, contacts are lost and said so
    std::uint32_t max_contacts = 4096;  // pairs of surfaces in contact, likewise
    Vec3 gravity{0.0, -9.81, 0.0};      // (unit: meters per square second)
    int sub_steps = 1;                  // collision steps in one step(), 1..16
    int velocity_iterations = 6;        // of the contact solver in a sub-step, >= 2
    std::uint32_t max_joints = 256;     // 1..32768
    int position_iterations = 2;        // >= 1
    // Bodies may overlap by this before they are pushed apart, >= 0 (unit: meters). Without any overlap
    // contacts come and go from tick to tick.
    double penetration_slop = 2e-5;
    std::uint32_t remembered_wakings = 0;  // see save(); 0 where nobody goes back in time
    // When more bodies than this are awake, those farthest from every hand take longer steps where these
    // change nothing (far_islands.hpp). 0: all take every step; needed for save().
    std::uint32_t full_rate_bodies = 0;
};

// A fingertip's patch of contact that holds a body against turning about its normal.
struct TwistSpring {
    Vec3 axis{0.0, 1.0, 0.0};  // unit, in the world
    double twist = 0.0;        // of the body beyond the patch, about the axis, now (unit: radians)
    double stiffness = 0.0;    // (unit: newton meters per radian), >= 0
    double limit = 0.0;        // at which it slips (unit: newton meters), >= 0; 0: it holds nothing
    double patch_spin = 0.0;   // of the patch about the axis, during the step (unit: radians per second)
};

// A hand's spring pressing on a body. Within the step the force changes by `stiffness` times the way that the
// hand goes on less the way that the body gives, and by `damping` times the speed that the body loses; it
// never pulls. A fingertip that sticks holds the body in all directions, one that slides only along the
// force.
struct SpringForce {
    Vec3 force{0.0};          // on the body now, in the world (unit: newtons)
    Vec3 point{0.0};          // where, in the world (unit: meters)
    double stiffness = 0.0;   // (unit: newtons per meter), > 0
    double damping = 0.0;     // (unit: newton seconds per meter), >= 0
    Vec3 hand_velocity{0.0};  // during the step, in the world (unit: meters per second)
    bool sticks = false;
    TwistSpring twist = {};
};

// What a hand's springs and forces have given a body in a step.
struct HandPush {
    BodyId body;
    Vec3 impulse{0.0};  // in the world (unit: newton seconds)
    Vec3 turn{0.0};     // angular impulse about its centre of mass (unit: newton meter seconds)
};

// Bits that step() returns.
enum StepStatus : std::uint32_t {
    step_ok = 0,
    step_nothing_awake = 1u << 0,  // nothing could move: no work was done
    step_pairs_full = 1u << 1,     // raise max_touching_pairs; some bodies passed through others
    step_contacts_full = 1u << 2,  // raise max_contacts; likewise
    step_memory_full = 1u << 3,    // the world's memory was used up and the system's had to help
    step_body_lost = 1u << 4,  // a body left the range of numbers and was put back, asleep (sound_places.hpp)
};

class PhysicsWorld {
public:
    explicit PhysicsWorld(const PhysicsSettings& settings = {});
    ~PhysicsWorld();

    PhysicsWorld(const PhysicsWorld&) = delete;
    PhysicsWorld& operator=(const PhysicsWorld&) = delete;

    // --- what is in it

    // Takes the body and leaves `body` empty. When the world is full (or `body` is not ready) nothing is
    // taken and the id is invalid. A body that moves, or that bodies rest on, wakes its neighbours.
    BodyId add(PreparedBody& body);

    // The body goes back to the caller, who destroys it off the loop or adds it again, now where it was last.
    // Its sleeping neighbours wake.
    PreparedBody remove(BodyId id);

    // Exchanges shape, mass, inertia and centre of mass with those of `other`; all else, and the pose, stays.
    // Whether a body can move must be the same for both, or nothing happens and the result is false.
    bool reshape(BodyId id, PreparedBody& other);

    // Joins two bodies, or one and the world (an invalid id). Invalid when a body is missing, neither can
    // move, or there is no room. Removing a body removes its joints.
    JointId add_joint(const JointDescription& joint, BodyId first, BodyId second);
    bool remove_joint(JointId id);
    std::size_t joint_count() const;
    // Nearest to `pose` that the joints of the body to what does not move allow.
    Pose on_joints(BodyId id, const Pose& pose) const;

    // After many bodies were added one by one, before the loop runs: makes finding neighbours fast at once
    // rather than over the next steps. Takes milliseconds for thousands of bodies.
    void settle_broad_phase();

    bool contains(BodyId id) const;
    std::size_t body_count() const;

    // --- changing it. An id that is not in the world does nothing, here and below.

    void set_gravity(const Vec3& gravity);  // (unit: meters per square second); wakes nothing
    void set_pose(BodyId id,
                  const Pose& pose);  // at once, without a velocity; wakes the body and its neighbours
    void move_to(BodyId id, const Pose& pose,
                 double seconds);  // gives the velocity that is there after `seconds`
    void set_velocity(BodyId id, const Vec3& linear,
                      const Vec3& angular);     // of the centre of mass, in the world
    bool set_motion(BodyId id, Motion motion);  // false: a static body made without may_move stays so
    void set_material(BodyId id, const SurfaceMaterial& material);
    // From the next step on; wakes nothing.
    void set_factors(BodyId id, const BodyFactors& factors);
    void set_damping(BodyId id, double linear, double angular);
    void set_gravity_scale(BodyId id, double scale);
    void set_collision(BodyId id, const CollisionLayers& collision);
    void set_continuous(BodyId id, bool continuous);
    void set_can_sleep(BodyId id, bool can_sleep);
    void wake(BodyId id);
    void sleep(BodyId id);

    // For the next step only; wakes a dynamic body, does nothing to any other.
    void apply_force(BodyId id, const Vec3& force, const Vec3& world_point);  // (units: newtons, meters)
    // The same for a hand's spring: stable for bodies however light, where apply_force() rings
    // (spring_push.hpp). The first 64 a step; beyond, and for a stiffness of zero, it is apply_force().
    void apply_spring_force(BodyId id, const SpringForce& spring);
    void apply_torque(BodyId id, const Vec3& torque);  // (unit: newton meters)
    // As apply_force(), counted among hand_pushes().
    void apply_hand_force(BodyId id, const Vec3& force, const Vec3& world_point);

    // --- time

    bool anything_awake() const;
    std::size_t awake_count() const;
    // Where hands are, at most 64, in the world (unit: meters): bodies near one take every step.
    void set_hands(std::span<const Vec3> hands);
    // Of those awake, the ones that take one step of many (PhysicsSettings::full_rate_bodies).
    std::size_t slowed_count() const;

    // Moves what is awake on by `seconds` (> 0). The result is made of StepStatus bits.
    std::uint32_t step(double seconds);

    // The bodies that the last step moved or woke, each once; the same order on every run. Until the next
    // one.
    std::span<const BodyId> moved() const;

    // What hands gave in the last step that was more than nothing, one for each spring and force; exact: a
    // body without anything else has changed its momentum by so much. Until the next step.
    std::span<const HandPush> hand_pushes() const;

    std::uint64_t steps() const;  // that were more than nothing, so far

    // --- going back in time

    // What is awake and what its motion depends on, as bytes: poses, velocities, contacts, joints, sleep
    // timers, gravity. Not the settings of bodies, nor forces applied but not stepped. Returns how many bytes
    // were written, 0 when `memory` is too small (about 400 bytes a body and 250 a contact) or bodies are
    // slowed.
    std::size_t save(std::span<std::byte> memory) const;

    // The same with everything that could move, awake or not: what another world made by the same calls
    // needs.
    std::size_t save_everything(std::span<std::byte> memory) const;

    // Goes back to the moment of the snapshot, to the last bit. False, and nothing has changed, when bodies
    // were added, removed, reshaped or frozen since, or when more bodies have woken than
    // `remembered_wakings`.
    bool restore(std::span<const std::byte> snapshot);

    // One body as it is in another world that was made by the same calls, to the last bit: place, velocities,
    // sleep. Contacts and joints stay as they are here. Nothing where one of the worlds has no such body.
    void take_state(BodyId id, const PhysicsWorld& other);

    // --- looking at it

    BodyMotion state(BodyId id) const;
    Pose pose(BodyId id) const;
    Vec3 center_of_mass(BodyId id) const;    // in the world (unit: meters)
    Vec3 linear_velocity(BodyId id) const;   // of the centre of mass (unit: meters per second)
    Vec3 angular_velocity(BodyId id) const;  // (unit: radians per second)
    Vec3 velocity_at(BodyId id, const Vec3& world_point) const;  // of the body's material there
    double mass(BodyId id) const;                                // (unit: kilograms); 0 for what cannot move
    // What an angular impulse changes the angular velocity by (units: newton meter seconds, radians per
    // second).
    Vec3 spun_by(BodyId id, const Vec3& turn) const;
    // What a unit impulse there changes the speed of that place by, along itself; 0 for what cannot move
    // (unit: 1/kilogram). `along`: need not be of unit length.
    double mobility(BodyId id, const Vec3& world_point, const Vec3& along) const;
    Motion motion(BodyId id) const;
    bool awake(BodyId id) const;
    bool touching(BodyId first, BodyId second) const;  // each other, in the last step
    std::uint64_t memory_overflows() const;            // see step_memory_full; since the world was made

private:
    std::size_t save_state(std::span<std::byte> memory, bool everything) const;

    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace tactus
