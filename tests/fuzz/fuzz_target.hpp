// A function of bytes that somebody else has written. libFuzzer plays it, led by the code that is reached, or
// the driver beside it, which any compiler makes (driver/).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>
#include <vector>

#include "core/math/types.hpp"

namespace tactus::fuzz {

using Bytes = std::vector<std::byte>;

// Whatever the bytes are: it returns, soon, and what must() says holds.
void play(std::span<const std::byte> input);

// What honest sides say: where the search begins.
std::vector<Bytes> seeds();

// An input whose first byte says what the others are.
inline Bytes of_kind(std::uint8_t kind, std::span<const std::byte> bytes) {
    Bytes input(1 + bytes.size(), static_cast<std::byte>(kind));
    std::ranges::copy(bytes, input.begin() + 1);
    return input;
}

// Counts with assertions and without.
inline void must(bool holds, const char* what) {
    if (!holds) {
        std::fprintf(stderr, "does not hold: %s\n", what);
        std::abort();
    }
}

// Bytes as numbers; zeros where they have come to their end.
class Numbers {
public:
    explicit Numbers(std::span<const std::byte> from) : from_(from) {}

    bool is_over() const { return from_.empty(); }
    std::span<const std::byte> rest() const { return from_; }

    std::span<const std::byte> bytes(std::size_t most) {
        const std::size_t count = most < from_.size() ? most : from_.size();
        const std::span<const std::byte> taken = from_.first(count);
        from_ = from_.subspan(count);
        return taken;
    }
    template <typename Integer>
    Integer integer() {
        Integer value{};
        const std::span<const std::byte> taken = bytes(sizeof value);
        if (!taken.empty()) {
            std::memcpy(&value, taken.data(), taken.size());
        }
        return value;
    }
    std::uint8_t byte() { return integer<std::uint8_t>(); }
    std::size_t below(std::size_t limit) { return limit == 0 ? 0 : integer<std::uint16_t>() % limit; }
    bool flag() { return (byte() & 1u) != 0; }

    // Mostly of a scene's size, in steps of a millimetre; one in eight any number there is, or none.
    double real() {
        const std::uint8_t kind = byte();
        return kind < 0xe0 ? 1e-3 * integer<std::int16_t>() : integer<double>();
    }
    Vec3 vector() {
        const double x = real(), y = real(), z = real();
        return {x, y, z};
    }

private:
    std::span<const std::byte> from_;
};

}  // namespace tactus::fuzz
