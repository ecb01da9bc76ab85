#include "nodes/haptic_path.hpp"

#include "nodes/conversions.hpp"
#include "nodes/curve_reading.hpp"
#include "nodes/mesh_drawing.hpp"

namespace tactus {

using namespace godot;

void HapticPath::form_changed() {
    notify_property_list_changed();
    emit_changed();
}

HandPath HapticPath::hand_path() const {
    if (form_ == FORM_CIRCLE_WAVE) {
        return circle_;
    }
    if (form_ == FORM_CURVE) {
        return at_speed(places_along(curve_), curve_speed_, curve_loop_);
    }
    KeyframePath path;
    path.interpolation = interpolation_;
    path.loop = loop_;
    for (int64_t i = 0; i < points_.size(); ++i) {
        const double time = i < times_.size() ? times_[i] : static_cast<double>(i);
        path.keyframes.push_back({from_seconds(time), from_godot(points_[i])});
    }
    return path;
}

String HapticPath::get_problem() const {
    if (form_ == FORM_CURVE && (curve_.is_null() || curve_->get_point_count() < 2)) {
        return "there is no curve of two points or more: set 'curve' to a Curve3D, as a Path3D has one";
    }
    if (form_ == FORM_POINTS && !times_.is_empty() && times_.size() != points_.size()) {
        return "there are " + String::num_int64(points_.size()) + " points and " +
               String::num_int64(times_.size()) +
               " times: give each point a time, or leave the times empty for one second a point";
    }
    return to_godot(problem_with(hand_path()));
}

double HapticPath::get_duration() const {
    const HandPath path = hand_path();
    return problem_with(path).empty() ? to_seconds(path_duration(path)) : 0.0;
}

HandSample HapticPath::sample_at(double time) const {
    const HandPath path = hand_path();
    return problem_with(path).empty() ? sample_path(path, from_seconds(time)) : HandSample{};
}

Ref<ArrayMesh> HapticPath::create_line_mesh(double thickness) const {
    return drawn_mesh(drawn_path(hand_path(), thickness));
}

}  // namespace tactus
