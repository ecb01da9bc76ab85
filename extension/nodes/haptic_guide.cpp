#include "nodes/haptic_guide.hpp"

#include <algorithm>
#include <utility>

#include "nodes/conversions.hpp"
#include "nodes/curve_reading.hpp"
#include "nodes/mesh_drawing.hpp"
#include "world/scene_frame.hpp"

namespace tactus {

using namespace godot;

namespace {

// Of a curve, so that no place of the guide is farther from it than a tenth of a millimeter (unit: meters).
constexpr double curve_tolerance = 2e-5;

}  // namespace

void HapticGuide::points_changed() {
    made_ = {};
    emit_changed();
}

std::vector<Vec3> HapticGuide::places() const {
    return curve_.is_valid() && form_ == HandGuide::Form::way ? places_near(curve_, curve_tolerance)
                                                              : from_godot(points_);
}

const std::shared_ptr<const GuideWay>& HapticGuide::way(const Mat3& scaling) const {
    if (made_.way == nullptr || !same_scaling(scaling, made_.scaling)) {
        std::vector<Vec3> places = this->places();
        std::ranges::for_each(places, [&](Vec3& place) { place = scaling * place; });
        made_.way = GuideWay::of(std::move(places));
        made_.scaling = scaling;
        made_.problem = check_way(*made_.way);
    }
    return made_.way;
}

// Of too many points as many are taken as show that.
HandGuide HapticGuide::described(const Transform3D& frame) const {
    HandGuide guide;
    guide.form = form_;
    guide.mode = mode_;
    guide.frame = pose_of(frame);
    guide.stiffness = stiffness_;
    guide.range = range_;
    const Mat3 scaling = scaling_of(frame_of(frame));
    if (form_ == HandGuide::Form::way) {
        guide.way = way(scaling);
        return guide;
    }
    const std::vector<Vec3> places = this->places();
    guide.count = std::min(places.size(), HandGuide::max_points);
    for (std::size_t i = 0; i < guide.count; ++i) {
        guide.points[i] = scaling * places[i];
    }
    return guide;
}

// A way of thousands of points is looked at once, and not in each frame.
std::string HapticGuide::problem_of(const HandGuide& guide) const {
    if (guide.form != HandGuide::Form::way) {
        return check_guide(guide);
    }
    HandGuide without_way = guide;
    without_way.form = HandGuide::Form::none;
    std::string error = check_guide(without_way);
    return error.empty() ? made_.problem : error;
}

HandGuide HapticGuide::guide(const Transform3D& frame) const {
    const HandGuide guide = described(frame);
    return problem_of(guide).empty() ? guide : HandGuide{};
}

Vector3 HapticGuide::get_place(const Vector3& hand) const {
    const HandGuide guide = this->guide(Transform3D());
    return guide.form != HandGuide::Form::none ? to_godot(guided_place(guide, from_godot(hand))) : hand;
}

Ref<ArrayMesh> HapticGuide::create_line_mesh(double thickness) const {
    return drawn_mesh(get_problem().is_empty() ? tube(places(), thickness, false) : Drawing{});
}

}  // namespace tactus
