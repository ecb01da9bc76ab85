#include "core/haptics/neighbourhood.hpp"

#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

namespace tactus {

namespace {

// Packs that lie side by side have numbers side by side (Fibonacci hashing).
std::size_t place_of(std::uint32_t pack) {
    return (pack * 2'654'435'769u) >> 23;
}

}  // namespace

void Neighbourhood::remember_bounds() {
    std::memset(table_.data(), 0xff, sizeof(table_));  // no pack, bound -1
    for (std::size_t i = 0; i < count_; ++i) {
        if (packs_[i].bound < 0) {
            continue;
        }
        std::size_t place = place_of(packs_[i].pack);
        while (table_[place].bound >= 0) {
            place = (place + 1) % table_size;
        }
        table_[place] = {packs_[i].pack, packs_[i].bound};
    }
    std::swap(bounds_, old_bounds_);
}

std::int32_t Neighbourhood::remembered_bound(std::uint32_t pack) const {
    std::size_t place = place_of(pack);
    while (table_[place].bound >= 0 && table_[place].pack != pack) {
        place = (place + 1) % table_size;
    }
    return table_[place].bound;
}

bool Neighbourhood::gather(const TriangleTree& tree, const Vec3& point, double reach, double soon,
                           double odometer) {
    std::array<FoundPack, capacity> found;
    const FoundPacks packs = tree.packs_within(point, reach, found);
    if (!packs.complete) {
        clear();
        return false;
    }
    remember_bounds();
    count_ = packs.count;
    bound_count_ = 0;
    covered_until_ = odometer + reach;
    const LanesVec3 here = splat(point);
    for (std::size_t i = 0; i < count_; ++i) {
        double distance = static_cast<double>(found[i].distance);
        const std::uint32_t pack = found[i].pack;
        std::int32_t bound = remembered_bound(pack);
        if (bound >= 0) {
            const PackBound& old = (*old_bounds_)[static_cast<std::size_t>(bound)];
            distance = std::max(distance, smallest(least_distances(old, here)));
            bound = static_cast<std::int32_t>(bound_count_);
            (*bounds_)[bound_count_++] = old;
        } else if (distance <= soon) {
            tree.fetch_pack(pack);
        }
        packs_[i] = {pack, bound, -1.0};
        set_clear(i, odometer + distance);
    }
    for (std::size_t i = count_; i % lane_count != 0; ++i) {
        set_clear(i, std::numeric_limits<double>::infinity());
    }
    return true;
}

}  // namespace tactus
