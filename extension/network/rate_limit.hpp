// So many a second, and a burst now and then: what comes beyond that is turned away before anything is done
// for it.
#pragma once

#include <algorithm>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

class RateLimit {
public:
    // `every`: nanoseconds for one, > 0; `burst`: at once after a pause, > 0.
    RateLimit(Nanoseconds every, std::int64_t burst) : every_(every), burst_(burst) {}

    // Whether one more may pass at `now`, of any steady clock.
    bool pass(Nanoseconds now) {
        // When the last one would have passed had all come evenly.
        due_ = std::max(due_, now - every_ * burst_);
        if (due_ > now) {
            return false;
        }
        due_ += every_;
        return true;
    }

private:
    Nanoseconds every_;
    std::int64_t burst_;
    Nanoseconds due_ = 0;
};

}  // namespace tactus
