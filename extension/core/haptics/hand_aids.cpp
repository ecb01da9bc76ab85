#include "core/haptics/hand_aids.hpp"

#include <algorithm>
#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>
#include <utility>

namespace tactus {

bool are_same_aids(const HandAids& a, const HandAids& b) {
    return a.guide_count == b.guide_count && std::ranges::equal(a.guides, b.guides, is_same_guide) &&
           a.effects == b.effects;
}

std::string check_aids(const HandAids& aids) {
    if (aids.guide_count > HandAids::most_guides) {
        return "a hand has more than four guides: take some away";
    }
    if (aids.effects.count > HandEffects::most) {
        return "a hand has more than eight effects: take some away";
    }
    std::string error;
    for (std::size_t i = 0; i < aids.guide_count && error.empty(); ++i) {
        error = check_guide(aids.guides[i]);
    }
    for (std::size_t i = 0; i < aids.effects.count && error.empty(); ++i) {
        error = check_effect(aids.effects.items[i]);
    }
    return error;
}

const Pose& FollowedFrame::follow(const Pose& target) {
    if (!std::exchange(is_there_, true)) {
        now_ = target_ = target;
    }
    if (target.position != target_.position || target.rotation != target_.rotation) {
        target_ = target;
        ticks_left_ = std::clamp(since_, 1, longest);
        since_ = 0;
    }
    since_ = std::min(since_ + 1, longest);
    if (ticks_left_ > 0) {
        const double share = 1.0 / ticks_left_--;
        now_.position += (target_.position - now_.position) * share;
        now_.rotation = glm::slerp(now_.rotation, target_.rotation, share);
    }
    return now_;
}

namespace {

// Over a bend of a way the place that it leads to may jump where the hand does not.
AidForce guides_force(const HandAids& aids, const AidedHand& hand, AidMemory& memory) {
    AidForce led;
    double wanted = 0.0;
    for (std::size_t i = 0; i < aids.guide_count; ++i) {
        wanted += steepest(aids.guides[i]);
    }
    led.wall.stiffness = safe_wall(hand.lag, 0.5 * hand.damping, {wanted, 0.0}).stiffness;
    const double safe = wanted > 0.0 ? led.wall.stiffness / wanted : 1.0;
    for (std::size_t i = 0; i < aids.guide_count; ++i) {
        const HandGuide& guide = aids.guides[i];
        if (guide.form == HandGuide::Form::none) {
            continue;
        }
        AidMemory::Guided& before = memory.guides[i];
        const Pose& frame = before.frame.follow(guide.frame);
        const Vec3 here = to_local(frame, hand.motion.position);
        const Vec3 place = guided_place(guide, here);
        const double way = glm::distance(here, std::exchange(before.hand, here));
        const double led_on = glm::distance(place, std::exchange(before.place, place));
        constexpr double rounding = 1e-6;  // (unit: meters)
        led.jumped = led.jumped || led_on > 2.0 * way + rounding;
        led.force += direction_to_parent(
            frame, guide_force(guide.mode, here - place, guide.range, safe * guide.stiffness));
    }
    for (std::size_t i = aids.guide_count; i < HandAids::most_guides; ++i) {
        memory.guides[i] = {};
    }
    led.damping = hand.damping - damping_needed(led.wall.stiffness, hand.lag);
    return led;
}

}  // namespace

AidForce aid_force(const HandAids& aids, const AidedHand& hand, HandField& field, AidMemory& memory) {
    const AidForce led = guides_force(aids, hand, memory);
    const HandEffects& effects = aids.effects;
    const Wall computed = field.begin_tick(hand.now, hand.max_force);
    Wall wanted = computed;
    for (std::size_t i = 0; i < effects.count; ++i) {
        const Wall steep = steepest(effects.items[i]);
        wanted.stiffness += steep.stiffness;
        wanted.damping += steep.damping;
    }
    const Wall bounded{std::min(wanted.stiffness, HandField::stiffest), wanted.damping};
    const Wall wall = safe_wall(hand.lag, 0.5 * led.damping, bounded);
    const double stiff = wanted.stiffness > 0.0 ? wall.stiffness / wanted.stiffness : 1.0;
    const double damped = wanted.damping > 0.0 ? wall.damping / wanted.damping : 1.0;
    const Wall safe{computed.stiffness * stiff, computed.damping * damped};
    Vec3 force = field.force(hand.motion, effects.count > 0 ? safe : wall, hand.max_damping);
    for (std::size_t i = 0; i < effects.count; ++i) {
        force +=
            effect_force(weakened(effects.items[i], stiff, damped), hand.motion, hand.now, memory.effects[i]);
    }
    for (std::size_t i = effects.count; i < HandEffects::most; ++i) {
        memory.effects[i] = {};  // what comes next begins anew
    }
    return {led.force + force,
            {led.wall.stiffness + wall.stiffness, wall.damping},
            led.damping - damping_needed(wall.stiffness, hand.lag) - wall.damping,
            led.jumped};
}

}  // namespace tactus
