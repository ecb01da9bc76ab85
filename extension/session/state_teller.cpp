#include "session/state_teller.hpp"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "core/teleop/deadband.hpp"
#include "core/teleop/derivation.hpp"

namespace tactus {

namespace {

// Where a body has come to rest is said so many ticks longer.
constexpr std::uint64_t linger = 200;
constexpr std::uint64_t linger_rounds = 8;

// Nobody sees such a difference in a body that moves (unit: meters, radians).
constexpr double seen_position = 1e-3;
constexpr double seen_angle = 0.02;

// A body that has just been acknowledged is in the operator's loop by then.
constexpr Nanoseconds settling = 200'000'000;
// From one time that something is said of what stands to the next: as long as word of losses takes to come.
constexpr Nanoseconds again_after = 100'000'000;
constexpr double hardly = 1e-3;  // a doubt that is none
// Share lost of what is said before the far side has reported: until then no loss is no better a guess.
constexpr double lost_if_unknown = 0.5;

// What stands is said once more after that, as many bodies in one turn as a packet holds.
constexpr Nanoseconds healed_after = 4 * nanoseconds_per_second;
constexpr std::size_t max_looked_at = 1024;  // in a turn

constexpr double hand_speed = 1.0;  // of one that hurries (unit: meters per second)

}  // namespace

StateTeller::StateTeller(std::size_t max_bodies) : told_(max_bodies) {
    due_.reserve(max_bodies);
    urgency_.resize(max_bodies);
    hands_.reserve(max_proxies + max_tools);
}

void StateTeller::restart() {
    pace_.restart();
    for (Told& told : told_) {
        told.known = told.known == Known::built ? Known::awaited : told.known;
        begin_anew(told);
    }
}

void StateTeller::announced(SessionHandle body) {
    if (body < told_.size() && told_[body].known == Known::unasked) {
        told_[body].known = Known::awaited;
    }
}

void StateTeller::described(SessionHandle body) {
    if (body < told_.size()) {
        told_[body].known = Known::built;
        begin_anew(told_[body]);
    }
}

void StateTeller::withdrawn(SessionHandle body) {
    if (body < told_.size()) {
        told_[body].known = Known::unasked;
    }
}

// Of what stands, all is to be said again.
void StateTeller::begin_anew(Told& told) const {
    told.times = 0;
    told.due = tick_ + ticks(settling);
}

void StateTeller::tell(SessionLoop& loop, Channel& channel, SampleSequence newest, Nanoseconds now,
                       bool others_yield, double rate) {
    ++tick_;
    has_said_ = false;
    seconds_ = loop.seconds();
    losing_ = loses(channel.link().statistics());
    if (!others_yield) {
        pace_.adapt(channel.link(), now);
    }
    const TeleopSettings& settings = channel.settings();
    const std::uint64_t every =
        std::max(1u, std::min(settings.states_every, settings.refresh_every)) * pace_.stride();
    if (said_ >= due_.size() && tick_ % every == 0) {
        round_ = every;
        begin_round(loop, channel, now);
        note_load(loop);
        if (rate > 0.0) {
            budget_.earn(std::max(rate, least_body_rate), static_cast<double>(round_) * seconds_);
            keep_most_urgent(loop, budget_.room());
        }
    }
    constexpr std::size_t room = ObjectStates::max_count;
    const std::uint64_t packets = (due_.size() + room - 1) / room;
    while (said_ < due_.size() && (tick_ - round_began_) * packets >= said_ / room * round_) {
        const std::size_t count = std::min(room, due_.size() - said_);
        send(loop, channel, newest, now, std::span(due_).subspan(said_, count));
        said_ += count;
    }
}

void StateTeller::begin_round(SessionLoop& loop, const Channel& channel, Nanoseconds now) {
    const TeleopSettings& settings = channel.settings();
    round_began_ = tick_;
    due_.clear();
    said_ = 0;
    std::size_t room_for_standing = ObjectStates::max_count;
    for (std::size_t i = 0; i < told_.size(); ++i) {
        const auto body = static_cast<SessionHandle>(i);
        const SessionLoop::Body* const there = loop.body(body);
        Told& told = told_[i];
        if (there == nullptr) {
            if (told.tick != 0) {
                told = {};
            }
            continue;
        }
        if (told.known == Known::awaited) {
            continue;
        }
        bool due = false;
        if (there->motion == Motion::Static) {
            note_where_it_stands(loop, body);
            due = told.due != 0 && told.due <= tick_ && room_for_standing > 0;
            room_for_standing -= due ? 1 : 0;
        } else {
            told.moved_at = loop.asleep(body) ? told.moved_at : tick_;
            due = has_its_turn(settings, body) || moves_otherwise(loop, settings, body, now);
        }
        if (due) {
            due_.push_back(body);
        }
    }
    if (tick_ >= next_turn_) {
        next_turn_ = tick_ + std::max(1u, settings.refresh_every);
        take_slow_turn(loop);
    }
}

void StateTeller::note_load(const SessionLoop& loop) {
    const double round = static_cast<double>(round_) * seconds_;
    load_.wanted = static_cast<double>(due_.size()) * budget_.bits_a_state() / round;
    std::uint64_t oldest = tick_;
    for (const SessionHandle body : due_) {
        const Told& told = told_[body];
        if (loop.body(body)->motion != Motion::Static && told.tick != 0) {
            oldest = std::min(oldest, told.tick);
        }
    }
    load_.oldest = static_cast<double>(tick_ - oldest) * seconds_;
}

void StateTeller::keep_most_urgent(SessionLoop& loop, std::size_t room) {
    if (due_.size() <= room) {
        return;
    }
    hands_.clear();
    for (std::size_t i = 0; i < max_proxies; ++i) {
        if (const SessionLoop::ProxySlot& slot = loop.proxy(i); slot.present()) {
            hands_.push_back(slot.state.position);
        }
    }
    for (std::size_t i = 0; i < max_tools; ++i) {
        if (const ToolSlot* const slot = loop.tool(i); slot != nullptr && slot->use.enabled) {
            hands_.push_back(slot->state.pose.position);
        }
    }
    const double soonest = static_cast<double>(round_) * seconds_;
    for (const SessionHandle body : due_) {
        const double age = static_cast<double>(tick_ - told_[body].tick) * seconds_;
        urgency_[body] = age / std::max(soonest, time_to_touch(loop, body));
    }
    const auto kept = due_.begin() + static_cast<std::ptrdiff_t>(room);
    std::nth_element(due_.begin(), kept, due_.end(), [this](SessionHandle a, SessionHandle b) {
        return urgency_[a] != urgency_[b] ? urgency_[a] > urgency_[b] : a < b;
    });
    due_.erase(kept, due_.end());
}

// Before a hand may be there (unit: seconds), >= 0; where there is none, as if it were a meter away.
double StateTeller::time_to_touch(SessionLoop& loop, SessionHandle body) const {
    const BodyMotion motion = loop.motion(body);
    double nearest = hands_.empty() ? 1.0 : std::numeric_limits<double>::infinity();
    for (const Vec3& hand : hands_) {
        nearest = std::min(nearest, glm::distance(hand, motion.pose.position));
    }
    const double distance = std::max(0.0, nearest - loop.body(body)->shape->reach);
    return distance / (hand_speed + glm::length(motion.linear_velocity));
}

void StateTeller::note_where_it_stands(SessionLoop& loop, SessionHandle body) {
    const Pose& pose = loop.scene().body(loop.body(body)->slot).pose;
    Told& told = told_[body];
    if (pose.position != told.stands.position || pose.rotation != told.stands.rotation) {
        told.stands = pose;
        told.times = 0;
        told.due = told.tick == 0 ? tick_ : std::max(tick_, told.tick + ticks(again_after));
    }
}

// Those that have been said long ago, from where the last turn has ended.
void StateTeller::take_slow_turn(const SessionLoop& loop) {
    std::size_t room = ObjectStates::max_count;
    const std::size_t looked_at = std::min(told_.size(), max_looked_at);
    for (std::size_t looked = 0; looked < looked_at && room > 0; ++looked) {
        const auto body = static_cast<SessionHandle>(turn_at_);
        turn_at_ = (turn_at_ + 1) % told_.size();
        const SessionLoop::Body* const there = loop.body(body);
        const Told& told = told_[body];
        if (there != nullptr && there->motion == Motion::Static && told.due == 0 &&
            tick_ - told.tick >= ticks(healed_after)) {
            due_.push_back(body);
            --room;
        }
    }
}

// As many as a packet holds have their turn together, one packet after the other.
bool StateTeller::has_its_turn(const TeleopSettings& settings, SessionHandle body) const {
    const std::uint64_t refresh = std::uint64_t{std::max(1u, settings.refresh_every)} * pace_.stride();
    const std::uint64_t turns = std::max<std::uint64_t>(1, refresh / round_);
    return tick_ / round_ % turns == body / ObjectStates::max_count % turns;
}

bool StateTeller::moves_otherwise(SessionLoop& loop, const TeleopSettings& settings, SessionHandle body,
                                  Nanoseconds now) const {
    const Told& told = told_[body];
    if (told.moved_at == 0 || tick_ - told.moved_at >= std::max(linger, linger_rounds * round_)) {
        return false;
    }
    if (told.again) {
        return true;  // what was said may have been lost
    }
    if (!settings.deadband.enabled || told.tick == 0 || loop.asleep(body) != told.asleep ||
        now - told.time >= settings.deadband.longest_silence) {
        return true;
    }
    DerivationInput since;
    since.received = told.motion;
    since.seconds = static_cast<double>(tick_ - told.tick) * seconds_;
    DeadbandSettings band = settings.deadband;
    if (settings.traditional) {
        // What is only seen may be off by more.
        band.position = std::max(band.position, seen_position);
        band.angle = std::max(band.angle, seen_angle);
    }
    return motion_needs_sending(band, derive(Derivation::velocity, since), loop.motion(body));
}

// Whether packets have been lost lately. What the far side loses is known to it alone; links mostly lose both
// ways.
bool StateTeller::loses(const LinkStatistics& link) {
    constexpr std::uint64_t lately = 1000;
    if (link.missing != missing_) {
        lost_at_ = link.missing > missing_ ? tick_ : lost_at_;
        missing_ = link.missing;
    }
    return lost_at_ != 0 && tick_ - lost_at_ < lately;
}

void StateTeller::send(SessionLoop& loop, Channel& channel, SampleSequence newest, Nanoseconds now,
                       std::span<const SessionHandle> bodies) {
    ObjectStates message;
    message.true_at = channel.link().local_time(now);
    message.newest_operator_sample = newest;
    for (const SessionHandle body : bodies) {
        if (loop.body(body) != nullptr) {
            const BodyMotion said = to_local(channel.settings().frame, loop.motion(body));
            message.states[message.count++] = {static_cast<ObjectId>(body), loop.asleep(body), said.pose,
                                               said.linear_velocity, said.angular_velocity};
        }
    }
    const std::uint64_t before = channel.link().statistics().bytes_sent;
    if (message.count == 0 || !channel.try_send(message)) {
        return;
    }
    const std::uint64_t bytes = channel.link().statistics().bytes_sent - before;
    budget_.sent(message.count, 8.0 * static_cast<double>(bytes + channel.link().overhead()));
    for (const SessionHandle body : bodies) {
        if (loop.body(body) != nullptr) {
            note_told(loop, channel, body, now);
            has_said_ = has_said_ || loop.body(body)->motion == Motion::Dynamic;
        }
    }
}

void StateTeller::note_told(SessionLoop& loop, const Channel& channel, SessionHandle body, Nanoseconds now) {
    Told& told = told_[body];
    told.motion = loop.motion(body);
    told.tick = tick_;
    told.time = now;
    told.asleep = loop.asleep(body);
    told.again = channel.settings().deadband.enabled && losing_ && !told.again;
    if (told.due != 0) {
        ++told.times;
        const LinkStatistics& link = channel.link().statistics();
        const double lost = link.lost_there + lost_if_unknown * link.loss_unknown;
        const double doubt = std::pow(lost, told.times);
        told.due = doubt > hardly ? tick_ + ticks(again_after) : 0;
    }
}

std::uint64_t StateTeller::ticks(Nanoseconds span) const {
    return static_cast<std::uint64_t>(to_seconds(span) / seconds_);
}

}  // namespace tactus
