// What the operator believes of a body's published state, which may be seen only roughly (pose_filter.hpp,
// seen_pose.hpp).
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "session/operator_side.hpp"

namespace tactus {

namespace {

// What is received is rounded: where the model had the same but for that, it was right, to the last bit.
bool is_as_sent(const BodyMotion& received, const BodyMotion& expected) {
    constexpr double turn = 1e-9;           // of a quaternion's parts
    constexpr double of_velocity = 2.0e-7;  // two roundings to single precision
    constexpr double of_position = 2.0;     // quanta
    const auto near = [](const Vec3& a, const Vec3& b, double tolerance) {
        return glm::distance(a, b) <= tolerance;
    };
    const auto near_velocity = [&near](const Vec3& a, const Vec3& b) {
        return near(a, b, of_velocity * (1.0 + glm::length(b)));
    };
    const Quat& q = received.pose.rotation;
    const Quat& p = expected.pose.rotation;
    return near(received.pose.position, expected.pose.position, of_position * position_quantum) &&
           std::min(glm::length(q - p), glm::length(q + p)) <= turn &&
           near_velocity(received.linear_velocity, expected.linear_velocity) &&
           near_velocity(received.angular_velocity, expected.angular_velocity);
}

}  // namespace

// Of a place that is seen only roughly, what its way and the model make of it; where the far side says how
// roughly, what that makes of it.
BodyMotion OperatorSide::believed(SessionLoop& loop, SessionHandle body, SampleSequence sample,
                                  const BodyMotion& received) {
    const BodyMotion* const expected = past_.motion(truths_.place_of(body), sample);
    const bool is_right = expected && is_as_sent(received, *expected);
    BodyMotion result = is_right ? *expected : received;
    if (Found& found = found_[body]; found.estimate.has_doubt) {
        const PoseStep step = step_to(body, sample, received);
        const Pose steady = found.seen.believe(settings().seen, received.pose, found.estimate.doubt,
                                               expected ? expected->pose : loop.motion(body).pose,
                                               step.open_way, step.open_turn);
        result.pose = is_right ? result.pose : on_joints(loop, body, steady);
        return result;
    }
    if (settings().derivation == Derivation::resimulate && resimulator_.exists()) {
        const Pose model = expected ? expected->pose : loop.motion(body).pose;
        PoseFilter& filter = filters_[body];
        const Pose filtered =
            filter.filter(settings().filter, result.pose, model, step_to(body, sample, received), eyes_);
        if (!is_right) {
            const Pose steady = on_joints(loop, body, filtered);
            result.pose = expected ? filter.unless_said(settings().filter, steady, model, eyes_) : steady;
        }
    }
    return result;
}

// An honest far side keeps a body on its joints. The model's joint would tear a pose that it does not allow.
Pose OperatorSide::on_joints(const SessionLoop& loop, SessionHandle body, const Pose& seen) const {
    const Pose held = loop.on_joints(body, seen);
    const bool allowed = glm::distance(held.position, seen.position) <= settings().filter.place &&
                         angle_between(held.rotation, seen.rotation) <= settings().filter.turn;
    return allowed ? seen : held;
}

// Before any state of a message is believed: the same eyes have seen all of them.
void OperatorSide::note_forbidden(const SessionLoop& loop, SessionHandle body, const Pose& seen) {
    const Pose held = on_joints(loop, body, seen);
    if (held.position != seen.position || held.rotation != seen.rotation) {
        eyes_.note_forbidden(settings().filter, seen, held);
    }
}

// How a body has come from its last state to this one: as the model's did, which may have begun and ended
// with other velocities. Of that difference only the ends are known; somewhere in between it changed.
PoseStep OperatorSide::step_to(SessionHandle body, SampleSequence sample, const BodyMotion& received) const {
    constexpr double of_unknown = 0.2;  // a hand that is silent does not tell the time (unit: seconds)
    const double spread = 1.0 / std::sqrt(12.0);
    const Truth& last = truths_.of(body);
    if (last.packet == 0 || last.sample == no_sample || sample <= last.sample) {
        return {Vec3(0.0), Quat(1.0, 0.0, 0.0, 0.0), of_unknown * glm::length(received.linear_velocity),
                of_unknown * glm::length(received.angular_velocity)};
    }
    const double seconds = static_cast<double>(sample - last.sample) * seconds_;
    const std::uint32_t place = truths_.place_of(body);
    const BodyMotion* const end = past_.motion(place, sample);
    const BodyMotion* start = past_.motion(place, last.sample);
    if (start && resimulator_.goes_on_from(body) == last.sample) {
        start = &last.motion;
    }
    const bool known = start && end;
    const BodyMotion from = known ? *start : BodyMotion{};
    const BodyMotion to = known ? *end : BodyMotion{};
    const Vec3 at_start = last.motion.linear_velocity - from.linear_velocity;
    const Vec3 at_end = received.linear_velocity - to.linear_velocity;
    const Vec3 spin_at_start = last.motion.angular_velocity - from.angular_velocity;
    const Vec3 spin_at_end = received.angular_velocity - to.angular_velocity;
    PoseStep step;
    step.way = to.pose.position - from.pose.position + 0.5 * seconds * (at_start + at_end);
    step.turn = turn_by(0.5 * (spin_at_start + spin_at_end), seconds) * to.pose.rotation *
                glm::conjugate(from.pose.rotation);
    step.open_way = spread * seconds * glm::length(at_end - at_start);
    step.open_turn = spread * seconds * glm::length(spin_at_end - spin_at_start);
    return step;
}

}  // namespace tactus
