#include "session/channel.hpp"

#include <utility>

namespace tactus {

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
    link_.begin_tick(now);
    return changed;
}

bool Channel::peer_has_started() {
    const std::uint64_t epoch = link_.peer_epoch();
    if (epoch == 0 || epoch == peer_epoch_) {
        return false;
    }
    peer_epoch_ = epoch;
    ++starts_;
    return true;
}

const Packet* Channel::receive() {
    const Endpoint::Received* const received = link_.receive();
    return received ? &received->packet : nullptr;
}

void Channel::end_tick(TeleopStatistics& statistics) {
    link_.end_tick();
    statistics.link = link_.statistics();
    port_->statistics.publish(statistics);
}

}  // namespace tactus
