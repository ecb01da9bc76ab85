#include "core/geometry/places_along.hpp"

#include <glm/common.hpp>
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

std::vector<Vec3> evenly_along(const std::vector<Vec3>& places, std::size_t count) {
    if (places.size() < 2) {
        return places;
    }
    double whole = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i) {
        whole += glm::distance(places[i - 1], places[i]);
    }
    std::vector<Vec3> even{places.front()};
    const double step = whole / static_cast<double>(count - 1);
    double way = 0.0;
    for (std::size_t i = 1; i < places.size(); ++i) {
        const double length = glm::distance(places[i - 1], places[i]);
        while (even.size() + 1 < count && step * static_cast<double>(even.size()) <= way + length) {
            const double share = (step * static_cast<double>(even.size()) - way) / length;
            even.push_back(glm::mix(places[i - 1], places[i], share));
        }
        way += length;
    }
    even.push_back(places.back());
    return even;
}

}  // namespace tactus
