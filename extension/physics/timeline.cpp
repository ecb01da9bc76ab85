#include "physics/timeline.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

TimelineSettings within_range(TimelineSettings settings) {
    settings.ticks_a_snapshot = std::max(1u, settings.ticks_a_snapshot);
    if (settings.ticks == 0) {
        settings.inputs_a_tick = 0;
        settings.snapshot_bytes = 0;
        return settings;
    }
    settings.ticks = std::max(2 * settings.ticks_a_snapshot, settings.ticks);
    settings.ticks -= settings.ticks % settings.ticks_a_snapshot;
    return settings;
}

// What is left of a spring's force when its point of the body has given way by u: F (1 - k n.u / |F|), n the
// force's direction.
SpringForce given_way(SpringForce spring, const Vec3& point) {
    const Vec3 way = point - spring.point;
    const double square = glm::dot(spring.force, spring.force);
    if (square > 0.0)
        spring.force *= std::max(0.0, 1.0 - spring.stiffness * glm::dot(spring.force, way) / square);
    spring.point = point;
    return spring;
}

}  // namespace

Timeline::Timeline(const TimelineSettings& settings)
    : settings_(within_range(settings)),
      present_(settings_.physics),
      twin_(settings_.ticks > 0 ? std::make_unique<PhysicsWorld>(settings_.physics) : nullptr),
      ticks_(settings_.ticks),
      inputs_(std::size_t{settings_.ticks} * settings_.inputs_a_tick),
      snapshots_(settings_.ticks / settings_.ticks_a_snapshot),
      memory_(snapshots_.size() * settings_.snapshot_bytes),
      hand_over_(2 * settings_.snapshot_bytes) {
    truth_.reserve(has_past() ? most_truths : 0);
}

BodyId Timeline::add(PreparedBody& body, PreparedBody& same_body) {
    const BodyId id = present_.add(body);
    if (!id.valid() || !has_past())
        return id;
    if (!(twin_->add(same_body) == id)) {
        body = present_.remove(id);
        return {};
    }
    forget_past();
    return id;
}

std::pair<PreparedBody, PreparedBody> Timeline::remove(BodyId id) {
    std::pair<PreparedBody, PreparedBody> bodies;
    bodies.first = present_.remove(id);
    if (has_past())
        bodies.second = twin_->remove(id);
    forget_past();
    return bodies;
}

bool Timeline::reshape(BodyId id, PreparedBody& other, PreparedBody& same_other) {
    const bool done = present_.reshape(id, other);
    if (done && has_past())
        twin_->reshape(id, same_other);
    forget_past();
    return done;
}

// Two worlds with the same history of changes give the same numbers to their joints. A joint holds bodies as
// they are when it is made, and the twin's are wherever its last replay left them.
JointId Timeline::add_joint(const JointDescription& joint, BodyId first, BodyId second) {
    const JointId id = present_.add_joint(joint, first, second);
    if (id.valid() && has_past()) {
        twin_->take_state(first, present_);
        twin_->take_state(second, present_);
        twin_->add_joint(joint, first, second);
    }
    forget_past();
    return id;
}

bool Timeline::remove_joint(JointId id) {
    const bool done = present_.remove_joint(id);
    if (has_past())
        twin_->remove_joint(id);
    forget_past();
    return done;
}

bool Timeline::set_motion(BodyId id, Motion motion) {
    const bool done = present_.set_motion(id, motion);
    if (has_past())
        twin_->set_motion(id, motion);
    forget_past();
    return done;
}

void Timeline::settle_broad_phase() {
    present_.settle_broad_phase();
    if (has_past())
        twin_->settle_broad_phase();
}

void Timeline::set_material(BodyId id, const SurfaceMaterial& material) {
    present_.set_material(id, material);
    if (has_past())
        twin_->set_material(id, material);
}

void Timeline::set_factors(BodyId id, const BodyFactors& factors) {
    present_.set_factors(id, factors);
    if (has_past())
        twin_->set_factors(id, factors);
}

void Timeline::set_damping(BodyId id, double linear, double angular) {
    present_.set_damping(id, linear, angular);
    if (has_past())
        twin_->set_damping(id, linear, angular);
}

void Timeline::set_gravity_scale(BodyId id, double scale) {
    present_.set_gravity_scale(id, scale);
    if (has_past())
        twin_->set_gravity_scale(id, scale);
}

void Timeline::set_collision(BodyId id, const CollisionLayers& collision) {
    present_.set_collision(id, collision);
    if (has_past())
        twin_->set_collision(id, collision);
}

void Timeline::forget_past() {
    if (!has_past())
        return;
    replaying_ = false;
    known_ = false;
}

// Many changes at once forget but once.
void Timeline::begin_past() {
    if (known_)
        return;
    known_ = true;
    first_known_ = tick_;
    ticks_[tick_ % ticks_.size()] = {};
    for (Snapshot& snapshot : snapshots_)
        snapshot.bytes = 0;
    save(present_, tick_);
}

std::size_t Timeline::slot_index(std::uint64_t tick) const {
    return tick / settings_.ticks_a_snapshot % snapshots_.size();
}

std::span<std::byte> Timeline::slot(std::uint64_t tick) {
    return std::span(memory_).subspan(slot_index(tick) * settings_.snapshot_bytes, settings_.snapshot_bytes);
}

void Timeline::save(const PhysicsWorld& world, std::uint64_t tick) {
    snapshots_[slot_index(tick)] = {tick, world.save_everything(slot(tick))};
}

void Timeline::record(const Input& input) {
    if (has_past())
        begin_past();
    apply(input, present_);
    if (!has_past())
        return;
    Tick& now = ticks_[tick_ % ticks_.size()];
    if (now.inputs < settings_.inputs_a_tick)
        inputs_[tick_ % ticks_.size() * settings_.inputs_a_tick + now.inputs++] = input;
}

void Timeline::apply(const Input& input, PhysicsWorld& world) {
    switch (input.kind) {
        case Input::Kind::force:
            world.apply_force(input.id, input.spring.force, input.spring.point);
            break;
        case Input::Kind::spring_force:
            world.apply_spring_force(
                input.id, given_way(input.spring, to_parent(world.pose(input.id), input.pose.position)));
            break;
        case Input::Kind::torque:
            world.apply_torque(input.id, input.spring.force);
            break;
        case Input::Kind::pose:
            world.set_pose(input.id, input.pose);
            break;
        case Input::Kind::velocity:
            world.set_velocity(input.id, input.spring.force, input.angular);
            break;
        case Input::Kind::way:
            world.move_to(input.id, input.pose, input.seconds);
            break;
        case Input::Kind::gravity:
            world.set_gravity(input.spring.force);
            break;
    }
}

void Timeline::apply_inputs(std::uint64_t tick, PhysicsWorld& world) const {
    const std::size_t first = tick % ticks_.size() * settings_.inputs_a_tick;
    for (std::size_t i = 0; i < ticks_[tick % ticks_.size()].inputs; ++i)
        apply(inputs_[first + i], world);
}

void Timeline::set_gravity(const Vec3& gravity) {
    record({Input::Kind::gravity, {}, {gravity}, {}, {}});
}

void Timeline::move_to(BodyId id, const Pose& pose, double seconds) {
    record({Input::Kind::way, id, {}, pose, {}, seconds});
}

void Timeline::apply_force(BodyId id, const Vec3& force, const Vec3& world_point) {
    record({Input::Kind::force, id, {force, world_point}, {}, {}});
}

void Timeline::apply_spring_force(BodyId id, const SpringForce& spring) {
    if (!has_past()) {
        present_.apply_spring_force(id, spring);
        return;
    }
    const Vec3 in_body = to_local(present_.pose(id), spring.point);
    record({Input::Kind::spring_force, id, spring, {in_body, {}}, {}});
}

void Timeline::apply_torque(BodyId id, const Vec3& torque) {
    record({Input::Kind::torque, id, {torque}, {}, {}});
}

void Timeline::set_pose(BodyId id, const Pose& pose) {
    record({Input::Kind::pose, id, {}, pose, {}});
}

void Timeline::set_velocity(BodyId id, const Vec3& linear, const Vec3& angular) {
    record({Input::Kind::velocity, id, {linear}, {}, angular});
}

bool Timeline::restore(std::span<const std::byte> snapshot) {
    if (!present_.restore(snapshot))
        return false;
    forget_past();
    return true;
}

void Timeline::take_state(BodyId id, const PhysicsWorld& other) {
    present_.take_state(id, other);
    forget_past();
}

std::uint32_t Timeline::step(double seconds) {
    if (!has_past()) {
        ++tick_;
        return present_.step(seconds);
    }
    begin_past();
    ticks_[tick_ % ticks_.size()].seconds = seconds;
    const std::uint32_t status = present_.step(seconds);
    ++tick_;
    ticks_[tick_ % ticks_.size()] = {};
    if (tick_ % settings_.ticks_a_snapshot == 0)
        save(present_, tick_);
    return status;
}

// The slot about to be written last holds the oldest snapshot; one tick of the ring is the present one's.
std::uint64_t Timeline::oldest_tick() const {
    std::uint64_t oldest = tick_;
    if (!known_)
        return oldest;
    for (const Snapshot& snapshot : snapshots_)
        if (snapshot.bytes != 0 && snapshot.tick >= first_known_ && tick_ - snapshot.tick < ticks_.size())
            oldest = std::min(oldest, snapshot.tick);
    return oldest;
}

bool Timeline::correct(std::uint64_t tick, std::span<const BodyTruth> truth, PastInputs* inputs) {
    if (!known_ || tick > tick_ || tick < oldest_tick())
        return false;
    const Snapshot* nearest = nullptr;
    for (const Snapshot& snapshot : snapshots_)
        if (snapshot.bytes != 0 && snapshot.tick <= tick && snapshot.tick >= first_known_ &&
            tick_ - snapshot.tick < ticks_.size() && (nearest == nullptr || snapshot.tick > nearest->tick))
            nearest = &snapshot;
    if (nearest == nullptr || !twin_->restore(slot(nearest->tick).first(nearest->bytes)))
        return false;
    replaying_ = true;
    replay_at_ = nearest->tick;
    truth_at_ = tick;
    truth_.assign(truth.begin(),
                  truth.begin() + static_cast<std::ptrdiff_t>(std::min(truth.size(), most_truths)));
    past_inputs_ = inputs;
    return true;
}

void Timeline::replay_tick() {
    if (past_inputs_ != nullptr && replay_at_ >= truth_at_)
        past_inputs_->act(replay_at_, *twin_);
    else
        apply_inputs(replay_at_, *twin_);
    twin_->step(ticks_[replay_at_ % ticks_.size()].seconds);
    ++replay_at_;
    // What is corrected later starts from here.
    if (replay_at_ > truth_at_ && replay_at_ % settings_.ticks_a_snapshot == 0)
        save(*twin_, replay_at_);
}

bool Timeline::replay(std::uint32_t most_steps) {
    if (!replaying_)
        return false;
    for (std::uint32_t i = 0;; ++i) {
        if (replay_at_ == truth_at_) {
            for (const BodyTruth& body : truth_) {
                twin_->set_pose(body.id, body.pose);
                twin_->set_velocity(body.id, body.linear_velocity, body.angular_velocity);
            }
            truth_.clear();
        }
        if (replay_at_ == tick_ || i == most_steps)
            break;
        replay_tick();
    }
    if (replay_at_ != tick_)
        return false;
    replaying_ = false;
    const std::size_t bytes = twin_->save_everything(hand_over_);
    if (!present_.restore(std::span(hand_over_).first(bytes)))
        return false;
    apply_inputs(tick_, present_);
    return true;
}

}  // namespace tactus
