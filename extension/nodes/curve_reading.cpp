#include "nodes/curve_reading.hpp"

#include "core/geometry/places_along.hpp"
#include "nodes/conversions.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr double spacing = 0.002;    // (unit: meters)
constexpr int halvings = 6;          // of a piece of the curve, at most
constexpr double same_place = 1e-6;  // what is nearer is one (unit: meters)

}  // namespace

std::vector<Vec3> places_along(const Ref<Curve3D>& curve) {
    if (curve.is_null() || curve->get_point_count() < 2) {
        return {};
    }
    return apart(from_godot(curve->tessellate_even_length(halvings, static_cast<real_t>(spacing))),
                 same_place);
}

}  // namespace tactus
