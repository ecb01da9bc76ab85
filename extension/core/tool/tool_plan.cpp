// Where a tool goes next, and what holds it back: balance without friction, what friction holds, and the
// motion along the surfaces with that.
#include <algorithm>
#include <glm/geometric.hpp>

#include "core/haptics/surface_feel.hpp"
#include "core/tool/tool_proxy.hpp"
#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

NearestMotion ToolProxy::nearest(const Vector6& goal, double tolerance) {
    const std::span<MotionBound> bounds(bounds_.data(), at(contacts_.count));
    NearestMotion nearest = nearest_motion(goal, bounds, length_, tolerance * skin(), work_);
    if (!nearest.possible) {
        // Contacts a hair below rest in a narrow place: do not try to lift off all of them at once.
        for (MotionBound& bound : bounds) {
            bound.gap = std::max(bound.gap, 0.0);
        }
        nearest = nearest_motion(goal, bounds, length_, tolerance * skin(), work_);
    }
    return nearest;
}

void ToolProxy::bound_motion() {
    for (int i = 0; i < contacts_.count; ++i) {
        const ToolContact& contact = contacts_.items[at(i)];
        bounds_[at(i)] = {contact.normal, contact.point - pose_.position, contact.gap, 0.0, 0.0};
    }
}

// The slides of x are allowed: contacts do not lift because of them.
void ToolProxy::bound_slides(const Vector6& x) {
    const RigidMotion motion = lowered(x, length_);
    for (int i = 0; i < contacts_.count; ++i) {
        MotionBound& bound = bounds_[at(i)];
        bound.slide = glm::length(along_surface(motion.at(bound.arm), bound.normal));
    }
}

double ToolProxy::friction_at(const ToolContact& contact, bool sliding) const {
    const Feel feel = feel_at(*scene_, contact.body, contact.feature);
    return friction_share(*scene_, feel, contact.body, contact.feature, contact.point, contact.normal) *
           (sliding ? feel.material->dynamic_friction : feel.material->static_friction);
}

// Where Coulomb's friction lets the tool go, with the forces that hold it.
NearestMotion ToolProxy::hold(const Vector6& goal, bool sliding) {
    for (int i = 0; i < contacts_.count; ++i) {
        const ToolContact& contact = contacts_.items[at(i)];
        MotionBound& bound = bounds_[at(i)];
        bound.friction = contact.gap <= touching_gap * skin() ? friction_at(contact, sliding) : 0.0;
        bound.slide = 0.0;
    }
    NearestMotion held = nearest(goal, cones_met);
    for (int i = 0; sliding && i < slide_rounds && length_of(held.x) > least_step * skin(); ++i) {
        bound_slides(held.x);
        held = nearest(goal, cones_met);
    }
    return held;
}

// Whether a point that friction holds moves along its surface nevertheless.
bool ToolProxy::slips(const NearestMotion& held) const {
    const RigidMotion motion = lowered(held.x, length_);
    return std::ranges::any_of(
        std::span(held.pushes).first(at(held.push_count)), [&](const MotionPush& push) {
            const MotionBound& bound = bounds_[at(push.bound)];
            return bound.friction > 0.0 &&
                   glm::length(along_surface(motion.at(bound.arm), bound.normal)) > least_step * skin();
        });
}

ToolProxy::Plan ToolProxy::plan(const RigidMotion& pull) {
    const Vector6 goal = lifted(pull, length_);
    bound_motion();
    Plan plan;
    plan.holding = nearest(goal, bounds_met);
    plan.motion = plan.holding.x;
    plan.possible = plan.holding.possible && plan.holding.missing == 0.0;
    const bool is_held = std::ranges::any_of(
        std::span(plan.holding.pushes).first(at(plan.holding.push_count)), [&](const MotionPush& p) {
            const ToolContact& contact = contacts_.items[at(p.bound)];
            return contact.gap <= touching_gap * skin() &&
                   feel_at(*scene_, contact.body, contact.feature).material->static_friction > 0.0;
        });
    if (!plan.possible || !is_held) {
        return plan;
    }
    NearestMotion held = hold(goal, sliding_);
    plan.slides = slips(held);
    if (plan.slides && !sliding_) {
        held = hold(goal, true);  // static friction has given way
        sliding_ = true;
    }
    plan.holding = held;
    plan.motion = held.x;
    if (length_of(held.x) > least_step * skin()) {
        // What friction gives, as one wrench, and the motion exactly along the surfaces with it.
        Vector6 held_goal = goal;
        for (int i = 0; i < held.push_count; ++i) {
            const MotionPush& push = held.pushes[at(i)];
            const MotionBound& bound = bounds_[at(push.bound)];
            const Vector6 row = lifted_row(push.direction - bound.normal, bound.arm, length_);
            for (std::size_t j = 0; j < 6; ++j) {
                held_goal[j] += push.size * row[j];
            }
        }
        bound_motion();
        const NearestMotion along = nearest(held_goal, bounds_met);
        plan.motion = along.x;
        plan.possible = along.possible && along.missing == 0.0;
    }
    return plan;
}

void ToolProxy::keep_touches(const NearestMotion& holding) {
    touch_count_ = holding.push_count;
    for (int i = 0; i < touch_count_; ++i) {
        const MotionPush& push = holding.pushes[at(i)];
        const ToolContact& contact = contacts_.items[at(push.bound)];
        const Vector6 row = lifted_row(contact.normal, contact.point - pose_.position, length_);
        const double give = length_of(row);
        touches_[at(i)] = {contact.point,
                           contact.normal,
                           push.direction * (push.size * settings_.stiffness),
                           settings_.stiffness / (give * give),
                           contact.body,
                           contact.feature};
    }
}

}  // namespace tactus
