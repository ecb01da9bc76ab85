// What a playout of samples is told and what it says (jitter_buffer.hpp).
#pragma once

#include <cstdint>

namespace tactus {

struct JitterBufferSettings {
    std::uint32_t depth = 0;  // samples kept in hand at least, 0 … 200
    bool sparse = false;
    bool newest = false;     // the newest sample is played at once: no lag is kept, and none is filled in
    double seconds = 0.001;  // of a tick here, > 0
    double sample_seconds = 0.001;  // between two samples of the operator, > 0
    double guess_seconds = 0.2;     // sparse: so long a sample is carried on, >= 0
};

enum class Playing : std::uint8_t {
    waiting,  // nothing has come yet
    exact,
    filled,   // between two samples, of which some between them were lost or lie elsewhere in time
    guessed,  // sparse: carried on from the last one
    held,     // dry
};

struct BufferCounts {
    std::uint64_t exact = 0, filled = 0, guessed = 0, held = 0;
    std::uint64_t late = 0;         // came after their turn
    std::uint64_t doubled = 0;      // were there already
    std::uint64_t implausible = 0;  // of a place in the sequence where the operator cannot be
    std::uint64_t catch_ups = 0;    // times that playing faster was begun
    std::uint64_t restarts = 0;
};

}  // namespace tactus
