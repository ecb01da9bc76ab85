#include "session/teleop_link.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

bool TeleopLink::send(const Message& message, Nanoseconds now) {
    const std::size_t bytes = encode({epoch_, ++sequence_, now}, message, buffer_);
    if (bytes == 0 || !link_.send(std::span(buffer_).first(bytes), now)) {
        ++not_taken_;
        return false;
    }
    ++sent_;
    bytes_sent_ += bytes;
    return true;
}

void TeleopLink::send_outgoing(Nanoseconds now) {
    while (const Letter* const letter = port_->outgoing.front()) {
        if (!link_.send(std::span(letter->datagram).first(letter->bytes), now)) {
            ++not_taken_;
            return;
        }
        ++sent_;
        bytes_sent_ += letter->bytes;
        port_->outgoing.pop();
    }
}

bool TeleopLink::receive(Packet& packet, Nanoseconds now) {
    while (const ReceivedDatagram datagram = link_.receive(buffer_, now)) {
        const auto bytes = std::span<const std::byte>(buffer_).first(datagram.bytes);
        if (const Refusal refusal = decode(bytes, packet); refusal != Refusal::none) {
            refused_.add(refusal);
            continue;
        }
        if (packet.header.epoch == epoch_before_) {
            continue;
        }
        ++received_;
        bytes_received_ += datagram.bytes;
        last_heard_ = now;
        if (packet.header.epoch != peer_epoch_) {
            epoch_before_ = std::exchange(peer_epoch_, packet.header.epoch);
            restarts_ += epoch_before_ != 0 ? 1u : 0u;
            peer_is_new_ = true;
        }
        if (std::holds_alternative<ObjectStates>(packet.message) ||
            std::holds_alternative<OperatorSamples>(packet.message) ||
            std::holds_alternative<ForceSample>(packet.message)) {
            return true;
        }
        Letter letter;
        letter.bytes = datagram.bytes;
        letter.arrived = datagram.arrived;
        std::ranges::copy(bytes, letter.datagram.begin());
        port_->incoming.try_push(std::move(letter));  // full: the sender repeats it until it is acknowledged
    }
    return false;
}

bool TeleopLink::peer_is_new() {
    return std::exchange(peer_is_new_, false);
}

void TeleopLink::count(TeleopStatistics& statistics) const {
    statistics.packets_sent = sent_;
    statistics.bytes_sent = bytes_sent_;
    statistics.packets_received = received_;
    statistics.bytes_received = bytes_received_;
    statistics.packets_refused_by_link = not_taken_;
    statistics.refused = refused_;
    statistics.restarts = restarts_;
}

}  // namespace tactus
