#include "world/led_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace tactus {

namespace {

// Accelerations that the model does without: less than a hand notices of a kilogram (units: meters per square
// second, radians per square second).
constexpr double least_pull = 0.05;
constexpr double least_spin_up = 0.5;

// What both say, axis by axis: the smaller one where the signs agree, else nothing.
Vec3 agreed(const Vec3& a, const Vec3& b, double least) {
    Vec3 both(0.0);
    for (int i = 0; i < 3; ++i) {
        const double size = std::min(std::abs(a[i]), std::abs(b[i]));
        both[i] = a[i] * b[i] > 0.0 && size > least ? std::copysign(size, a[i]) : 0.0;
    }
    return both;
}

}  // namespace

BodyMotion LedMotion::expected() const {
    const BodyCorrection& in_it = before_.corrected;
    return {shifted(before_.motion.pose, sent_.by - in_it.by, turn_by(sent_.turn - in_it.turn, 1.0)),
            before_.motion.linear_velocity + sent_.linear - in_it.linear,
            before_.motion.angular_velocity + sent_.angular - in_it.angular};
}

LedMotion::Frame LedMotion::frame(const BodyMotion& truth, const LedState& model, double seconds) {
    Frame frame;
    frame.impulse = model.impulse - std::exchange(given_, model.impulse);
    frame.turn = model.turn - std::exchange(given_turn_, model.turn);
    if (!std::exchange(is_known_, true)) {
        before_ = model;
        return frame;
    }
    const BodyMotion model_then = expected();
    BodyCorrection& correction = frame.correction;
    correction.acceleration = pull_;
    correction.spin_up = spin_up_;
    if (differs(truth, model_then, MotionThreshold{})) {
        correction.by = truth.pose.position - model_then.pose.position;
        correction.turn = turn_vector(truth.pose.rotation * glm::conjugate(model_then.pose.rotation));
        correction.linear = truth.linear_velocity - model_then.linear_velocity;
        correction.angular = truth.angular_velocity - model_then.angular_velocity;
    }
    const bool was_put_there =
        glm::length(correction.by) > farthest_way + seconds * glm::length(truth.linear_velocity) ||
        glm::length(correction.turn) > farthest_turn;
    correction.seconds = was_put_there ? 0.0 : seconds;
    const Vec3 unknown = pull_before_ + correction.linear / seconds;
    const Vec3 unknown_spin = spin_up_before_ + correction.angular / seconds;
    pull_before_ = std::exchange(pull_, agreed(unknown, std::exchange(unknown_, unknown), least_pull));
    spin_up_before_ = std::exchange(
        spin_up_, agreed(unknown_spin, std::exchange(unknown_spin_, unknown_spin), least_spin_up));
    frame.corrects = pull_ != correction.acceleration || spin_up_ != correction.spin_up ||
                     glm::length(correction.by) + glm::length(correction.turn) +
                             glm::length(correction.linear) + glm::length(correction.angular) >
                         0.0;
    correction.acceleration = pull_;
    correction.spin_up = spin_up_;
    sent_.by += correction.by;
    sent_.turn += correction.turn;
    sent_.linear += correction.linear;
    sent_.angular += correction.angular;
    before_ = model;
    return frame;
}

}  // namespace tactus
