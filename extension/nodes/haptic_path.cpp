#include "nodes/haptic_path.hpp"

#include "nodes/conversions.hpp"
#include "nodes/mesh_drawing.hpp"
#include "nodes/messages.hpp"

namespace tactus {

using namespace godot;

namespace {

constexpr int64_t max_waves = 1'000'000;

constexpr int line_steps = 600;  // points of a drawn path: 3 mm apart on the path of the thesis

bool starts_with(const StringName& name, const char* prefix) {
    return String(name).begins_with(prefix);
}

}  // namespace

void HapticPath::set_form(Form form) {
    if (!is_one_of(*this, "form", form, FORM_POINTS, "FORM")) {
        return;
    }
    change(form_, form);
    notify_property_list_changed();
}

void HapticPath::set_center(const Vector3& center) {
    if (!center.is_finite()) {
        refuse(*this, "circle_center", center, "made of finite numbers");
        return;
    }
    change(circle_.centre, from_godot(center));
}

Vector3 HapticPath::get_center() const {
    return to_godot(circle_.centre);
}

void HapticPath::set_radius(double radius) {
    if (!is_at_least_zero(radius)) {
        refuse(*this, "circle_radius", radius, "a finite number, 0 or more");
        return;
    }
    change(circle_.radius, radius);
}

void HapticPath::set_amplitude(double amplitude) {
    if (!is_at_least_zero(amplitude)) {
        refuse(*this, "circle_amplitude", amplitude, "a finite number, 0 or more");
        return;
    }
    change(circle_.amplitude, amplitude);
}

void HapticPath::set_turn_time(double seconds) {
    if (!(seconds >= 1e-3 && seconds <= 1e6)) {
        refuse(*this, "circle_turn_time", seconds, "between 0.001 and 1,000,000 seconds");
        return;
    }
    change(circle_.turn_time, from_seconds(seconds));
}

void HapticPath::set_waves(int64_t waves) {
    if (waves < 0 || waves > max_waves) {
        refuse(*this, "circle_waves", waves, "between 0 and 1,000,000");
        return;
    }
    change(circle_.waves, static_cast<int>(waves));
}

void HapticPath::set_points(const PackedVector3Array& points) {
    change(points_, points);
}
void HapticPath::set_times(const PackedFloat64Array& times) {
    change(times_, times);
}
void HapticPath::set_interpolation(Interpolation interpolation) {
    if (is_one_of(*this, "points_interpolation", interpolation, INTERPOLATION_SMOOTH, "INTERPOLATION")) {
        change(interpolation_, interpolation);
    }
}
void HapticPath::set_loop(bool loop) {
    change(loop_, loop);
}

HandPath HapticPath::hand_path() const {
    if (form_ == FORM_CIRCLE_WAVE) {
        return circle_;
    }
    KeyframePath path;
    path.interpolation =
        interpolation_ == INTERPOLATION_SMOOTH ? PathInterpolation::catmull_rom : PathInterpolation::linear;
    path.loop = loop_;
    for (int64_t i = 0; i < points_.size(); ++i) {
        const double time = i < times_.size() ? times_[i] : static_cast<double>(i);
        path.keyframes.push_back({from_seconds(time), from_godot(points_[i])});
    }
    return path;
}

String HapticPath::get_problem() const {
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

Vector3 HapticPath::sample(double time) const {
    const HandPath path = hand_path();
    return problem_with(path).empty() ? to_godot(sample_path(path, from_seconds(time)).position) : Vector3();
}

Vector3 HapticPath::sample_velocity(double time) const {
    const HandPath path = hand_path();
    return problem_with(path).empty() ? to_godot(sample_path(path, from_seconds(time)).velocity) : Vector3();
}

Ref<ArrayMesh> HapticPath::create_line_mesh(double thickness) const {
    const HandPath path = hand_path();
    std::vector<Vec3> points;
    const bool closed = form_ == FORM_CIRCLE_WAVE;
    if (problem_with(path).empty()) {
        const Nanoseconds duration = path_duration(path);
        for (int i = 0; i < line_steps; ++i) {
            points.push_back(
                sample_path(path, duration * i / (closed ? line_steps : line_steps - 1)).position);
        }
    }
    return tube_mesh(points, thickness, closed);
}

void HapticPath::_validate_property(PropertyInfo& property) const {
    const bool of_circle = starts_with(property.name, "circle_");
    const bool of_points = starts_with(property.name, "points_");
    if ((of_circle && form_ != FORM_CIRCLE_WAVE) || (of_points && form_ != FORM_POINTS)) {
        property.usage = PROPERTY_USAGE_STORAGE;
    }
}

}  // namespace tactus
