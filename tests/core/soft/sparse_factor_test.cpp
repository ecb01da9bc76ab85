#include "core/soft/sparse_factor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "shared/random_values.hpp"

namespace tactus::sparse_factor_test {
namespace {

using Entry = SparseFactor::Entry;

// A grid of unknowns that pull at their neighbours, and a little at where they are.
struct Grid {
    std::vector<Vec3> places;
    std::vector<std::vector<std::uint32_t>> neighbours;
};

Grid grid(int side) {
    Grid grid;
    for (int i = 0; i < side * side * side; ++i) {
        grid.places.push_back(Vec3(i % side, i / side % side, i / (side * side)));
    }
    grid.neighbours.resize(grid.places.size());
    for (std::uint32_t i = 0; i < grid.places.size(); ++i) {
        for (std::uint32_t j = 0; j < grid.places.size(); ++j) {
            if (i != j && glm::distance(grid.places[i], grid.places[j]) < 1.1) {
                grid.neighbours[i].push_back(j);
            }
        }
    }
    return grid;
}

std::vector<Entry> entries_of(const Grid& grid, std::span<const std::uint32_t> order) {
    std::vector<std::uint32_t> place_of(order.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        place_of[order[i]] = i;
    }
    std::vector<Entry> entries;
    for (std::uint32_t i = 0; i < order.size(); ++i) {
        entries.push_back({place_of[i], place_of[i], 0.1});
        for (const std::uint32_t j : grid.neighbours[i]) {
            entries.push_back({place_of[i], place_of[i], 1.0});
            if (place_of[i] > place_of[j]) {
                entries.push_back({place_of[i], place_of[j], -1.0});
            }
        }
    }
    return entries;
}

TEST(SparseFactor, SolvesFourRightSidesAtOnce) {
    const Grid cube = grid(6);
    const std::vector<std::uint32_t> order = dissection_order(cube.places, cube.neighbours);
    const std::vector<Entry> entries = entries_of(cube, order);
    SparseFactor factor;
    ASSERT_TRUE(factor.make(order.size(), entries));
    shared::RandomValues random(3);
    std::vector<Lanes> wanted(order.size()), right(order.size(), splat(0.0));
    for (Lanes& row : wanted) {
        for (int i = 0; i < lane_count; ++i) {
            row[i] = random.between(-1.0, 1.0);
        }
    }
    for (const Entry& e : entries) {
        right[e.row] += wanted[e.column] * splat(e.value);
        if (e.row != e.column) {
            right[e.column] += wanted[e.row] * splat(e.value);
        }
    }
    factor.solve(right);
    for (std::size_t n = 0; n < right.size(); ++n) {
        for (int i = 0; i < lane_count; ++i) {
            ASSERT_NEAR(right[n][i], wanted[n][i], 1e-12);
        }
    }
}

TEST(SparseFactor, TheOrderNamesEachOnceAndKeepsTheFactorSparse) {
    const Grid cube = grid(8);
    const std::vector<std::uint32_t> order = dissection_order(cube.places, cube.neighbours);
    std::vector<std::uint32_t> sorted = order, as_they_come(order.size());
    std::ranges::sort(sorted);
    for (std::uint32_t i = 0; i < sorted.size(); ++i) {
        ASSERT_EQ(sorted[i], i);
        as_they_come[i] = i;
    }
    SparseFactor good, plain;
    ASSERT_TRUE(good.make(order.size(), entries_of(cube, order)));
    ASSERT_TRUE(plain.make(order.size(), entries_of(cube, as_they_come)));
    EXPECT_LT(good.entries(), 0.7 * static_cast<double>(plain.entries()));
}

TEST(SparseFactor, WhatIsNotPositiveDefiniteIsRefused) {
    SparseFactor factor;
    const std::vector<Entry> saddle{{0, 0, 1.0}, {1, 1, 1.0}, {1, 0, 2.0}};
    EXPECT_FALSE(factor.make(2, saddle));
    EXPECT_EQ(factor.size(), 0u);
    const std::vector<Entry> nonsense{{0, 0, std::nan("")}};
    EXPECT_FALSE(factor.make(1, nonsense));
}

}  // namespace
}  // namespace tactus::sparse_factor_test
