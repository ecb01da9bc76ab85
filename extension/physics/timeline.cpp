#include "physics/timeline.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

namespace {

TimelineSettings within_range(TimelineSettings settings) {
    settings.ticks_a_snapshot = std::max(1u, settings.ticks_a_snapshot);
    settings.ticks = std::max(2 * settings.ticks_a_snapshot, settings.ticks);
    settings.ticks -= settings.ticks % settings.ticks_a_snapshot;
    return settings;
}

}  // namespace

Timeline::Timeline(const TimelineSettings& settings)
    : settings_(within_range(settings)),
      present_(settings_.physics),
      twin_(settings_.physics),
      ticks_(settings_.ticks),
      inputs_(std::size_t{settings_.ticks} * settings_.inputs_a_tick),
      snapshots_(settings_.ticks / settings_.ticks_a_snapshot),
      memory_(snapshots_.size() * settings_.snapshot_bytes),
      hand_over_(settings_.snapshot_bytes) {
    truth_.reserve(most_truths);
    forget_past();
}

BodyId Timeline::add(PreparedBody& body, PreparedBody& same_body) {
    const BodyId id = present_.add(body);
    if (id.valid() && !(twin_.add(same_body) == id))
        return {};
    forget_past();
    return id;
}

std::pair<PreparedBody, PreparedBody> Timeline::remove(BodyId id) {
    std::pair<PreparedBody, PreparedBody> bodies{present_.remove(id), twin_.remove(id)};
    forget_past();
    return bodies;
}

void Timeline::forget_past() {
    replaying_ = false;
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
    apply(input, present_);
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
            world.apply_spring_force(input.id, input.spring);
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
    }
}

void Timeline::apply_force(BodyId id, const Vec3& force, const Vec3& world_point) {
    record({Input::Kind::force, id, {force, world_point}, {}, {}});
}

void Timeline::apply_spring_force(BodyId id, const SpringForce& spring) {
    record({Input::Kind::spring_force, id, spring, {}, {}});
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

std::uint32_t Timeline::step(double seconds) {
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
    for (const Snapshot& snapshot : snapshots_)
        if (snapshot.bytes != 0 && snapshot.tick >= first_known_ && tick_ - snapshot.tick < ticks_.size())
            oldest = std::min(oldest, snapshot.tick);
    return oldest;
}

bool Timeline::correct(std::uint64_t tick, std::span<const BodyTruth> truth, PastInputs* inputs) {
    if (tick > tick_ || tick < oldest_tick())
        return false;
    const Snapshot* nearest = nullptr;
    for (const Snapshot& snapshot : snapshots_)
        if (snapshot.bytes != 0 && snapshot.tick <= tick && snapshot.tick >= first_known_ &&
            tick_ - snapshot.tick < ticks_.size() && (nearest == nullptr || snapshot.tick > nearest->tick))
            nearest = &snapshot;
    if (nearest == nullptr || !twin_.restore(slot(nearest->tick).first(nearest->bytes)))
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
    const Tick& past = ticks_[replay_at_ % ticks_.size()];
    if (past_inputs_ != nullptr && replay_at_ >= truth_at_) {
        past_inputs_->act(replay_at_, twin_);
    } else {
        const std::size_t first = replay_at_ % ticks_.size() * settings_.inputs_a_tick;
        for (std::size_t i = 0; i < past.inputs; ++i)
            apply(inputs_[first + i], twin_);
    }
    twin_.step(past.seconds);
    ++replay_at_;
    // What is corrected later starts from here.
    if (replay_at_ > truth_at_ && replay_at_ % settings_.ticks_a_snapshot == 0)
        save(twin_, replay_at_);
}

bool Timeline::replay(std::uint32_t most_steps) {
    if (!replaying_)
        return false;
    for (std::uint32_t i = 0;; ++i) {
        if (replay_at_ == truth_at_) {
            for (const BodyTruth& body : truth_) {
                twin_.set_pose(body.id, body.pose);
                twin_.set_velocity(body.id, body.linear_velocity, body.angular_velocity);
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
    const std::size_t bytes = twin_.save_everything(hand_over_);
    return present_.restore(std::span(hand_over_).first(bytes));
}

}  // namespace tactus
