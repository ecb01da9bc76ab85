#include "session/body_telling.hpp"

#include <algorithm>
#include <utility>

namespace tactus {

void BodyTelling::take_orders(TeleopPort& port) {
    while (PreparedDiscovery* const announced = port.announced.front()) {
        const ObjectId object = announced->object;
        if (port.tap) {
            port.tap->took_announced();
        }
        if (discovery_.announce(*announced)) {
            states_.announced(object);
        }
        port.released.try_push(std::move(announced->content));
        port.announced.pop();
    }
    ObjectId gone = no_object;
    while (port.withdrawn.try_pop(gone)) {
        if (port.tap) {
            port.tap->took_withdrawn(gone);
        }
        std::shared_ptr<const std::vector<std::byte>> content;
        discovery_.withdraw(gone, content);
        states_.withdrawn(gone);
        port.released.try_push(std::move(content));
    }
}

void BodyTelling::take(const DiscoveryAcknowledgement& known) {
    if (discovery_.take(known)) {
        states_.described(known.object);
        estimates_.described(known.object);
    }
}

void BodyTelling::restart() {
    discovery_.restart();
    bulk_ = {};
    states_.restart();
    estimates_.restart();
}

void BodyTelling::describe(Channel& channel, Nanoseconds now) {
    constexpr int max_a_tick = 4;
    constexpr Nanoseconds soonest = 200'000'000;
    Endpoint& link = channel.link();
    discovery_.set_repeat_after(
        std::max(soonest, static_cast<Nanoseconds>(1.5 * link.clock().figures().mean_delay)));
    const TeleopSettings& settings = channel.settings();
    link.set_world(counts().waiting + counts().known + counts().refused + counts().no_room,
                   direction_to_local(settings.frame, settings.gravity));
    const bool heard = link.hears_peer();
    // States keep to the other half while there is anything to describe.
    const double most = settings.body_rate > 0.0 ? settings.body_rate / 16.0 : BulkRate::max_rate;
    bulk_.adapt(link, now, heard && discovery_.has_more(), most);
    Message message;
    for (int i = 0; i < max_a_tick && heard && bulk_.may_send() && discovery_.next(now, message); ++i) {
        const std::uint64_t before = link.statistics().bytes_sent;
        link.send(message);
        bulk_.sent(link.statistics().bytes_sent - before);
    }
}

}  // namespace tactus
