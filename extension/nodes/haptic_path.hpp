#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "devices/hand_path.hpp"

namespace tactus {

// A scripted way of the hand: time in, position out. New, it is the path of the thesis.
class HapticPath : public godot::Resource {
    GDCLASS(HapticPath, godot::Resource)

public:
    enum Form : int64_t { FORM_CIRCLE_WAVE, FORM_POINTS };
    enum Interpolation : int64_t { INTERPOLATION_LINEAR, INTERPOLATION_SMOOTH };

    void set_form(Form form);
    Form get_form() const { return form_; }

    void set_center(const godot::Vector3& center);
    godot::Vector3 get_center() const;
    void set_radius(double radius);
    double get_radius() const { return circle_.radius; }
    void set_amplitude(double amplitude);
    double get_amplitude() const { return circle_.amplitude; }
    void set_turn_time(double seconds);
    double get_turn_time() const { return to_seconds(circle_.turn_time); }
    void set_waves(int64_t waves);
    int get_waves() const { return circle_.waves; }

    void set_points(const godot::PackedVector3Array& points);
    godot::PackedVector3Array get_points() const { return points_; }
    void set_times(const godot::PackedFloat64Array& times);
    godot::PackedFloat64Array get_times() const { return times_; }
    void set_interpolation(Interpolation interpolation);
    Interpolation get_interpolation() const { return interpolation_; }
    void set_loop(bool loop);
    bool is_looping() const { return loop_; }

    godot::String get_problem() const;
    double get_duration() const;
    godot::Vector3 sample(double time) const;
    godot::Vector3 sample_velocity(double time) const;
    godot::Ref<godot::ArrayMesh> create_line_mesh(double thickness) const;

    HandPath hand_path() const;

protected:
    static void _bind_methods();
    void _validate_property(godot::PropertyInfo& property) const;

private:
    template <typename Value>
    void change(Value& property, const Value& value) {
        property = value;
        emit_changed();
    }

    Form form_ = FORM_CIRCLE_WAVE;
    CircleWave circle_;
    godot::PackedVector3Array points_;
    godot::PackedFloat64Array times_;
    Interpolation interpolation_ = INTERPOLATION_SMOOTH;
    bool loop_ = false;
};

}  // namespace tactus

VARIANT_ENUM_CAST(tactus::HapticPath::Form);
VARIANT_ENUM_CAST(tactus::HapticPath::Interpolation);
