// The edges at one vertex of a mesh: which two of them are one edge, and whether they lead all around.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <utility>
#include <vector>

#include "core/geometry/box_node.hpp"

namespace tactus {

// The edges at a vertex: 2 i leaves it along corner i, 2 i + 1 arrives there.
struct Spokes {
    static constexpr std::uint32_t nobody = 0xffff'ffffu;
    static constexpr std::size_t few = 2 * node_width;

    std::vector<std::uint32_t> to;       // the other vertex
    std::vector<std::uint32_t> partner;  // the one other spoke to the same vertex; nobody: none, or more

    void begin(std::size_t number) {
        count = number;
        if (to.size() < std::max(few, number)) {
            to.resize(std::max(few, number));
            partner.resize(to.size());
        }
        std::fill_n(to.data(), few, nobody);  // what is not set is no vertex
        std::fill_n(partner.data(), few, nobody);
        std::fill(partner.begin() + few, partner.end(), nobody);
    }

    void pair_up() {
        if (count <= few) {
            pair_few();
        } else {
            pair_many();
        }
    }

    // Its edge is nobody else's.
    void part(std::size_t spoke) {
        if (const std::uint32_t other = std::exchange(partner[spoke], nobody); other != nobody) {
            partner[other] = nobody;
        }
    }

    // Crossing an edge leads into the triangle beyond, and to its other edge here.
    bool are_one_round() const {
        std::size_t crossed = 0;
        std::size_t at = 0;
        do {
            if (count == 0 || partner[at] == nobody) {
                return false;
            }
            at = partner[at] ^ 1u;
            ++crossed;
        } while (at != 0);
        return 2 * crossed == count;
    }

private:
    using Row = std::int32_t __attribute__((vector_size(32)));

    // Each against all at once.
    void pair_few() {
        Row low, high;
        std::memcpy(&low, to.data(), sizeof low);
        std::memcpy(&high, to.data() + node_width, sizeof high);
        for (std::size_t i = 0; i < count; ++i) {
            const Row own = Row{} + static_cast<std::int32_t>(to[i]);
            const unsigned same = lane_bits(low == own) | lane_bits(high == own) << node_width;
            if (std::popcount(same) == 2) {
                partner[i] = static_cast<std::uint32_t>(std::countr_zero(same & ~(1u << i)));
            }
        }
    }

    void pair_many() {
        std::vector<std::uint32_t> order(count);
        std::iota(order.begin(), order.end(), 0u);
        std::ranges::sort(order, {}, [this](std::uint32_t spoke) { return to[spoke]; });
        for (std::size_t i = 0, end = 0; i < count; i = end) {
            for (end = i + 1; end < count && to[order[end]] == to[order[i]]; ++end) {
            }
            if (end - i == 2) {
                partner[order[i]] = order[i + 1];
                partner[order[i + 1]] = order[i];
            }
        }
    }

    std::size_t count = 0;
};

}  // namespace tactus
