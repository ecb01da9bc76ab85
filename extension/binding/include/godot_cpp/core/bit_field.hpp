#pragma once

#include <cstdint>

namespace godot {

// A set of flags of an engine enum; in memory the engine's own int64_t.
template <class T>
class BitField {
public:
    constexpr BitField() = default;
    constexpr BitField(int64_t value) : value_(value) {}
    constexpr BitField(T flag) : value_(static_cast<int64_t>(flag)) {}

    constexpr BitField& set_flag(BitField flags) {
        value_ |= flags.value_;
        return *this;
    }
    constexpr void clear_flag(BitField flags) { value_ &= ~flags.value_; }
    constexpr bool has_flag(BitField flags) const { return (value_ & flags.value_) != 0; }
    constexpr bool is_empty() const { return value_ == 0; }
    constexpr void clear() { value_ = 0; }
    constexpr operator int64_t() const { return value_; }

private:
    int64_t value_ = 0;
};

}  // namespace godot
