// What a body that gives looks like: written in each of its ticks, read whenever it is drawn.
#pragma once

#include <vector>

#include "core/math/types.hpp"
#include "realtime/triple_buffer.hpp"

namespace tactus {

class SoftView {
public:
    explicit SoftView(const std::vector<Vec3>& rest) : places_(rest) {}

    // The loop's.
    std::vector<Vec3>& back() { return places_.back(); }
    void publish() { places_.publish(); }

    // Who draws it: where the vertices of the surface are, in the body's frame (unit: meters). False where
    // that is the same as the last time.
    bool refresh() { return places_.refresh(); }
    const std::vector<Vec3>& places() const { return places_.front(); }

private:
    TripleBuffer<std::vector<Vec3>> places_;
};

}  // namespace tactus
