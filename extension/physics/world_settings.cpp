#include "physics/world_settings.hpp"

#include <algorithm>

#include "physics/jolt_units.hpp"

namespace tactus {

namespace {

// Contacts are looked for this far ahead: what 1 m/s covers in a millisecond.
constexpr double speculative_distance = 1e-3;  // (unit: meters)

// Points of a face this far from its plane still belong to it.
constexpr double manifold_tolerance = 5e-5;  // (unit: meters)

// The most that one iteration pushes apart.
constexpr double largest_push = 0.02;  // (unit: meters)

// A contact point inherits the force that it had in the last step where it went no farther: at 20 m/s. Points
// are told apart by name (contact_points.hpp), not by place.
constexpr double same_contact = 0.02;  // (unit: meters)

// Two bodies that moved less than this against each other keep the contacts found before.
constexpr double cache_distance = 1e-4;            // (unit: meters)
constexpr float cache_cos_half_angle = 0.999998f;  // of 0.004 rad

// Slower than this nothing bounces.
constexpr double bounce_threshold = 0.05;  // (unit: meters per second)

// Slower than this for half a second and a body sleeps.
constexpr double sleep_velocity = 2e-3;  // (unit: meters per second)
constexpr float sleep_time = 0.5f;       // (unit: seconds)

float squared(float value) {
    return value * value;
}

}  // namespace

JPH::PhysicsSettings jolt_settings(const PhysicsSettings& settings) {
    JPH::PhysicsSettings jolt;
    jolt.mPenetrationSlop = units::length(std::max(0.0, settings.penetration_slop));
    jolt.mSpeculativeContactDistance = units::length(speculative_distance);
    jolt.mManifoldTolerance = units::length(manifold_tolerance);
    jolt.mMaxPenetrationDistance = units::length(largest_push);
    jolt.mContactPointPreserveLambdaMaxDistSq = squared(units::length(same_contact));
    jolt.mBodyPairCacheMaxDeltaPositionSq = squared(units::length(cache_distance));
    jolt.mBodyPairCacheCosMaxDeltaRotationDiv2 = cache_cos_half_angle;
    jolt.mMinVelocityForRestitution = units::length(bounce_threshold);
    jolt.mPointVelocitySleepThreshold = units::length(sleep_velocity);
    jolt.mTimeBeforeSleep = sleep_time;
    jolt.mNumVelocitySteps = static_cast<JPH::uint>(std::max(2, settings.velocity_iterations));
    jolt.mNumPositionSteps = static_cast<JPH::uint>(std::max(1, settings.position_iterations));
    jolt.mDeterministicSimulation = true;
    // Ours reports each point on its own (contact_points.hpp).
    jolt.mUseManifoldReduction = false;
    // It shares large islands out among threads; here there is one.
    jolt.mUseLargeIslandSplitter = false;
    return jolt;
}

}  // namespace tactus
