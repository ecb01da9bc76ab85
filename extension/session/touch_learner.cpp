#include "session/touch_learner.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// A contact is felt from here on, and until there: between them is what the observer is off by (unit:
// newtons).
constexpr double begins_at = 0.4;
constexpr double ends_at = 0.15;

// Eyes are off by no more, and no tip sinks in farther (unit: meters).
constexpr double off_by = 0.01;

// For finding out which body a tip touches: some 10 microseconds (unit: see WorkBudget).
constexpr std::int64_t work_a_tick = 2000;

}  // namespace

// The body whose surface is next to the tip; no_handle: none is, as far as is known.
SessionHandle TouchLearner::touched_by(SessionLoop& loop, std::size_t pointer, const RobotTip& tip,
                                       Vec3& normal) {
    const SessionLoop::Body* const before = loop.body(touching_[pointer]);
    WorkBudget work(work_a_tick);
    const NearestBody::Found found = nearest_[pointer].look(loop.scene(), tip.position, tip.radius + off_by,
                                                            before != nullptr ? before->slot : -1, work);
    normal = found.surface.normal;
    return loop.body_in(found.body);
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
    const SessionHandle body = touched_by(loop, pointer, tip, normal);
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
    lesson(body).estimate.feel({tip.seconds, normal, tip.position, -tip.contact, pose.position,
                                motion.linear_velocity, motion.angular_velocity});
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
