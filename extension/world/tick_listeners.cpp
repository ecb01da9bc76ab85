#include "world/tick_listeners.hpp"

#include <algorithm>

namespace tactus {

bool TickListeners::listen(Session& session, std::uint64_t who, const std::shared_ptr<TickRing>& ring,
                           SessionHandle proxy, SessionHandle body) {
    auto found = std::ranges::find(all_, who, &Listener::who);
    if (found != all_.end() && found->ring != ring) {
        end(session, who);
        found = all_.end();
    }
    if (found != all_.end() && found->proxy == proxy && found->body == body) {
        return true;
    }
    if (!session.record(*ring, proxy, body)) {
        return false;
    }
    if (found == all_.end()) {
        all_.push_back({who, ring, proxy, body});
    } else {
        found->proxy = proxy;
        found->body = body;
    }
    return true;
}

void TickListeners::end(Session& session, std::uint64_t who) {
    const auto found = std::ranges::find(all_, who, &Listener::who);
    if (found != all_.end()) {
        session.end_recording(*found->ring);
        retired_.push_back(std::move(found->ring));
        all_.erase(found);
    }
}

}  // namespace tactus
