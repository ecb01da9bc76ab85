// What an experiment makes wrong about one object of the model, before it is built.
#pragma once

#include "network/messages.hpp"

namespace tactus {

struct ModelError {
    Vec3 move{0.0};                 // in the far world (unit: meters)
    Quat turn{1.0, 0.0, 0.0, 0.0};  // about the object's own place
    double mass = 1.0;              // factors, >= 0
    double friction = 1.0;          // between bodies
    double touch_friction = 1.0;    // felt
    double stiffness = 1.0;
};

inline void distort(const ModelError& error, ObjectDescription& description) {
    BodyDescription& body = description.body;
    body.pose.position += error.move;
    body.pose.rotation = error.turn * body.pose.rotation;
    body.mass *= error.mass;
    body.material.friction *= error.friction;
    description.touch.static_friction *= error.touch_friction;
    description.touch.dynamic_friction *= error.touch_friction;
    description.touch.stiffness *= error.stiffness;
}

}  // namespace tactus
