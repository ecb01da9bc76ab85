// Contacts that Jolt solves point by point: private to physics/.
//
// Jolt 5.6 bounds the friction of a manifold (all points of two touching faces) by mu N along the surface and
// by mu sum(N_i d_i) about its normal, each for itself, so a patch that slides keeps its whole moment against
// turning. Friction of a patch couples both (Goyal, Ruina and Papadopoulos 1991): each point i bears at most
// mu N_i, against its own velocity. Jolt does that for manifolds of one point, so each point is handed to it
// as a manifold of its own. A patch bears its load at the corners of its outline, at most four.
#pragma once

#include "physics/jolt.hpp"

#include <Jolt/Physics/Body/Body.h>
#include <Jolt/Physics/Collision/CollideShape.h>
#include <Jolt/Physics/Collision/ShapeFilter.h>
#include <Jolt/Physics/PhysicsSettings.h>

namespace tactus {

// The most points that one patch is reduced to, and with it the most manifolds of two flat faces.
constexpr unsigned points_of_a_patch = 4;

// For JPH::PhysicsSystem::SetSimCollideBodyVsBody(). Collides two bodies, joins what has the same normal to
// one patch as Jolt's own manifold reduction does (which has to be off), and reports each point of it. The
// points of a patch are told apart by the two topmost bits of the second sub-shape; the same point of a patch
// keeps its name from step to step, so that it begins with the force of the last one. Allocates nothing.
void collide_by_points(const JPH::PhysicsSettings& settings, const JPH::Body& body1, const JPH::Body& body2,
                       JPH::Mat44Arg transform1, JPH::Mat44Arg transform2,
                       JPH::CollideShapeSettings& collide_settings, JPH::CollideShapeCollector& collector,
                       const JPH::ShapeFilter& filter);

}  // namespace tactus
