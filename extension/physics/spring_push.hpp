// A hand's force on a body that gives way under it: private to physics/.
//
// The hand's spring holds F = k (hand - proxy), and the proxy sits on the body. Applied as a mere force for a
// whole step, it overshoots as soon as k dt^2 exceeds the body's mass (1 g at 1000 N/m and 1 ms) and the two
// of them ring. So the step solves it along with the contacts, implicitly: at its end
//
//     F = F0 + k (h - u) - c (v - v0)
//
// with u and h the ways of the point and of the hand since the step began, v0 and v the point's velocity at
// its begin and end. That is stable for every mass. A braced body feels F0 to the full, a free one what is
// left of it; a body pushed at a steady pace feels what holds it back, since hand and body advance together.
//
// Such a spring is also a damper, of k dt between hand and body: a step takes the share k dt^2 / m of an
// oscillation's energy. Where something else holds the body, by friction, weight or another finger, that is
// what lets it come to rest, since Coulomb's friction takes nothing from an oscillation that never stops the
// body. Where nothing does, it would be energy lost: 5 % of what 1000 N/m put into a throw of 1 kg. So of the
// way and the velocity within the step only the share s counts that is borne by others,
//
//     s = 1 - m (v - v0) . n / (l . n)        (l: the impulse given so far, m: the mass felt at the point)
//
// 0 for a free body, and 1 for one that is held. A free body sees F0 alone, so it gets the impulse that the
// hand feels, and keeps its energy. That is semi-implicit Euler, stable while k dt^2 + 2 c dt < 4 m, with k
// and c of all springs on the body. Lighter bodies, m < dt (k dt + c) / 2, have s = 1.
//
// A sliding fingertip: the same along the direction n of F0 alone. In both cases F . n >= 0.
//
// A light body that is braced needs care. Solved in turns with the contacts, the spring would first give way
// to a body that seems free, and come back by a share m / (k dt^2) a turn. So it first holds F0 while the
// contacts find what they have to bear, and gives way only then to what still moves.
#pragma once

#include "physics/jolt.hpp"
#include "physics/physics_world.hpp"
#include "physics/twist_hold.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Constraints/Constraint.h>

namespace tactus {

class SpringPush final : public JPH::Constraint {
public:
    SpringPush();

    // For the next step. The force is not zero, the stiffness positive.
    void set(JPH::Body& body, const SpringForce& spring);
    void take(const SpringPush& other) {
        push_ = other.push_;
        twist_ = other.twist_;
    }

    // Another one presses the same body in the next step: each is told of the other once.
    void add_beside(const SpringPush& other) {
        push_.all_stiffness += other.push_.stiffness;
        push_.all_damping += other.push_.damping;
    }

    bool acts_on(const JPH::Body& body) const { return push_.body == &body; }
    const JPH::Body& body() const { return *push_.body; }
    // What the step has given the body: the impulse, and the angular impulse about the centre of mass.
    JPH::Vec3 impulse() const { return push_.impulse + of_sub_step(); }
    JPH::Vec3 turn() const { return push_.turn + turn_of_sub_step(); }

    JPH::EConstraintSubType GetSubType() const override { return JPH::EConstraintSubType::User1; }
    void NotifyShapeChanged(const JPH::BodyID&, JPH::Vec3Arg) override {}
    void ResetWarmStart() override {}
    // A body that was put to rest since belongs to no island: nothing may push it.
    bool IsActive() const override { return push_.body->IsActive(); }
    void SetupVelocityConstraint(float seconds) override;
    void WarmStartVelocityConstraint(float) override;
    bool SolveVelocityConstraint(float seconds) override;
    bool SolvePositionConstraint(float, float) override { return false; }
    void BuildIslands(JPH::uint32 index, JPH::IslandBuilder& islands, JPH::BodyManager& bodies) override;
    JPH::uint BuildIslandSplits(JPH::LargeIslandSplitter& splitter) const override;
    JPH::Ref<JPH::ConstraintSettings> GetConstraintSettings() const override { return nullptr; }

private:
    void give_way(float seconds);
    bool solve();
    bool solve_along();
    void add_impulse(JPH::Vec3Arg impulse);
    void add_impulse_along(float impulse);
    // Zero where the body was asleep.
    JPH::Vec3 of_sub_step() const {
        return push_.elapsed == 0.0f ? JPH::Vec3::sZero()
               : push_.sticks        ? impulse_
                                     : push_.direction * impulse_along_;
    }
    JPH::Vec3 turn_of_sub_step() const {
        return push_.elapsed == 0.0f ? JPH::Vec3::sZero() : arm_.Cross(of_sub_step()) + twist_.impulse();
    }
    float given_along() const { return push_.sticks ? impulse_.Dot(push_.direction) : impulse_along_; }
    // What of a vector counts: along n alone for a sliding fingertip.
    JPH::Vec3 along(JPH::Vec3Arg v) const {
        return push_.sticks ? v : push_.direction * push_.direction.Dot(v);
    }

    // All in Jolt's units, in the world but for local_point.
    struct Push {
        JPH::Body* body = nullptr;
        bool sticks = false;
        JPH::Vec3 direction = JPH::Vec3::sZero();       // n
        JPH::Vec3 local_point = JPH::Vec3::sZero();     // in the frame of the body's centre of mass
        JPH::RVec3 start = JPH::RVec3::sZero();         // the point when the step began
        JPH::Vec3 force = JPH::Vec3::sZero();           // F0
        JPH::Vec3 hand_velocity = JPH::Vec3::sZero();   // dh/dt
        JPH::Vec3 first_velocity = JPH::Vec3::sZero();  // v0
        float stiffness = 0.0f;                         // k
        float damping = 0.0f;                           // c
        float all_stiffness = 0.0f;                     // of all springs on the body, this one among them
        float all_damping = 0.0f;
        float elapsed = 0.0f;                    // since the step began (unit: seconds)
        float given = 0.0f;                      // impulse along n of the sub-steps before
        JPH::Vec3 impulse = JPH::Vec3::sZero();  // of those, all of it
        JPH::Vec3 turn = JPH::Vec3::sZero();     // and angular, about the centre of mass
    };
    Push push_;
    TwistHold twist_;

    JPH::Vec3 force_ = JPH::Vec3::sZero();  // when the sub-step began
    float inverse_mass_along_ = 0.0f;       // velocity along n for a unit impulse along n
    float softness_ = 0.0f;                 // velocity the spring gives way by for a unit impulse
    JPH::Vec3 arm_ = JPH::Vec3::sZero();    // r, from the centre of mass to the point
    JPH::Vec3 lever_ = JPH::Vec3::sZero();  // r x n
    JPH::Vec3 turn_ = JPH::Vec3::sZero();   // I^-1 (r x n)
    JPH::Vec3 bias_ = JPH::Vec3::sZero();   // velocity at which the spring would be slack
    float bias_along_ = 0.0f;
    JPH::Mat44 effective_mass_ = JPH::Mat44::sZero();
    float effective_mass_along_ = 0.0f;
    JPH::Vec3 impulse_ = JPH::Vec3::sZero();
    float impulse_along_ = 0.0f;
    int held_ = 0;        // iterations to come in which the impulse stays what it is
    bool gives_ = false;  // softness, bias and effective mass are known
    bool is_light_ = false;
    bool is_stable_ = true;  // under the force of the step's begin alone
};

}  // namespace tactus
