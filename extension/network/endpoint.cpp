#include "network/endpoint.hpp"

#include <sodium.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "network/plausibility.hpp"

namespace tactus {
namespace {

constexpr double way_smoothing = 1.0 / 16.0;

// Nothing is held up for longer. Whoever still speaks of an epoch then was put aside by somebody else.
constexpr Nanoseconds remembers_for = 5 * nanoseconds_per_second;

}  // namespace

Endpoint::Endpoint(Link& link, const EndpointSettings& settings) : link_(link), settings_(settings) {}

void Endpoint::begin_tick(Nanoseconds now) {
    now_ = now;
    local_now_ = local_time(now);
    taken_this_tick_ = 0;
    if (!ticked_) {
        ticked_ = true;
        rates_since_ = next_hello_ = next_request_ = now;
    }
    const bool alive = hears_peer() || statistics_.peer == PeerState::wrong_side;
    if (alive && now - heard_at_ > settings_.vanish_after) {
        statistics_.peer = PeerState::vanished;
        ++statistics_.vanishings;
    }
    if (window_.newest() != 0 && now - admitted_at_ > settings_.vanish_after) {
        // Should a sequence have been believed that was none, the true one is taken up again.
        window_.forget();
    }
}

const Endpoint::Received* Endpoint::receive() {
    while (taken_this_tick_ < max_datagrams_per_tick) {
        const ReceivedDatagram datagram = link_.receive(buffer_, now_);
        if (!datagram) {
            return nullptr;
        }
        ++taken_this_tick_;
        const Refusal refusal = decode(std::span(buffer_).first(datagram.bytes), received_.packet);
        if (refusal != Refusal::none) {
            statistics_.refused.add(refusal);
            continue;
        }
        received_.arrived = local_time(datagram.arrived);
        if (!admit(received_.packet.header)) {
            continue;
        }
        ++statistics_.packets_received;
        statistics_.bytes_received += datagram.bytes;
        if (take(received_.arrived)) {
            return &received_;
        }
    }
    return nullptr;
}

// Whether the packet belongs to the far side's present epoch and is here for the first time.
bool Endpoint::admit(const PacketHeader& header) {
    if (!admit_epoch(header)) {
        return false;
    }
    if (!is_plausible(header)) {
        ++statistics_.implausible;
        return false;
    }
    switch (window_.note(header.sequence)) {
        case SequenceWindow::Arrival::copy:
            ++statistics_.copies;
            return false;
        case SequenceWindow::Arrival::too_old:
            ++statistics_.too_old;
            return false;
        case SequenceWindow::Arrival::late:
            ++statistics_.late;
            break;
        case SequenceWindow::Arrival::newest:
            newest_at_ = now_;
            break;
    }
    admitted_at_ = now_;
    statistics_.missing = window_.missing();
    return true;
}

// Only a hello of the other side begins an epoch. While the far side is heard another one has to prove that
// it hears this side: who only throws packets in knows no epoch of this side.
bool Endpoint::admit_epoch(const PacketHeader& header) {
    const Hello* const hello = std::get_if<Hello>(&received_.packet.message);
    if (header.epoch == settings_.epoch || was_before(header.epoch)) {
        ++statistics_.strange_epoch;
        return false;
    }
    if (hello != nullptr && hello->side == settings_.side) {
        ++statistics_.implausible;
        if (header.epoch != statistics_.peer_epoch && !hears_peer()) {
            statistics_.peer = PeerState::wrong_side;
            heard_at_ = now_;
        }
        return false;
    }
    if (header.epoch == statistics_.peer_epoch) {
        return true;
    }
    const bool proves_itself = hello != nullptr && hello->heard_epoch == settings_.epoch;
    if (hello == nullptr || (hears_peer() && !proves_itself)) {
        ++statistics_.strange_epoch;
        if (hello != nullptr) {
            next_hello_ = now_;  // so that it hears this side
        }
        return false;
    }
    meet(header.epoch);
    return true;
}

// An epoch is over for good when another one has proved itself: until then it may come back.
void Endpoint::end_epoch_before() {
    if (epoch_before_ != 0) {
        past_[past_count_++ % max_past] = {std::exchange(epoch_before_, 0), now_};
    }
}

// A sender gets ahead by what was lost, and by no more than it can have sent meanwhile.
bool Endpoint::is_plausible(const PacketHeader& header) const {
    if (window_.newest() == 0) {
        return true;
    }
    const double could_send = to_seconds(now_ - newest_at_) * plausible::max_packets_per_second;
    const double ahead = static_cast<double>(header.sequence) - static_cast<double>(window_.newest());
    return ahead <= static_cast<double>(plausible::max_sequence_jump) + could_send;
}

bool Endpoint::was_before(std::uint64_t epoch) const {
    return std::ranges::any_of(past_, [this, epoch](const PastEpoch& past) {
        return past.epoch == epoch && now_ - past.over_at < remembers_for;
    });
}

void Endpoint::meet(std::uint64_t epoch) {
    if (statistics_.peer_epoch != 0) {
        epoch_before_ = statistics_.peer_epoch;
        ++statistics_.peer_restarts;
    }
    statistics_.peer_epoch = epoch;
    statistics_.peer = PeerState::one_way;
    window_.forget();
    hello_sequence_ = bye_sequence_ = 0;
    reported_packets_ = reported_sequence_ = 0;
    statistics_.lost_there = lost_there_ = 0.0;
    statistics_.loss_unknown = 1.0;
    clock_.forget();
    queue_there_.forget();
    statistics_.clock = {};
    statistics_.queue_there = {};
    one_way_known_ = false;
    often_until_ = now_ + nanoseconds_per_second;
    next_hello_ = next_request_ = now_;  // it need not wait to be heard
}

bool Endpoint::take(Nanoseconds arrived) {
    const PacketHeader& header = received_.packet.header;
    const Message& message = received_.packet.message;
    if (std::holds_alternative<Bye>(message)) {
        statistics_.peer = PeerState::left;
        bye_sequence_ = std::max(bye_sequence_, header.sequence);
        left_at_ = now_;
        return false;
    }
    if (statistics_.peer == PeerState::left) {
        // Who has left says nothing more: a hello after it shows that the bye was none of its own.
        const bool after = header.sequence > bye_sequence_ || now_ - left_at_ > settings_.vanish_after;
        if (!std::holds_alternative<Hello>(message) || !after) {
            return false;
        }
        bye_sequence_ = 0;
        statistics_.peer = PeerState::one_way;
    }
    heard_at_ = now_;
    if (statistics_.peer == PeerState::vanished || statistics_.peer == PeerState::wrong_side) {
        statistics_.peer = PeerState::one_way;  // until its next hello says more
        next_hello_ = now_;
    }
    note_one_way(header.sent_at, arrived);
    if (const auto* hello = std::get_if<Hello>(&message)) {
        take_hello(header, *hello);
        return false;
    }
    if (const auto* request = std::get_if<ClockRequest>(&message)) {
        answer(*request, arrived);
        return false;
    }
    if (const auto* clock_answer = std::get_if<ClockAnswer>(&message)) {
        take_answer(*clock_answer, arrived);
        return false;
    }
    return true;
}

void Endpoint::take_hello(const PacketHeader& header, const Hello& hello) {
    if (header.sequence < hello_sequence_ && hello_sequence_ - header.sequence < SequenceWindow::length) {
        return;  // overtaken by a newer one
    }
    hello_sequence_ = header.sequence;
    statistics_.peer_hello = hello;
    statistics_.peer_hello_packet = header.sequence;
    statistics_.peer = hello.heard_epoch == settings_.epoch ? PeerState::connected : PeerState::one_way;
    if (statistics_.peer == PeerState::connected) {
        end_epoch_before();
        note_report(hello);
    }
}

// What is lost on the way there, smoothed: a report tells the more the more packets it is about. What was
// overtaken only comes later.
void Endpoint::note_report(const Hello& hello) {
    constexpr double as_much_as_all_before = 150.0;  // (unit: packets)
    if (hello.heard_sequence > reported_sequence_ && hello.heard_sequence <= sequence_ &&
        hello.heard_packets >= reported_packets_) {
        const auto sent = static_cast<double>(hello.heard_sequence - reported_sequence_);
        const auto came = static_cast<double>(hello.heard_packets - reported_packets_);
        // Below 0 where what was overtaken before comes: only so does the mean count it once.
        // The first report tells only from where on the far side counts.
        if (reported_sequence_ != 0) {
            const double lost = std::clamp(1.0 - came / sent, -1.0, 1.0);
            const double share = sent / (sent + as_much_as_all_before);
            lost_there_ += share * (lost - lost_there_);
            statistics_.lost_there = std::max(lost_there_, 0.0);
            statistics_.loss_unknown *= 1.0 - share;
        }
    }
    reported_sequence_ = hello.heard_sequence;
    reported_packets_ = hello.heard_packets;
}

void Endpoint::answer(const ClockRequest& request, Nanoseconds arrived) {
    // The tick may have been due before the request came, and yet have run after.
    send(ClockAnswer{request.number, request.t0, arrived, std::max(local_now_, arrived)});
}

void Endpoint::take_answer(const ClockAnswer& answer, Nanoseconds arrived) {
    const std::uint64_t jumps = clock_.figures().jumps;
    const bool holds = clock_.add({answer.t0, arrived, answer.t1, answer.t2});
    statistics_.clock = clock_.figures();
    if (!holds) {
        return;
    }
    if (statistics_.clock.jumps != jumps) {
        queue_there_.forget();
    }
    queue_there_.add(answer.t0, answer.t1, now_ - (arrived - answer.t0));
    statistics_.queue_there = queue_there_.figures();
}

void Endpoint::note_one_way(Nanoseconds sent_at, Nanoseconds arrived) {
    if (!clock_.figures().known) {
        return;
    }
    const Nanoseconds way = arrived - clock_.near_time(sent_at);
    const auto way_now = static_cast<double>(way);
    if (!one_way_known_) {
        one_way_known_ = true;
        statistics_.one_way_delay = way_now;
        statistics_.one_way_jitter = 0.0;
    } else {
        const double change = std::abs(static_cast<double>(way - last_one_way_));
        statistics_.one_way_jitter += way_smoothing * (change - statistics_.one_way_jitter);
        statistics_.one_way_delay += way_smoothing * (way_now - statistics_.one_way_delay);
    }
    last_one_way_ = way;
}

bool Endpoint::send(const Message& message) {
    std::array<std::byte, max_message_bytes> bytes;
    const std::size_t size = encode({settings_.epoch, sequence_ + 1, local_now_}, message, bytes);
    if (size == 0 || !link_.send(std::span(bytes).first(size), now_)) {
        ++statistics_.not_sent;
        return false;
    }
    ++sequence_;
    ++statistics_.packets_sent;
    statistics_.bytes_sent += size;
    return true;
}

void Endpoint::end_tick() {
    has_said_hello_ = !leaves_ && now_ >= next_hello_;
    if (leaves_) {
        return;
    }
    if (has_said_hello_) {
        say_hello();
        next_hello_ = now_ + settings_.hello_every;
    }
    if (hears_peer() && now_ >= next_request_) {
        send(ClockRequest{++request_, local_now_});
        next_request_ = now_ + (now_ < often_until_ ? often_every : settings_.clock_every);
    } else if (now_ < often_until_) {
        next_request_ = std::min(next_request_, now_ + often_every);
    }
    statistics_.clock = clock_.figures_at(local_now_);
    queue_there_.wait(now_, statistics_.clock.latest_delay);
    statistics_.queue_there = queue_there_.figures();
    measure_rates(now_);
}

void Endpoint::say_hello() {
    own_hello_.side = settings_.side;
    own_hello_.scenario = settings_.scenario;
    own_hello_.period = settings_.period;
    own_hello_.heard_epoch = hears_peer() ? statistics_.peer_epoch : 0;
    const SequenceWindow::Settled settled = window_.settled();
    own_hello_.heard_packets = settled.packets;
    own_hello_.heard_sequence = settled.sequence;
    send(own_hello_);
}

void Endpoint::leave() {
    for (int i = 0; i < 3; ++i) {
        send(Bye{});
    }
    leaves_ = true;
}

// That there is more to come is said before it comes: nothing that moves falls before all is described.
void Endpoint::set_world(std::uint32_t object_count, const Vec3& gravity) {
    const bool is_more = object_count > std::exchange(own_hello_.object_count, object_count);
    own_hello_.gravity = glm::clamp(gravity, -plausible::max_gravity, plausible::max_gravity);
    if (is_more && hears_peer() && !leaves_) {
        say_hello();
        next_hello_ = now_ + settings_.hello_every;
    }
}

void Endpoint::measure_rates(Nanoseconds now) {
    const Nanoseconds elapsed = now - rates_since_;
    if (elapsed < nanoseconds_per_second) {
        return;
    }
    const std::uint64_t totals[4] = {statistics_.packets_sent, statistics_.bytes_sent,
                                     statistics_.packets_received, statistics_.bytes_received};
    double* const rates[4] = {&statistics_.sent_rate.packets, &statistics_.sent_rate.bytes,
                              &statistics_.received_rate.packets, &statistics_.received_rate.bytes};
    for (int i = 0; i < 4; ++i) {
        *rates[i] = static_cast<double>(totals[i] - rate_base_[i]) / to_seconds(elapsed);
        rate_base_[i] = totals[i];
    }
    const auto overhead = static_cast<double>(link_.overhead());
    for (TrafficRate* const rate : {&statistics_.sent_rate, &statistics_.received_rate}) {
        rate->bits_per_s = 8.0 * (rate->bytes + rate->packets * overhead);
    }
    rates_since_ = now;
}

std::uint64_t random_epoch() {
    std::uint64_t epoch = 0;
    while (epoch == 0) {
        randombytes_buf(&epoch, sizeof epoch);
    }
    return epoch;
}

}  // namespace tactus
