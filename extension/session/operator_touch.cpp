// How the operator's side puts the model right, and what its hand is given.
#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <utility>

#include "core/safety/limited_force.hpp"
#include "session/operator_side.hpp"

namespace tactus {

namespace {

// Of a pointer that rests on nothing that says otherwise (unit: newtons per meter).
constexpr double usual_stiffness = 500.0;

SurfaceSpring spring_under(const SessionLoop& loop, const ProxyState& state) {
    const SessionLoop::Body* const under = state.contact_count > 0 ? loop.body(state.bodies[0]) : nullptr;
    if (!under) {
        const double alike = state.contact_count > 0 ? usual_stiffness : 0.0;
        return {alike, alike};
    }
    const SurfaceSpring spring = spring_of(loop.scene().body(under->slot).material);
    const double stiffer = std::max(1.0, spring.stiffness);
    return spring.is_linear() ? SurfaceSpring{stiffer, stiffer} : spring;
}

// A body that has gone so much farther than its rates say has been put there (unit: meters; a share of its
// way, since rates change within a tick, too).
constexpr double leap = 2e-4, leap_share = 0.5;

// A far side that has heard nothing more of the hand for so long has lost it (unit: seconds).
constexpr double usual_silence = 0.5;

}  // namespace

double change_to_come(const TouchedBody& before, const TouchedBody& now, double force) {
    const double rubbed = std::max(0.0, now.friction - before.friction);
    const double heavier =
        before.mass > 0.0 && now.mass > 0.0 ? std::abs(now.mass - before.mass) / before.mass : 0.0;
    return std::max(rubbed, heavier) * force;
}

std::uint32_t felt_status(FeltState state) {
    switch (state) {
        case FeltState::together:
            return 0;
        case FeltState::carried:
            return felt_carried;
        case FeltState::bridged:
            return felt_bridged;
        case FeltState::letting_go:
            return felt_letting_go;
    }
    return 0;
}

// --- correcting

// What would be felt in this tick without a correction. True where a pointer has just come to touch
// something: a correction would have to hide a force that nobody has felt yet; it waits for the next tick.
bool OperatorSide::lands(SessionLoop& loop, Nanoseconds now) {
    bool any = false;
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (!slot.present()) {
            continue;
        }
        Pointer& pointer = pointers_[i];
        const Proxy& proxy = pointer.carried.apart() ? *pointer.carried.slot().proxy : *slot.proxy;
        const bool was_free = proxy.touching().empty();
        pointer.uncorrected = force_uncorrected(loop, pointer, slot, now);
        any = any || (was_free && glm::length(pointer.uncorrected.force) > no_force);
    }
    const bool tools = tools_land(loop);
    any = any || tools;
    return any && is_stealthy(settings().correction);
}

// The pointers are left as they were.
SessionLoop::SceneForce OperatorSide::force_uncorrected(SessionLoop& loop, Pointer& pointer,
                                                        SessionLoop::ProxySlot& slot, Nanoseconds now) const {
    const auto try_out = [&](SessionLoop::ProxySlot& tried) {
        const ProxyMemory memory = tried.proxy->memory();
        const EffectMemory effects = tried.effects;
        const AidMemory aids = tried.aids;
        const Vec3 before = tried.force;
        tried.force_before = before;
        loop.touch(tried, now);
        const SessionLoop::SceneForce found = tried.scene_force();
        tried.proxy->recall(memory);
        tried.effects = effects;
        tried.aids = aids;
        tried.force = before;
        return found;
    };
    if (!pointer.carried.apart()) {
        return try_out(slot);
    }
    SessionLoop::ProxySlot& felt = pointer.carried.slot();
    felt.hand = slot.hand + pointer.carried.offset();
    felt.hand_velocity = slot.hand_velocity;
    return try_out(felt);
}

void OperatorSide::correct(SessionLoop& loop, Nanoseconds) {
    ++statistics_.corrections;
    corrected_ = true;
    const bool with_velocity = settings().correction != Correction::pose;
    const bool turns = settings().correction == Correction::stealthy_turn;
    for (const Target& target : targets_) {
        const Pose from = loop.scene().body(loop.body(target.body)->slot).pose;
        const Pose motion = displacement(from, target.motion.pose);
        statistics_.cost.moved =
            std::max(statistics_.cost.moved, glm::length(target.motion.pose.position - from.position));
        if (settings().correction == Correction::passive) {
            charge_motion(loop, target);
        }
        bool rides = false;
        for (std::size_t i = 0; i < max_proxies && is_carrying(settings().correction); ++i) {
            if (const SessionLoop::ProxySlot& slot = loop.proxy(i);
                slot.present() && pointers_[i].carried.has_room()) {
                rides |= pointers_[i].carried.carry(loop, slot, target, motion, turns,
                                                    settings().stealth.longest_offset);
            }
        }
        loop.put_right(target.body, target.motion, with_velocity, rides,
                       target.previous_known ? &target.previous : nullptr);
    }
    // The pointers and tools that press go on from where the replay has led them.
    const bool replayed = std::ranges::any_of(targets_, &Target::previous_known);
    if (replayed) {
        recall_tools(loop);
    }
    for (std::size_t i = 0; i < max_proxies && replayed; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.proxy && resimulator_.twin()->proxy(i).proxy) {
            slot.proxy->recall(resimulator_.twin()->proxy(i).proxy->memory());
        }
    }
}

// What a correction gives a body in speed, whoever touches it may get.
void OperatorSide::charge_motion(SessionLoop& loop, const Target& target) {
    const Vec3 before = loop.motion(target.body).linear_velocity;
    const Vec3& after = target.motion.linear_velocity;
    const double energy = 0.5 * loop.mass(target.body) * (glm::dot(after, after) - glm::dot(before, before));
    for (std::size_t i = 0; i < max_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (slot.present() && loop.rests_on(*slot.proxy, target.body)) {
            pointers_[i].update.sped_up(energy);
        }
    }
}

// --- feeling

void OperatorSide::set_forces(SessionLoop& loop, Nanoseconds now) {
    statistics_.offset = 0.0;
    statistics_.energy = {};  // the sum over all pointers
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        Pointer& pointer = pointers_[i];
        if (!slot.present()) {
            pointer.felt.forget();
            pointer.carried.forget();
            pointer.update.forget();
            pointer.known = false;
            slot.fading.clear();
            continue;
        }
        feel(loop, i, slot, now);
    }
    feel_tools(loop);
}

// What touch leaps by, a pointer that slips off an edge, say, fades as it does where the scene is. What a
// correction or another change makes of the force is hidden instead: it is no leap of touch.
Vec3 OperatorSide::modelled_force(SessionLoop& loop, Pointer& pointer, SessionLoop::ProxySlot& slot,
                                  bool changed, Nanoseconds now) {
    CarriedPointer& carried = pointer.carried;
    const bool apart = carried.apart();
    if (apart) {
        carried.touch(loop, slot, now);
    }
    const SessionLoop::SceneForce touched = apart ? carried.slot().scene_force() : slot.scene_force();
    SessionLoop::SceneForce& expected = pointer.uncorrected;
    if (!corrected_) {
        expected = touched;
    }
    const double limit = loop.force_limit(slot);
    expected.force = limited_force(
        slot.fading.felt(expected.force, limit, expected.jumped && !changed, expected.step), limit);
    const Vec3 force = slot.fading.goes_on_with(touched.force, limit);
    if (!apart) {
        return force;
    }
    const double stiffness = std::max(spring_under(loop, carried.slot().state).steepest(), usual_stiffness);
    const double way = carried.slot().state.contact_count == 0
                           ? settings().stealth.free_speed * seconds_
                           : unnoticed_change(settings().stealth, glm::length(force), seconds_) / stiffness;
    slot.state = carried.slot().state;
    slot.state.hand = slot.hand;
    carried.fade(way);
    if (!carried.apart()) {
        const Vec3 together = slot.fading.goes_on_with(slot.force, limit);
        pointer.felt.hide(limited_force(force, limit), limited_force(together, limit));
        return together;
    }
    return force;
}

// What the far side has answered last.
OperatorPassivity::In OperatorSide::heard(std::size_t index) const {
    const TraditionalTouch::Far& far = traditional_.far(index);
    OperatorPassivity::In in;
    in.far_force = far.force;
    in.far_sample = far.sample;
    in.far_taken = far.taken;
    in.seconds = seconds_;
    return in;
}

// The far side's force, as much of it as makes no energy.
Vec3 OperatorSide::passive_force(std::size_t index, const SessionLoop::ProxySlot& slot, bool answers) {
    OperatorPassivity& passivity = pointers_[index].passivity;
    OperatorPassivity::In in = heard(index);
    in.sample = sample_;
    in.hand = slot.hand;
    in.velocity = slot.hand_velocity;
    if (!answers) {
        passivity.rest(settings().passivity, settings().passive, in);
        return Vec3(0.0);
    }
    return passivity.force(settings().passivity, settings().passive, in);
}

// What has left for the device is what the hand has felt, and what the far side is told of.
void OperatorSide::note_given(SessionLoop& loop, std::size_t index) {
    Pointer& pointer = pointers_[index];
    const SessionLoop::ProxySlot& slot = loop.proxy(index);
    const Vec3 before = std::exchange(pointer.force, loop.given_force(slot));
    const double step = glm::distance(pointer.force, before) - slot.own_change;
    statistics_.largest_unexplained_step = std::max(statistics_.largest_unexplained_step, step);
    pointer.passivity.given(settings().passive, pointer.force, seconds_);
}

// Whether what is touched is not where its motion leads: a joint, say, has put it there.
template <typename State>
bool OperatorSide::has_leapt(SessionLoop& loop, const State& touch) const {
    if (settings().traditional) {
        return false;
    }
    for (int i = 0; i < touch.contact_count; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const SessionLoop::Body* const body = loop.body(touch.bodies[at]);
        if (!body || body->motion != Motion::Dynamic) {
            continue;
        }
        const TouchBody& touched = loop.scene().body(body->slot);
        const Vec3& point = touch.points[at];
        const double way = glm::distance(to_parent(touched.pose, to_local(touched.previous, point)), point);
        const BodyMotion motion = loop.motion(touch.bodies[at]);
        const double speed =
            glm::length(motion.linear_velocity) +
            glm::length(motion.angular_velocity) * glm::distance(point, touched.pose.position);
        if (way > (1.0 + leap_share) * speed * seconds_ + leap) {
            return true;
        }
    }
    return false;
}
template bool OperatorSide::has_leapt(SessionLoop&, const ProxyState&) const;
template bool OperatorSide::has_leapt(SessionLoop&, const ToolState&) const;

// With a deadband it may be that nothing needs saying, and some of what is said is lost (unit: ticks).
SampleSequence OperatorSide::silence() const {
    const double silence =
        settings().deadband.enabled ? 5.0 * to_seconds(settings().deadband.longest_silence) : usual_silence;
    return static_cast<SampleSequence>(silence / seconds_);
}

void OperatorSide::feel(SessionLoop& loop, std::size_t index, SessionLoop::ProxySlot& slot, Nanoseconds now) {
    Pointer& pointer = pointers_[index];
    const Vec3 way = pointer.known ? slot.hand - pointer.hand : Vec3(0.0);
    bool changed = changed_ || (!corrected_ && has_leapt(loop, slot.state));
    FeltInput in;
    SurfaceSpring spring;
    in.hand_velocity = way / seconds_;
    in.seconds = seconds_;
    if (settings().traditional) {
        const bool answers =
            traditional_.answers(index, sample_, channel_.link().hears_peer(), silence()) && !slot.idle;
        changed |= std::exchange(pointer.answered, answers) != answers;
        in.modelled = passive_force(index, slot, answers);
        traditional_.describe(index, slot, in.modelled);
        spring.stiffness = spring.deep = glm::length(in.modelled) > no_force ? usual_stiffness : 0.0;
    } else {
        in.modelled = modelled_force(loop, pointer, slot, changed, now);
        spring = spring_under(loop, slot.state);
    }
    // No hand feels more than its device may give: nothing of what is beyond needs hiding.
    const Vec3 whole = in.modelled;
    in.modelled = limited_force(whole, loop.force_limit(slot));
    in.stiffness = spring.as_rich(glm::length(in.modelled));
    hide_changes(pointer, in.modelled, spring, way, changed);
    const TouchedBody touched = touched_body(loop, slot.state);
    if (const double force = glm::length(in.modelled);
        changed && pointer.known &&
        change_to_come(pointer.touched, touched, force) > just_noticeable(settings().stealth, force)) {
        pointer.felt.let_go();
    }
    pointer.touched = touched;
    const Vec3 turned_speed = slot.hand_velocity - pointer.velocity;
    const double own_doing =
        2.0 * spring.steepest() * glm::length(way) + slot.step.damping * glm::length(turned_speed);
    // What keeps traditional touch passive follows the hand's motion.
    const Vec3 damped = settings().traditional ? whole - traditional_.far(index).force : Vec3(0.0);
    const double damped_more = glm::distance(damped, std::exchange(pointer.damped, damped));
    if (!pointer.known) {
        slot.own_change = 0.0;
    } else if (settings().traditional) {
        slot.own_change = settings().passivity != Passivity::none && pointer.answered ? damped_more : 0.0;
    } else {
        slot.own_change = std::min(glm::distance(in.modelled, pointer.modelled), own_doing);
    }
    pointer.velocity = slot.hand_velocity;
    const Vec3 modelled = in.modelled;
    if (settings().correction == Correction::passive && !settings().traditional) {
        in.modelled = pointer.update.feel(settings().update, in);
    } else {
        pointer.update.forget();
    }
    slot.state.force = pointer.felt.feel(settings().stealth, in);
    if (slot.state.force == modelled) {
        slot.state.force = whole;
    }
    pointer.modelled_before =
        pointer.known && !changed && !corrected_ ? pointer.modelled : modelled;  // a change is no trend
    pointer.modelled = modelled;
    pointer.hand = slot.hand;
    pointer.known = true;
    tell_felt(pointer, slot, index);
}

// A correction's part is known to the bit. Any other change of what is touched, or of who answers, is what
// the force had changed by without the correction, beyond what the hand's own way can have made of it.
void OperatorSide::hide_changes(Pointer& pointer, const Vec3& modelled, const SurfaceSpring& spring,
                                const Vec3& way, bool changed) {
    if (changed && pointer.known) {
        const Vec3 expected = pointer.modelled + (pointer.modelled - pointer.modelled_before);
        const Vec3& uncorrected = corrected_ ? pointer.uncorrected.force : modelled;
        const double natural = 2.0 * spring.steepest() * glm::length(way) + no_force;
        if (glm::distance(expected, uncorrected) > natural) {
            pointer.felt.hide(expected, uncorrected);
        }
    }
    if (corrected_) {
        CorrectionCost& cost = statistics_.cost;
        const Vec3& uncorrected = pointer.uncorrected.force;
        const Vec3 before = uncorrected + pointer.felt.hidden();
        if (settings().correction == Correction::stealthy_direction) {
            pointer.felt.hide(uncorrected, modelled);
        } else if (settings().correction == Correction::stealthy_magnitude) {
            pointer.felt.hide_size(uncorrected, modelled);
        } else if (settings().correction == Correction::passive) {
            pointer.update.changed(uncorrected, spring.as_rich(glm::length(uncorrected)), modelled,
                                   spring.as_rich(glm::length(modelled)));
        }
        cost.force_step = std::max(cost.force_step, glm::distance(modelled + pointer.felt.hidden(), before));
    }
}

void OperatorSide::tell_felt(Pointer& pointer, SessionLoop::ProxySlot& slot, std::size_t index) {
    const FeltPointer& felt = pointer.felt;
    const FeltState state =
        felt.state() == FeltState::together && pointer.carried.apart() ? FeltState::carried : felt.state();
    slot.state.status |= felt_status(state);
    statistics_.pointers[index] = {state, glm::length(pointer.carried.offset()), glm::length(felt.hidden())};
    statistics_.let_go += felt.begins_to_let_go() ? 1 : 0;
    statistics_.offset = std::max(statistics_.offset, glm::length(pointer.carried.offset()));
    add_energy(felt.energy());
    note_cost(felt.faded(), glm::length(slot.state.force));
}

void OperatorSide::add_energy(const EnergyFigures& energy) {
    statistics_.energy.hand_J += energy.hand_J;
    statistics_.energy.tank_J += energy.tank_J;
    statistics_.energy.hidden_J += energy.hidden_J;
    statistics_.energy.damped_J += energy.damped_J;
}

void OperatorSide::note_cost(double faded, double force) {
    CorrectionCost& cost = statistics_.cost;
    cost.faded = std::max(cost.faded, faded);
    statistics_.largest_force_step = std::max(statistics_.largest_force_step, cost.force_step);
    cost.jnd_share = (cost.force_step + cost.faded) / just_noticeable(settings().stealth, force);
}

}  // namespace tactus
