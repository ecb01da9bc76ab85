// One step of the proxy's motion: from where it is towards the hand, as far as the surfaces around it allow.
//
// `pull` is hand - proxy. Every surface is convex by itself (a triangle, a box, a sphere, inflated), so the
// half-space beyond its contact plane is free of it: the straight way along `motion` stays outside all given
// contacts. Contacts that are covered do not count. Violations and steps up to `tolerance` are none (unit:
// meters).
#pragma once

#include <span>

#include "core/haptics/contact.hpp"
#include "core/tree/work.hpp"

namespace tactus {

struct ConstrainedStep {
    Vec3 motion{0.0};                // the step (unit: meters)
    int pressing[3] = {-1, -1, -1};  // contacts that hold the proxy back
    int pressing_count = 0;
    double pressure[3] = {0.0, 0.0, 0.0};  // how much each holds back (unit: meters), > 0
    Vec3 slide{0.0};                       // what of the pull is left along the surfaces (unit: meters)
    Vec3 drop{0.0};     // the part of the motion that leads onto the surfaces (unit: meters)
    bool bent = false;  // it follows bent surfaces, and ends above them
};

// Solves min |motion - pull|^2 over the contact planes.
ConstrainedStep flat_step(const Vec3& pull, const ContactList& contacts, double tolerance, WorkBudget& work);

struct BendLimits {
    double radius;     // of the sphere (unit: meters)
    double tolerance;  // (unit: meters)
    // Newton's step is right near its end; from afar it may overshoot, so nothing beyond the flat step goes
    // farther (unit: meters).
    double trust;
};

// Takes in the curvature of the pressing contacts, in their order (a Newton step on the Lagrangian), as far
// as the curved piece of the surface goes. That makes a resting place on an edge or in a groove of edges
// exact in a few steps instead of many, and leads around an edge in one. It ends before what stands in its
// way, as far as the contacts tell.
void bend_step(ConstrainedStep& step, const Vec3& pull, const ContactList& contacts,
               std::span<const Curvature> curvatures, const BendLimits& limits, WorkBudget& work);

// Whether the way ends in front of the planes of all contacts.
bool stays_in_front_of_all(const Vec3& motion, const ContactList& contacts, double tolerance);

// The shortest way to where no contact is below rest; zero where there is none.
Vec3 lift_to_rest(const ContactList& contacts, double tolerance, WorkBudget& work);

}  // namespace tactus
