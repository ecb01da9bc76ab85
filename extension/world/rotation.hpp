// Whose turn it is, where there is no time to look at all in every frame.
#pragma once

#include <algorithm>
#include <cstddef>

namespace tactus {

// How many have their turn in a frame: so many that each has it within a round, but neither fewer nor more
// than that.
struct Turns {
    std::size_t frames_a_round = 1;
    std::size_t min = 1, max = 1;

    std::size_t in_a_frame(std::size_t count) const {
        return std::min(count, std::clamp(count / frames_a_round, min, max));
    }
};

class Rotation {
public:
    // look(item) for those whose turn it is; `items` may be others in every frame.
    template <class Items, class Look>
    void take(const Turns& turns, const Items& items, const Look& look) {
        for (std::size_t i = turns.in_a_frame(items.size()); i > 0; --i) {
            next_ = next_ + 1 < items.size() ? next_ + 1 : 0;
            look(items[next_]);
        }
    }

private:
    std::size_t next_ = 0;
};

}  // namespace tactus
