#include "nodes/haptic_guide.hpp"

#include <algorithm>

#include "nodes/mesh_drawing.hpp"

namespace tactus {

using namespace godot;

// Of too many points as many are taken as show that.
HandGuide HapticGuide::described() const {
    HandGuide guide;
    guide.form = static_cast<HandGuide::Form>(form_);
    guide.count = static_cast<std::size_t>(points_.size());
    const std::size_t taken = std::min(guide.count, HandGuide::max_points);
    for (std::size_t i = 0; i < taken; ++i) {
        guide.points[i] = from_godot(points_[static_cast<int64_t>(i)]);
    }
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
    std::vector<Vec3> points;
    for (const Vector3& point : points_) {
        points.push_back(from_godot(point));
    }
    return drawn_mesh(get_problem().is_empty() ? tube(points, thickness, false) : Drawing{});
}

}  // namespace tactus
