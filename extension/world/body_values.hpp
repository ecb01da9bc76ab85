// What a running body can take over as it is, without being made anew. A property more is a field here and a
// row in body_values.cpp; who reads it off an engine's body fills the field.
#pragma once

#include <memory>

#include "session/session.hpp"

namespace tactus {

struct BodyValues {
    Motion motion = Motion::Static;
    TouchMaterial touch;
    std::shared_ptr<const TouchDetail> detail;  // null: none
    SurfaceMaterial surface;
    CollisionLayers layers;
    double gravity_scale = 1.0;
    double linear_damping = 0.0;   // (unit: 1/seconds)
    double angular_damping = 0.0;  // likewise
    Vec3 constant_force{0.0};      // at the centre of mass, in the world (unit: newtons)
    Vec3 constant_torque{0.0};     // in the world (unit: newton meters)
    bool is_paused = false;        // it stands still, and goes on as it moved before
};

// Into what a body is made from.
void put_into(BodyAddition& addition, const BodyValues& values);

// What a body that has just been made does not have yet.
void send_rest(Session& session, SessionHandle body, const BodyValues& values);

// Tells a running body what is another one. True where what it is made from is another one by that.
bool send_changes(Session& session, SessionHandle body, const BodyValues& before, const BodyValues& now);

}  // namespace tactus
