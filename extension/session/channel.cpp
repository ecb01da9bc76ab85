#include "session/channel.hpp"

#include <algorithm>

#include <utility>

namespace tactus {

Channel::Channel(const TeleopSettings& settings, Link& link, std::shared_ptr<TeleopPort> port,
                 const EndpointSettings& endpoint)
    : settings_(settings),
      before_(settings),
      link_(link, endpoint),
      port_(std::move(port)),
      side_(endpoint.side) {
    link_.set_scenario(scenario_of(settings_));
}

bool Channel::begin_tick(Nanoseconds now) {
    bool changed = false;
    if (port_->settings.refresh()) {
        before_ = std::exchange(settings_, port_->settings.front());
        if (port_->tap) {
            port_->tap->took(settings_);
        }
        link_.set_skew(settings_.skew);
        link_.set_scenario(scenario_of(settings_));
        if (settings_.leaving && !before_.leaving) {
            link_.leave();
        }
        changed = true;
    }
    now_ = now;
    link_.begin_tick(now);
    compare_terms();
    return changed;
}

bool Channel::peer_has_started() {
    const std::uint64_t epoch = link_.peer_epoch();
    if (epoch == 0 || epoch == peer_epoch_) {
        return false;
    }
    peer_epoch_ = epoch;
    met_at_ = now_;
    hellos_ = 0;
    ++starts_;
    return true;
}

const Packet* Channel::receive() {
    while (const Endpoint::Received* const received = link_.receive()) {
        const Terms* const terms = std::get_if<Terms>(&received->packet.message);
        if (terms == nullptr) {
            return &received->packet;
        }
        take(*terms, received->packet.header.sequence);
    }
    compare_terms();
    return nullptr;
}

void Channel::take(const Terms& terms, std::uint64_t packet) {
    if (peer_terms_epoch_ != link_.peer_epoch() || packet > peer_terms_packet_) {
        peer_terms_epoch_ = link_.peer_epoch();
        peer_terms_packet_ = packet;
        peer_ = terms;
    }
}

Terms Channel::terms_of_settings() const {
    Terms terms;
    terms.scenario = scenario_of(settings_);
    terms.passivity = static_cast<std::uint8_t>(settings_.passivity);
    static_assert(static_cast<std::uint8_t>(Passivity::wave_variables) == Terms::with_waves);
    const bool has_waves = settings_.passivity == Passivity::wave_variables;
    terms.impedance = has_waves ? std::clamp(settings_.passive.impedance, 0.0, max_impedance) : 0.0;
    return terms;
}

void Channel::set_own(const Terms& terms) {
    own_changed_ = own_changed_ || terms != own_;
    own_ = terms;
}

// What both sides change at once differs for as long as the word of it is on its way.
void Channel::compare_terms() {
    constexpr Nanoseconds shortest_patience = 150'000'000, longest_patience = nanoseconds_per_second;
    const Nanoseconds delay = link_.statistics().clock.mean_delay;
    const Nanoseconds patience =
        std::min(shortest_patience + std::max<Nanoseconds>(delay, 0), longest_patience);
    const Disagreement now_found = found();
    has_agreed_ = has_agreed_ && link_.hears_peer();
    if (!now_found.any() && !waits_for_terms()) {
        agreed_at_ = now_;
        has_agreed_ = link_.hears_peer();
    }
    disagreement_ = has_agreed_ && now_ - agreed_at_ < patience ? Disagreement{} : now_found;
}

bool Channel::waits_for_terms() const {
    return link_.hears_peer() && peer_terms_epoch_ != link_.peer_epoch() &&
           link_.statistics().peer_hello.newest_version >= first_version_with_terms;
}

// A far side that speaks an older version says its scenario only. Before the terms have come the teleoperator
// presses nothing; the operator goes on touching its model.
Disagreement Channel::found() const {
    const Hello& hello = link_.statistics().peer_hello;
    if (!link_.hears_peer()) {
        return {};
    }
    if (peer_terms_epoch_ == link_.peer_epoch()) {
        return side_ == Side::operator_side ? compare(own_, peer_) : compare(peer_, own_);
    }
    if (waits_for_terms()) {
        Disagreement nothing_yet;
        nothing_yet.whole = side_ == Side::teleoperator_side;
        return nothing_yet;
    }
    Terms peer = own_;
    peer.scenario = hello.scenario;
    return compare(own_, peer);
}

void Channel::end_tick(TeleopStatistics& statistics) {
    link_.end_tick();
    // Often when the two meet, later with every fifth hello: any of them may be lost, and until they have
    // come no far hand presses what the operator's own does already.
    constexpr Nanoseconds meeting = nanoseconds_per_second, often = 20'000'000;
    constexpr std::uint64_t every = 5;
    const bool meets = link_.hears_peer() && now_ - met_at_ < meeting && now_ - told_at_ >= often;
    if (own_changed_ || meets || (link_.has_said_hello() && hellos_ % every == 0)) {
        own_changed_ = !link_.send(own_);
        told_at_ = now_;
    }
    hellos_ += link_.has_said_hello() ? 1 : 0;
    statistics.disagreement = disagreement_;
    statistics.own_terms = own_;
    statistics.peer_terms = peer_;
    statistics.link = link_.statistics();
    port_->statistics.publish(statistics);
}

}  // namespace tactus
