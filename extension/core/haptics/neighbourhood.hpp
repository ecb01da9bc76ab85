// What a proxy remembers about the triangles around it. Consecutive ticks ask almost the same question: the
// packs found within `reach` of one place answer for every place until the proxy has travelled out of them,
// and most of them by their bound alone.
//
// Travel is measured by an odometer that only grows: the length of the proxy's path relative to the part.
#pragma once

#include <array>
#include <cstddef>

#include "core/geometry/triangle_tree.hpp"

namespace tactus {

struct Neighbourhood {
    static constexpr std::size_t capacity = 224;  // packs

    std::array<NearPack, capacity> packs;
    std::size_t count = 0;
    double covered_until = -1.0;  // odometer + distance up to which every pack is known

    // False where too many packs lie within reach: the neighbourhood is then empty and the tree itself must
    // be asked.
    bool gather(const TriangleTree& tree, const Vec3& point, double reach, double odometer) {
        const CollectResult found = tree.collect(point, reach, reach, packs);
        count = found.complete ? found.count : 0;
        covered_until = found.complete ? odometer + reach : -1.0;
        return found.complete;
    }
};

}  // namespace tactus
