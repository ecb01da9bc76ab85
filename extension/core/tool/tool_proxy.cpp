#include "core/tool/tool_proxy.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <utility>

#include "core/haptics/hand_place.hpp"
#include "core/haptics/surface_feel.hpp"
#include "core/haptics/surface_way.hpp"
#include "core/teleop/body_motion.hpp"

namespace tactus {

namespace {

// Of the skin.
constexpr double least_step = 0.125;  // the tool is where it should be
constexpr double touching_gap = 4.0;  // what the tool is still above does not hold it by friction
constexpr double far_enough = 64.0;   // how far ahead contacts are looked for while the hand is slow
constexpr double bounds_met = 1e-3;   // by motions
constexpr double cones_met = 1e-2;    // by friction

constexpr int max_stalls = 6;    // steps that lead nowhere
constexpr int slide_rounds = 4;  // of the pressure and the friction that goes with it

// Of a sphere's radius: what a body on its way may enter before it has to take the tool along (the next step
// lifts the tool out of less), and where the tool is let go since it could come out on the other side.
constexpr double entered = 0.5;
constexpr double lost = 0.9;
constexpr int takes_along = 6;         // by what gives, in a tick: each sphere that it enters most
constexpr double farthest_ride = 0.2;  // of the tool's reach: how far bodies may take it in a tick

constexpr std::size_t at(int i) {
    return static_cast<std::size_t>(i);
}

double length_of(const Vector6& x) {
    double sum = 0.0;
    for (const double value : x) {
        sum += value * value;
    }
    return std::sqrt(sum);
}

}  // namespace

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
        const Vec3 way = motion.at(bound.arm);
        bound.slide = glm::length(way - bound.normal * glm::dot(bound.normal, way));
    }
}

// Where Coulomb's friction lets the tool go, with the forces that hold it.
NearestMotion ToolProxy::hold(const Vector6& goal, bool sliding) {
    for (int i = 0; i < contacts_.count; ++i) {
        const ToolContact& contact = contacts_.items[at(i)];
        const Feel feel = feel_at(*scene_, contact.body, contact.feature);
        const bool touches = contact.gap <= touching_gap * skin();
        bounds_[at(i)].friction =
            touches ? friction_share(*scene_, feel, contact.body, contact.feature, contact.point,
                                     contact.normal) *
                          (sliding ? feel.material->dynamic_friction : feel.material->static_friction)
                    : 0.0;
        bounds_[at(i)].slide = 0.0;
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
        std::span(held.pushes).first(at(held.push_count)), [&](const NearestMotion::Push& push) {
            const MotionBound& bound = bounds_[at(push.bound)];
            const Vec3 way = motion.at(bound.arm);
            return bound.friction > 0.0 &&
                   glm::length(way - bound.normal * glm::dot(bound.normal, way)) > least_step * skin();
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
        std::span(plan.holding.pushes).first(at(plan.holding.push_count)), [&](const NearestMotion::Push& p) {
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
            const NearestMotion::Push& push = held.pushes[at(i)];
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
        const NearestMotion::Push& push = holding.pushes[at(i)];
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

void ToolProxy::go(const RigidMotion& motion) {
    pose_ = moved(pose_, motion);
    around_.went(motion);
}

void ToolProxy::give_work(std::int64_t units) {
    work_ = WorkBudget(units);
    work_given_ = units;
}

ToolMemory ToolProxy::memory() const {
    ToolMemory memory{pose_, present_, sliding_, false, pace_, {}};
    const auto hardest = hardest_touch();
    if (hardest != touching().end()) {
        memory.rests = true;
        memory.on = *hardest;
    }
    return memory;
}

// What its spheres know of what is around them holds wherever they are.
void ToolProxy::recall(const ToolMemory& memory, const TouchScene& scene) {
    around_.went(motion_between(pose_, memory.pose));
    pose_ = memory.pose;
    present_ = memory.present;
    sliding_ = memory.sliding;
    pace_ = memory.pace;
    touch_count_ = memory.rests ? 1 : 0;
    touches_[0] = memory.on;
    revision_ = scene.revision();
}

void ToolProxy::go_along(const TouchScene& scene, const Pose& motion, int body) {
    constexpr int max_parts_of_turn = 16;
    scene_ = &scene;
    const Pose there = compose(motion, pose_);
    give_work(settings_.max_work);
    around_.begin_tick(scene, settings_.mask, pose_,
                       2.0 * around_.farthest_way(motion_between(pose_, there)));
    for (int i = 0; i < max_parts_of_turn; ++i) {
        const RigidMotion left = motion_between(pose_, there);
        const double straight = around_.straight_share(left);
        const double free = around_.free_share(pose_, left * straight, work_, body);
        go(left * (straight * free));
        if (straight * free >= 1.0 || free < 1.0 || work_.is_gone()) {
            return;
        }
    }
}

ToolTick ToolProxy::appear(const Pose& hand) {
    around_.forget();
    around_.begin_tick(*scene_, settings_.mask, hand, 0.0);
    give_work(2 * settings_.max_work);
    present_ = around_.is_free(hand, work_);
    pose_ = hand;
    sliding_ = false;
    touch_count_ = 0;
    pace_ = 0.0;
    ToolTick tick;
    tick.pose = hand;
    tick.status = present_ ? 0u : static_cast<std::uint32_t>(tool_absent);
    return tick;
}

std::span<const ToolTouch>::iterator ToolProxy::hardest_touch() const {
    return std::ranges::max_element(
        touching(), {}, [](const ToolTouch& touch) { return glm::dot(touch.force, touch.normal); });
}

// The body that the tool rests on hardest; -1: none.
int ToolProxy::carrier() const {
    const auto hardest = hardest_touch();
    return hardest == touching().end() ? -1 : hardest->body;
}

// What has moved takes the tool along: all the way, as far as there is room, where it rests on it; and what
// is left of the way where it would enter its spheres so far that the next step could lose them. False where
// something else leaves no room for that.
bool ToolProxy::ride() {
    const Pose before = pose_;
    double taken = 0.0;
    const auto take_along = [&](int index, double share) {
        const TouchBody& body = scene_->body(index);
        const Pose there = compose(displacement(body.previous, body.pose), pose_);
        const RigidMotion motion = motion_between(pose_, there) * share;
        taken += around_.farthest_way(motion);
        if (taken <= farthest_ride * shape().reach) {
            const double straight = around_.straight_share(motion);
            go(motion * (straight * around_.free_share(pose_, motion * straight, work_, index)));
        }
    };
    if (const int carries = carrier(); carries >= 0 && scene_->body(carries).moved) {
        take_along(carries, 1.0);
    }
    bool has_room = true;
    for (const int index : scene_->moved_bodies()) {
        const double share = around_.share_until_entered(index, before, pose_, entered, work_);
        if (share < 1.0) {
            take_along(index, 1.0 - share);
            has_room = has_room && around_.share_until_entered(index, before, pose_, lost, work_) == 1.0;
        }
    }
    return ride_forms(taken) && has_room && taken <= farthest_ride * shape().reach;
}

// The rigid motion nearest to how the surface has gone under the tool, by what each contact presses with.
// About axes that the contacts say nothing of it does not turn.
RigidMotion ToolProxy::way_of_form(int body) const {
    constexpr double steadies = 0.01;  // of the tool's reach
    double pressing = 0.0;
    Vec3 center(0.0), mean(0.0);
    const auto for_each = [&](auto&& use) {
        for (const ToolTouch& touch : touching()) {
            const double weight = glm::dot(touch.force, touch.normal);
            if (touch.body == body && weight > 0.0) {
                Touch place;
                place.point = touch.point;
                place.body = touch.body;
                place.feature = touch.feature;
                use(weight, touch.point - pose_.position, tactus::way_of_surface(*scene_, place));
            }
        }
    };
    for_each([&](double weight, const Vec3& arm, const Vec3& way) {
        pressing += weight;
        center += weight * arm;
        mean += weight * way;
    });
    if (pressing <= 0.0) {
        return {};
    }
    center /= pressing;
    mean /= pressing;
    const double steady = steadies * shape().reach;
    Mat3 inertia(pressing * steady * steady);
    Vec3 momentum(0.0);
    for_each([&](double weight, const Vec3& arm, const Vec3& way) {
        const Vec3 r = arm - center;
        inertia += weight * (Mat3(glm::dot(r, r)) - glm::outerProduct(r, r));
        momentum += weight * glm::cross(r, way - mean);
    });
    const Vec3 turn = glm::inverse(inertia) * momentum;
    return {mean - glm::cross(turn, center), turn};
}

// What gives carries a tool that rests on it, and takes it along where it would enter its spheres too far.
bool ToolProxy::ride_forms(double& taken) {
    const Pose before = pose_;
    const auto take_along = [&](const RigidMotion& motion, int index) {
        taken += around_.farthest_way(motion);
        if (motion.way != Vec3(0.0) && taken <= farthest_ride * shape().reach) {
            const double straight = around_.straight_share(motion);
            go(motion * (straight * around_.free_share(pose_, motion * straight, work_, index)));
        }
    };
    bool has_room = true;
    for (const int index : scene_->deformed_bodies()) {
        const TouchBody& body = scene_->body(index);
        if ((body.layer & settings_.mask) == 0 || !is_deformation(*body.former, *body.shape)) {
            continue;
        }
        if (const RigidMotion rests = way_of_form(index); rests.way != Vec3(0.0)) {
            take_along(rests, index);
        }
        double share = 0.0;
        for (int i = 0; i < takes_along && share < 1.0; ++i) {
            const auto entering = around_.entered_by_form(index, before, pose_, entered, work_);
            share = entering.share;
            take_along({entering.way, Vec3(0.0)}, index);
        }
        has_room = has_room &&
                   (share == 1.0 || around_.entered_by_form(index, before, pose_, lost, work_).share == 1.0);
    }
    return has_room;
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
        const RigidMotion step = wanted * (trust * around_.straight_share(wanted));
        const RigidMotion gone = step * around_.free_share(pose_, step, work_);
        go(gone);
        // What a turn bends towards a surface grows with its square, what lifts the tool off with the turn.
        const bool stalled = around_.farthest_way(gone) < least;
        stalls = stalled ? stalls + 1 : 0;
        trust = stalled ? 0.25 * trust : std::min(1.0, 2.0 * trust);
    }
    sliding_ = slid;
    tick.status |= ended ? 0u : static_cast<std::uint32_t>(tool_unfinished);
}

ToolTick ToolProxy::move(const TouchScene& scene, const Pose& given_hand) {
    scene_ = &scene;
    if (is_hand_pose(given_hand)) {
        hand_ = {given_hand.position, glm::normalize(given_hand.rotation)};
    }
    const Pose hand = hand_;
    if (!present_) {
        return appear(hand);
    }
    const Pose start = pose_;
    // What gives comes nearer everywhere, tick after tick, and most spheres have to look again.
    give_work(settings_.max_work * (scene.deformed_bodies().empty() ? 1 : 2));
    if (!scene.only_gives_since(std::exchange(revision_, scene.revision()))) {
        touch_count_ = 0;
    }
    // It ends no farther from the hand than it is after its ride.
    const double ridden = farthest_ride * (shape().reach + length_);
    around_.begin_tick(scene, settings_.mask, pose_,
                       2.0 * (length_of(lifted(motion_between(pose_, hand), length_)) + ridden));
    ToolTick tick;
    if (!ride()) {
        tick = appear(hand);
        tick.status |= tool_squeezed;
        return tick;
    }
    descend(hand, tick);
    pace_ = around_.farthest_way(motion_between(start, pose_));
    const RigidMotion pull = motion_between(pose_, hand);
    tick.pose = pose_;
    tick.force = pull.way * -settings_.stiffness;
    tick.torque = pull.turn * -settings_.turning_stiffness;
    tick.status |= (touch_count_ > 0 ? static_cast<std::uint32_t>(tool_touching) : 0u) |
                   (sliding_ && touch_count_ > 0 ? static_cast<std::uint32_t>(tool_sliding) : 0u);
    return tick;
}

}  // namespace tactus
