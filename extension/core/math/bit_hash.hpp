// One number for the bits of many.
#pragma once

#include <bit>
#include <cstdint>

#include "core/math/types.hpp"

namespace tactus {

// Numbers one by one, so that padding between them does not count. Not for what somebody may want to forge:
// a word at a time, by the multiplication and the turn of FNV-1a and xxHash.
class BitHash {
public:
    void add(std::uint64_t bits) {
        constexpr std::uint64_t odd = 0x9e3779b97f4a7c15u;  // 2^64 over the golden ratio
        value_ = std::rotl((value_ ^ bits) * odd, 31);
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    void add(const Vec3& v) {
        add(v.x);
        add(v.y);
        add(v.z);
    }
    void add(const Quat& q) {
        add(q.w);
        add(q.x);
        add(q.y);
        add(q.z);
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace tactus
