#include "nodes/haptic_effect.hpp"

#include <cmath>
#include <godot_cpp/variant/utility_functions.hpp>

#include "nodes/conversions.hpp"
#include "nodes/haptic_tool.hpp"
#include "nodes/haptic_world.hpp"
#include "nodes/messages.hpp"
#include "nodes/proxy_choice.hpp"
#include "nodes/proxy_pointer.hpp"
#include "nodes/roll.hpp"
#include "nodes/scene_warnings.hpp"
#include "nodes/signals.hpp"
#include "platform/clock.hpp"

namespace tactus {

using namespace godot;

const Node3D* HapticEffect::hand_node() const {
    return chosen_hand(*this, proxy_);
}

String HapticEffect::problem() const {
    if (!enabled_) {
        return String();
    }
    const String without_proxy = problem_of_hand(*this, proxy_);
    if (!without_proxy.is_empty()) {
        return without_proxy;
    }
    const String of_formula = formula_.is_valid() ? formula_->get_problem() : String();
    if (!of_formula.is_empty()) {
        return of_formula;
    }
    if (guide_.is_valid()) {
        return guide_->get_problem();
    }
    if (formula_.is_valid() || has_method(method_)) {
        return String();
    }
    return "its script has no method '" + method_ +
           "': set 'formula' or 'guide', or write one that answers with a force, a Vector3 in newtons";
}

String HapticEffect::hindrance() const {
    const String wrong = problem();
    return wrong.is_empty() && enabled_ ? without_room_ : wrong;
}

PackedStringArray HapticEffect::_get_configuration_warnings() const {
    PackedStringArray warnings;
    if (is_inside_tree()) {
        warn(warnings, "This HapticEffect gives no force", problem_without_world(*this));
        warn(warnings, "This HapticEffect gives no force", hindrance());
    }
    return warnings;
}

HapticEffect::State HapticEffect::get_state() const {
    if (!enabled_) {
        return why_off_.is_empty() ? STATE_OFF : STATE_FAILED;
    }
    const bool has_world = HapticWorld::of(this) != nullptr;
    return state_of<State>(!hindrance().is_empty(), has_world, has_world);
}

String HapticEffect::get_state_text() const {
    if (!enabled_) {
        return why_off_.is_empty() ? String("off") : why_off_;
    }
    const String wrong = hindrance();
    if (!wrong.is_empty()) {
        return wrong;
    }
    const auto* const proxy = Object::cast_to<ProxyPointer>(hand_node());
    const auto* const tool = Object::cast_to<HapticTool>(hand_node());
    const bool is_limited =
        (proxy != nullptr && proxy->is_field_limited()) || (tool != nullptr && tool->is_field_limited());
    return is_limited
               ? String(
                     "working, weaker than its script says: its force leaps, or changes within a short way, "
                     "more steeply than is safe; let it rise over a longer way, or use a body")
               : String("working");
}

void HapticEffect::enabled_changed() {
    why_off_ = String();
    budget_.forget();
    told_.tell(*this);
    update_configuration_warnings();
}

bool HapticEffect::is_on() const {
    return enabled_ && problem().is_empty();
}

// Of the node above it; the world's where that is the hand itself, which moves.
Transform3D HapticEffect::frame() const {
    const auto* const above = Object::cast_to<Node3D>(get_parent());
    return above != nullptr && !is_hand(above) ? above->get_global_transform() : Transform3D();
}

std::optional<HandEffect> HapticEffect::closed_form() const {
    return formula_.is_valid() && is_on() ? std::optional(formula_->effect(frame())) : std::nullopt;
}

std::optional<HandGuide> HapticEffect::placed_guide() const {
    return guide_.is_valid() && is_on() ? std::optional(guide_->guide(frame())) : std::nullopt;
}

bool HapticEffect::begin_frame() {
    told_.tell(*this);
    taken_ = 0;
    return enabled_ && has_method(method_) && problem().is_empty();
}

bool HapticEffect::end_frame() {
    if (enabled_ && budget_.is_overdrawn(to_seconds(taken_), time_budget_)) {
        switch_off(
            "its script took " + String::num(get_time_ms(), 1) + " ms in a frame, more than its budget of " +
            String::num(1e3 * time_budget_, 1) +
            " ms: it is switched off; make it shorter or raise 'time_budget', and switch 'enabled' on");
    }
    return enabled_;
}

// Nothing where it is switched off by that.
std::optional<Vec3> HapticEffect::ask(const HandMotion& hand, double time) {
    const Nanoseconds begun = monotonic_now();
    const Variant answer = call(method_, to_godot(hand.position), to_godot(hand.velocity), time);
    taken_ += monotonic_now() - begun;
    const bool is_vector = answer.get_type() == Variant::VECTOR3;
    const Vec3 force = is_vector ? from_godot(static_cast<Vector3>(answer)) : Vec3(0.0);
    if (!is_vector) {
        switch_off("'" + method_ +
                   "' has not answered with a Vector3: it is switched off; let it, and switch 'enabled' on");
    } else if (!std::isfinite(force.x + force.y + force.z)) {
        switch_off("'" + method_ +
                   "' has answered with a force that is not finite: it is switched off; see what it divides "
                   "by, and switch 'enabled' on");
    }
    return enabled_ ? std::optional(force) : std::nullopt;
}

void HapticEffect::switch_off(const String& why) {
    enabled_ = false;
    why_off_ = why;
    UtilityFunctions::push_warning(name_of(*this), ": ", why, ".");
    post_signal(*this, "switched_off", {why});
    told_.tell(*this);
}

void HapticEffect::_notification(int what) {
    keep_roll(*this, what);
}

}  // namespace tactus
