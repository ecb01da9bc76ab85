// A x = b for one symmetric positive definite A with mostly zeros, again and again: A = L L^T is worked out
// once, and each solve goes through L twice. Four right sides are solved at once.
//
// The factor is made off the haptic thread; a solve allocates nothing and always does the same work.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/math/lanes.hpp"

namespace tactus {

// An order of elimination in which the factor stays sparse: nested dissection. What divides the rest in two
// halves comes last, and so on in each half. `neighbours[i]`: where A has an entry beside the diagonal.
std::vector<std::uint32_t> dissection_order(std::span<const Vec3> places,
                                            const std::vector<std::vector<std::uint32_t>>& neighbours);

class SparseFactor {
public:
    // Of the lower half, in any order; what is given twice is added.
    struct Entry {
        std::uint32_t row, column;  // row >= column
        double value;
    };

    // A is eliminated from the first unknown to the last. False, and nothing can be solved, where A is not
    // positive definite.
    bool make(std::size_t size, std::span<const Entry> entries);

    // b becomes x.
    void solve(std::span<Lanes> b) const;

    std::size_t size() const { return inverse_diagonal_.size(); }
    std::size_t entries() const { return rows_.size(); }  // of L, below the diagonal

private:
    void find_pattern(std::size_t size, const std::vector<std::vector<Entry>>& columns);

    std::vector<std::size_t> begin_;   // of each column's entries, and the end of the last
    std::vector<std::uint32_t> rows_;  // of the entries, rising within a column
    std::vector<double> values_;       // likewise
    std::vector<double> inverse_diagonal_;
};

}  // namespace tactus
