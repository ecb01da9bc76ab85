#include "core/soft/sparse_factor.hpp"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace tactus {

namespace {

class Dissection {
public:
    Dissection(std::span<const Vec3> places, const std::vector<std::vector<std::uint32_t>>& neighbours)
        : places_(places), neighbours_(neighbours), half_(places.size(), 0) {
        order_.reserve(places.size());
    }

    std::vector<std::uint32_t> order() {
        std::vector<std::uint32_t> all(places_.size());
        for (std::size_t i = 0; i < all.size(); ++i) {
            all[i] = static_cast<std::uint32_t>(i);
        }
        divide(all);
        return std::move(order_);
    }

private:
    static constexpr std::size_t few = 8;  // are eliminated as they come

    int longest_axis(const std::vector<std::uint32_t>& part) const {
        Vec3 low(std::numeric_limits<double>::infinity()), high(-low);
        for (const std::uint32_t i : part) {
            low = glm::min(low, places_[i]);
            high = glm::max(high, places_[i]);
        }
        const Vec3 size = high - low;
        return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    }

    void divide(std::vector<std::uint32_t>& part) {
        if (part.size() <= few) {
            order_.insert(order_.end(), part.begin(), part.end());
            return;
        }
        const int axis = longest_axis(part);
        std::ranges::sort(part, [&](std::uint32_t a, std::uint32_t b) {
            return places_[a][axis] != places_[b][axis] ? places_[a][axis] < places_[b][axis] : a < b;
        });
        std::vector<std::uint32_t> lower(part.begin(),
                                         part.begin() + static_cast<std::ptrdiff_t>(part.size() / 2));
        ++mark_;
        for (const std::uint32_t i : lower) {
            half_[i] = mark_;
        }
        std::vector<std::uint32_t> upper, between;
        for (std::size_t k = lower.size(); k < part.size(); ++k) {
            const bool divides =
                std::ranges::any_of(neighbours_[part[k]], [&](std::uint32_t n) { return half_[n] == mark_; });
            (divides ? between : upper).push_back(part[k]);
        }
        divide(lower);
        divide(upper);
        order_.insert(order_.end(), between.begin(), between.end());
    }

    std::span<const Vec3> places_;
    const std::vector<std::vector<std::uint32_t>>& neighbours_;
    std::vector<std::uint32_t> half_;  // the mark of the last lower half that held it
    std::uint32_t mark_ = 0;
    std::vector<std::uint32_t> order_;
};

}  // namespace

std::vector<std::uint32_t> dissection_order(std::span<const Vec3> places,
                                            const std::vector<std::vector<std::uint32_t>>& neighbours) {
    return Dissection(places, neighbours).order();
}

// Eliminating column j fills in, in the first column below it, everything else that it holds.
void SparseFactor::find_pattern(std::size_t size, const std::vector<std::vector<Entry>>& columns) {
    std::vector<std::vector<std::uint32_t>> pattern(size);
    begin_.assign(1, 0);
    rows_.clear();
    for (std::size_t j = 0; j < size; ++j) {
        std::vector<std::uint32_t>& rows = pattern[j];
        for (const Entry& entry : columns[j]) {
            if (entry.row > j) {
                rows.push_back(entry.row);
            }
        }
        std::ranges::sort(rows);
        rows.erase(std::ranges::unique(rows).begin(), rows.end());
        if (!rows.empty()) {
            std::vector<std::uint32_t>& parent = pattern[rows.front()];
            parent.insert(parent.end(), rows.begin() + 1, rows.end());
        }
        rows_.insert(rows_.end(), rows.begin(), rows.end());
        begin_.push_back(rows_.size());
        rows = {};
    }
}

bool SparseFactor::make(std::size_t size, std::span<const Entry> entries) {
    std::vector<std::vector<Entry>> columns(size);
    for (const Entry& entry : entries) {
        columns[entry.column].push_back(entry);
    }
    find_pattern(size, columns);
    values_.assign(rows_.size(), 0.0);
    inverse_diagonal_.assign(size, 0.0);
    // Column by column: what earlier columns leave of it, over the root of what they leave of its diagonal.
    std::vector<std::vector<std::size_t>> in_row(size);  // entries of earlier columns in this row
    std::vector<std::size_t> column_of(rows_.size());
    std::vector<double> work(size, 0.0);
    for (std::size_t j = 0; j < size; ++j) {
        for (const Entry& entry : columns[j]) {
            work[entry.row] += entry.value;
        }
        for (const std::size_t at : in_row[j]) {
            const double factor = values_[at];
            for (std::size_t i = at; i < begin_[column_of[at] + 1]; ++i) {
                work[rows_[i]] -= values_[i] * factor;
            }
        }
        const double pivot = work[j];
        if (!(pivot > 0.0 && std::isfinite(pivot))) {
            *this = {};
            return false;
        }
        inverse_diagonal_[j] = 1.0 / std::sqrt(pivot);
        work[j] = 0.0;
        for (std::size_t i = begin_[j]; i < begin_[j + 1]; ++i) {
            values_[i] = work[rows_[i]] * inverse_diagonal_[j];
            work[rows_[i]] = 0.0;
            column_of[i] = j;
            in_row[rows_[i]].push_back(i);
        }
    }
    return true;
}

void SparseFactor::solve(std::span<Lanes> b) const {
    Lanes* const x = b.data();
    const std::uint32_t* const rows = rows_.data();
    const double* const values = values_.data();
    for (std::size_t j = 0; j < size(); ++j) {
        x[j] = x[j] * splat(inverse_diagonal_[j]);
        const Lanes minus = -x[j];
        for (std::size_t i = begin_[j]; i < begin_[j + 1]; ++i) {
            x[rows[i]] = multiply_add(splat(values[i]), minus, x[rows[i]]);
        }
    }
    for (std::size_t j = size(); j-- > 0;) {
        // Two sums, so that one needs not wait for the other.
        Lanes even = splat(0.0), odd = splat(0.0);
        std::size_t i = begin_[j];
        for (; i + 1 < begin_[j + 1]; i += 2) {
            even = multiply_add(splat(values[i]), x[rows[i]], even);
            odd = multiply_add(splat(values[i + 1]), x[rows[i + 1]], odd);
        }
        if (i < begin_[j + 1]) {
            even = multiply_add(splat(values[i]), x[rows[i]], even);
        }
        x[j] = (x[j] - (even + odd)) * splat(inverse_diagonal_[j]);
    }
}

}  // namespace tactus
