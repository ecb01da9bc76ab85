#include "session/ghosts.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "session/session_loop.hpp"
#include "session/teleoperator_side.hpp"
#include "session/tool_slot.hpp"

namespace tactus {

namespace {

constexpr Nanoseconds moving_every = 16'000'000;
constexpr Nanoseconds standing_every = 200'000'000;
// Nobody sees less (unit: meters).
constexpr double seen_move = 1e-4;
// Who has gone, or cannot be heard, is seen no longer than this.
constexpr Nanoseconds holds_for = 500'000'000;

bool looks_the_same(const Ghosts& a, const Ghosts& b) {
    return std::equal(a.ghosts.begin(), a.ghosts.begin() + a.count, b.ghosts.begin(),
                      b.ghosts.begin() + b.count, [](const Ghost& one, const Ghost& other) {
                          return one.pointer == other.pointer && one.touches == other.touches &&
                                 glm::distance(one.position, other.position) < seen_move;
                      });
}

double largest_ball(const ToolShape& shape) {
    return std::ranges::max_element(shape.spheres, {}, &ToolSphere::radius)->radius;
}

}  // namespace

const Ghosts* GhostTeller::due(SessionLoop& loop, const PointerShare& share, const Pose& frame,
                               Nanoseconds now) {
    const Nanoseconds since = now - said_at_;
    if (share.every < 2 || since < moving_every) {
        return nullptr;
    }
    Ghosts there;
    for (std::size_t i = 0; i < max_proxies; ++i) {
        const SessionLoop::ProxySlot& slot = loop.proxy(i);
        if (share.has(i) || !slot.present() || slot.idle) {
            continue;
        }
        there.ghosts[there.count++] = {static_cast<std::uint16_t>(i), slot.state.contact_count > 0,
                                       to_local(frame, slot.state.position),
                                       std::min(slot.description.settings.radius, max_ghost_radius)};
    }
    // A tool is seen as a ball at its place, as large as the largest that it has room for.
    for (std::size_t i = 0; i < max_tools && there.count < Ghosts::max_count; ++i) {
        const ToolSlot* const slot = loop.tool(i);
        if (!share.has(i) && slot && slot->hand.holds) {
            there.ghosts[there.count++] = {static_cast<std::uint16_t>(first_tool + i),
                                           slot->state.contact_count > 0,
                                           to_local(frame, slot->state.pose.position),
                                           std::min(largest_ball(slot->proxy.shape()), max_ghost_radius)};
        }
    }
    if (there.count == 0 || (since < standing_every && looks_the_same(there, said_))) {
        return nullptr;
    }
    said_ = there;
    said_at_ = now;
    return &said_;
}

void GhostEar::take(const Ghosts& ghosts, std::uint64_t packet, const Pose& frame, Nanoseconds now) {
    if (packet <= packet_) {
        return;
    }
    packet_ = packet;
    heard_at_ = now;
    seen_ = {ghosts.count, ghosts.ghosts};
    for (Ghost& ghost : seen_.ghosts) {
        ghost.position = to_parent(frame, ghost.position);
    }
}

const SeenGhosts& GhostEar::seen(Nanoseconds now) {
    if (now - heard_at_ >= holds_for) {
        seen_.count = 0;
    }
    return seen_;
}

}  // namespace tactus
