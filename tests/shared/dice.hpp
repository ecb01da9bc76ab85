// Chance for attacks: splitmix64, since a hundred million draws should not take longer than what they test.
#pragma once

#include <cmath>
#include <cstdint>
#include <iterator>

#include "core/math/types.hpp"
#include "network/plausibility.hpp"

namespace tactus::shared {

class Dice {
public:
    explicit Dice(std::uint64_t seed) : state_(seed) {}
    std::uint64_t bits() {
        std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
        return z ^ (z >> 31);
    }
    std::uint64_t below(std::uint64_t limit) { return bits() % limit; }
    bool one_in(std::uint64_t n) { return below(n) == 0; }
    double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

    // Of all sizes, and the ones at which something ends.
    std::uint64_t number() {
        constexpr std::uint64_t ends[] = {0,
                                          1,
                                          2,
                                          511,
                                          512,
                                          513,
                                          1023,
                                          1024,
                                          1025,
                                          0xffff'ffffu,
                                          ~std::uint64_t{0},
                                          plausible::max_sequence,
                                          std::uint64_t{1} << 40};
        return one_in(3) ? ends[below(std::size(ends))] : bits() >> below(64);
    }
    // Over twelve orders of magnitude up to `most`, and `most` itself; never 0.
    double size(double most) { return one_in(8) ? most : most * std::pow(10.0, -12.0 * unit()); }
    double real(double most) { return one_in(2) ? -size(most) : size(most); }
    Vec3 vector(double most) { return {real(most), real(most), real(most)}; }
    Vec3 sizes(double most) { return {size(most), size(most), size(most)}; }
    Quat rotation() { return glm::normalize(Quat(real(1.0) + 1e-9, real(1.0), real(1.0), real(1.0))); }

private:
    std::uint64_t state_;
};

}  // namespace tactus::shared
