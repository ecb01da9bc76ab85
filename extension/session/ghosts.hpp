// Where the fingertips of other operators in the same environment are: told by the far side for the eye.
#pragma once

#include <array>

#include "network/messages.hpp"

namespace tactus {

class SessionLoop;
struct PointerShare;

// As the operator knows them, in its own scene.
struct SeenGhosts {
    std::size_t count = 0;
    std::array<Ghost, Ghosts::max_count> ghosts{};
};

// Far side: what an operator is told of the others, and when. Once a tick.
class GhostTeller {
public:
    // The pointers that are not of `share`; none where nothing is to be said now.
    const Ghosts* due(SessionLoop& loop, const PointerShare& share, const Pose& frame, Nanoseconds now);

private:
    Ghosts said_;
    Nanoseconds said_at_ = 0;
};

// Operator: the newest that was told, for as long as it holds.
class GhostEar {
public:
    void take(const Ghosts& ghosts, std::uint64_t packet, const Pose& frame, Nanoseconds now);
    void forget() { *this = {}; }
    // Once a tick.
    const SeenGhosts& seen(Nanoseconds now);

private:
    SeenGhosts seen_;
    std::uint64_t packet_ = 0;
    Nanoseconds heard_at_ = 0;
};

}  // namespace tactus
