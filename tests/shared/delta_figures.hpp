// What the kinematics of a delta arm are held against, at random places of its sound workspace.
#pragma once

#include <cstdint>

#include "core/kinematics/delta.hpp"

namespace tactus::shared {

struct DeltaFigures {
    int places = 0;
    int lost = 0;                        // places that forward kinematics did not find
    double round_trip_rad = 0.0;         // angles -> place -> angles (unit: radians)
    double round_trip_m = 0.0;           // place -> angles -> place, from the middle (unit: meters)
    int steps_cold = 0, steps_warm = 0;  // most that Newton took, from the middle and from 0.2 mm beside
    double jacobian_error = 0.0;         // against numeric differentiation, relative
    // Between a force and what its torques do to the hand by virtual work, with the angles' derivatives taken
    // numerically (unit: degrees).
    double force_direction_deg = 0.0;
    double force_size_error = 0.0;  // relative

    void add(const DeltaFigures& other);
};

DeltaFigures check_delta(const DeltaGeometry& geometry, std::uint64_t seed, int places);

// A place of the workspace that is not singular, within the stops.
class RandomValues;
Vec3 sound_place(const DeltaGeometry& geometry, RandomValues& random);

// The Jacobian by central differences of fourth order.
Mat3 numeric_jacobian(const DeltaGeometry& geometry, const Vec3& place);

// Of the Jacobian: how many times farther a step of all angles leads in one direction than in another, >= 1;
// infinite where the arm is singular.
double condition_of(const DeltaPose& pose);

}  // namespace tactus::shared
