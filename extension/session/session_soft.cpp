// Bodies that give, in the loop: what presses them, what they lie on, and the form that they take.
#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <span>

#include "session/session_loop.hpp"

namespace tactus {

namespace {

// What is farther than this is no obstacle until it is looked for again (unit: meters).
constexpr double near_enough = 0.1;
constexpr std::uint64_t ticks_between_looks = 16;

// Of a tick, for all bodies that give together.
constexpr double soft_share = 0.6;

// One more solve for hands that press, one for what it lies on.
double time_of_step(const SoftSlot& soft) {
    const SoftModel& model = soft.body.model();
    const int solves = (soft.is_pressed() ? 1 : 0) + (soft.near().empty() ? 0 : 1);
    return soft.body.iterations * model.iteration_time() + solves * model.solve_time();
}

}  // namespace

// Over a link nothing is told of a body's form: there it stays as it is at rest.
void SessionLoop::take_soft_forms() {
    for (const SessionHandle handle : giving_) {
        Body& giving = bodies_[handle];
        if (giving.soft->take_form()) {
            scene_.give(giving.slot, giving.soft->form(), giving.soft->gave_by());
        }
    }
}

// Solids alone, of what has a layer that the body lies on: a mesh takes too long to ask for every vertex.
void SessionLoop::find_obstacles(const Body& giving) {
    SoftSlot& soft = *giving.soft;
    std::array<SoftSlot::Obstacle, SoftSlot::max_obstacles> found;
    std::size_t count = 0;
    const ScenePart& own = scene_.parts()[scene_.body(giving.slot).first_part];
    const Vec3 center = to_parent(own.pose, own.part->center);
    for (std::size_t i = 0; i < scene_.slots_in_use(); ++i) {
        const TouchBody& other = scene_.body(static_cast<int>(i));
        const bool is_solid =
            other.shape && static_cast<int>(i) != giving.slot && (other.layer & soft.mask) != 0;
        for (std::size_t part = 0; is_solid && part < other.shape->parts.size(); ++part) {
            const TouchPart& surface = other.shape->parts[part];
            const double distance =
                glm::distance(to_parent(compose(other.pose, surface.pose), surface.center), center);
            if (!surface.tree() && distance <= surface.radius + own.part->radius + near_enough &&
                count < found.size()) {
                found[count++] = {static_cast<int>(i), part};
            }
        }
    }
    soft.set_near(std::span(found).first(count));
}

// Of a body that goes, or takes another form: who may lie on it looks anew.
void SessionLoop::forget_obstacle(int slot) {
    for (const SessionHandle handle : giving_) {
        SoftSlot& soft = *bodies_[handle].soft;
        if (std::ranges::find(soft.near(), slot, &SoftSlot::Obstacle::body) != soft.near().end()) {
            soft.set_near({});
        }
    }
}

// Where they are after the physics step, in the frame of the body. True where one of them is elsewhere in it
// than in the last step.
bool SessionLoop::place_obstacles(const Body& giving) {
    SoftSlot& soft = *giving.soft;
    const Pose into = inverse(scene_.body(giving.slot).pose);
    bool moved = false;
    for (std::size_t i = 0; i < soft.near().size(); ++i) {
        const SoftSlot::Obstacle& near = soft.near()[i];
        SoftObstacle& obstacle = soft.obstacles()[i];
        const TouchBody& other = scene_.body(near.body);
        const Body& owner = bodies_[handle_of_slot_[static_cast<std::size_t>(near.body)]];
        const TouchPart& part = other.shape->parts[near.part];
        const bool is_still = owner.motion == Motion::Static;
        const Pose now = is_still ? other.pose : physics_.pose(owner.id);
        const Pose pose = compose(into, compose(now, part.pose));
        moved = moved || pose.position != obstacle.pose.position || pose.rotation != obstacle.pose.rotation;
        obstacle = {&part.solid(), pose, compose(into, compose(other.pose, part.pose)),
                    soft.body.model().design.material.friction,
                    owner.motion == Motion::Dynamic ? 1.0 / physics_.mass(owner.id) : 0.0};
    }
    return moved;
}

// What it pushes back goes to the bodies that move, in their next step.
void SessionLoop::push_obstacles(const Body& giving) {
    SoftSlot& soft = *giving.soft;
    const Pose at = scene_.body(giving.slot).pose;
    for (std::size_t i = 0; i < soft.near().size(); ++i) {
        const SoftObstacle& obstacle = soft.obstacles()[i];
        const Body& owner = bodies_[handle_of_slot_[static_cast<std::size_t>(soft.near()[i].body)]];
        if (owner.motion == Motion::Dynamic && obstacle.impulse != Vec3(0.0)) {
            physics_.apply_force(owner.id, direction_to_parent(at, obstacle.impulse) / seconds_,
                                 to_parent(at, obstacle.pose.position));
            physics_.apply_torque(owner.id, direction_to_parent(at, obstacle.turn) / seconds_);
        }
    }
}

void SessionLoop::step_soft(SessionHandle handle) {
    const Body& giving = bodies_[handle];
    if ((tick_ + handle) % ticks_between_looks == 0 || giving.soft->near().empty()) {
        find_obstacles(giving);
    }
    if (place_obstacles(giving)) {
        giving.soft->body.wake();
    }
    const std::uint32_t status = giving.soft->step(scene_.body(giving.slot).pose, gravity_);
    status_ |= status & soft_lost ? static_cast<TickStatus>(session_body_lost) : 0u;
    push_obstacles(giving);
}

// What is pressed goes first; what there is no time for stays as it is for this tick, and is among the first
// in the next. One always goes on, however large it is. What sleeps takes no time.
//
// A twin has what this loop has, and would go on from another form.
void SessionLoop::step_soft() {
    slowed_soft_ = 0;
    if (twin() || giving_.empty()) {
        return;
    }
    const std::size_t first = soft_turn_ % giving_.size();
    double left = soft_share * seconds_;
    const double of_each = std::min(max_iteration_time, left / static_cast<double>(giving_.size()));
    bool any = false;
    for (const bool pressed : {true, false}) {
        for (std::size_t i = 0; i < giving_.size(); ++i) {
            const std::size_t at = (first + i) % giving_.size();
            SoftSlot& soft = *bodies_[giving_[at]].soft;
            if (soft.was_stepped(tick_) || (pressed && !soft.is_pressed())) {
                continue;
            }
            soft.body.iterations = soft.body.model().iterations_within(of_each);
            const double time = soft.body.is_asleep() && !soft.is_pressed() ? 0.0 : time_of_step(soft);
            if (any && time > left) {
                soft_turn_ = slowed_soft_++ == 0 ? at : soft_turn_;
                soft.skip(tick_);
                continue;
            }
            left -= time;
            any = any || time > 0.0;
            soft.begin_step(tick_);
            step_soft(giving_[at]);
        }
    }
}

}  // namespace tactus
