// What the model's bodies were, keyed by the operator's samples: the state after the tick of sample n. All
// memory is taken in the constructor.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/math/body_motion.hpp"

namespace tactus {

class StateHistory {
public:
    // Remembers the last `samples` (>= 1) samples of bodies 0 … bodies - 1.
    StateHistory(std::size_t bodies, std::size_t samples);

    std::size_t bodies() const { return bodies_; }

    void set(std::size_t body, std::uint64_t sample, const BodyMotion& motion);

    // Null where it is forgotten or was never known.
    const BodyMotion* at(std::size_t body, std::uint64_t sample) const;

    // After a correction: the model's past moves with its present, so that what is still on its way is
    // compared with the corrected model. Changes the samples first … last.
    void carry(std::size_t body, std::uint64_t first, std::uint64_t last, const BodyMotion& before,
               const BodyMotion& after);

    void forget(std::size_t body);

private:
    struct Entry {
        std::uint64_t sample = 0;
        bool known = false;
        BodyMotion motion;
    };
    Entry& entry(std::size_t body, std::uint64_t sample) {
        return entries_[body * samples_ + static_cast<std::size_t>(sample % samples_)];
    }
    const Entry& entry(std::size_t body, std::uint64_t sample) const {
        return entries_[body * samples_ + static_cast<std::size_t>(sample % samples_)];
    }

    std::size_t bodies_;
    std::size_t samples_;
    std::vector<Entry> entries_;
};

}  // namespace tactus
