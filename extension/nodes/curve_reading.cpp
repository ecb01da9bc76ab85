#include "nodes/curve_reading.hpp"

#include <algorithm>
#include <glm/geometric.hpp>

#include "core/geometry/places_along.hpp"
#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double spacing = 0.002;    // (unit: meters)
constexpr int halvings = 6;          // of a piece of the curve, at most
constexpr double same_place = 1e-6;  // what is nearer is one (unit: meters)
constexpr int deepest = 9;           // halvings of a piece of a curve with handles

Vec3 place_on(const Curve3D& curve, int32_t piece, double share) {
    return from_godot(curve.sample(piece, static_cast<real_t>(share)));
}

double distance_to_chord(const Vec3& from, const Vec3& to, const Vec3& place) {
    const Vec3 way = to - from;
    const double squared = glm::dot(way, way);
    const double share = squared > 0.0 ? std::clamp(glm::dot(place - from, way) / squared, 0.0, 1.0) : 0.0;
    return glm::distance(place, from + way * share);
}

// All places after that at `from`, up to that at `to`. An even bend shows in the middle, one to and fro in
// the quarters.
void add_piece(const Curve3D& curve, int32_t piece, double from, double to, double tolerance, int depth,
               std::vector<Vec3>& places) {
    const Vec3 begin = place_on(curve, piece, from);
    const Vec3 end = place_on(curve, piece, to);
    const double step = 0.25 * (to - from);
    bool is_straight = true;
    for (int i = 1; i < 4; ++i) {
        const Vec3 between = place_on(curve, piece, from + step * i);
        is_straight = is_straight && distance_to_chord(begin, end, between) <= tolerance;
    }
    if (is_straight || depth == 0) {
        places.push_back(end);
        return;
    }
    const double middle = 0.5 * (from + to);
    add_piece(curve, piece, from, middle, tolerance, depth - 1, places);
    add_piece(curve, piece, middle, to, tolerance, depth - 1, places);
}

}  // namespace

std::vector<Vec3> places_along(const Ref<Curve3D>& curve) {
    if (curve.is_null() || curve->get_point_count() < 2) {
        return {};
    }
    return apart(from_godot(curve->tessellate_even_length(halvings, static_cast<real_t>(spacing))),
                 same_place);
}

std::vector<Vec3> places_near(const Ref<Curve3D>& curve, double tolerance) {
    if (curve.is_null() || curve->get_point_count() < 2) {
        return {};
    }
    std::vector<Vec3> places{place_on(**curve, 0, 0.0)};
    for (int32_t piece = 0; piece + 1 < curve->get_point_count(); ++piece) {
        add_piece(**curve, piece, 0.0, 1.0, tolerance, deepest, places);
    }
    return apart(places, same_place);
}

}  // namespace tactus
