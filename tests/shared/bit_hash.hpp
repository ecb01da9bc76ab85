#pragma once

#include <cstdint>
#include <cstring>

#include "core/math/types.hpp"

namespace tactus::shared {

// FNV-1a over the bits of numbers, each by itself: padding between them does not count.
class BitHash {
public:
    void add(double value) {
        std::uint64_t bits;
        std::memcpy(&bits, &value, sizeof bits);
        add(bits);
    }
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
    void add(std::uint64_t bits) {
        for (int i = 0; i < 8; ++i) {
            value_ = (value_ ^ ((bits >> (8 * i)) & 0xffu)) * 0x100000001b3u;
        }
    }
    std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325u;
};

}  // namespace tactus::shared
