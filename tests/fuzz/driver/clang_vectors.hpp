// Included before everything else that clang compiles: it compares doubles into vectors of long long, gcc
// into vectors of std::int64_t, and of core/'s lane_bits() neither takes the former as it is.
#pragma once

namespace tactus {

using ComparedLanes = long long __attribute__((vector_size(32)));

inline unsigned lane_bits(ComparedLanes mask) {
    unsigned bits = 0;
    for (int i = 0; i < 4; ++i) {
        bits |= mask[i] != 0 ? 1u << i : 0u;
    }
    return bits;
}

}  // namespace tactus
