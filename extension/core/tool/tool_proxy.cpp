#include "core/tool/tool_proxy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "core/haptics/hand_place.hpp"
#include "core/haptics/surface_feel.hpp"
#include "core/tool/tool_pair.hpp"
#include "core/tool/tool_steps.hpp"

namespace tactus {

using namespace tool_steps;

ToolProxy::ToolProxy(std::shared_ptr<const ToolShape> shape, std::size_t max_parts,
                     const ToolSettings& settings)
    : around_(std::move(shape), max_parts) {
    set_settings(settings);
}

void ToolProxy::set_settings(const ToolSettings& settings) {
    if (settings.mask != settings_.mask) {
        around_.forget();
    }
    settings_ = settings;
    length_ = std::sqrt(settings.turning_stiffness / settings.stiffness);
}

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

void ToolProxy::give_work(std::int64_t units) {
    work_ = WorkBudget(units);
    work_given_ = units;
}

ToolMemory ToolProxy::memory() const {
    ToolMemory memory{pose_, present_, sliding_, false, pace_, {}, 0};
    const auto hardest = hardest_touch();
    if (hardest != touching().end()) {
        memory.rests = true;
        memory.on = *hardest;
    }
    for (std::size_t i = 0; i < pairs().size(); ++i) {
        memory.slides_on |= pairs()[i]->sliding() ? 1u << i : 0u;
    }
    return memory;
}

// What its spheres know of what is around them holds wherever they are.
void ToolProxy::recall(const ToolMemory& memory, const TouchScene& scene) {
    const bool elsewhere = pose_.position != memory.pose.position || pose_.rotation != memory.pose.rotation;
    around_.went(motion_between(pose_, memory.pose));
    pose_ = memory.pose;
    present_ = memory.present;
    sliding_ = memory.sliding;
    pace_ = memory.pace;
    touch_count_ = memory.rests ? 1 : 0;
    meeting_count_ = 0;
    touches_[0] = memory.on;
    for (std::size_t i = 0; i < pairs().size(); ++i) {
        pairs()[i]->set_sliding((memory.slides_on >> i & 1u) != 0);
        if (elsewhere) {
            pairs()[i]->displaced();
        }
    }
    revision_ = scene.revision();
}

ToolTick ToolProxy::appear(const Pose& hand) {
    around_.forget();
    around_.begin_tick(*scene_, settings_.mask, hand, 0.0);
    give_work(2 * settings_.max_work);
    pose_ = start_ = hand;
    present_ = around_.is_free(hand, work_) && fits_beside_tools();
    sliding_ = false;
    touch_count_ = meeting_count_ = 0;
    pace_ = 0.0;
    ToolTick tick;
    tick.pose = hand;
    tick.status = present_ ? 0u : static_cast<std::uint32_t>(tool_absent);
    return tick;
}

void ToolProxy::descend(const Pose& hand, ToolTick& tick) {
    const double least = least_step * skin();
    bool slid = false;
    bool ended = false;
    double trust = 1.0;
    for (int stalls = 0; stalls < max_stalls; ++tick.steps) {
        const RigidMotion pull = motion_between(pose_, hand);
        around_.collect(pose_, pull, 4.0 * pace_ + far_enough * skin(), contacts_, work_);
        const Plan next = plan(pull);
        if (work_.is_gone() || !next.possible) {
            break;
        }
        slid = slid || next.slides;
        tick.residual = length_of(next.motion);
        keep_touches(next.holding);
        ended = tick.residual <= least;
        if (ended || tick.steps == settings_.max_steps) {
            break;
        }
        const RigidMotion wanted = lowered(next.motion, length_);
        const RigidMotion step = wanted * (trust * straight_share(wanted));
        const RigidMotion gone = step * free_share(step);
        go(gone);
        // What a turn bends towards a surface grows with its square, what lifts the tool off with the turn.
        const bool stalled = around_.farthest_way(gone) < least;
        stalls = stalled ? stalls + 1 : 0;
        trust = stalled ? 0.25 * trust : std::min(1.0, 2.0 * trust);
    }
    sliding_ = slid;
    tick.status |= ended ? 0u : static_cast<std::uint32_t>(tool_unfinished);
}

// It ends no farther from the hand than it is after its ride (unit: meters).
double ToolProxy::farthest_to_go() const {
    const double ridden = farthest_ride * (shape().reach + length_);
    return 2.0 * (length_of(lifted(motion_between(pose_, hand_), length_)) + ridden);
}

// True where it has to go on from there.
bool ToolProxy::begin(const TouchScene& scene, const Pose& given_hand, ToolTick& tick) {
    scene_ = &scene;
    if (is_hand_pose(given_hand)) {
        hand_ = {given_hand.position, glm::normalize(given_hand.rotation)};
    }
    const Pose hand = hand_;
    if (!present_) {
        tick = appear(hand);
        return false;
    }
    start_ = pose_;
    meeting_count_ = 0;
    // What gives comes nearer everywhere, tick after tick, and most spheres have to look again.
    give_work(settings_.max_work * (scene.deformed_bodies().empty() ? 1 : 2));
    if (!scene.only_gives_since(std::exchange(revision_, scene.revision()))) {
        touch_count_ = 0;
    }
    around_.begin_tick(scene, settings_.mask, pose_, farthest_to_go());
    if (!ride()) {
        tick = appear(hand);
        tick.status |= tool_squeezed;
        return false;
    }
    return true;
}

void ToolProxy::finish(ToolTick& tick) {
    pace_ = around_.farthest_way(motion_between(start_, pose_));
    const RigidMotion pull = motion_between(pose_, hand_);
    tick.pose = pose_;
    tick.force = pull.way * -settings_.stiffness;
    tick.torque = pull.turn * -settings_.turning_stiffness;
    const bool slides = sliding_ && touch_count_ > 0;
    const bool slides_on_tool = meeting_count_ > 0 && std::ranges::any_of(pairs(), &ToolPair::sliding);
    tick.status |= (touch_count_ + meeting_count_ > 0 ? static_cast<std::uint32_t>(tool_touching) : 0u) |
                   (slides || slides_on_tool ? static_cast<std::uint32_t>(tool_sliding) : 0u);
}

ToolTick ToolProxy::move(const TouchScene& scene, const Pose& hand) {
    ToolTick tick;
    if (begin(scene, hand, tick)) {
        descend(hand_, tick);
        finish(tick);
    }
    return tick;
}

void ToolProxy::meet(ToolPair& pair) {
    pairs_[at(pair_count_++)] = &pair;
}

void ToolProxy::leave(const ToolPair& pair) {
    const auto last = pairs_.begin() + pair_count_;
    pair_count_ -= static_cast<int>(last - std::remove(pairs_.begin(), last, &pair));
    meeting_count_ = 0;
}

}  // namespace tactus
