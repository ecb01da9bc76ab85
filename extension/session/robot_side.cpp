#include "session/robot_side.hpp"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "core/math/shortened.hpp"
#include "network/plausibility.hpp"
#include "session/hand_terms.hpp"

namespace tactus {

namespace {

// As stiff as robots of this size are held; what of it is safe decides the robot's damping.
constexpr Wall wanted_coupling{1000.0, 5.0};

// Less is noise of the observer, not contact (unit: newtons).
constexpr double least_contact = 0.3;

// A passive link lets a robot be pressed with so much beyond its friction, which nothing pays for: friction
// is known no better (unit: newtons).
constexpr double unseen = 2.0 * least_contact;

// Of a robot that does not say what it weighs (unit: kilograms).
constexpr double usual_mass = 0.2;

}  // namespace

RobotBody RobotSide::body_of(const DeviceCapabilities& robot) {
    return {robot.mass > 0.0 ? robot.mass : usual_mass, robot.viscous, robot.coulomb,
            robot.velocity_smoothed};
}

Wall RobotSide::coupling_of(const RobotView& robot) const {
    const double scale = robot.workspace.scale;
    return safe_wall({seconds_, robot.capabilities.delay}, robot.capabilities.damping / scale,
                     {wanted_coupling.stiffness / scale, wanted_coupling.damping / scale});
}

RobotSide::RobotSide(const SessionSettings& session, const TeleopSettings& settings, Link& link,
                     std::shared_ptr<TeleopPort> port, const EndpointSettings& endpoint)
    : channel_(settings, link, std::move(port), endpoint),
      telling_(session.max_bodies),
      hands_(channel_, max_proxies, to_seconds(session.period)),
      seconds_(to_seconds(session.period)) {}

void RobotSide::set_hands(SessionLoop& loop, Nanoseconds now) {
    const bool changed = channel_.begin_tick(now);
    telling_.take_orders(channel_.port());
    // Before what has come is taken: after a standstill of this side the first tick hears the peer again.
    if (!channel_.link().hears_peer()) {
        release_hands(loop);
    }
    receive(loop);
    hands_.follow(channel_, changed);
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (const SessionLoop::ProxySlot& slot = loop.proxy(i); slot.proxy) {
            play(loop, i, slot);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = loop.tool(i)) {
            play(loop, i, *slot);
        }
    }
}

// The operator is not there, or has started again.
void RobotSide::release_hands(SessionLoop& loop) {
    statistics_.sample = no_sample;
    hands_.restart();
    for (Pointer& pointer : pointers_) {
        pointer.holds = false;
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        tools_[i].holds = false;
        if (ToolSlot* const slot = loop.tool(i)) {
            PlayedHands::restart(*slot);
        }
    }
}

void RobotSide::receive(SessionLoop& loop) {
    while (const Packet* const packet = channel_.receive()) {
        if (channel_.peer_has_started()) {
            release_hands(loop);
            telling_.restart();
        }
        if (const auto* const samples = std::get_if<OperatorSamples>(&packet->message)) {
            hands_.take(*samples,
                        [&](std::size_t tool) { return tool < max_tools ? loop.tool(tool) : nullptr; });
        } else if (const auto* const known = std::get_if<DiscoveryAcknowledgement>(&packet->message)) {
            telling_.take(*known);
        }
    }
}

void RobotSide::play(SessionLoop& loop, std::size_t index, const SessionLoop::ProxySlot& slot) {
    Pointer& pointer = pointers_[index];
    pointer.playing = hands_.play(index, pointer.played);
    const bool waits = pointer.playing == Playing::waiting;
    const RobotView robot = loop.robot(slot.description.device);
    const bool is_there = slot.present() && robot.connected;
    if (waits || !pointer.played.connected || !is_there || !channel_.link().hears_peer() ||
        !telling_.may_press(channel_, index)) {
        pointer.holds = false;
        touch_.let_go(index);
        return;
    }
    const double scale = robot.workspace.scale;
    const RobotBody body = body_of(robot.capabilities);
    if (!pointer.holds) {
        pointer.holds = true;
        pointer.returns = false;
        pointer.target = slot.hand;
        pointer.passivity.reset();
        pointer.observer.reset();
    }
    // Forces keep their size in the scene, ways do not.
    const Vec3 drive = loop.given_force(slot);
    pointer.contact = pointer.observer.observe(body, drive, slot.hand_velocity / scale, seconds_);
    pointer.coupled = -drive;
    touch_.feel(loop, index, {slot.hand, pointer.contact, slot.description.settings.radius, seconds_});
    statistics_.sample = std::max(statistics_.sample, pointer.played.sequence);
    const Wall coupling = coupling_of(robot);
    const Vec3 before = pointer.target;
    const double speed = follow_speed(glm::length(pointer.played.velocity), settings().stand_in.speed);
    pointer.target = next_target(before, hand_of(pointer, slot, robot, coupling), speed,
                                 robot.workspace.pose.position, robot.capabilities.radius * scale, seconds_);
    const double left = glm::distance(to_parent(settings().frame, pointer.played.position), slot.hand);
    pointer.returns = hands_.is_outage(index) || (pointer.returns && left > slot.description.settings.radius);
    if (const auto most = most_press(pointer.played, pointer.returns)) {
        pointer.target =
            yielding(pointer.target, slot.hand, *most, friction_at(robot, slot.hand_velocity), coupling);
    }
    pointer.passivity.went(pointer.target);
    pointer.velocity = (pointer.target - before) / seconds_;
    pointer.coupling = coupling;
}

// Of the robot's own motion, at a velocity of the scene (unit: newtons).
double RobotSide::friction_at(const RobotView& robot, const Vec3& velocity) {
    return glm::length(friction_of(body_of(robot.capabilities), velocity / robot.workspace.scale));
}

// After an outage the operator's hand may have gone around what the robot runs into on its straight way. A
// robot cannot begin elsewhere: with a model it is led by no more than the operator is pressed with until it
// is there. Without one the operator says where its hand may press no harder (unit: newtons).
std::optional<double> RobotSide::most_press(const PointerSample& played, bool returns) const {
    return returns || settings().traditional
               ? known_press(settings().traditional, settings().passivity, played.force)
               : std::nullopt;
}

// Led by so much, besides what its own friction takes.
Vec3 RobotSide::yielding(const Vec3& target, const Vec3& place, double most, double friction,
                         const Wall& coupling) {
    return place + shortened(target - place, (most + friction + unseen) / coupling.stiffness);
}

// Where the operator's stand-in would have the robot.
Vec3 RobotSide::hand_of(Pointer& pointer, const SessionLoop::ProxySlot& slot, const RobotView& robot,
                        const Wall& coupling) const {
    const Pose& frame = settings().frame;
    const PointerSample& played = pointer.played;
    if (settings().passivity != Passivity::none) {
        FarPassivity::In in;
        in.sample = played.sequence;
        in.hand = to_parent(frame, played.position);
        in.force = direction_to_parent(frame, played.force);
        in.own_force = pointer.coupled;
        in.is_free = glm::length(pointer.contact) <= least_contact;
        in.seconds = seconds_;
        in.is_exact = pointer.playing == Playing::exact || pointer.playing == Playing::guessed;
        if (settings().passivity != Passivity::wave_variables) {
            in.coupled = {coupling.stiffness, friction_at(robot, slot.hand_velocity), unseen, pointer.contact,
                          slot.hand};
        }
        return pointer.passivity.hand(settings().passivity, settings().passive, in);
    }
    StandInInput in;
    in.hand = to_parent(frame, played.position);
    in.velocity = direction_to_parent(frame, played.velocity);
    in.force = direction_to_parent(frame, played.force);
    in.own_hand = pointer.target;
    in.own_proxy = slot.hand;
    in.in_contact = glm::length(pointer.contact) > least_contact;
    in.stiffness = coupling.stiffness;
    in.seconds = seconds_;
    return stand_in_hand(settings().control, settings().stand_in, in);
}

void RobotSide::set_forces(SessionLoop& loop, Nanoseconds) {
    for (std::size_t i = 0; i < max_proxies; ++i) {
        SessionLoop::ProxySlot& slot = loop.proxy(i);
        const Pointer& pointer = pointers_[i];
        if (slot.proxy) {
            slot.state.force = pointer.holds ? drive_force(pointer.coupling, pointer.target, pointer.velocity,
                                                           slot.hand, slot.hand_velocity)
                                             : Vec3(0.0);
            slot.state.hand = slot.state.position = slot.hand;
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (ToolSlot* const slot = loop.tool(i)) {
            drive(tools_[i], *slot);
        }
    }
}

void RobotSide::report(SessionLoop& loop, Nanoseconds now) {
    if (settings().traditional) {
        send_forces(loop, now);
    } else {
        telling_.tell_states(loop, channel_, statistics_.sample, now);
        telling_.tell_estimates(loop, channel_, &touch_, now);
        telling_.describe(channel_, now);
        statistics_.discovery = telling_.counts();
        statistics_.load = telling_.load();
    }
    for (std::size_t i = 0; i < max_proxies; ++i) {
        Pointer& pointer = pointers_[i];
        if (const SessionLoop::ProxySlot& slot = loop.proxy(i); slot.proxy) {
            statistics_.energy.far_J +=
                pointer.holds ? glm::dot(pointer.contact, slot.hand - pointer.had_hand) : 0.0;
            pointer.had_hand = slot.hand;
        }
    }
    tell_tools(loop, now);
    if (SampleAcknowledgements standing; hands_.acknowledges(standing)) {
        channel_.send(standing);
    }
    hands_.tell(statistics_);
    Terms terms = channel_.terms_of_settings();
    terms.bodies = settings().traditional ? 0 : loop.bodies_end();
    note_hands(loop, terms);
    channel_.set_own(terms);
    channel_.end_tick(statistics_);
}

// A wave is made of the force at the port, which is the target.
Vec3 RobotSide::told_force(const Pointer& pointer) const {
    return settings().passivity == Passivity::wave_variables ? pointer.coupled : pointer.contact;
}

void RobotSide::send_forces(SessionLoop& loop, Nanoseconds now) {
    ForceSamples message;
    for (std::size_t i = 0; i < max_proxies && message.count < ForceSamples::max_count; ++i) {
        const Pointer& pointer = pointers_[i];
        const Vec3 force = told_force(pointer);
        const bool due = force_needs_sending(settings().deadband, pointer.force_sent, force) ||
                         now - pointer.force_sent_at >= settings().deadband.longest_silence;
        if (!pointer.holds || !due) {
            continue;
        }
        ForceSample& sample = message.samples[message.count++];
        sample.pointer = static_cast<std::uint16_t>(i);
        sample.true_at = channel_.link().local_time(now);
        sample.newest_operator_sample = pointer.played.sequence;
        sample.force = glm::clamp(direction_to_local(settings().frame, force), -plausible::max_force,
                                  plausible::max_force);
        sample.proxy = to_local(settings().frame, loop.proxy(i).hand);
        sample.object = no_object;
        sample.taken = told_energy(pointer.passivity.taken());
    }
    if (message.count == 0 || !channel_.try_send(message)) {
        return;
    }
    for (std::size_t i = 0; i < message.count; ++i) {
        Pointer& pointer = pointers_[message.samples[i].pointer];
        pointer.force_sent = told_force(pointer);
        pointer.force_sent_at = now;
    }
}

}  // namespace tactus
