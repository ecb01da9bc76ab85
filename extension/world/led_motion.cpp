#include "world/led_motion.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

namespace tactus {

namespace {

// Accelerations that the model does without: less than a hand notices of a kilogram (units: meters per square
// second, radians per square second).
constexpr double least_pull = 0.05;
constexpr double least_spin_up = 0.5;

// An engine that is late makes up for so many frames, and loses the rest of the time (Godot, unless
// Engine.max_physics_steps_per_frame is another number).
constexpr double most_frames_at_once = 8.0;

// What both say, axis by axis: the smaller one where the signs agree, else nothing.
Vec3 agreed(const Vec3& a, const Vec3& b, double least) {
    Vec3 both(0.0);
    for (int i = 0; i < 3; ++i) {
        const double size = std::min(std::abs(a[i]), std::abs(b[i]));
        both[i] = a[i] * b[i] > 0.0 && size > least ? std::copysign(size, a[i]) : 0.0;
    }
    return both;
}

// A body whose velocity changes evenly from `begin` to `end`, in ticks, goes so much farther in `seconds`
// than the model, which went by `way`.
Vec3 beyond(const Vec3& begin, const Vec3& end, const Vec3& way, double seconds, double tick) {
    return 0.5 * seconds * (begin + end) + 0.5 * tick * (end - begin) - way;
}

// An engine's own solver may fail for some frames.
bool is_finite(const BodyMotion& motion) {
    const Vec3 sums = motion.pose.position + motion.linear_velocity + motion.angular_velocity;
    const Quat& q = motion.pose.rotation;
    return std::isfinite(sums.x + sums.y + sums.z + q.w + q.x + q.y + q.z);
}

void correct(BodyCorrection& correction, const BodyMotion& truth, const BodyMotion& model) {
    correction.by = truth.pose.position - model.pose.position;
    correction.turn = turn_vector(truth.pose.rotation * glm::conjugate(model.pose.rotation));
    correction.linear = truth.linear_velocity - model.linear_velocity;
    correction.angular = truth.angular_velocity - model.angular_velocity;
}

// The model has had the correction `had` since it was compared, and changed by `change` meanwhile. Of `next`,
// what takes back of `had` what the model has lost by itself. What hands take from it is no loss: the
// engine's body will have that, too.
Vec3 taken_back(const Vec3& next, const Vec3& had, const Vec3& change) {
    const double size = glm::dot(had, had);
    if (!(size > 0.0)) {
        return Vec3(0.0);
    }
    const double lost = std::clamp(1.0 - glm::dot(change, had) / size, 0.0, 1.0);
    return had * -std::clamp(-glm::dot(next, had) / size, 0.0, lost);
}

}  // namespace

BodyMotion LedMotion::expected() const {
    const BodyCorrection& in_it = before_.corrected;
    return {shifted(before_.motion.pose, sent_.by - in_it.by, turn_by(sent_.turn - in_it.turn, 1.0)),
            before_.motion.linear_velocity + sent_.linear - in_it.linear,
            before_.motion.angular_velocity + sent_.angular - in_it.angular};
}

void LedMotion::leave_what_is_lost(BodyCorrection& next, const LedState& model) const {
    const BodyMotion &then = before_.motion, &now = model.motion;
    const BodyCorrection &had = before_.corrected, &has = model.corrected;
    const Vec3 by = now.pose.position - then.pose.position - (model.way - before_.way);
    const Vec3 turn =
        turn_vector(now.pose.rotation * glm::conjugate(then.pose.rotation)) - (model.turned - before_.turned);
    next.by -= taken_back(next.by, has.by - had.by, by);
    next.turn -= taken_back(next.turn, has.turn - had.turn, turn);
    const Vec3 pushed = before_.mass > 0.0 ? (model.impulse - before_.impulse) / before_.mass : Vec3(0.0);
    const Vec3 linear = now.linear_velocity - then.linear_velocity - pushed;
    next.linear -= taken_back(next.linear, has.linear - had.linear, linear);
    const Vec3 angular = now.angular_velocity - then.angular_velocity - (model.spun - before_.spun);
    next.angular -= taken_back(next.angular, has.angular - had.angular, angular);
}

// The model as it was one frame ago had been pushed by what the engine's body shows now. Of `besides`, by
// which the engine's velocity has changed more than the model's, returns what is not of its mass.
Vec3 LedMotion::without_mass(const Vec3& besides, bool is_seen) {
    if (before_.mass <= 0.0) {
        return besides;
    }
    const double told = before_.mass / before_.corrected.mass;
    const Vec3 change = besides + pushed_ / before_.mass;
    if (is_seen) {
        mass_.note(pushed_, change, told);
    }
    return change - pushed_ / (told * mass_.factor());
}

void LedMotion::note_unknown(const Vec3& besides, const Vec3& angular, double seconds) {
    const Vec3 unknown = besides / seconds;
    const Vec3 unknown_spin = spin_up_before_ + angular / seconds;
    pull_before_ = std::exchange(pull_, agreed(unknown, std::exchange(unknown_, unknown), least_pull));
    spin_up_before_ = std::exchange(
        spin_up_, agreed(unknown_spin, std::exchange(unknown_spin_, unknown_spin), least_spin_up));
}

// Where the model is that has come as far as the engine's body.
BodyMotion LedMotion::without_lead(const BodyMotion& body, double lead) const {
    const Vec3 by = lead * body.linear_velocity + ahead_;
    const Vec3 turn = lead * body.angular_velocity + ahead_turn_;
    return {shifted(body.pose, -by, turn_by(-turn, 1.0)), body.linear_velocity, body.angular_velocity};
}

void LedMotion::note_lead(const LedState& model, double seconds, double tick) {
    constexpr double kept = 0.98;  // from one frame to the next
    const double time = model.seconds - before_.seconds;
    const double late = kept * late_;
    late_ = std::clamp(late + seconds - time, -seconds, seconds);
    const double compared = time + late_ - late;
    const BodyMotion &then = before_.motion, &now = model.motion;
    const BodyCorrection &sent = model.corrected, &had = before_.corrected;
    const Vec3 linear = then.linear_velocity + sent.linear - had.linear;
    const Vec3 angular = then.angular_velocity + sent.angular - had.angular;
    ahead_ = kept * ahead_ + beyond(linear, now.linear_velocity, model.way - before_.way, compared, tick);
    ahead_turn_ = kept * ahead_turn_ +
                  beyond(angular, now.angular_velocity, model.turned - before_.turned, compared, tick);
}

LedMotion::Frame LedMotion::frame(const BodyMotion& engines, const LedState& model, double seconds,
                                  double tick) {
    if (!is_finite(engines)) {
        return {};
    }
    const BodyMotion truth = without_lead(engines, 0.5 * std::max(0.0, seconds - tick));
    Frame frame;
    // What hands did in the time that the engine loses is lost with it: else a body flies away that was
    // pressed against friction meanwhile.
    const double kept =
        std::min(1.0, most_frames_at_once * seconds / std::max(seconds, model.seconds - before_.seconds));
    frame.impulse = kept * (model.impulse - std::exchange(given_, model.impulse));
    frame.turn = kept * (model.turn - std::exchange(given_turn_, model.turn));
    BodyCorrection& correction = frame.correction;
    if (std::exchange(is_known_, true)) {
        const BodyMotion model_then = expected();
        if (differs(truth, model_then, MotionThreshold{})) {
            correct(correction, truth, model_then);
            leave_what_is_lost(correction, model);
        }
        const bool was_put_there =
            glm::length(correction.by) > farthest_way + seconds * glm::length(truth.linear_velocity) ||
            glm::length(correction.turn) > farthest_turn;
        correction.seconds = was_put_there ? 0.0 : seconds;
        const Vec3 pull = pull_, spin_up = spin_up_;
        const double mass = mass_.factor();
        const bool is_even = std::abs(late_) < 0.5 * seconds;  // else pushes of several frames come in one
        const Vec3 besides = correction.linear + pull_before_ * seconds;
        note_unknown(without_mass(besides, !was_put_there && is_even), correction.angular, seconds);
        correction.mass = mass_.factor();
        correction.acceleration = pull_;
        correction.spin_up = spin_up_;
        frame.corrects = pull_ != pull || spin_up_ != spin_up || mass_.factor() != mass ||
                         glm::length(correction.by) + glm::length(correction.turn) +
                                 glm::length(correction.linear) + glm::length(correction.angular) >
                             0.0;
        sent_.by += correction.by;
        sent_.turn += correction.turn;
        sent_.linear += correction.linear;
        sent_.angular += correction.angular;
        note_lead(model, seconds, tick);
    }
    before_ = model;
    pushed_ = frame.impulse;
    return frame;
}

}  // namespace tactus
