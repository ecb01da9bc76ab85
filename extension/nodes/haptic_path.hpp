#pragma once

#include <godot_cpp/classes/array_mesh.hpp>
#include <godot_cpp/classes/curve3d.hpp>
#include <godot_cpp/classes/resource.hpp>
#include <godot_cpp/core/binder_common.hpp>
#include <godot_cpp/variant/packed_float64_array.hpp>
#include <godot_cpp/variant/packed_vector3_array.hpp>

#include "devices/hand_path.hpp"
#include "nodes/messages.hpp"
#include "nodes/properties.hpp"

namespace tactus {

// A scripted way of the hand: time in, position out. New, it is the path of the thesis.
class HapticPath : public godot::Resource {
    GDCLASS(HapticPath, godot::Resource)

public:
    enum Form : int64_t { FORM_CIRCLE_WAVE, FORM_POINTS, FORM_CURVE };

    TACTUS_PROPERTIES(HapticPath)

    godot::String get_problem() const;
    godot::PackedStringArray get_problems() const { return list_of(get_problem()); }
    double get_duration() const;
    godot::Vector3 sample(double time) const { return to_godot(sample_at(time).position); }
    godot::Vector3 sample_velocity(double time) const { return to_godot(sample_at(time).velocity); }
    godot::Ref<godot::ArrayMesh> create_line_mesh(double thickness) const;

    HandPath hand_path() const;

protected:
    static void _bind_methods();
    void _validate_property(godot::PropertyInfo& property) const;

private:
    void form_changed();
    HandSample sample_at(double time) const;  // at rest where the path cannot be followed

    Form form_ = FORM_CIRCLE_WAVE;
    CircleWave circle_;
    godot::PackedVector3Array points_;
    godot::PackedFloat64Array times_;
    PathInterpolation interpolation_ = PathInterpolation::catmull_rom;
    bool loop_ = false;
    godot::Ref<godot::Curve3D> curve_;
    double curve_speed_ = 0.1;  // (unit: meters per second)
    bool curve_loop_ = false;
};

}  // namespace tactus
