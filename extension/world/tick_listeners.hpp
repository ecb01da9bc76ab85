// Who hears every tick of a proxy: a recorder, a loudspeaker. The session writes into their rings. Owner's
// thread only.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "session/session.hpp"

namespace tactus {

using TickRing = RecorderRing<SessionRecord>;

class TickListeners {
public:
    // From now on into this ring, of this proxy and the place of this body (or no_handle). False where as
    // many listen as can.
    bool listen(Session& session, std::uint64_t who, const std::shared_ptr<TickRing>& ring,
                SessionHandle proxy, SessionHandle body);
    void end(Session& session, std::uint64_t who);

    // The session has carried out all that was asked of it: rings of those who have left are free.
    void forget_retired() { retired_.clear(); }

private:
    struct Listener {
        std::uint64_t who = 0;
        std::shared_ptr<TickRing> ring;
        SessionHandle proxy = no_handle, body = no_handle;
    };

    std::vector<Listener> all_;
    std::vector<std::shared_ptr<TickRing>> retired_;
};

}  // namespace tactus
