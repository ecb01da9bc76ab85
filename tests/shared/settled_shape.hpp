// A shape whose trees lie in memory as a world's do.
#pragma once

#include <algorithm>

#include "core/geometry/touch_shape.hpp"
#include "core/tree/triangle_tree.hpp"
#include "platform/large_pages.hpp"

namespace tactus::shared {

inline void settle(const TouchShape& shape) {
    for (const TouchPart& part : shape.parts) {
        if (const TriangleTree* const tree = part.tree()) {
            std::ranges::for_each(tree->memory(), move_to_large_pages);
        }
        if (part.touchable) {
            std::ranges::for_each(part.touchable->tree->memory(), move_to_large_pages);
        }
    }
}

}  // namespace tactus::shared
