#include "nodes/haptic_effect.hpp"

#include <cmath>
#include <godot_cpp/variant/utility_functions.hpp>

#include "nodes/conversions.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_choice.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "platform/clock.hpp"

namespace tactus {

using namespace godot;

namespace {

// How far from where it is, and how much faster, the hand is thought to be, to see how the force changes
// (units: meters, meters per second).
constexpr double look_aside = 1e-3;
constexpr double look_faster = 1e-2;

// So many frames above the budget in a row, or one that is so many times above it.
constexpr int late_in_a_row = 5;
constexpr double far_too_late = 100.0;

}  // namespace

const ProxyPointer* HapticEffect::proxy_node() const {
    return chosen_proxy(*this, proxy_);
}

String HapticEffect::problem() const {
    if (!enabled_) {
        return String();
    }
    const String without_proxy = problem_of_proxy(*this, proxy_);
    if (!without_proxy.is_empty() || has_method(method_)) {
        return without_proxy;
    }
    return "its script has no method '" + method_ +
           "': write one that answers with a force, a Vector3 in newtons";
}

PackedStringArray HapticEffect::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        warn(warnings, "This HapticEffect gives no force", problem_without_world(*this));
        warn(warnings, "This HapticEffect gives no force", problem());
    }
    return warnings;
}

String HapticEffect::get_state_text() const {
    if (!enabled_) {
        return why_off_.is_empty() ? String("off") : why_off_;
    }
    const String wrong = problem();
    return wrong.is_empty() ? String("working") : wrong;
}

void HapticEffect::enabled_changed() {
    why_off_ = String();
    late_ = 0;
    update_configuration_warnings();
}

std::optional<FieldMoment> HapticEffect::look(const HandMotion& hand, double time) {
    if (!enabled_ || !problem().is_empty()) {
        return std::nullopt;
    }
    FieldMoment moment;
    moment.place = hand.position;
    moment.velocity = hand.velocity;
    const Nanoseconds begun = monotonic_now();
    bool is_sound = ask(hand, time, moment.force);
    for (int axis = 0; axis < 3 && is_sound; ++axis) {
        HandMotion aside = hand, faster = hand;
        aside.position[axis] += look_aside;
        faster.velocity[axis] += look_faster;
        Vec3 there(0.0), then(0.0);
        is_sound = ask(aside, time, there) && ask(faster, time, then);
        moment.by_place[axis] = (there - moment.force) / look_aside;
        moment.by_velocity[axis] = (then - moment.force) / look_faster;
    }
    taken_ = monotonic_now() - begun;
    if (is_sound) {
        watch_time();
    }
    return enabled_ ? std::optional(moment) : std::nullopt;
}

bool HapticEffect::ask(const HandMotion& hand, double time, Vec3& force) {
    const Variant answer = call(method_, to_godot(hand.position), to_godot(hand.velocity), time);
    const bool is_vector = answer.get_type() == Variant::VECTOR3;
    force = is_vector ? from_godot(static_cast<Vector3>(answer)) : Vec3(0.0);
    if (!is_vector) {
        switch_off("'" + method_ +
                   "' has not answered with a Vector3: it is switched off; let it, and switch 'enabled' on");
    } else if (!std::isfinite(force.x + force.y + force.z)) {
        switch_off("'" + method_ +
                   "' has answered with a force that is not finite: it is switched off; see what it divides "
                   "by, and switch 'enabled' on");
    }
    return enabled_;
}

void HapticEffect::watch_time() {
    const double budget = 1e-3 * budget_ms_;
    const double taken = to_seconds(taken_);
    late_ = taken > budget ? late_ + 1 : 0;
    if (late_ >= late_in_a_row || taken > far_too_late * budget) {
        switch_off("its script took " + String::num(get_time_ms(), 1) +
                   " ms in a frame, more than its budget of " + String::num(budget_ms_, 1) +
                   " ms: it is switched off; make it shorter or raise 'budget_ms', and switch 'enabled' on");
    }
}

void HapticEffect::switch_off(const String& why) {
    enabled_ = false;
    why_off_ = why;
    UtilityFunctions::push_warning(name_of(*this), ": ", why, ".");
    post_signal(*this, "switched_off", {why});
}

void HapticEffect::_notification(int what) {
    keep_roll(*this, what);
}

}  // namespace tactus
