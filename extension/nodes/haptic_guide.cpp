#include "nodes/haptic_guide.hpp"

#include <algorithm>

#include "core/geometry/places_along.hpp"
#include "nodes/curve_reading.hpp"
#include "nodes/mesh_drawing.hpp"

namespace tactus {

using namespace godot;

std::vector<Vec3> HapticGuide::places() const {
    if (curve_.is_valid() && form_ == HandGuide::Form::way) {
        return evenly_along(places_along(curve_), HandGuide::max_points);
    }
    return from_godot(points_);
}

// Of too many points as many are taken as show that.
HandGuide HapticGuide::described() const {
    const std::vector<Vec3> places = this->places();
    HandGuide guide;
    guide.form = form_;
    guide.count = places.size();
    const std::size_t taken = std::min(guide.count, HandGuide::max_points);
    std::copy_n(places.begin(), taken, guide.points.begin());
    guide.stiffness = stiffness_;
    guide.range = range_;
    return guide;
}

HandGuide HapticGuide::guide() const {
    const HandGuide guide = described();
    return check_guide(guide).empty() ? guide : HandGuide{};
}

Vector3 HapticGuide::get_place(const Vector3& hand) const {
    const HandGuide guide = this->guide();
    return guide.form != HandGuide::Form::none ? to_godot(guided_place(guide, from_godot(hand))) : hand;
}

Ref<ArrayMesh> HapticGuide::create_line_mesh(double thickness) const {
    return drawn_mesh(get_problem().is_empty() ? tube(places(), thickness, false) : Drawing{});
}

}  // namespace tactus
