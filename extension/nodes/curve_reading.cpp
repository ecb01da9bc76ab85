#include "nodes/curve_reading.hpp"

#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double spacing = 0.002;  // (unit: meters)
constexpr int halvings = 6;        // of a piece of the curve, at most
constexpr double apart = 1e-6;     // what is nearer is one place (unit: meters)

}  // namespace

std::vector<Vec3> places_along(const Ref<Curve3D>& curve) {
    std::vector<Vec3> places;
    if (curve.is_null() || curve->get_point_count() < 2) {
        return places;
    }
    const PackedVector3Array pieces = curve->tessellate_even_length(halvings, static_cast<real_t>(spacing));
    for (const Vector3& point : pieces) {
        const Vec3 place = from_godot(point);
        if (places.empty() || glm::distance(place, places.back()) > apart) {
            places.push_back(place);
        }
    }
    return places;
}

std::vector<Vec3> even_places_along(const Ref<Curve3D>& curve, std::size_t count) {
    const std::vector<Vec3> places = places_along(curve);
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
