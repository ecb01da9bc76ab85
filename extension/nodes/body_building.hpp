// From what was read of a Godot body to one that the loop can take: triangle trees and the rigid body.
#pragma once

#include <string>
#include <vector>

#include "nodes/body_reading.hpp"

namespace tactus {

// As the node was when it was read.
struct BodyPlan {
    BodyReading reading;
    BodyValues values;
    BodyMakings makings;
    godot::Transform3D place;
    godot::Vector3 linear_velocity;
    godot::Vector3 angular_velocity;
    bool may_move = false;
};

struct BuiltBody {
    BodyAddition addition;              // what it was made from
    ReadyBody body;                     // body.error may be empty and the body still none: see `buildable`
    std::vector<std::string> problems;  // of single shapes; the rest of the body can still be touched
    bool buildable = false;
};

// Triangles to build trees over, about.
std::size_t triangle_count(const BodyReading& reading);

// Any thread but the haptic one. Bodies of the same mesh and scale share one tree.
BuiltBody build_body(const BodyPlan& plan, const ParallelRunner& run);

}  // namespace tactus
