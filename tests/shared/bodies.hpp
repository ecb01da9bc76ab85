// Bodies that tests, checks and benches of physics share.
#pragma once

#include <utility>
#include <vector>

#include "physics/body_description.hpp"

namespace tactus::shared {

inline std::vector<PlacedShape> one(Shape shape) {
    return {PlacedShape{std::move(shape), Pose{}}};
}

inline BodyDescription box(const Vec3& size, const Vec3& position, double mass, double friction = 1.0) {
    BodyDescription body;
    body.shapes = one(BoxShape{0.5 * size});
    body.pose.position = position;
    body.mass = mass;
    body.material.friction = friction;
    return body;
}

inline BodyDescription ball(double radius, const Vec3& position, double mass, double friction = 1.0) {
    BodyDescription body;
    body.shapes = one(SphereShape{radius});
    body.pose.position = position;
    body.mass = mass;
    body.material.friction = friction;
    return body;
}

// The ground y <= 0.
inline BodyDescription ground(double friction = 1.0) {
    BodyDescription body;
    body.shapes = one(PlaneShape{});
    body.motion = Motion::Static;
    body.material.friction = friction;
    return body;
}

}  // namespace tactus::shared
