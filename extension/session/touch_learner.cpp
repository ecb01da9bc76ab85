#include "session/touch_learner.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/geometry/surface_query.hpp"

namespace tactus {

namespace {

// A contact is felt from here on, and until there: between them is what the observer is off by (unit:
// newtons).
constexpr double begins_at = 0.4;
constexpr double ends_at = 0.15;

// Eyes are off by no more, and no tip sinks in farther (unit: meters).
constexpr double off_by = 0.01;

}  // namespace

// The body whose surface is next to the tip; no_handle: none is.
SessionHandle TouchLearner::touched_by(SessionLoop& loop, const RobotTip& tip, Vec3& normal) const {
    SessionHandle nearest = no_handle;
    double within = tip.radius + off_by;
    for (std::size_t i = 0; i < loop.max_bodies(); ++i) {
        const auto body = static_cast<SessionHandle>(i);
        const SessionLoop::Body* const there = loop.body(body);
        if (there == nullptr) {
            continue;
        }
        const TouchBody& touched = loop.scene().body(there->slot);
        if (glm::distance(touched.pose.position, tip.position) > touched.shape->reach + within) {
            continue;
        }
        const SurfaceHit hit = nearest_surface(*touched.shape, touched.pose, tip.position, within);
        if (hit.hit && hit.distance < within) {
            within = hit.distance;
            nearest = body;
            normal = hit.normal;
        }
    }
    return nearest;
}

// Whose touch is longest ago makes room.
TouchLearner::Learnt& TouchLearner::lesson(SessionHandle body) {
    const auto known = std::ranges::find(learnt_, body, &Learnt::body);
    Learnt& one = known != learnt_.end() ? *known : *std::ranges::min_element(learnt_, {}, &Learnt::touched);
    if (one.body != body) {
        one = {body, 0, TouchEstimate()};
    }
    return one;
}

void TouchLearner::feel(SessionLoop& loop, std::size_t pointer, const RobotTip& tip) {
    SessionHandle& touching = touching_[pointer];
    const double force = glm::length(tip.contact);
    if (force < (touching == no_handle ? begins_at : ends_at)) {
        let_go(pointer);
        return;
    }
    Vec3 normal(0.0);
    const SessionHandle body = touched_by(loop, tip, normal);
    if (body == no_handle) {
        let_go(pointer);
        return;
    }
    if (touching != body) {
        let_go(pointer);
        touching = body;
        lesson(body).touched = ++touches_;
    }
    const BodyMotion motion = loop.body(body)->motion == Motion::Static ? BodyMotion{} : loop.motion(body);
    const Pose& pose = loop.scene().body(loop.body(body)->slot).pose;
    TipSample sample;
    sample.seconds = tip.seconds;
    sample.normal = normal;
    sample.tip = tip.position - pose.position;
    sample.body_velocity =
        motion.linear_velocity + glm::cross(motion.angular_velocity, tip.position - pose.position);
    sample.tip_velocity = tip.velocity - sample.body_velocity;
    sample.force = -tip.contact;
    lesson(body).estimate.feel(sample);
}

void TouchLearner::let_go(std::size_t pointer) {
    if (const SessionHandle body = std::exchange(touching_[pointer], no_handle); body != no_handle) {
        lesson(body).estimate.let_go();
    }
}

const TouchEstimate* TouchLearner::of(SessionHandle body) const {
    const auto known = std::ranges::find(learnt_, body, &Learnt::body);
    return known != learnt_.end() && body != no_handle ? &known->estimate : nullptr;
}

}  // namespace tactus
