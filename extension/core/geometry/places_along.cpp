#include "core/geometry/places_along.hpp"

#include <glm/geometric.hpp>

namespace tactus {

std::vector<Vec3> apart(const std::vector<Vec3>& places, double least) {
    std::vector<Vec3> kept;
    for (const Vec3& place : places) {
        if (kept.empty() || glm::distance(place, kept.back()) > least) {
            kept.push_back(place);
        }
    }
    return kept;
}

}  // namespace tactus
